"""What the reference cases leave unsaid: kinds of coordinates, units, what a scalar means, what
an expectation waits for."""
# The cases do not say what kind of quantity a coordinate is: here for the cases with units; the others are
# dimensionless.
KINDS = {
    "bead_rotating_hoop": {"theta": "angle"},
    "celest_kepler_e06": {"x": "length", "y": "length"},
    "double_atwood": {"x": "length", "y": "length"},
    "double_pendulum_equal": {"q1": "angle", "q2": "angle"},
    "elastic_pendulum": {"r": "length", "theta": "angle"},
    "electro_condenser_microphone": {"q": "charge", "x": "length"},
    "electro_dc_motor": {"q": "charge", "theta": "angle"},
    "foucault_linear": {"x": "length", "y": "length"},
    "gear_planetary_ring_fixed": dict.fromkeys(("ts", "tr", "tc", "tp"), "angle"),
    "iftomm_a01_pendulum": {"x": "length", "y": "length"},
    "iftomm_a05_flyball": {"phi": "angle", "b1": "angle", "b2": "angle", "s": "length"},
    "iftomm_spatial_slider_crank": {"th": "angle", "s": "length", "a1": "angle", "a2": "angle", "a3": "angle"},
    "ivp_andrews": dict.fromkeys(("beta", "theta", "gamma", "phi", "delta", "omega", "epsilon"), "angle"),
    "lagrange_top": {"theta": "angle", "phi": "angle", "psi": "angle"},
    "noether_caldirola_kanai": {"x": "length"},
    "nonhol_knife_edge": {"x": "length", "y": "length", "phi": "angle"},
    "nonhol_rolling_disc": {"x": "length", "y": "length", "q1": "angle", "q2": "angle", "q3": "angle"},
    "variational_brachistochrone": {"y": "length"},
    "sympy_four_bar_linkage": {"q1": "angle", "q2": "angle", "q3": "angle"},
}
UNITS = {"angle": ("rad", "rad/s", "rad/s^2"), "length": ("m", "m/s", "m/s^2"), "charge": ("C", "A", "A/s")}
MULTIPLIER_UNIT = {"ivp_andrews": "N", "iftomm_a01_pendulum": "N/m"}

# Numbers of a statement that carry a unit which the statement leaves unsaid.
UNSAID = {"iftomm_a05_flyball": {"0.3*wd^2/6": "0.3 [kg] wd^2/6"}}

# What a case states as a scalar, an expression or an integral and what the language says otherwise.
MORE = {
    "gear_planetary_ring_fixed": ("Willis: the ratio of sun and carrier, the speed of the planets",
                                  ["equation ts'' = (1 + rr/rs) tc''", "equation tp'' = (1 - rr/rp) tc''"]),
    "iftomm_a01_pendulum": ("the period; the tension in the rod, "
                            "-3 m g y/L = -2 L λ, at the turning points and at the bottom",
                            ["energy conserved rel 5e-14   # of the sum of its terms: 1e-12 J",
                             "x at 2.3678419475762374493 s = -1 m ± 1e-11",
                             "y at 2.3678419475762374493 s = 0 m ± 1e-11",
                             "-2 L multiplier(c1) at 0 s = 0 N ± 1e-11",
                             "-2 L multiplier(c1) at 0.591960486894059362 s = 29.43 N ± 1e-10",
                             "-2 L multiplier(c1) at 1.18392097378811872 s = 0 N ± 1e-10"]),
    "celest_kepler_e06": ("the period 2π", ["x at 6.2831853071795864769 s = 0.4 m ± 1e-11",
                                            "y at 6.2831853071795864769 s = 0 m ± 1e-11"]),
    "electro_dc_motor": ("the steady speed K V/(R b + K²) and current b V/(R b + K²)",
                         ["θ' at 20 s = 104.347826086956521739 rad/s ± 1e-9",
                          "q' at 20 s = 1.04347826086956521739 A ± 1e-9"]),
    "euler_top_elliptic": ("the period of the body rates", ["wa at 6.485572551922631999 = 0.6 ± 1e-12",
                                                            "wb at 6.485572551922631999 = 0 ± 1e-12",
                                                            "wc at 6.485572551922631999 = 1 ± 1e-12"]),
}

# Cases whose conserved quantities the search of `maup invariants` must find as well: `expect integral`.
SEARCHED = {
    "noether_caldirola_kanai", "noether_galilei_boost", "noether_helical", "noether_lrl_3d",
    "noether_relativistic_free",
    "noether_rotating_potential", "celest_henon_heiles", "celest_kepler_e06", "sicm_harmonic", "nonhol_knife_edge",
    "nonhol_particle", "nonhol_rolling_disc", "foucault_linear", "block_on_moving_wedge", "bead_rotating_hoop",
    "sicm_sliding_pendulum",
    "geodesic_sphere", "lagrange_top", "velocity_potential_weber", "celest_arenstorf_3loop",
}
# What a published symmetry is the generator of: names of conserved quantities of the same case.
CHARGES = {"noether_galilei_boost": ["K_x", "K_y"], "noether_lrl_3d": ["A_x", "A_y", "A_z"]}
# A case at other values of parameters, or in other words, for what it states of equilibria and steady motions:
# quantity → (suffix of the model, replaced or added formulas, replaced start, expectations).
VARIANTS = {
    "bead_rotating_hoop": {"critical angular speed": (
        "_critical", {"w": "sqrt(g/R)"}, None,
        ["frequencies squared at θ = 0 : 0 ± 1e-12", "equilibrium at θ = 0 is undecided"])},
    "electro_condenser_microphone": {"equilibrium condition": (
        "_pull_in", {"E": "sqrt(8*k*s0^3/(27*epsA))"}, None,
        ["equilibrium at x = s0/3, q = epsA E/(s0 - s0/3) is undecided   # two equilibria meet"]), },
    "nonhol_rolling_disc": {"critical spin for upright rolling (r=g=m=1)": (
        "_critical", {}, "x' = 1 [m/s]/sqrt(3), q3' = 1 [rad/s]/sqrt(3)",
        ["frequencies at q2 = 0, q3' = 1 [rad/s]/sqrt(3) : 0 rad/s, 0 rad/s, 0 rad/s, 0 rad/s ± 1e-12"])},
}
# The same as whole models, where the coordinates of the case fail at the point in question.
REWRITTEN = {
    "lagrange_top": {"sleeping-top threshold omega3": ("_upright", """param A = 0.002 kg m^2
param C = 0.0008 kg m^2
param mgl = 0.03 N m
let threshold = 2 sqrt(A mgl)/C
coord α, β, ψ : angle                  # Cardan angles: Euler's fail where the top stands upright
T = A (α'^2 cos^2 β + β'^2)/2 + C (ψ' + α' sin β)^2/2
V = mgl cos α cos β

start ψ' = threshold

# sleeping-top threshold omega3
expect equilibrium at α = 0, β = 0, ψ' = 0.999 threshold is unstable
expect equilibrium at α = 0, β = 0, ψ' = 1.001 threshold is undecided   # gyroscopic forces hold it
expect frequencies at α = 0, β = 0, ψ' = threshold : 0 rad/s, C threshold/(2 A), C threshold/(2 A) ± 1e-6\
   # a double root
expect frequencies at α = 0, β = 0, ψ' = 1.25 threshold : 0 rad/s, C threshold/(4 A), C threshold/A rel 1e-12
""")},
}
# What a case says of a linearization in words.
LINEARIZED = {"sympy_nonminimal_pendulum": ["frequencies squared at q1 = L, q2 = 0 : g/L rel 1e-12"]}

# Between what ends the stationary path of a case runs, and its Morse index: of the oscillator ⌈ω T/π⌉ − 1, of the
# others 0.
PATHS = {
    "action_harmonic": "from 0.4 at 0 to -1.1 at 2",
    "action_minimum_cosine": "from 1 at 0 to 0 at pi/2",
    "sicm_free_action": "from (7, 5, 1) at 0 to (47, 35, 21) at 10",
    "variational_brachistochrone": "from 0 at 0 to 2 R at pi R",
}

WAITS = {  # kind of an expectation → the capability that it waits for
    "eigenvalues": "modes", "equilibria": "modes",
    "characteristic_polynomial": "modes", "floquet_trace": "modes",
    "identity": "analysis",
    "field_equations": "fields", "field_solution": "fields", "conservation_law": "fields",
    "boundary_conditions": "fields", "event": "contacts", "event_times": "contacts",
    "matrix": "mass matrix on the command line", "expression": "analysis", "scalar": "analysis", "scalars": "analysis",
}
SCALARS = {  # what a scalar or an expression of a case waits for, where the general word does not say it
    "sicm_free_rigid_body": "mass matrix on the command line",
}


def waits_for(case_id, expectation):
    kind = expectation["kind"]
    if kind in ("scalar", "scalars", "expression", "identity") and case_id in SCALARS:
        return SCALARS[case_id]
    return WAITS[kind]

"""Reference values of the gallery's holonomic systems: closed forms, or equations in independent coordinates by hand.

Each function yields (subject, time, value) of the model of its name; scripts/reference_values.py prints and
checks them.
"""
import json
import pathlib

from precise import D, PI, acos, asin, atan, cos, cosh, ellipk, integrate, jacobi, motion, sin, sinh, sqrt

G = D("9.81")
DEG = PI / 180


def slope(f, t, order=1):
    """The first or second derivative of a closed form of t: 44 digits leave 20 after the differences."""
    h = D("1e-9")
    low, middle, high = f(t - h), f(t), f(t + h)
    return (high - low) / (2 * h) if order == 1 else (high - 2 * middle + low) / h ** 2


def cartesian_pendulum():
    """sin(θ/2) = k sn(K + ω0 t, k); tension m g (3 cos θ − 2 cos θ0) (Landau and Lifshitz, Mechanics, §11)."""
    k, w = sin(30 * DEG), sqrt(G)
    for t in (D(1), D(10)):
        theta = 2 * asin(k * jacobi(ellipk(k * k) + w * t, k * k)[0])
        yield "x", f"{t} s", sin(theta)
        yield "y", f"{t} s", -cos(theta)
        yield "reaction(rod)", f"{t} s", G * (3 * cos(theta) - 2 * cos(60 * DEG))
        yield "multiplier(rod)", f"{t} s", -G * (3 * cos(theta) - 2 * cos(60 * DEG)) / 2


def dumbbell():
    """The centre of mass falls on a parabola, the rod turns uniformly; tension μ l ω², μ the reduced mass."""
    l, w, t = D("0.5"), D(4), D(2)
    x, y = 3 * t, 5 * t - G * t * t / 2
    yield "x1", "2 s", x + 2 * l / 3 * cos(w * t)
    yield "y1", "2 s", y + 2 * l / 3 * sin(w * t)
    yield "x2", "2 s", x - l / 3 * cos(w * t)
    yield "y2", "2 s", y - l / 3 * sin(w * t)
    yield "reaction(rod)", "2 s", D(2) / 3 * l * w * w


def bead_on_wire():
    """On the ellipse x = a cos s, y = b sin s; the wire carries what m r'' and the weight leave over."""
    a, b, m = D(1), D("0.5"), D("0.1")

    def acceleration(_, q, v):
        s, c = sin(q[0]), cos(q[0])
        return [-((a * a - b * b) * s * c * v[0] ** 2 + G * b * c) / (a * a * s * s + b * b * c * c)]

    for t, (q, v) in zip((1, 5), motion(acceleration, [D(0)], [D(0)], (1, 5))):
        s, c, second = sin(q[0]), cos(q[0]), acceleration(0, q, v)[0]
        ax, ay = -a * (c * v[0] ** 2 + s * second), b * (-s * v[0] ** 2 + c * second)
        nx, ny = c / a, s / b  # the gradient of x²/a² + y²/b² − 1 points outwards
        yield "x", f"{t} s", a * c
        yield "y", f"{t} s", b * s
        yield "reaction(wire)", f"{t} s", m * (ax * nx + (ay + G) * ny) / sqrt(nx * nx + ny * ny)


def crank_and_rod(t):
    """Coupler and rocker angles of the four-bar linkage by the law of cosines on its diagonal (Freudenstein)."""
    a, b, c, d = D("0.1"), D("0.3"), D("0.25"), D("0.3")
    crank = 6 * t
    x, y = d - a * cos(crank), -a * sin(crank)  # from the crank's end to the rocker's pivot
    diagonal = sqrt(x * x + y * y)
    lean = asin(y / diagonal)
    coupler = lean + acos((b * b + diagonal ** 2 - c * c) / (2 * b * diagonal))
    ex, ey = a * cos(crank) + b * cos(coupler) - d, a * sin(crank) + b * sin(coupler)
    return crank, coupler, acos(ex / c) if ey > 0 else -acos(ex / c)


def four_bar():
    """Angles by the law of cosines; the driving torque from the power balance τ ω = d(T + V)/dt."""
    a, b, c, d = D("0.1"), D("0.3"), D("0.25"), D("0.3")
    m1, m2, m3 = D("0.5"), D("1.5"), D("1.2")

    def energy(t):
        """That of three slender bars: m (|A|² + |B|² + A·B)/6 of the velocities of their ends, and the weight of their
        middles."""
        ends = lambda s: (lambda p: [a * cos(p[0]), a * sin(p[0]), d + c * cos(p[2]), c * sin(p[2])])(crank_and_rod(s))
        ax, ay, bx, by = ends(t)
        h = D("1e-11")
        va = [(high - low) / (2 * h) for low, high in zip(ends(t - h), ends(t + h))]
        a2, b2 = va[0] ** 2 + va[1] ** 2, va[2] ** 2 + va[3] ** 2
        return (m1 * a2 + m3 * b2 + m2 * (a2 + b2 + va[0] * va[2] + va[1] * va[3])) / 6 + G / 2 * (
            (m1 + m2) * ay + (m2 + m3) * by)

    for t in (D("0.3"), D(2)):
        _, coupler, rocker = crank_and_rod(t)
        yield "β", f"{t} s", coupler
        yield "γ", f"{t} s", rocker
        yield "reaction(drive)", f"{t} s", slope(energy, t) / 6


def slider_crank():
    """x = r cos ωt + √(l² − r² sin² ωt); the rod pulls with −m x'' l/(x − r cos ωt), the crank with M = r × that."""
    r, l, m, w = D("0.05"), D("0.15"), D("0.4"), D(100)
    x = lambda t: r * cos(w * t) + sqrt(l * l - (r * sin(w * t)) ** 2)
    for label, t in (("5 ms", D("0.005")), ("100 ms", D("0.1"))):
        tension = -m * slope(x, t, 2) * l / (x(t) - r * cos(w * t))
        yield "x", label, x(t)
        yield "x'", label, slope(x, t)
        yield "reaction(rod)", label, tension
        yield "reaction(drive)", label, m * slope(x, t, 2) * slope(x, t) / w


def parallelogram():
    """A pendulum of inertia m l² + 3 J and weight moment (m + 3/2 m_c) g l: the coupler does not turn."""
    m, l, mc = D(2), D("0.4"), D("0.3")
    inertia, moment = m * l * l + mc * l * l, (m + 3 * mc / 2) * G * l  # three slender cranks: 3 · m_c l²/3
    k, w = sin(30 * DEG), sqrt(moment / inertia)
    for t in (D(1), D(5)):
        theta = 2 * asin(k * jacobi(ellipk(k * k) + w * t, k * k)[0])
        yield "θ1", f"{t} s", theta
        yield "θ3", f"{t} s", theta
        yield "x", f"{t} s", l * sin(theta)
        yield "y", f"{t} s", -l * cos(theta)
        yield "α", f"{t} s", D(0)


def planetary_gear():
    """Newton for each wheel: sun τ − rs F, planets rp (F − E), carrier (rs + rp)(F + E),
    with F and E the tooth forces."""
    rs, rp, tau = D("0.02"), D("0.015"), D("0.1")
    i_s, i_p, i_c = D("1e-5"), 3 * D("4e-6"), D("8e-5") + 3 * D("0.05") * (rs + rp) ** 2
    rr = rs + 2 * rp
    # rs (αs − αc) = −rp (αp − αc) and −rr αc = rp (αp − αc) give αs = (1 + rr/rs) αc, αp = (1 − rr/rp) αc
    s, p = 1 + rr / rs, 1 - rr / rp
    c = tau * s / (i_s * s * s + i_p * p * p + i_c)
    yield "φs''", "0 s", s * c
    yield "φc", "1 s", c / 2
    yield "φp'", "1 s", p * c
    sun_force = (tau - i_s * s * c) / rs
    planet_force = i_p * p * c / rp  # αp i_p = −rp (sun_force) + rp (ring_force)
    yield "reaction(sun_mesh)", "1 s", -sun_force
    yield "reaction(ring_mesh)", "1 s", -(sun_force + planet_force)
    yield "reaction(hold)", "1 s", rr * (sun_force + planet_force)


def heavy_top():
    """The top of models/lagrange_top.lag: nutation, precession, spin; the centre of mass is
    h (sin θ sin φ, −sin θ cos φ, cos θ)."""
    a, c, mgl = D("1.4e-4"), D("6e-5"), D("0.1") * G * D("0.03")
    theta0, spin, h = 25 * DEG, D(200), D("0.03")
    p_psi, p_phi = c * spin, c * spin * cos(theta0)

    def rates(_, y):
        s, k = sin(y[0]), cos(y[0])
        precession = (p_phi - p_psi * k) / (a * s * s)
        nutation = precession ** 2 * s * k - p_psi * precession * s / a + mgl * s / a
        return [y[1], nutation, precession, p_psi / c - precession * k]

    for t, y in zip(("0.5", "2"), integrate(rates, [theta0, D(0), D(0), D(0)], ["0.5", 2])):
        yield "top.x", f"{t} s", h * sin(y[0]) * sin(y[2])
        yield "top.y", f"{t} s", -h * sin(y[0]) * cos(y[2])
        yield "top.z", f"{t} s", h * cos(y[0])


def tumbling_satellite():
    """Jacobi's solution, started where ω1 = 0 (Landau and Lifshitz, Mechanics, §37): that of models/satellite.lag."""
    from reference_values import satellite
    for subject, time, value in satellite():
        yield subject, time, value


def chain():
    """Equilibrium of six massless links with five weights between two pegs: the horizontal pull H is the same
    in all links."""
    l, m, span, n = D("0.3"), D("0.2"), D("1.2"), 6

    def width(pull):
        return sum(l * pull / sqrt(pull ** 2 + (m * G * (D(n - 1) / 2 - i)) ** 2) for i in range(n))

    low, high = D("0.01"), D(10)
    for _ in range(140):
        middle = (low + high) / 2
        low, high = (middle, high) if width(middle) < span else (low, middle)
    x = y = D(0)
    for i in range(n):
        vertical = m * G * (D(n - 1) / 2 - i)
        tension = sqrt(low ** 2 + vertical ** 2)
        x, y = x + l * low / tension, y - l * vertical / tension
        if i < 3:
            yield f"x{i + 1}", "60 s", x
            yield f"y{i + 1}", "60 s", y
        yield f"reaction(link{i + 1})", "60 s", tension


def bead_on_rotating_rod():
    """r = r0 cosh Ωt; the rod pushes with 2 m Ω r' = 2 m Ω² r0 sinh Ωt (Landau and Lifshitz, Mechanics, §39)."""
    w, r0, m = D(2), D("0.1"), D("0.05")
    for t in (D(1), D("2.5")):
        r = r0 * cosh(w * t)
        yield "x", f"{t} s", r * cos(w * t)
        yield "y", f"{t} s", r * sin(w * t)
        yield "reaction(rod)", f"{t} s", 2 * m * w * w * r0 * sinh(w * t)


def squeezer():
    """Recomputed in quadruple precision by extrapolation (tests/problems/cases/ivp_andrews.json)."""
    root = pathlib.Path(__file__).resolve().parent.parent
    case = json.loads((root / "tests/problems/cases/ivp_andrews.json").read_text())
    state, forces, accelerations = (e["values_recomputed"] for e in case["expected"])
    names = {"theta": "Θ", "phi": "Φ", "omega": "Ω", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε"}
    for name, letter in names.items():
        yield letter, "30 ms", D(state[name])
        yield letter + "'", "30 ms", D(state[f"dot({name})"])
    for name, letter in names.items():
        yield letter + "''", "30 ms", D(accelerations[name])
    for k, loop in enumerate(("loop1_x", "loop1_y", "loop2_x", "loop2_y", "loop3_x", "loop3_y"), 1):
        yield f"multiplier({loop})", "30 ms", -D(forces[f"lambda{k}"])


def bennett_linkage():
    """tan(θ1/2) tan(θ2/2) = sin((β + α)/2)/sin((β − α)/2), θ3 = −θ1 (Hunt, Kinematic Geometry of Mechanisms)."""
    alpha = 60 * DEG
    beta = asin(sin(alpha) / 2)
    ratio = sin((beta + alpha) / 2) / sin((beta - alpha) / 2)
    for t in (D("0.5"), D(5)):
        theta = 60 * DEG + 2 * t
        second = 2 * atan(ratio * cos(theta / 2) / sin(theta / 2))  # jumps by a turn where θ1 passes one
        yield "θ1", f"{t} s", theta
        yield "θ2", f"{t} s", second - 2 * PI * (theta // (2 * PI)) * (1 if ratio > 0 else -1)
        yield "θ3", f"{t} s", -theta


MODELS = [bennett_linkage, cartesian_pendulum, dumbbell, bead_on_wire, four_bar, slider_crank, squeezer, parallelogram,
          planetary_gear, heavy_top, tumbling_satellite, chain, bead_on_rotating_rod]

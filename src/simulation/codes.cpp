#include <maupertuis/codes.hpp>

#include <array>

namespace maupertuis {
namespace {

constexpr std::array entries{
    CodeEntry{
        "E0701", "the run has no length",
        "A run needs an end: a `run` statement in the model, --duration on the command line, or times asked for "
        "with --at. `run 10 s` runs for ten seconds; `run until P.y = 0 within 60 s` stops when the condition is met.",
        "# maup simulate\ncoord θ : angle\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
        "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\nstart θ = 60 deg\n",
        "# maup simulate\ncoord θ : angle\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
        "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\nstart θ = 60 deg\nrun 10 s\n"},
    CodeEntry{
        "E0702", "a start value is not a finite number",
        "The initial state is computed from the parameters. A division by zero or a root of a negative number in a "
        "start value leaves no state to begin from.",
        "", ""},
    CodeEntry{"E0703", "the length of the run is not a finite number",
              "The duration of a run is computed from the parameters; here it is infinite or undefined.", "", ""},
    CodeEntry{
        "E0704", "the output interval is not a positive time",
        "`output every 10 ms` sets the time between two rows of the trajectory. It must be positive; the direction "
        "of time follows from the run.",
        "", ""},
    CodeEntry{"E0705", "the trajectory would be too large",
              "The trajectory is kept in memory until it is written. With more than twenty million rows, of fields ten "
              "values each, it would not fit; choose a longer interval between rows. The steps of the integrator are "
              "not affected.",
              "# maup simulate\ncoord x : length\nparam m = 1 kg, k = 4 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
              "start x = 10 cm\nrun 5 s\noutput every 1 ps\n",
              "# maup simulate\ncoord x : length\nparam m = 1 kg, k = 4 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
              "start x = 10 cm\nrun 5 s\noutput every 1 ms\n"},
    CodeEntry{"E0706", "a time that is asked for is not on the way of the run",
              "A run goes one way from its start: forwards, or backwards with a negative duration. States on the other "
              "side of the start need a run of their own.",
              "# maup simulate --at -1s\ncoord x : length\nparam m = 1 kg, k = 4 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
              "start x = 10 cm\nrun 5 s\n",
              "# maup simulate --at -1s --duration -5s\ncoord x : length\nparam m = 1 kg, k = 4 N/m\nT = 1/2 m x'^2\n"
              "V = 1/2 k x^2\nstart x = 10 cm\nrun 5 s\n"},
    CodeEntry{
        "E0707", "the start violates a constraint",
        "`start exactly` keeps every written value as it stands. Here the written values do not lie on the "
        "constraints, whatever the others are. Without `exactly` they are moved by the least kinetic change, with a "
        "warning.",
        "# maup simulate\ncoord x, y : length\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\npoint P mass m at (x, y)\n"
        "gravity (0, -g)\nconstraint x^2 + y^2 = l^2 name rod\nstart exactly x = 0.6 m, y = -0.7 m\nrun 5 s\n",
        "# maup simulate\ncoord x, y : length\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\npoint P mass m at (x, y)\n"
        "gravity (0, -g)\nconstraint x^2 + y^2 = l^2 name rod\nstart exactly x = 0.6 m, y = -0.8 m\nrun 5 s\n"},
    CodeEntry{
        "E0708", "the constraints cannot be met",
        "From the start, and from several other configurations, no configuration was found on which all "
        "constraints hold: a loop that cannot close, or constraints that contradict each other. The message names a "
        "smallest set of them that clashes. The search is local: a start near a configuration that you know to "
        "be possible helps it.",
        "# maup simulate\ncoord x, y : length\nparam m = 1 kg, a = 1 m, b = 1 m, d = 3 m, g = 9.81 m/s^2\n"
        "point P mass m at (x, y)\ngravity (0, -g)\nconstraint x^2 + y^2 = a^2 name left_rod\n"
        "constraint (x - d)^2 + y^2 = b^2 name right_rod\nstart x = 0.6 m, y = -0.8 m\nrun 1 s\n",
        "# maup simulate\ncoord x, y : length\nparam m = 1 kg, a = 1 m, b = 1 m, d = 1.2 m, g = 9.81 m/s^2\n"
        "point P mass m at (x, y)\ngravity (0, -g)\nconstraint x^2 + y^2 = a^2 name left_rod\n"
        "constraint (x - d)^2 + y^2 = b^2 name right_rod\nstart x = 0.6 m, y = -0.8 m\nrun 1 s\n"},
    CodeEntry{"E0709", "no velocities satisfy the constraints",
              "At the configuration of the start the constraints on the velocities contradict each other or the rates "
              "that the start asks for.",
              "# maup simulate\ncoord x : length, φ : angle\nparam m = 1 kg, R = 20 cm, v = 1 m/s, Ω = 6 rad/s\n"
              "body disk mass m inertia m R^2/2 at (x, R) rotation angle φ\nconstraint x' + R φ' = 0 name rolling\n"
              "constraint x' = v name pull\nconstraint φ' = -Ω name motor\nrun 2 s\n",
              "# maup simulate\ncoord x : length, φ : angle\nparam m = 1 kg, R = 20 cm, v = 1 m/s\n"
              "body disk mass m inertia m R^2/2 at (x, R) rotation angle φ\nconstraint x' + R φ' = 0 name rolling\n"
              "constraint x' = v name pull\nrun 2 s\n"},
    CodeEntry{"W0701", "written start values were moved onto the constraints",
              "The values that the start gives contradict the constraints or each other, so that no choice of the "
              "others can make them hold. They were moved by the least kinetic change. `start exactly` makes this an "
              "error.",
              "# maup simulate\ncoord x, y : length\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
              "point P mass m at (x, y)\ngravity (0, -g)\nconstraint x^2 + y^2 = l^2 name rod\n"
              "start x = 0.6 m, y = -0.7 m\nrun 5 s\n",
              "# maup simulate\ncoord x, y : length\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
              "point P mass m at (x, y)\ngravity (0, -g)\nconstraint x^2 + y^2 = l^2 name rod\n"
              "start x = 0.6 m, y = -0.8 m\nrun 5 s\n"},
    CodeEntry{
        "W0703", "the run was carried out without compiled code",
        "--backend compiled asks for machine code, which the module with LLVM makes. It may be missing, belong to "
        "another build, or not do this: a very large model, or a method other than "
        "Taylor's. The results of the interpreter are the same to rounding, they only take longer.",
        "# maup simulate --method variational --step 10ms --backend compiled\ncoord θ : angle\n"
        "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\nT = 1/2 m l^2 θ'^2\nV = -m g l cos θ\nstart θ = 60 deg\nrun 10 s\n",
        "# maup simulate --method variational --step 10ms\ncoord θ : angle\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
        "T = 1/2 m l^2 θ'^2\nV = -m g l cos θ\nstart θ = 60 deg\nrun 10 s\n"},
    CodeEntry{
        "N0704", "compiled code would have paid for this run, and is not here",
        "A run of many steps takes machine code from the module with LLVM where it can. This installation has none "
        "that works; the interpreter carried the run out, with the same results to rounding.",
        "", ""},
    CodeEntry{
        "W0705", "the kept code of earlier runs is not as it should be",
        "Machine code is kept in $XDG_CACHE_HOME/maupertuis or ~/.cache/maupertuis, so that the next run of the same "
        "model begins at once. The folder cannot be written; or it belongs to another user, or others can write to it, "
        "who could have put in code that "
        "would run as you: then it is neither written nor read. A file in it that is not yours alone is not run, and "
        "replaced. The run itself is not affected.",
        "", ""},
    CodeEntry{
        "N0702", "the stiff method took over",
        "Where a fast, strongly damped motion has died out, an explicit method still has to follow its time scale. "
        "The default method sees that its steps are far shorter than the times in which the velocities change and "
        "goes on with implicit steps (Radau's). They keep a tolerance (1e-12, or --tol), not rounding level. --method "
        "taylor forbids the change, --method stiff uses it from the start.",
        "# maup simulate\ncoord x : length\nparam m = 1 g, k = 10 N/m, c = 1000 kg/s\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
        "D = 1/2 c x'^2\nstart x = 1 cm\nrun 100 s\n",
        "# maup simulate\ncoord x : length\nparam m = 1 g, k = 10 N/m, c = 0.05 kg/s\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
        "D = 1/2 c x'^2\nstart x = 1 cm\nrun 1 s\n"},
    CodeEntry{
        "N0701", "the start was found by a search",
        "The coordinates that the start does not give have no solution near zero, so that one was searched for from "
        "several points. A mechanism can often be assembled in more than one way: give more start values to choose.",
        "# maup simulate\ncoord x, y : length\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\npoint P mass m at (x, y)\n"
        "gravity (0, -g)\nconstraint x^2 + y^2 = l^2 name rod\nrun 2 s\n",
        "# maup simulate\ncoord x, y : length\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\npoint P mass m at (x, y)\n"
        "gravity (0, -g)\nconstraint x^2 + y^2 = l^2 name rod\nstart x = 0.6 m, y = -0.8 m\nrun 2 s\n"},
    CodeEntry{"E0720", "the variational method does not take constraints between velocities",
              "A constraint between velocities that no constraint between positions implies follows d'Alembert's "
              "principle, not "
              "Hamilton's: variations obey other conditions than motions do. The default method takes it.",
              "# maup simulate --method variational --step 10ms\ncoord x, y : length, φ : angle\n"
              "param m = 1 kg, J = 0.02 kg m^2, g = 9.81 m/s^2, β = 20 deg\nT = 1/2 m (x'^2 + y'^2) + 1/2 J φ'^2\n"
              "V = -m g x sin β\nconstraint y' cos φ = x' sin φ name blade\nstart φ' = 1 rad/s\nrun 2 s\n",
              "# maup simulate\ncoord x, y : length, φ : angle\n"
              "param m = 1 kg, J = 0.02 kg m^2, g = 9.81 m/s^2, β = 20 deg\nT = 1/2 m (x'^2 + y'^2) + 1/2 J φ'^2\n"
              "V = -m g x sin β\nconstraint y' cos φ = x' sin φ name blade\nstart φ' = 1 rad/s\nrun 2 s\n"},
    CodeEntry{
        "E0731", "the variational method does not take a degenerate Lagrangian",
        "A variational step is found from the momenta at its ends. Where det ∂²L/∂q'∂q' = 0 they do not determine "
        "the velocities. The default method takes such Lagrangians.",
        "# maup simulate --method variational --step 10ms\ndimensionless\ncoord x, y : number\n"
        "L = x y' - 1/2 x^2 - 1/2 y^2\nstart x = 1\nrun 1\n",
        "# maup simulate\ndimensionless\ncoord x, y : number\nL = x y' - 1/2 x^2 - 1/2 y^2\nstart x = 1\nrun 1\n"},
    CodeEntry{"E0721", "the variational method needs the length of its step",
              "The steps of a variational integrator are all alike, which is why it keeps momenta and the symplectic "
              "form; its "
              "length is given with --step. It must be positive, and not so short that a run has not as many.",
              "# maup simulate --method variational\ncoord θ : angle\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
              "T = 1/2 m l^2 θ'^2\nV = -m g l cos θ\nstart θ = 60 deg\nrun 10 s\n",
              "# maup simulate --method variational --step 10ms\ncoord θ : angle\n"
              "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\nT = 1/2 m l^2 θ'^2\nV = -m g l cos θ\nstart θ = 60 deg\n"
              "run 10 s\n"},
    CodeEntry{
        "E0722", "there is no variational step of this order",
        "Steps on s Gauss nodes have order 2s, on s Lobatto nodes 2s - 2 (under constraints). Even orders from 2 to "
        "12 are offered.",
        "# maup simulate --method variational --step 10ms --order 20\ncoord θ : angle\n"
        "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\nT = 1/2 m l^2 θ'^2\nV = -m g l cos θ\nstart θ = 60 deg\nrun 10 s\n",
        "# maup simulate --method variational --step 10ms --order 4\ncoord θ : angle\n"
        "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\nT = 1/2 m l^2 θ'^2\nV = -m g l cos θ\nstart θ = 60 deg\nrun 10 s\n"},
    CodeEntry{"E0724", "the tolerance of the stiff method is no number between 0 and 1",
              "It is relative: the error of a step is compared with the size of each coordinate and velocity times the "
              "tolerance.",
              "", ""},
    CodeEntry{"E0725", "this method calculates in double alone",
              "--precision quad and --precision 100 run Taylor's method, whose order grows with the number of digits. "
              "The stiff and the "
              "variational method have bounded orders.",
              "# maup simulate --precision quad --method stiff\ncoord θ : angle\n"
              "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\nT = 1/2 m l^2 θ'^2\nV = -m g l cos θ\nstart θ = 60 deg\n"
              "run 1 s\n",
              "# maup simulate --precision quad\ncoord θ : angle\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
              "T = 1/2 m l^2 θ'^2\nV = -m g l cos θ\nstart θ = 60 deg\nrun 1 s\n"},
    CodeEntry{"E0726", "a run cannot end with a force that the model does not determine",
              "Where constraints depend on each other, or coordinates have removed one, its force is not unique.",
              "# maup simulate\ncoord θ : angle\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\nT = 1/2 m l^2 θ'^2\n"
              "V = -m g l cos θ\nreaction rod = release l\nstart θ = 60 deg\n"
              "run until reaction(rod) = m g within 2 s\n",
              "# maup simulate\ncoord θ : angle\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
              "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\nreaction rod = release l\nstart θ = 60 deg\n"
              "run until reaction(rod) = m g within 2 s\n"},
    CodeEntry{
        "E0727", "this method does not go through contacts, friction or events",
        "They are located to rounding on the polynomials of Taylor's steps, and the mode changes there. The stiff "
        "and the variational method have no such polynomials.",
        "# maup simulate --method variational --step 10ms\ncoord z : length\n"
        "param m = 1 kg, g = 9.81 m/s^2, e = 0.8\nT = 1/2 m z'^2\nV = m g z\n"
        "contact z >= 0 restitution e name floor\nstart z = 1 m\nrun 2 s\n",
        "# maup simulate\ncoord z : length\nparam m = 1 kg, g = 9.81 m/s^2, e = 0.8\nT = 1/2 m z'^2\nV = m g z\n"
        "contact z >= 0 restitution e name floor\nstart z = 1 m\nrun 2 s\n"},
    CodeEntry{"E0733", "friction by a force that is not linear in forces of constraint",
     "Friction changes the forces that press, and these change friction. Where the normal force is a sum of forces of "
     "constraint the accelerations follow from linear equations. With the resultant of two of them, the root of the "
     "sum of their squares, they do not, and such a motion is not computed yet.",
     "# maup simulate\ncoord r : length, θ, φ : angle\nparam m = 0.1 kg, R = 0.3 m, Ω = 8 rad/s, g = 9.81 m/s^2, μ = "
     "0.2\n"
     "point P mass m at r (sin θ cos φ, sin θ sin φ, -cos θ)\ngravity (0, 0, -g)\nconstraint r = R name hoop\n"
     "constraint φ = Ω t name spin\nfriction θ coefficient μ normal R sqrt(reaction(hoop)^2 + reaction(spin)^2/(R "
     "sin θ)^2)\nstart r = R, θ = 20 deg\nrun 1 s\n",
     "# maup simulate\ncoord r : length, θ, φ : angle\nparam m = 0.1 kg, R = 0.3 m, Ω = 8 rad/s, g = 9.81 m/s^2, μ = "
     "0.2\n"
     "point P mass m at r (sin θ cos φ, sin θ sin φ, -cos θ)\ngravity (0, 0, -g)\nconstraint r = R name hoop\n"
     "constraint φ = Ω t name spin\nfriction θ coefficient μ normal R reaction(hoop)\nstart r = R, θ = 20 deg\n"
     "run 1 s\n"},
    CodeEntry{"E0732", "friction by a force that the model does not determine",
     "Redundant constraints, a beam on three supports, share their forces in a way that rigid bodies do not tell: that "
     "is a question of elasticity. Friction that takes one of them for its normal force is not determined either, and "
     "so is the motion.",
     "# maup simulate\nparam m = 2 kg, g = 10 m/s^2, μ = 0.1\ncoord y, s : length\npoint P mass m at (0, y)\npoint W "
     "mass m at (s, 1 m)\ngravity (0, -g)\nconstraint y = 0 name f1\nconstraint 2 y = 0 name f2\nfriction s "
     "coefficient μ normal reaction(f1)\nstart s' = 1 m/s\nrun 1 s\n",
     "# maup simulate\nparam m = 2 kg, g = 10 m/s^2, μ = 0.1\ncoord y, s : length\npoint P mass m at (0, y)\npoint W "
     "mass m at (s, 1 m)\ngravity (0, -g)\nconstraint y = 0 name f1\nfriction s coefficient μ normal "
     "reaction(f1)\nstart s' = 1 m/s\nrun 1 s\n"},
    CodeEntry{
        "E0730", "a contact with a kink",
        "A gap made of abs, min, max, step or piecewise may switch where it and its slope go on, as on the border of a "
        "stadium. At a corner or a step of the surface the normal direction jumps: that is two contacts.",
        "# maup simulate\ncoord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\npoint P mass m at (x, z)\n"
        "gravity (0, -g)\ncontact z >= abs(x) restitution 0.8 name groove\nstart x = 0.2 m, z = 1 m\nrun 1 s\n",
        "# maup simulate\ncoord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\npoint P mass m at (x, z)\n"
        "gravity (0, -g)\ncontact z >= x restitution 0.8 name right_side\n"
        "contact z >= -x restitution 0.8 name left_side\nstart x = 0.2 m, z = 1 m\nrun 1 s\n"},
    CodeEntry{
        "E0729", "impacts where momenta are not linear in the velocities",
        "An impulse changes p = ∂L/∂q'. For a Lagrangian that is quadratic in q' the velocities after it follow from a "
        "linear equation, which is solved; others, as of a relativistic particle, are not carried out yet.",
        "# maup simulate\ncoord x : length\nparam m = 9.11e-31 kg, c = 299792458 m/s, d = 1 m\n"
        "L = -m c^2 sqrt(1 - x'^2/c^2)\ncontact x <= d restitution 1 name wall\nstart x' = 0.5 c\nrun 10 ns\n",
        "# maup simulate\ncoord x : length\nparam m = 9.11e-31 kg, c = 299792458 m/s, d = 1 m\nL = 1/2 m x'^2\n"
        "contact x <= d restitution 1 name wall\nstart x' = 0.01 c\nrun 500 ns\n"},
    CodeEntry{"W0731", "no motion begins at this start",
              "Contacts and friction allow no motion with finite forces from here, or several: Painlevé's paradox.",
              "# maup check\ncoord x, z : length, θ : angle\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
              "body rod mass m inertia m l^2/12 at (x, z) rotation angle θ\ngravity (0, -g)\n"
              "contact z - l/2 sin θ >= 0 friction 3 slip x' + l/2 sin θ θ' name floor\n"
              "start z = l/2 sin(1), θ = 1 rad, x' = -3 m/s\nrun 0.1 s\n",
              "# maup check\ncoord x, z : length, θ : angle\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
              "body rod mass m inertia m l^2/12 at (x, z) rotation angle θ\ngravity (0, -g)\n"
              "contact z - l/2 sin θ >= 0 friction 0.3 slip x' + l/2 sin θ θ' name floor\n"
              "start z = l/2 sin(1), θ = 1 rad, x' = -3 m/s\nrun 0.1 s\n"},
    CodeEntry{
        "W0737", "an event sets a state that is not possible",
        "`set` puts the motion into another state, from which it goes on. That state has to keep every constraint, "
        "with its velocities too, has to lie inside no contact, and needs a value for each coordinate. Nothing is "
        "moved to make it so: set all coordinates that a constraint ties together. The run keeps what came before.",
        "# maup simulate\ncoord x, y : length\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\npoint P mass m at (x, y)\n"
        "gravity (0, -g)\nconstraint x^2 + y^2 = l^2 name rod\nevent low when x = 0 : set x = 0.1 m\n"
        "start x = 0.6 m, y = -0.8 m\nrun 5 s\n",
        "# maup simulate\ncoord x, y : length\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\npoint P mass m at (x, y)\n"
        "gravity (0, -g)\nconstraint x^2 + y^2 = l^2 name rod\nevent low when x = 0 : set x' = x'/2, y' = y'/2\n"
        "start x = 0.6 m, y = -0.8 m\nrun 5 s\n"},
    CodeEntry{
        "W0738", "events without end",
        "Events, impacts and changes of contact may follow each other faster and faster up to an instant that no "
        "number of them passes; a `set` does not say what comes after it, as a contact with `restitution` does. Or "
        "they come so fast that a run would meet more of them than are followed: that is foreseen from their rate, "
        "or counted. The message names the bound. The run keeps what came before.",
        "# maup simulate\ncoord z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m z'^2\nV = m g z\n"
        "event floor when z = 0 falling : set z' = -0.5 z'\nstart z = 1 m\nrun 5 s\n",
        "# maup simulate\ncoord z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m z'^2\nV = m g z\n"
        "contact z >= 0 restitution 0.5 name floor\nstart z = 1 m\nrun 5 s\n"},
    CodeEntry{
        "W0739", "no motion goes on",
        "With rigid contacts and dry friction there may be no motion with finite forces, or several. In Painlevé's "
        "paradox friction turns the response of a contact to its own force around: more force makes it close faster. "
        "A stiff spring in place of that contact, or less friction, has a motion. Contacts that are hit at once may "
        "have no impulses that keep all of them from closing: `impact sequential` lets them follow each other. Static "
        "friction below kinetic friction neither holds nor slides. Bounces may become too small to be told apart: "
        "`restitution 0` ends them. And backwards in time nothing follows from an impact or a stop: begin behind it. "
        "A force that begins without all of its derivatives, as √t, begins no motion that is followed through events. "
        "The run keeps what came before.",
        "# maup simulate\ncoord x, z : length, θ : angle\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
        "body rod mass m inertia m l^2/12 at (x, z) rotation angle θ\ngravity (0, -g)\n"
        "contact z - l/2 sin θ >= 0 friction 3 slip x' + l/2 sin θ θ' name floor\n"
        "start z = l/2 sin(1), θ = 1 rad, x' = -3 m/s\nrun 0.1 s\n",
        "# maup simulate\ncoord x, z : length, θ : angle\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
        "body rod mass m inertia m l^2/12 at (x, z) rotation angle θ\ngravity (0, -g)\n"
        "contact z - l/2 sin θ >= 0 friction 0.3 slip x' + l/2 sin θ θ' name floor\n"
        "start z = l/2 sin(1), θ = 1 rad, x' = -3 m/s\nrun 0.1 s\n"},
    CodeEntry{"E0728", "the start violates a contact",
              "A contact g >= 0 holds at all times, at the first one too: bodies do not begin inside each other.",
              "# maup simulate\ncoord z : length\nparam m = 1 kg, g = 9.81 m/s^2, e = 0.8\nT = 1/2 m z'^2\n"
              "V = m g z\ncontact z >= 0 restitution e name floor\nstart z = -1 cm\nrun 2 s\n",
              "# maup simulate\ncoord z : length\nparam m = 1 kg, g = 9.81 m/s^2, e = 0.8\nT = 1/2 m z'^2\n"
              "V = m g z\ncontact z >= 0 restitution e name floor\nstart z = 1 cm\nrun 2 s\n"},
    CodeEntry{"E0735", "the motion from this start is not the only one",
              "Where a force grows as a power below 1 of the displacement, q'' = q^(1/2), it has no finite derivative, "
              "and a rest there does not determine what follows: q = 0 for ever obeys the equation, and so does q = "
              "(t - T)^4/144 from any time T on (Norton's dome). A force of that kind that draws back, q'' = -q^(1/2), "
              "keeps the rest.",
              "# maup simulate\ndimensionless\nparam g = 1\ncoord s : number\nT = 1/2 s'^2\nV = -2/3 g s^(3/2)\n"
              "start s = 0\nrun 1\n",
              "# maup simulate\ndimensionless\nparam g = 1\ncoord s : number\nT = 1/2 s'^2\nV = -2/3 g s^(3/2)\n"
              "start s = 1e-6\nrun 1\n"},
    CodeEntry{"W0734", "the energy drifts far beyond the errors of the steps",
              "Nothing in the equations of motion changes it so. Where an energy jumps, a force acts that no "
              "derivative shows, and the motion goes through as if there were none. Most jumps are "
              "refused before a run (E0430); this is the word for those that only the run meets.",
              "# maup simulate\ndimensionless\ncoord x : number\nT = 1/2 x'^2\n"
              "V = piecewise((x^2 + x - 1)^2 < 1e-8 : 0.3, else : 0)\nstart x = 0, x' = 1\nrun 2\n",
              "# maup simulate\ndimensionless\ncoord x : number\nT = 1/2 x'^2\n"
              "V = 0.3 exp(-((x^2 + x - 1)/0.01)^2)\nstart x = 0, x' = 1\nrun 2\n"},
    CodeEntry{"W0736", "an event has no value along the motion",
              "An event is met where its function comes to 0. Where the function is no real number, as a root or a "
              "logarithm of what is negative, it is never met. It is looked at where steps begin and where the run "
              "ends.",
              "# maup simulate\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\n"
              "event turns when sqrt(x - 2) = 0.1 : record\nstart x = 1\nrun 10\n",
              "# maup simulate\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\n"
              "event turns when x = 2.01 : record\nstart x = 1\nrun 10\n"},
};

}  // namespace

std::span<const CodeEntry> simulation_codes() { return entries; }

}  // namespace maupertuis

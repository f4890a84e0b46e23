#include <maupertuis/codes.hpp>

namespace maupertuis {
namespace {

constexpr CodeEntry entries[] = {
    {"E1401", "no periodic motion near the start",
     "`maup orbits --floquet` looks for the first time at which the state is back near the start, and then moves start "
     "and period "
     "by Newton's method until the motion closes. Either it never came near, or the method did not converge: most "
     "motions of most "
     "systems are not periodic. Give a start that is nearer to a periodic motion, or the period itself with --period.",
     "# maup orbits --floquet\nparam m = 1 kg, μ = 1 m^3/s^2\ncoord r : length, φ : angle\n"
     "T = 1/2 m (r'^2 + r^2 φ'^2)\nV = -m μ/r\nstart r = 1 m, φ' = 1.5 rad/s\nrun 20 s\n",
     "# maup orbits --floquet\nparam m = 1 kg, μ = 1 m^3/s^2\ncoord r : length, φ : angle\n"
     "T = 1/2 m (r'^2 + r^2 φ'^2)\nV = -m μ/r\nstart r = 1 m, φ' = 1.2 rad/s\nrun 20 s\n"},
    {"E1402", "the motion rests",
     "At an equilibrium nothing moves: every time is a period. `maup modes` tells what happens near an equilibrium.",
     "# maup orbits --floquet\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\n"
     "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\nrun 10 s\n",
     "# maup orbits --floquet\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\n"
     "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\nstart θ = 60 deg\nrun 10 s\n"},
    {"E1403", "the motion has no derivative by its start",
     "Where an acceleration jumps (sign, step, piecewise with different values at the switch, abs in an energy), "
     "neighbours of a motion "
     "meet the jump at other times, and the tangent equations do not say what it does to them. A force that is "
     "continuous at "
     "its switch, such as min(x, 0), is no obstacle, and a switch of t alone, as in sign(sin(t)), is none either: all "
     "neighbours cross it together. Impacts, contacts and friction of the model are none either: "
     "neighbours "
     "are carried through them. But some of them part there: where a contact is only touched, where several are hit at "
     "once and the order matters, where the motion starts in an impact.",
     "# maup orbits --floquet\nparam m = 1 kg, F = 2 N\ncoord x : length\nT = 1/2 m x'^2\nV = F abs(x)\n"
     "start x = 1 m\nrun 10 s\n",
     "# maup orbits --floquet\nparam m = 1 kg, F = 2 N, d = 1 cm\ncoord x : length\nT = 1/2 m x'^2\n"
     "V = F sqrt(x^2 + d^2)\nstart x = 1 m\nrun 10 s\n"},
    {"E1404", "the period does not fit the drive",
     "Where t stands in the equations, a motion can only repeat together with them. The period of sines and cosines of "
     "t is found; other "
     "drives need --period, and the equations must be the same after that time.",
     "# maup orbits --floquet\nparam m = 1 kg, k = 4 N/m, c = 0.5 kg/s, F = 1 N, a = 0.3 rad/s^2\ncoord x : length\n"
     "T = 1/2 m x'^2\nV = 1/2 k x^2\nD = 1/2 c x'^2\nforce x = F sin(a t^2)\nrun 10 s\n",
     "# maup orbits --floquet\nparam m = 1 kg, k = 4 N/m, c = 0.5 kg/s, F = 1 N, Ω = 3 rad/s\ncoord x : length\n"
     "T = 1/2 m x'^2\nV = 1/2 k x^2\nD = 1/2 c x'^2\nforce x = F sin(Ω t)\nrun 10 s\n"},
    {"E1405", "the section is never crossed",
     "A Poincaré section collects the points at which the motion passes through the zeros of a function, in one "
     "direction or in both. This "
     "motion does not pass through them within the time that was waited for: ten thousand times the model's run, or "
     "--longest.",
     "# maup orbits --section θ=90deg --crossings 20 --longest 100s\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
     "coord θ : angle\npoint P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\nstart θ = 60 deg\nrun 10 s\n",
     "# maup orbits --section θ=0 --crossings 20 --longest 100s\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
     "coord θ : angle\npoint P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\nstart θ = 60 deg\nrun 10 s\n"},
    {"E1406", "no time to follow the motion",
     "Periods, durations, times of a strobe and the longest time to wait are positive. The duration comes from "
     "--duration or from the model's "
     "`run`.",
     "# maup orbits --lyapunov\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\n"
     "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\nstart θ = 60 deg\n",
     "# maup orbits --lyapunov\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\n"
     "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\nstart θ = 60 deg\nrun 10 s\n"},
    {"E1407", "several starts cannot be spread over the section",
     "With --starts or --energy every point of the section becomes a motion: its position follows from the section and "
     "one velocity from the "
     "energy. That takes two coordinates, no constraints, a conserved energy, a section by positions, and an energy "
     "that reaches it.",
     "# maup orbits --section x=0 --starts 3 --crossings 10\n"
     "param m = 1 kg, k = 40 N/m, c = 0.2 N s/m, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\n"
     "point P mass m at (x, y)\nspring O - P stiffness k length l\ndamper O - P coefficient c\ngravity (0, -g)\n"
     "start x = 0.3 m, y = -1.2 m\nrun 10 s\n",
     "# maup orbits --section x=0 --starts 3 --crossings 10\nparam m = 1 kg, k = 40 N/m, l = 1 m, g = 9.81 m/s^2\n"
     "coord x, y : length\npoint P mass m at (x, y)\nspring O - P stiffness k length l\ngravity (0, -g)\n"
     "start x = 0.3 m, y = -1.2 m\nrun 10 s\n"},
    {"E1408", "the motion ends",
     "The run cannot go on: a collision, a singular mass matrix, constraints that contradict each other. The reason is "
     "that of "
     "`maup simulate`.",
     "# maup orbits --lyapunov\nparam m = 1 kg, μ = 1 m^3/s^2\ncoord r : length, φ : angle\n"
     "T = 1/2 m (r'^2 + r^2 φ'^2)\nV = -m μ/r\nstart r = 1 m\nrun 10 s\n",
     "# maup orbits --lyapunov\nparam m = 1 kg, μ = 1 m^3/s^2\ncoord r : length, φ : angle\n"
     "T = 1/2 m (r'^2 + r^2 φ'^2)\nV = -m μ/r\nstart r = 1 m, φ' = 1.2 rad/s\nrun 10 s\n"},
    {"E1409", "no section",
     "A section is an equation between the coordinates, their velocities and the time, with the direction in which the "
     "motion is to cross it: "
     "`x = 0 rising`, `θ1 = 0 falling`, `x' = 0`. A function that does not change along the motion cuts nothing out of "
     "it.",
     "# maup orbits --section l=1m --crossings 20\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\n"
     "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\nstart θ = 60 deg\nrun 10 s\n",
     "# maup orbits --section θ=0 --crossings 20\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\n"
     "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\nstart θ = 60 deg\nrun 10 s\n"},
    {"E1410", "nothing can move",
     "The constraints leave no direction in which a neighbour of the motion could lie, so that there is no rate at "
     "which neighbours part.",
     "# maup orbits --lyapunov\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\n"
     "point P mass m at (x, y)\ngravity (0, -g)\nconstraint x^2 + y^2 = l^2\nconstraint x = 0\nstart y = -l\n"
     "run 5 s\n",
     "# maup orbits --lyapunov\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\n"
     "point P mass m at (x, y)\ngravity (0, -g)\nconstraint x^2 + y^2 = l^2\nstart x = 0.6 l, y = -0.8 l\nrun 5 s\n"},
    {"E1411", "a time of the averages is out of proportion",
     "Lyapunov exponents are averages over the run, which begin after the transient and are taken in intervals. An "
     "interval longer than the run, or one that "
     "cuts it into more than a million, and a transient of more than 10^8 steps have no sense; left out, both are "
     "chosen.",
     "# maup orbits --lyapunov --interval 20s\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\n"
     "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\nstart θ = 60 deg\nrun 10 s\n",
     "# maup orbits --lyapunov --interval 1s\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\n"
     "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\nstart θ = 60 deg\nrun 10 s\n"},
    {"E1412", "more exponents than directions",
     "A system of n freedoms has 2 n exponents: one for each direction in which a neighbour can lie, in positions and "
     "velocities.",
     "# maup orbits --lyapunov --exponents 7\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\n"
     "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\nstart θ = 60 deg\nrun 10 s\n",
     "# maup orbits --lyapunov --exponents 2\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\n"
     "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\nstart θ = 60 deg\nrun 10 s\n"},
    {"E1413", "exponents of directions that vanish",
     "Where a contact closes or friction sticks, neighbours that differ in the direction that is held from then on "
     "come "
     "into the same state. Their exponents are −∞, and there are numbers only for the directions that are left.",
     "# maup orbits --lyapunov\nparam m = 1 kg, k = 100 N/m, g = 9.81 m/s^2, v = 0.2 m/s\ncoord x, z : length\n"
     "point block mass m at (x, z)\ngravity (0, -g)\nV += 1/2 k x^2\n"
     "contact z >= 0 friction 0.3 static 0.4 slip x' - v name belt\nstart x = 1 mm\nrun 10 s\n",
     "# maup orbits --lyapunov --exponents 1\nparam m = 1 kg, k = 100 N/m, g = 9.81 m/s^2, v = 0.2 m/s\n"
     "coord x, z : length\npoint block mass m at (x, z)\ngravity (0, -g)\nV += 1/2 k x^2\n"
     "contact z >= 0 friction 0.3 static 0.4 slip x' - v name belt\nstart x = 1 mm\nrun 10 s\n"},
    {"W1401", "Lyapunov exponents that do not add up",
     "The exponents add up to the mean rate at which the flow changes volumes: zero without dissipation, minus the "
     "damping rates else. If they "
     "do not, the neighbours of this motion were not carried to rounding; each exponent may be wrong by as much, and "
     "its error says so.",
     "# maup orbits --lyapunov\nparam m = 1 kg, μ = 1 m^3/s^2\ncoord r : length, φ : angle\n"
     "T = 1/2 m (r'^2 + r^2 φ'^2)\nV = -m μ/r\nstart r = 1 m, φ' = 0.001 rad/s\nrun 20 s\n",
     "# maup orbits --lyapunov\nparam m = 1 kg, μ = 1 m^3/s^2\ncoord r : length, φ : angle\n"
     "T = 1/2 m (r'^2 + r^2 φ'^2)\nV = -m μ/r\nstart r = 1 m, φ' = 1.2 rad/s\nrun 20 s\n"},
    {"W1402", "multipliers that the geometry contradicts",
     "Without forces and damping the derivative of the return map preserves the symplectic form; else its determinant "
     "is the exponential of the "
     "divergence, integrated over the period. Where it misses them by more than rounding its eigenvalues are no "
     "better, and those near the unit circle "
     "may lie on either side of it.",
     "# maup orbits --floquet\nparam m = 1 kg, μ = 1 m^3/s^2\ncoord r : length, φ : angle\n"
     "T = 1/2 m (r'^2 + r^2 φ'^2)\nV = -m μ/r\nstart r = 1 m, φ' = 0.03 rad/s\nrun 20 s\n",
     "# maup orbits --floquet\nparam m = 1 kg, μ = 1 m^3/s^2\ncoord r : length, φ : angle\n"
     "T = 1/2 m (r'^2 + r^2 φ'^2)\nV = -m μ/r\nstart r = 1 m, φ' = 1.2 rad/s\nrun 20 s\n"},
    {"W1403", "a drive that was looked at for some periods",
     "Sines and cosines of t repeat for ever. Where t stands elsewhere too, as in a pulse exp(-((t - t0)/τ)^2) or a "
     "switch at a time, "
     "equations that are the same after thousands of periods may still be others later.",
     "# maup orbits --floquet\ndimensionless\ncoord x : number\nL = 1/2 x'^2 - 2 x^2\n"
     "force x = sin(t) - 0.1 x' + 3 exp(-((t - 1e6)/5)^2)\nstart x = 0.3\nrun 60\n",
     "# maup orbits --floquet\ndimensionless\ncoord x : number\nL = 1/2 x'^2 - 2 x^2\n"
     "force x = sin(t) - 0.1 x'\nstart x = 0.3\nrun 60\n"},
};

}  // namespace

std::span<const CodeEntry> orbits_codes() { return entries; }

}  // namespace maupertuis

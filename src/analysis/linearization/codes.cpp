#include <maupertuis/codes.hpp>

namespace maupertuis {
namespace {

constexpr CodeEntry entries[] = {
    {"E1301", "no equilibrium and no steady motion",
     "At an equilibrium all forces balance while nothing moves; in a steady motion only coordinates go on of which the "
     "equations do not depend. "
     "Both are found by Newton's method from many points. A body in free fall has none; a driven system has one only "
     "where friction takes "
     "what the drive gives. The search is no proof: a point of your own may lead to one.",
     "# maup modes\nparam m = 1 kg, g = 9.81 m/s^2\ncoord z : length\nT = 1/2 m z'^2\nV = m g z\n",
     "# maup modes\nparam m = 1 kg, g = 9.81 m/s^2, k = 40 N/m\ncoord z : length\nT = 1/2 m z'^2\n"
     "V = m g z + 1/2 k z^2\n"},
    {"E1302", "no equilibrium at the point that was asked for",
     "The equations were to be linearized about a state of rest or of steady motion, but forces are left over there. "
     "Coordinates that are not "
     "given are solved for; those that are given stay, up to a ten-thousandth.",
     "# maup modes --at θ=30deg\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\n"
     "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\n",
     "# maup modes --at θ=0\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\n"
     "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\n"},
    {"E1303", "no equilibrium: the equations depend on the time",
     "A drive that stands in a force as a function of t moves the place where forces balance. An input is held at a "
     "value instead, as engineers do: "
     "the linearization then says how the system answers to small changes of it.",
     "# maup modes\nparam m = 1 kg, k = 4 N/m, F = 1 N, ω = 3 rad/s\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
     "force x = F cos(ω t)\n",
     "# maup modes\nparam m = 1 kg, k = 4 N/m, F = 1 N, ω = 3 rad/s\ncoord x : length\ninput u : [N] = F cos(ω t)\n"
     "T = 1/2 m x'^2\nV = 1/2 k x^2\nforce x = u\n"},
    {"E1304", "a singular mass matrix where the equations are linearized",
     "The equations to first order need the accelerations as functions of forces. Where a coordinate loses its inertia "
     "(an angle about an axis at "
     "distance 0) that function does not exist: it is the coordinates that fail, not the system.",
     "# maup modes --at r=0,φ=0\nparam m = 1 kg, k = 4 N/m\ncoord r : length, φ : angle\n"
     "point P mass m at r (cos φ, sin φ)\nV = 1/2 k r^2\n",
     "# maup modes --at x=0,y=0\nparam m = 1 kg, k = 4 N/m\ncoord x, y : length\npoint P mass m at (x, y)\n"
     "V = 1/2 k (x^2 + y^2)\n"},
    {"E1306", "an output without a value or a derivative at the point",
     "What is measured is written to first order, y = y0 + C x + D u: y0 is its value at the point, C and D its "
     "derivatives there. 1/θ has no "
     "value at θ = 0, √θ and abs(θ) have no derivative: no row of C stands for them. Where a formula has a limit that "
     "it does not reach "
     "(sin(θ)/θ), write the limit.",
     "# maup modes --at θ=0 --y 1/θ\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\n"
     "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\n",
     "# maup modes --at θ=0 --y θ\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\n"
     "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\n"},
    {"E1307", "an equilibrium on a kink",
     "Where a force jumps, at abs(x) or dry friction, the system may rest although forces are left over on every side, "
     "which push it back. There is no "
     "stiffness, and no frequency: it does not answer in proportion to a small displacement. So it is where the "
     "stiffness grows without bound, as that of abs(x)^1.5 at 0.",
     "# maup modes\nparam m = 1 kg, F = 2 N\ncoord x : length\nT = 1/2 m x'^2\nV = F abs(x)\n",
     "# maup modes\nparam m = 1 kg, F = 2 N, d = 1 mm\ncoord x : length\nT = 1/2 m x'^2\nV = F sqrt(x^2 + d^2)\n"},
    {"W1302", "a side of an equilibrium without a linearization",
     "The equilibrium is on a kink, and on this side the forces do not balance beside it. What the other sides have is "
     "shown for each of them. Or they balance, and the stiffness grows without bound.",
     "# maup modes\nparam m = 1 kg, k = 4 N/m, F = 2 N\ncoord x : length\nT = 1/2 m x'^2\n"
     "V = 1/2 k x^2 + F max(x, 0)\n",
     "# maup modes\nparam m = 1 kg, k = 4 N/m, K = 12 N/m\ncoord x : length\nT = 1/2 m x'^2\n"
     "V = 1/2 k x^2 + 1/2 K max(x, 0)^2\n"},
    {"E1308", "no point of rest in any mode of the contacts",
     "With contacts `maup modes` looks for rest in each mode: the forces balance, contacts that are closed press (λ > "
     "0), the others are open, and static friction holds what is left over. A point at which a closed contact would "
     "have to pull is none. Of more than six contacts not all sets of closed ones are looked at: those that touch at "
     "the "
     "start, or below it, come first. `--mode floor` looks at the equations of one mode whatever its contacts do.",
     "# maup modes\nparam m = 1 kg, g = 9.81 m/s^2, α = 20 deg\ncoord s, n : length\nT = 1/2 m (s'^2 + n'^2)\n"
     "V = m g (n cos α - s sin α)\ncontact n >= 0 friction 0.3 slip s' name plane\n",
     "# maup modes\nparam m = 1 kg, g = 9.81 m/s^2, α = 20 deg\ncoord s, n : length\nT = 1/2 m (s'^2 + n'^2)\n"
     "V = m g (n cos α - s sin α)\ncontact n >= 0 friction 0.5 slip s' name plane\n"},
    {"E1310", "a regulator for a model without inputs",
     "The linear-quadratic regulator chooses the inputs as functions of the state, u = u0 - F x. A force that is a "
     "formula of t cannot be chosen.",
     "# maup modes --at x=0 --Q 1\nparam m = 2 kg, k = 8 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n",
     "# maup modes --at x=0 --Q 1\nparam m = 2 kg, k = 8 N/m\ncoord x : length\ninput u : [N] = 0\nT = 1/2 m x'^2\n"
     "V = 1/2 k x^2\nforce x = u\n"},
    {"E1311", "weights of a regulator that do not fit",
     "It minimizes the integral of x^T Q x + w^T R w. Q weighs the states, positions and velocities in SI units, and "
     "may not be negative; R is the price of "
     "the inputs and is positive. A list of numbers is the diagonal, one number a multiple of 1; rows of a full matrix "
     "are separated by semicolons.",
     "# maup modes --at x=0 --Q 1 --R 0\nparam m = 2 kg\ncoord x : length\ninput u : [N] = 0\nT = 1/2 m x'^2\n"
     "force x = u\n",
     "# maup modes --at x=0 --Q 1 --R 0.1\nparam m = 2 kg\ncoord x : length\ninput u : [N] = 0\nT = 1/2 m x'^2\n"
     "force x = u\n"},
    {"E1312", "not stabilizable",
     "A mode that does not decay by itself is out of reach of the inputs: [A - λ, B] has not full rank at its "
     "eigenvalue (Popov, Belevitch and Hautus). "
     "No feedback can make the closed loop stable.",
     "# maup modes --at x=0,y=0 --Q 1\nparam m = 2 kg\ncoord x, y : length\ninput u : [N] = 0\n"
     "T = 1/2 m (x'^2 + y'^2)\nforce x = u\n",
     "# maup modes --at x=0,y=0 --Q 1\nparam m = 2 kg\ncoord x, y : length\ninput u : [N] = 0\ninput w : [N] = 0\n"
     "T = 1/2 m (x'^2 + y'^2)\nforce x = u\nforce y = w\n"},
    {"E1313", "a mode on the imaginary axis that costs nothing",
     "Where Q does not see a mode that neither grows nor decays, leaving it alone is the cheapest, and the closed loop "
     "keeps it: there is no stabilizing "
     "solution of the Riccati equation.",
     "# maup modes --at x=0 --Q 0,1\nparam m = 2 kg\ncoord x : length\ninput u : [N] = 0\nT = 1/2 m x'^2\n"
     "force x = u\n",
     "# maup modes --at x=0 --Q 1,0\nparam m = 2 kg\ncoord x : length\ninput u : [N] = 0\nT = 1/2 m x'^2\n"
     "force x = u\n"},
    {"E1314", "the Riccati equation was not solved",
     "The solution comes from the stable invariant subspace of the Hamiltonian matrix and is put back into the "
     "equation; where the residual is not small, or "
     "the closed loop is not stable, it is not shown.",
     "# maup modes --at x=0 --Q 1 --R 1e20\nparam m = 2 kg, k = 8 N/m\ncoord x : length\ninput u : [N] = 0\n"
     "T = 1/2 m x'^2\nV = 1/2 k x^2\nforce x = u\n",
     "# maup modes --at x=0 --Q 1 --R 1\nparam m = 2 kg, k = 8 N/m\ncoord x : length\ninput u : [N] = 0\n"
     "T = 1/2 m x'^2\nV = 1/2 k x^2\nforce x = u\n"},
    {"E1315", "this build has no LAPACK",
     "The regulator needs an ordered Schur form, which LAPACK has. Everything else of `maup modes` works without it.",
     "", ""},
    {"E1316", "a regulator whose input acts by its rate",
     "The regulator chooses u anew at every instant, along x' = A x + B u. A support at the input s acts on what hangs "
     "from it by s'', and a damper between them by s': then x' = A x + B u + B1 u' + B2 u'', which `maup modes` shows, "
     "and u cannot be chosen freely, since a jump of it would throw the system. What moves the support can be: a "
     "force on it.",
     "# maup modes --at x=0 --Q 1\nparam m = 1 kg, k = 4 N/m, c = 1 N s/m\ncoord x : length\ninput s : [m] = 0\n"
     "T = 1/2 m x'^2\nV = 1/2 k (x - s)^2\nD = 1/2 c (x' - s')^2\n",
     "# maup modes --at x=0,s=0 --Q 1\nparam m = 1 kg, k = 4 N/m, c = 1 N s/m\ncoord x, s : length\n"
     "input F : [N] = 0\nT = 1/2 m (x'^2 + s'^2)\nV = 1/2 k (x - s)^2\nD = 1/2 c (x' - s')^2\nforce s = F\n"},
    {"E1320", "a locus without a sweep",
     "A locus follows equilibria while one parameter changes: the model says `sweep NAME = FROM .. TO steps N`, or "
     "--sweep does.",
     "# maup modes --csv locus.csv\ncoord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\n",
     "# maup modes --csv locus.csv\ncoord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\nsweep "
     "k = 1 N/m .. 4 N/m steps 4\n"},
    {"W1301", "an equilibrium at which the coordinates fail",
     "The forces vanish, so the system can rest there; but the mass matrix is singular in these coordinates, so that "
     "frequencies cannot be told.",
     "# maup modes\nparam m = 1 kg, k = 4 N/m\ncoord r : length, φ : angle\npoint P mass m at r (cos φ, sin φ)\n"
     "V = 1/2 k r^2\n",
     "# maup modes\nparam m = 1 kg, k = 4 N/m\ncoord x, y : length\npoint P mass m at (x, y)\nV = 1/2 k (x^2 + y^2)\n"},
};

}  // namespace

std::span<const CodeEntry> linearization_codes() { return entries; }

}  // namespace maupertuis

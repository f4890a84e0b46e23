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
     "", ""},
    {"E1302", "no equilibrium at the point that was asked for",
     "The equations were to be linearized about a state of rest or of steady motion, but forces are left over there. "
     "Coordinates that are not "
     "given are solved for; those that are given stay, up to a ten-thousandth.",
     "expect frequencies at θ = 30 deg : 0.5 Hz rel 1e-9", "expect frequencies at θ = 0 : 0.5 Hz rel 1e-9"},
    {"E1303", "no equilibrium: the equations depend on the time",
     "A drive that stands in a force as a function of t moves the place where forces balance. An input is held at a "
     "value instead, as engineers do: "
     "the linearization then says how the system answers to small changes of it.",
     "force x = F cos(ω t)", "input u : [N] = F cos(ω t)\nforce x = u"},
    {"E1304", "a singular mass matrix where the equations are linearized",
     "The equations to first order need the accelerations as functions of forces. Where a coordinate loses its inertia "
     "(an angle about an axis at "
     "distance 0) that function does not exist: it is the coordinates that fail, not the system.",
     "", ""},
    {"E1306", "an output without a value or a derivative at the point",
     "What is measured is written to first order, y = y0 + C x + D u: y0 is its value at the point, C and D its "
     "derivatives there. 1/θ has no "
     "value at θ = 0, √θ and abs(θ) have no derivative: no row of C stands for them. Where a formula has a limit that "
     "it does not reach "
     "(sin(θ)/θ), write the limit.",
     "maup modes pendulum.lag --at \"θ=0\" --y \"1/θ\"", "maup modes pendulum.lag --at \"θ=0\" --y \"θ\""},
    {"E1307", "an equilibrium on a kink",
     "Where a force jumps, at abs(x) or dry friction, the system may rest although forces are left over on every side, "
     "which push it back. There is no "
     "stiffness, and no frequency: it does not answer in proportion to a small displacement.",
     "V = F abs(x)", "V = F sqrt(x^2 + d^2)"},
    {"W1302", "a side of an equilibrium without a linearization",
     "The equilibrium is on a kink, and on this side the forces do not balance beside it. What the other sides have is "
     "shown for each of them.",
     "", ""},
    {"E1308", "no point of rest in any mode of the contacts",
     "With contacts `maup modes` looks for rest in each mode: the forces balance, contacts that are closed press (λ > "
     "0), "
     "the others are open, and static friction holds what is left over. A point at which a closed contact would have "
     "to "
     "pull is none. `--mode floor` looks at the equations of one mode whatever its contacts do.",
     "", ""},
    {"E1310", "a regulator for a model without inputs",
     "The linear-quadratic regulator chooses the inputs as functions of the state, u = u0 - F x. A force that is a "
     "formula of t cannot be chosen.",
     "force x = 2 N", "input u : [N] = 0\nforce x = u"},
    {"E1311", "weights of a regulator that do not fit",
     "It minimizes the integral of x^T Q x + w^T R w. Q weighs the states, positions and velocities in SI units, and "
     "may not be negative; R is the price of "
     "the inputs and is positive. A list of numbers is the diagonal, one number a multiple of 1; rows of a full matrix "
     "are separated by semicolons.",
     "maup modes cart.lag --at \"x=0, θ=π\" --Q 1 --R 0", "maup modes cart.lag --at \"x=0, θ=π\" --Q 1 --R 0.1"},
    {"E1312", "not stabilizable",
     "A mode that does not decay by itself is out of reach of the inputs: [A - λ, B] has not full rank at its "
     "eigenvalue (Popov, Belevitch and Hautus). "
     "No feedback can make the closed loop stable.",
     "", ""},
    {"E1313", "a mode on the imaginary axis that costs nothing",
     "Where Q does not see a mode that neither grows nor decays, leaving it alone is the cheapest, and the closed loop "
     "keeps it: there is no stabilizing "
     "solution of the Riccati equation.",
     "", ""},
    {"E1314", "the Riccati equation was not solved",
     "The solution comes from the stable invariant subspace of the Hamiltonian matrix and is put back into the "
     "equation; where the residual is not small, or "
     "the closed loop is not stable, it is not shown.",
     "", ""},
    {"E1315", "this build has no LAPACK",
     "The regulator needs an ordered Schur form, which LAPACK has. Everything else of `maup modes` works without it.",
     "", ""},
    {"E1320", "a locus without a sweep",
     "A locus follows equilibria while one parameter changes: the model says `sweep NAME = FROM .. TO steps N`, or "
     "--sweep does.",
     "", ""},
    {"W1301", "an equilibrium at which the coordinates fail",
     "The forces vanish, so the system can rest there; but the mass matrix is singular in these coordinates, so that "
     "frequencies cannot be told.",
     "", ""},
};

}  // namespace

std::span<const CodeEntry> linearization_codes() { return entries; }

}  // namespace maupertuis

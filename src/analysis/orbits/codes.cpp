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
     "", ""},
    {"E1402", "the motion rests",
     "At an equilibrium nothing moves: every time is a period. `maup modes` tells what happens near an equilibrium.",
     "", ""},
    {"E1403", "the motion has no derivative by its start",
     "Where an acceleration jumps (sign, step, piecewise with different values at the switch, abs in an energy), "
     "neighbours of a motion "
     "meet the jump at other times, and the tangent equations do not say what it does to them. A force that is "
     "continuous at "
     "its switch, such as min(x, 0), is no obstacle. Impacts, contacts and friction of the model are none either: "
     "neighbours "
     "are carried through them. But some of them part there: where a contact is only touched, where several are hit at "
     "once and the order matters, where the motion starts in an impact.",
     "V = k abs(x)", "V = k sqrt(x^2 + w^2)"},
    {"E1404", "the period does not fit the drive",
     "Where t stands in the equations, a motion can only repeat together with them. The period of sines and cosines of "
     "t is found; other "
     "drives need --period, and the equations must be the same after that time.",
     "", ""},
    {"E1405", "the section is never crossed",
     "A Poincaré section collects the points at which the motion passes through the zeros of a function, in one "
     "direction or in both. This "
     "motion does not pass through them within the time that was waited for: ten thousand times the model's run, or "
     "--longest.",
     "", ""},
    {"E1406", "no time to follow the motion",
     "Periods, durations, times of a strobe and the longest time to wait are positive. The duration comes from "
     "--duration or from the model's "
     "`run`.",
     "", ""},
    {"E1407", "several starts cannot be spread over the section",
     "With --starts or --energy every point of the section becomes a motion: its position follows from the section and "
     "one velocity from the "
     "energy. That takes two coordinates, no constraints, a conserved energy, a section by positions, and an energy "
     "that reaches it.",
     "maup orbits model.lag --section \"x' = 0\" --starts 20",
     "maup orbits model.lag --section \"x = 0 rising\" --starts 20"},
    {"E1408", "the motion ends",
     "The run cannot go on: a collision, a singular mass matrix, constraints that contradict each other. The reason is "
     "that of "
     "`maup simulate`.",
     "", ""},
    {"E1409", "no section",
     "A section is an equation between the coordinates, their velocities and the time, with the direction in which the "
     "motion is to cross it: "
     "`x = 0 rising`, `θ1 = 0 falling`, `x' = 0`. A function that does not change along the motion cuts nothing out of "
     "it.",
     "", ""},
    {"E1410", "nothing can move",
     "The constraints leave no direction in which a neighbour of the motion could lie, so that there is no rate at "
     "which neighbours part.",
     "", ""},
    {"E1411", "a time of the averages is out of proportion",
     "Lyapunov exponents are averages over the run, which begin after the transient and are taken in intervals. An "
     "interval longer than the run, or one that "
     "cuts it into more than a million, and a transient of more than 10^8 steps have no sense; left out, both are "
     "chosen.",
     "maup orbits model.lag --lyapunov --interval 1e-300s", "maup orbits model.lag --lyapunov"},
    {"E1412", "more exponents than directions",
     "A system of n freedoms has 2 n exponents: one for each direction in which a neighbour can lie, in positions and "
     "velocities.",
     "maup orbits pendulum.lag --lyapunov --exponents 7", "maup orbits pendulum.lag --lyapunov --exponents 2"},
    {"E1413", "exponents of directions that vanish",
     "Where a contact closes or friction sticks, neighbours that differ in the direction that is held from then on "
     "come "
     "into the same state. Their exponents are −∞, and there are numbers only for the directions that are left.",
     "maup orbits bouncing_ball.lag --lyapunov", "maup orbits bouncing_ball.lag --lyapunov --exponents 2"},
    {"W1401", "Lyapunov exponents that do not add up",
     "The exponents add up to the mean rate at which the flow changes volumes: zero without dissipation, minus the "
     "damping rates else. If they "
     "do not, the neighbours of this motion were not carried to rounding; each exponent may be wrong by as much, and "
     "its error says so.",
     "", ""},
    {"W1402", "multipliers that the geometry contradicts",
     "Without forces and damping the derivative of the return map preserves the symplectic form; else its determinant "
     "is the exponential of the "
     "divergence, integrated over the period. Where it misses them by more than rounding its eigenvalues are no "
     "better, and those near the unit circle "
     "may lie on either side of it.",
     "", ""},
};

}  // namespace

std::span<const CodeEntry> orbits_codes() { return entries; }

}  // namespace maupertuis

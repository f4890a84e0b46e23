#include <maupertuis/codes.hpp>

namespace maupertuis {
namespace {

constexpr CodeEntry entries[] = {
    {"E0820", "a map leaves a coordinate out",
     "A map gives every coordinate of the first model as a function of the second. Coordinates that both models call "
     "by one name "
     "need not be written, nor those for which the second model has a `let` of that name.",
     "maup compare cartesian.lag angle.lag --map \"x = l sin θ\"",
     "maup compare cartesian.lag angle.lag --map \"x = l sin θ, y = -l cos θ\""},
    {"E0821", "a map that cannot be read",
     "A map is a list `name = formula`, with commas between. The names are coordinates, or parameters, of the first "
     "model; the "
     "formulas are those of the second, with its coordinates, parameters, points and definitions.",
     "maup compare cartesian.lag angle.lag --map \"θ = atan2(x, -y)\"",
     "maup compare cartesian.lag angle.lag --map \"x = l sin θ, y = -l cos θ\""},
    {"E0822", "a coordinate mapped to another dimension",
     "Both sides of an equation of the map have one dimension, as in a model.",
     "maup compare cartesian.lag angle.lag --map \"x = sin θ, y = -cos θ\"",
     "maup compare cartesian.lag angle.lag --map \"x = l sin θ, y = -l cos θ\""},
    {"E0823", "a coordinate mapped twice", "A coordinate has one value in each configuration.",
     "maup compare cartesian.lag angle.lag --map \"x = l sin θ, y = -l cos θ, y = l\"",
     "maup compare cartesian.lag angle.lag --map \"x = l sin θ, y = -l cos θ\""},
    {"E0824", "a map that is no smooth function of positions and time",
     "Two descriptions of one configuration are related by x = f(q, t). Velocities follow by the chain rule; a map "
     "that contains them "
     "would be a change of velocities, which Lagrange's equations do not survive in general. A map with |x|, a step or "
     "a piecewise "
     "formula has no acceleration at its kinks.",
     "maup compare cartesian.lag angle.lag --map \"x = abs(l sin θ), y = -l cos θ\"",
     "maup compare cartesian.lag angle.lag --map \"x = l sin θ, y = -l cos θ\""},
    {"E0825", "a parameter with two values",
     "Parameters of one name are taken to be the same quantity. With different values the motions differ whatever the "
     "equations are. "
     "Where the names mean different things, the map says what the parameter of the first model is in the second: `m = "
     "M + m`.",
     "maup compare angle.lag longer.lag", "maup compare angle.lag angle.lag"},
    {"N0826", "a parameter without a counterpart",
     "The first model has a parameter that the second does not have. Its value is put into the equations as an exact "
     "number, so that "
     "a proof holds for that value alone.",
     "maup compare cartesian.lag renamed.lag --map \"x = r sin θ, y = -r cos θ\"",
     "maup compare cartesian.lag renamed.lag --map \"x = r sin θ, y = -r cos θ, l = r\""},
    {"E0830", "nothing to reduce",
     "Constraints between positions tie coordinates to each other, so that some can be expressed by the rest. "
     "Constraints between "
     "velocities do not: they leave every configuration within reach. A model without constraints is in independent "
     "coordinates.",
     "# maup reduce\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\npoint P mass m at l (sin θ, -cos "
     "θ)\ngravity (0, -g)\n",
     "# maup reduce\nsystem pendulum\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at "
     "(x, y)\nconstraint x^2 + y^2 = l^2\ngravity (0, -g)\nstart x = l, y = 0 m\n"},
    {"E0831", "a constraint without a closed form",
     "Constraints are solved one by one: one that is linear in a coordinate, with a factor that does not change, for "
     "that coordinate; "
     "a circle, sphere or ellipsoid in two or three coordinates by angles. A closed loop of links is neither: its "
     "angles are roots "
     "of polynomials with several branches, and the constrained model is the better description of it.",
     "# maup reduce\nparam m = 1 kg, a = 1 m, b = 2 m\ncoord x, y : length\npoint P mass m at (x, y)\nconstraint x^4 + "
     "x y a^2 + y^4 = b^4\nstart x = b, y = 0 m\n",
     "# maup reduce\nparam m = 1 kg, a = 1 m, b = 2 m\ncoord x, y : length\npoint P mass m at (x, y)\nconstraint "
     "x^2/b^2 + y^2/a^2 = 1\nstart x = b, y = 0 m\n"},
    {"E0832", "a line that cannot be carried over to independent coordinates",
     "Old coordinates become definitions. A line that needs a coordinate, not a quantity, has no place for them.",
     "# maup reduce\nsystem pendulum\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at "
     "(x, y)\nconstraint x^2 + y^2 = l^2\nevent turn when y = -0.5 [m] : set x' = -x'\ngravity (0, -g)\nstart x = l, y "
     "= 0 m\n",
     "# maup reduce\nsystem pendulum\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at "
     "(x, y)\nconstraint x^2 + y^2 = l^2\nevent turn when y = -0.5 [m] : record\ngravity (0, -g)\nstart x = l, y = 0 "
     "m\n"},
    {"E0833", "a reduction that is not proved",
     "A reduced model is shown only when its motion is proved to be that of the model it comes from.", "", ""},
    {"E0834", "a degenerate Lagrangian in a comparison",
     "A comparison proves that each motion of one model is one of the other, from every state on the constraints. A "
     "degenerate Lagrangian asks more of states, or leaves functions of time free.",
     "", ""},
    {"E0835", "contacts, dry friction or set states in a comparison",
     "A comparison proves that two equations of motion have the same motions. Where contacts open and close, friction "
     "sticks and slides, or an event sets the state, an equation holds between such instants alone.",
     "", ""},
};

}  // namespace

std::span<const CodeEntry> comparison_codes() { return entries; }

}  // namespace maupertuis

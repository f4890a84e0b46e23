#include <maupertuis/codes.hpp>

namespace maupertuis {
namespace {

constexpr CodeEntry entries[] = {
    {"E0820", "a map leaves a coordinate out",
     "A map gives every coordinate of the first model as a function of the second. Coordinates that both models call by one name "
     "need not be written, nor those for which the second model has a `let` of that name.",
     "maup compare cartesian.lag angle.lag --map \"x = l sin θ\"", "maup compare cartesian.lag angle.lag --map \"x = l sin θ, y = -l cos θ\""},
    {"E0821", "a map that cannot be read",
     "A map is a list `name = formula`, with commas between. The names are coordinates, or parameters, of the first model; the "
     "formulas are those of the second, with its coordinates, parameters, points and definitions.",
     "maup compare cartesian.lag angle.lag --map \"θ = atan2(x, -y)\"", "maup compare angle.lag cartesian.lag --map \"θ = atan2(x, -y)\""},
    {"E0822", "a coordinate mapped to another dimension",
     "Both sides of an equation of the map have one dimension, as in a model.",
     "maup compare cartesian.lag angle.lag --map \"x = sin θ, y = -cos θ\"", "maup compare cartesian.lag angle.lag --map \"x = l sin θ, y = -l cos θ\""},
    {"E0823", "a coordinate mapped twice", "A coordinate has one value in each configuration.", "", ""},
    {"E0824", "a map that is no function of positions and time",
     "Two descriptions of one configuration are related by x = f(q, t). Velocities follow by the chain rule; a map that contains them "
     "would be a change of velocities, which Lagrange's equations do not survive in general.",
     "", ""},
    {"E0825", "a parameter with two values",
     "Parameters of one name are taken to be the same quantity. With different values the motions differ whatever the equations are. "
     "Where the names mean different things, the map says what the parameter of the first model is in the second: `m = M + m`.",
     "", ""},
    {"N0826", "a parameter without a counterpart",
     "The first model has a parameter that the second does not have. Its value is put into the equations as an exact number, so that "
     "a proof holds for that value alone.",
     "", ""},
};

}  // namespace

std::span<const CodeEntry> comparison_codes() { return entries; }

}  // namespace maupertuis

#include <maupertuis/codes.hpp>

namespace maupertuis {
namespace {

constexpr CodeEntry entries[] = {
    {"E1201", "no action to make stationary",
     "The principle of stationary action holds where the motion follows from a Lagrangian alone, with constraints "
     "between coordinates. Forces "
     "Q and dissipation D have no part in ∫ L dt; constraints between velocities follow d'Alembert's principle, and "
     "their motions are not the "
     "stationary paths among those that obey them.",
     "force x = -k x", "V = 1/2 k x^2"},
    {"E1202", "a path that leaves the constraints",
     "Every point of a path satisfies the constraints between coordinates, its ends included.",
     "path from (1, 1) at 0 to (0, -1) at 1", "path from (1, 0) at 0 to (0, -1) at 1"},
    {"E1203", "ends in the wrong order", "The action is an integral from the earlier end of the path to the later one.",
     "path from (0) at 2 s to (1) at 1 s", "path from (0) at 1 s to (1) at 2 s"},
    {"E1204", "no stationary path was found",
     "Newton's method looks for paths on which S is stationary from straight and bent lines between the ends, and by "
     "continuation from a "
     "short duration. Where all of that fails the end is most likely not reachable: outside of what L allows (a square "
     "root of a negative "
     "number), or conjugate to the start, where paths come together only at some points. It is no proof that there is "
     "none.",
     "", ""},
    {"E1205", "a path that misses its ends",
     "The model says between what ends paths run (`path from … to …`), and the path that was given begins or ends "
     "elsewhere.",
     "", ""},
    {"E1206", "L has no value on the path",
     "The integral of L is taken at points inside each piece of the path; there L is infinite or no number.", "", ""},
    {"E1207", "no path, and no run",
     "`maup action` needs to know which path: ends in the model (`path from (0, 1) at 0 to (2, 3) at 1`) or on the "
     "command line "
     "(--ends), a path as formulas (--path), or a motion (`run 10 s`, with its start).",
     "", ""},
    {"E1208", "the motion ends early",
     "The motion does not reach the end of its run. The reason is that of `maup simulate`.", "", ""},
    {"E1209", "rates beyond the range of numbers",
     "Numbers are doubles, up to 1.8e308. Ends that lie too close in time ask for velocities whose squares, and with "
     "them L, are larger: "
     "nothing is wrong with the principle, but no sum of such numbers exists.",
     "path from (0 m) at 0 s to (1 m) at 1e-300 s", "path from (0 m) at 0 s to (1 m) at 1 s"},
    {"E1210", "the study was interrupted",
     "Ctrl-C, or another signal, ended the search. What was found until then is not shown: it would be taken for all "
     "there is.",
     "", ""},
    {"W1202", "paths through a kink of L may be missing",
     "At abs, min, max and piecewise the derivatives of L may jump. A path that passes such a place is stationary "
     "where each side is and its momentum "
     "goes on. Newton's method, which finds the paths, needs second derivatives and may miss some of them; and the "
     "second variation "
     "has a part at each passage that is not counted, so that no Morse index is given for such a path.",
     "V = F abs(x)", "V = F sqrt(x^2 + d^2)"},
    {"W1201", "two counts of a Morse index disagree",
     "The index is counted by the negative inertia of the discretized second variation and by the zeros of Jacobi "
     "fields. Where they "
     "disagree no index is given: one of the two is beyond its accuracy.",
     "", ""},
};

}  // namespace

std::span<const CodeEntry> action_codes() { return entries; }

}  // namespace maupertuis

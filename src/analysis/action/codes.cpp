#include <maupertuis/codes.hpp>

namespace maupertuis {
namespace {

constexpr CodeEntry entries[] = {
    {"E1201", "no action to make stationary",
     "The principle of stationary action holds where the motion follows from a Lagrangian alone, with constraints "
     "between coordinates. Forces "
     "Q and dissipation D have no part in ∫ L dt; constraints between velocities follow d'Alembert's principle, and "
     "their motions are not the "
     "stationary paths among those that obey them. Where the constraints leave no freedom there is one path alone, "
     "with nothing to compare.",
     "# maup action\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nT = 1/2 m x'^2\nforce x = -k x\n"
     "path from 0 at 0 to 1 m at 1 s\n",
     "# maup action\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
     "path from 0 at 0 to 1 m at 1 s\n"},
    {"E1202", "a path that leaves the constraints",
     "Every point of a path satisfies the constraints between coordinates, its ends included.",
     "# maup action --paths 1\nparam m = 1 kg, l = 1 m\ncoord x, y : length\npoint P mass m at (x, y)\n"
     "constraint x^2 + y^2 = l^2\npath from (1 m, 1 m) at 0 to (0, 1 m) at 1 s\n",
     "# maup action --paths 1\nparam m = 1 kg, l = 1 m\ncoord x, y : length\npoint P mass m at (x, y)\n"
     "constraint x^2 + y^2 = l^2\npath from (1 m, 0) at 0 to (0, 1 m) at 1 s\n"},
    {"E1203", "ends in the wrong order", "The action is an integral from the earlier end of the path to the later one.",
     "", ""},
    {"E1204", "no stationary path was found",
     "Newton's method looks for paths on which S is stationary from straight and bent lines between the ends, and by "
     "continuation from a "
     "short duration. Where all of that fails the end is most likely not reachable: outside of what L allows (a square "
     "root of a negative "
     "number), or conjugate to the start, where paths come together only at some points. At an end that is free ∂L/∂q' "
     "has to vanish: where it is the same on all paths, and not 0, none is stationary. It is no proof that there is "
     "none.",
     "# maup action\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
     "path from 0 at 0 to 1 m at pi/2 s\n",
     "# maup action\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
     "path from 0 at 0 to 1 m at 1 s\n"},
    {"E1205", "a path that misses its ends",
     "The model says between what ends paths run (`path from … to …`), and the path that was given begins or ends "
     "elsewhere.",
     "# maup action --path y=s\nparam m = 1 kg, g = 9.81 m/s^2, v = 2 m/s\ncoord y : length\nT = 1/2 m y'^2\n"
     "V = m g y\nlet s = v t\npath from 0 at 0 to 1 m at 1 s\n",
     "# maup action --path y=s\nparam m = 1 kg, g = 9.81 m/s^2, v = 1 m/s\ncoord y : length\nT = 1/2 m y'^2\n"
     "V = m g y\nlet s = v t\npath from 0 at 0 to 1 m at 1 s\n"},
    {"E1206", "L has no value on the path",
     "The integral of L is taken at points inside each piece of the path; there L is infinite or no number.",
     "# maup action --path y=s\nparam g = 9.81 m/s^2, l = 1 m, h = -0.5 m\nindependent x : length\n"
     "coord y : length\nL = sqrt((1 + y'^2)/(2 g y))\nlet s = h + x\npath from h at 0 to h + l at l\n",
     "# maup action --path y=s\nparam g = 9.81 m/s^2, l = 1 m, h = 0.5 m\nindependent x : length\ncoord y : length\n"
     "L = sqrt((1 + y'^2)/(2 g y))\nlet s = h + x\npath from h at 0 to h + l at l\n"},
    {"E1207", "no path, and no run",
     "`maup action` needs to know which path: ends in the model (`path from (0, 1) at 0 to (2, 3) at 1`) or on the "
     "command line "
     "(--ends), a path as formulas (--path), or a motion (`run 10 s`, with its start).",
     "# maup action\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n",
     "# maup action\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
     "path from 0 at 0 to 1 m at 1 s\n"},
    {"E1208", "the motion ends early",
     "The motion does not reach the end of its run. The reason is that of `maup simulate`.",
     "# maup action --motion\nparam m = 1 kg, C = 1 J m\ncoord x : length\nT = 1/2 m x'^2\nV = -C/x\nstart x = 1 m\n"
     "run 5 s\n",
     "# maup action --motion\nparam m = 1 kg, C = 1 J m\ncoord x : length\nT = 1/2 m x'^2\nV = -C/x\nstart x = 1 m\n"
     "run 1 s\n"},
    {"E1209", "rates beyond the range of numbers",
     "Numbers are doubles, up to 1.8e308. Ends that lie too close in time ask for velocities whose squares, and with "
     "them L, are larger: "
     "nothing is wrong with the principle, but no sum of such numbers exists.",
     "# maup action\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
     "path from 0 at 0 to 1 m at 1e-300 s\n",
     "# maup action\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
     "path from 0 at 0 to 1 m at 1 s\n"},
    {"E1210", "the study was interrupted",
     "Ctrl-C, or another signal, ended the search. What was found until then is not shown: it would be taken for all "
     "there is.",
     "", ""},
    {"E1211", "a motion of too many steps",
     "`maup action --motion` lays elements of a path along the motion, one for each of its steps, so that the fastest "
     "turn is resolved; its second variation is a matrix over all of them. A longer run has no path.",
     "# maup action --motion\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
     "start x = 1 m\nrun 20000 s\n",
     "# maup action --motion\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
     "start x = 1 m\nrun 20 s\n"},
    {"E1212", "S of a path that is not known",
     "The integral of L along the path is infinite or converges too slowly to be told, as that of 1/(8 t) from 0 along "
     "x = sqrt(t) for a free particle; or so much happens on the path that not every piece of it can be looked at.",
     "# maup action --path x=s\nparam m = 1 kg, a = 1 m, τ = 1 s\ncoord x : length\nT = 1/2 m x'^2\n"
     "let s = a sqrt(t/τ)\npath from 0 at 0 to 1 m at 1 s\n",
     "# maup action --path x=s\nparam m = 1 kg, a = 1 m, τ = 1 s\ncoord x : length\nT = 1/2 m x'^2\n"
     "let s = a t/τ\npath from 0 at 0 to 1 m at 1 s\n"},
    {"E1213", "a path that jumps",
     "A path is a continuous curve. Where its formulas jump, the velocity is infinite, which the integral of L over "
     "both sides does not see: S of it would be no action.",
     "# maup action --path x=s\nparam m = 1 kg, a = 1 m, τ = 1 s\ncoord x : length\nT = 1/2 m x'^2\n"
     "let s = a step(t - τ/2)\npath from 0 at 0 to 1 m at 1 s\n",
     "# maup action --path x=s\nparam m = 1 kg, a = 1 m, τ = 1 s\ncoord x : length\nT = 1/2 m x'^2\n"
     "let s = a max(0, 2 t/τ - 1)\npath from 0 at 0 to 1 m at 1 s\n"},
    {"W1202", "paths through a kink of L may be missing",
     "At abs, min, max and piecewise the derivatives of L may jump. A path that passes such a place is stationary "
     "where each side is and its momentum "
     "goes on. Newton's method, which finds the paths, needs second derivatives and may miss some of them; and the "
     "second variation "
     "has a part at each passage that is not counted, so that no Morse index is given for such a path.",
     "# maup action\nparam m = 1 kg, F = 2 N\ncoord x : length\nT = 1/2 m x'^2\nV = F abs(x)\n"
     "path from 1 m at 0 to -1 m at 2 s\n",
     "# maup action\nparam m = 1 kg, F = 2 N, d = 1 cm\ncoord x : length\nT = 1/2 m x'^2\nV = F sqrt(x^2 + d^2)\n"
     "path from 1 m at 0 to -1 m at 2 s\n"},
    {"W1203", "a path that its own motion leaves",
     "A stationary path is checked by the motion from its own states, whose steps pass over nothing. Where the two "
     "differ by more than their errors, something narrower than the elements of the path acts on it, a barrier, a "
     "pulse; or the motion is as sensitive as that. S is told no better than the two agree.",
     "# maup action\ndimensionless\ncoord x : number\nL = 1/2 x'^2 + 1e6 exp(-((t - 0.5137)*1e6)^2)\n"
     "path from 0 at 0 to 1 at 1\n",
     "# maup action\ndimensionless\ncoord x : number\nL = 1/2 x'^2 + exp(-(t - 0.5137)^2)\n"
     "path from 0 at 0 to 1 at 1\n"},
    {"W1201", "two counts of a Morse index disagree",
     "The index is counted by the negative inertia of the discretized second variation and by the zeros of Jacobi "
     "fields. Where they "
     "disagree no index is given: one of the two is beyond its accuracy.",
     "# maup action\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
     "path from 0.4 m at 0 to -0.4 m at pi/2 (1 + 1e-9) s\n",
     "# maup action\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
     "path from 0.4 m at 0 to -0.4 m at 1.5 s\n"},
};

}  // namespace

std::span<const CodeEntry> action_codes() { return entries; }

}  // namespace maupertuis

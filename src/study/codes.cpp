#include <maupertuis/codes.hpp>

namespace maupertuis {
namespace {

constexpr CodeEntry entries[] = {
    {"E0245", "a study of motions in time for a model without it",
     "Equilibria, frequencies, periods and exponents belong to motions in time. Where another variable stands in its "
     "place there are "
     "equations (`maup derive`), their solutions from a start (`maup simulate`) and between two ends (`maup action`).",
     "# maup modes\nindependent x : length\ncoord y : length\nparam w = 2 N/m, h = 1 m\nL = w y sqrt(1 + y'^2)\n"
     "start y = h\nrun 1 m\n",
     "# maup simulate\nindependent x : length\ncoord y : length\nparam w = 2 N/m, h = 1 m\nL = w y sqrt(1 + y'^2)\n"
     "start y = h\nrun 1 m\n"},
    {"E0269", "no mode of the model",
     "A mode says which contacts are closed and what each friction does: `floor`, `floor sliding +, wall`, `x "
     "sticking`, "
     "or `free`. What is not named is open; friction that acts has to be named with what it does.",
     "# maup derive --mode ceiling\ncoord z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m z'^2\nV = m g z\n"
     "contact z >= 0 restitution 0.8 name floor\nstart z = 1 m\n",
     "# maup derive --mode floor\ncoord z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m z'^2\nV = m g z\n"
     "contact z >= 0 restitution 0.8 name floor\nstart z = 1 m\n"},
    {"E0270", "a question about one set of equations for a model with several modes",
     "Contacts and dry friction change the equations on the way. Hamiltonians, paths, second descriptions, and the "
     "linearization at a point or along a parameter are those of one mode, which --mode chooses; `maup simulate`, "
     "`maup test`, `maup orbits`, `maup invariants` and `maup modes` alone go through all of them.",
     "# maup hamiltonian\ncoord z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m z'^2\nV = m g z\n"
     "contact z >= 0 restitution 0.8 name floor\nstart z = 1 m\n",
     "# maup hamiltonian --mode free\ncoord z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m z'^2\nV = m g z\n"
     "contact z >= 0 restitution 0.8 name floor\nstart z = 1 m\n"},
    {"E0271", "an event acts on the motion that a question follows",
     "The action of a motion, and the motion by canonical equations, follow from L alone; what an event sets, or where "
     "it stops, does not. `maup simulate` and `maup orbits` carry events out.",
     "# maup action --motion\ncoord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\n"
     "event kick when x = 1 m : set x' = -x'\nstart x = 0 m, x' = 1 m/s\nrun 2 s\n",
     "# maup action --motion\ncoord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\n"
     "event kick when x = 1 m : record\nstart x = 0 m, x' = 1 m/s\nrun 2 s\n"},
    {"N0272", "events left out of account",
     "Equilibria, their stability and stationary paths are those of the equations of motion. An event that sets the "
     "state may throw a motion off an equilibrium that is stable by its equations.",
     "# maup modes\ncoord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
     "event kick when x = 0 falling : set x' = 2 x'\nstart x = 1 m\nrun 2 s\n",
     "# maup modes\ncoord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
     "start x = 1 m\nrun 2 s\n"},
    {"N0505", "the equations of a model with contacts",
     "Without --mode the equations are those of the system while no contact is closed and no dry friction acts.",
     "# maup derive\ncoord z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m z'^2\nV = m g z\n"
     "contact z >= 0 restitution 0.8 name floor\nstart z = 1 m\n",
     "# maup derive --mode free\ncoord z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m z'^2\nV = m g z\n"
     "contact z >= 0 restitution 0.8 name floor\nstart z = 1 m\n"},
    {"N0506", "a report of a model with contacts",
     "The page has the motion through all modes, but its equations are those without contact and dry friction, and "
     "what belongs to one set of equations is left out.",
     "# maup report -o - --no-run\ncoord z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m z'^2\nV = m g z\n"
     "contact z >= 0 restitution 0.8 name floor\nstart z = 1 m\nrun 2 s\n",
     "# maup report -o - --no-run --mode free\ncoord z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m z'^2\n"
     "V = m g z\ncontact z >= 0 restitution 0.8 name floor\nstart z = 1 m\nrun 2 s\n"},
    {"E0507", "a question about coordinates for a model with fields",
     "Of fields there are derivations, certified conservation laws, runs, modes, dispersion relations, plots, films, "
     "reports and tests; Hamiltonians, paths, orbits, sweeps and comparisons are those of coordinates.",
     "# maup hamiltonian\nfield u(x) : length on x = 0 m .. 1 m boundary u = 0\nparam ρ = 1 kg/m, T0 = 1 N\n"
     "density = 1/2 ρ u'^2 - 1/2 T0 u_x^2\n",
     "# maup derive\nfield u(x) : length on x = 0 m .. 1 m boundary u = 0\nparam ρ = 1 kg/m, T0 = 1 N\n"
     "density = 1/2 ρ u'^2 - 1/2 T0 u_x^2\n"},
    {"E0512", "a question about fields for a model without any",
     "A program that uses the library asked for the run of fields of a model that has coordinates alone. Its motion is "
     "that of Study::motion, `maup simulate`.",
     "", ""},
    {"E0690", "a derivation failed its certificate",
     "Every derivation is checked by routes that share nothing with it: jets of L along random paths, d'Alembert's "
     "principle over the particles, the power balance. One of them found a different value, so the derived equations "
     "are wrong and are not shown. That is a defect of the program, never of the model: please report it.",
     "", ""},
    {"W0691", "a check of the certificate was undecided",
     "A check could neither prove that a difference vanishes nor find a point where it does not, for example because "
     "the model takes a root or a logarithm of something that is negative almost everywhere. The equations are shown, "
     "but nothing vouches for them.",
     "# maup derive\ncoord x : length\nparam m = 1 kg, a = 10 cm, V0 = 2 J\nT = 1/2 m x'^2\n"
     "V = V0 sqrt(-1 - x^2/a^2)\n",
     "# maup derive\ncoord x : length\nparam m = 1 kg, a = 10 cm, V0 = 2 J\nT = 1/2 m x'^2\n"
     "V = V0 sqrt(1 + x^2/a^2)\n"},
};

}  // namespace

std::span<const CodeEntry> study_codes() { return entries; }

}  // namespace maupertuis

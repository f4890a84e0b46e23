#include <maupertuis/codes.hpp>

namespace maupertuis {
namespace {

constexpr CodeEntry entries[] = {
    {"E0245", "a study of motions in time for a model without it",
     "Equilibria, frequencies, periods and exponents belong to motions in time. Where another variable stands in its "
     "place there are "
     "equations (`maup derive`), their solutions from a start (`maup simulate`) and between two ends (`maup action`).",
     "", ""},
    {"E0269", "no mode of the model",
     "A mode says which contacts are closed and what each friction does: `floor`, `floor sliding +, wall`, `x "
     "sticking`, "
     "or `free`. What is not named is open; friction that acts has to be named with what it does.",
     "", ""},
    {"E0270", "a question about one set of equations for a model with several modes",
     "Contacts and dry friction change the equations on the way. Hamiltonians, paths, second descriptions, and the "
     "linearization at a point or along a parameter are those of one mode, which --mode chooses; `maup simulate`, "
     "`maup test`, `maup orbits`, `maup invariants` and `maup modes` alone go through all of them.",
     "", ""},
    {"N0505", "the equations of a model with contacts",
     "Without --mode the equations are those of the system while no contact is closed and no dry friction acts.", "",
     ""},
    {"N0506", "a report of a model with contacts",
     "The page has the motion through all modes, but its equations are those without contact and dry friction, and "
     "what belongs to one set of equations is left out.",
     "", ""},
    {"E0507", "a question about coordinates for a model with fields",
     "Of fields there are derivations, certified conservation laws, waves and tests; Hamiltonians, paths, "
     "linearizations "
     "and pictures are those of coordinates.",
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
     "", ""},
};

}  // namespace

std::span<const CodeEntry> study_codes() { return entries; }

}  // namespace maupertuis

#include <maupertuis/codes.hpp>

namespace maupertuis {
namespace {

constexpr CodeEntry entries[] = {
    {"E0245", "a study of motions in time for a model without it",
     "Equilibria, frequencies, periods and exponents belong to motions in time. Where another variable stands in its "
     "place there are "
     "equations (`maup derive`), their solutions from a start (`maup simulate`) and between two ends (`maup action`).",
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

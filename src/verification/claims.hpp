#pragma once
#include "verification/resemblance.hpp"

#include <string>

namespace maupertuis {

/// The known mistake from which the equation `difference = 0` follows, where it changes the terms in which the claim
/// differs from the equation that it resembles; else what that difference says; or an empty text. `resemblance` may be
/// null. Precondition: it does not follow from the right equations.
std::string diagnose_claim(Expr difference, const EquationsOfMotion& equations, const Resemblance* resemblance);

}  // namespace maupertuis

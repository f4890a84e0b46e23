#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <string>

namespace maupertuis {

/// The known mistake from which the equation `difference = 0` follows, or an empty text.
/// Precondition: it does not follow from the right equations.
std::string diagnose_claim(Expr difference, const EquationsOfMotion& equations);

}  // namespace maupertuis

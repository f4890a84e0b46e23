#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <string>
#include <vector>

namespace maupertuis {

/// What a term becomes by a slip of the pen, and which slip that is.
struct TermVariant {
  Expr value;
  std::string sentence;  // "cos θ stands in the place of sin θ"
};

/// Slips with functions, arguments, velocities and powers: sin for cos, θ for sin θ, θ1 + θ2 for θ1 − θ2, θ' for θ'^2,
/// θ for θ', θ2' for θ1'.
std::vector<TermVariant> term_variants(Expr term, const EquationsOfMotion& equations);

}  // namespace maupertuis

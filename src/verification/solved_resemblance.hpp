#pragma once
#include "verification/resemblance.hpp"

namespace maupertuis {

/// q̈ and λ as the equations determine them; empty where they are not solved for: singular, too many, too long.
ExprMap solved_motion(const EquationsOfMotion& equations);

/// A false claim F = 0 that is linear in q̈ and λ, compared with what the solved equations give for these: the same
/// combination of q̈ and λ with other terms beside it, or the same terms with another inertia before it. Nothing where
/// more than one term of these differs, or one by more than a number.
std::optional<Resemblance> resembled_solution(Expr difference, const EquationsOfMotion& equations);

}  // namespace maupertuis

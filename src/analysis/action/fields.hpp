#pragma once
#include "analysis/action/directions.hpp"

#include <maupertuis/stop_flag.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace maupertuis::action {

/// The equations of L + Σ λ G. With integral constraints λ and z = ∫ G stand as coordinates of their own behind those
/// of the system (λ' = 0, z' = G), so that neighbours with another λ are motions as well. Nothing where they cannot be
/// had.
std::optional<EquationsOfMotion> weighted_equations(const EquationsOfMotion& equations, const Vector& multipliers);

/// What the neighbours of a path do that leave its beginning together.
struct FieldStudy {
  std::string reason;  // why it could not be done; empty: it was
  std::vector<ConjugatePoint> inside;
  std::size_t at_end = 0;  // multiplicity of the end itself
  std::optional<std::size_t>
      concavity;  // of free or closed ends; nothing for fixed ones, or where the end is conjugate
  MotionCheck check;

  std::size_t count() const;
};

/// Jacobi fields along a stationary path by the tangent equations, stretch by stretch from the states of the path, so
/// that an unstable motion does no harm. Precondition: M is positive definite on the directions allowed.
/// `states`: where they are known better than by the path, by time.
FieldStudy jacobi_fields(Functional& functional, const EquationsOfMotion& weighted, Expr lagrangian, const Trial& trial,
                         std::span<const MotionState> states, const FixedEnds& fixed, bool singular_start,
                         bool singular_end, const Vector& least, const StopFlag* interrupt);

/// The check alone, where M is not positive definite. No integral constraints, L finite at both ends.
MotionCheck carried_along(const EquationsOfMotion& weighted, Expr lagrangian, const Trial& trial, const Vector& least,
                          const StopFlag* interrupt);

}  // namespace maupertuis::action

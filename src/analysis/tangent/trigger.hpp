#pragma once
#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/function_kernel.hpp>
#include <maupertuis/tangent.hpp>

#include <eigen3/Eigen/Core>
#include <optional>
#include <vector>

namespace maupertuis::tangent {

/// The function whose root an instant is, h(q, q̇, q̈, λ, t), with its derivatives.
class Trigger {
 public:
  /// `equations`: of the mode before the instant. Forces of contacts that are open there are 0.
  Trigger(const EquationsOfMotion& equations, Expr function);

  /// Whether q̈ or λ stands in it.
  bool sees_forces() const { return sees_forces_; }
  /// δh of each column [columns]. `forces`: those of the point, where it sees them.
  Eigen::RowVectorXd along(const TangentPoint& point, const std::optional<TangentForces>& forces) const;

 private:
  std::size_t n_, m_;
  bool sees_forces_ = false;
  DifferentiableKernel kernel_;
  mutable std::optional<FunctionWorkspace> work_;
};

}  // namespace maupertuis::tangent

#pragma once
#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/function_kernel.hpp>

#include <eigen3/Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace maupertuis::tangent {

/// Functions of q, q̇, t of a system in numbers, with their derivatives by (q, q̇).
class PointFunctions {
 public:
  /// Precondition: no accelerations and no multipliers stand in them.
  PointFunctions(const MechanicalSystem& system, std::span<const Expr> functions);

  std::vector<double> values(const MotionState& state) const;
  /// [functions × 2n]
  Eigen::MatrixXd slopes(const MotionState& state) const;

 private:
  std::vector<double> evaluate(FunctionWorkspace& work, std::size_t count, const MotionState& state) const;

  std::size_t rows_, columns_;
  DifferentiableKernel kernel_;
  mutable std::optional<FunctionWorkspace> values_, all_;
};

}  // namespace maupertuis::tangent

#pragma once
#include "kernel/dynamics/point_writer.hpp"
#include "kernel/sparse/elimination.hpp"

/// Accelerations and forces as straight lines.
namespace maupertuis::dynamics {

struct WrittenDynamics {
  std::vector<straight::StraightLine> lines;  // R of any q̈; and q̈, where there is a plan
  std::vector<NumberSource> numbers;          // of NumberArray
};

/// How M₀ is solved: by these pivots, or by a full L D Lᵀ where they are null. Null both: not at all.
struct WrittenPlan {
  const sparse::LiftedSystem* system = nullptr;
  const std::vector<sparse::Pivot>* pivots = nullptr;
};

/// Precondition: a plan has no constraints.
WrittenDynamics write_dynamics(const Program& program, const WrittenPlan& plan);

}  // namespace maupertuis::dynamics

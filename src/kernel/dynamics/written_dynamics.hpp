#pragma once
#include "kernel/dynamics/flat_program.hpp"
#include "kernel/sparse/elimination.hpp"
#include "kernel/straight_line/straight_line.hpp"

/// Accelerations and forces as straight lines, for machine code.
namespace maupertuis::dynamics {

/// Arrays of the lines, in order; then the scratch.
enum Array : std::uint32_t { TimeArray, PositionArray, VelocityArray, AccelerationArray, NumberArray, ResultArray, arrays };

/// What a number of NumberArray is; all follow from parameters and the sides of switches.
struct NumberSource {
  enum What : std::uint8_t { OfCoefficient, OfChoice, OfPivot } what;
  Coefficient coefficient{};    // OfCoefficient
  std::uint32_t index = 0;      // OfChoice: of the edge; OfPivot: of the pivot, whose usual size it is
};

struct WrittenDynamics {
  straight::StraightLine forces, accelerations;
  std::vector<NumberSource> numbers;
};

/// How M₀ is solved: by these pivots, or by a full L D Lᵀ where they are null.
struct WrittenPlan {
  const sparse::LiftedSystem& system;
  const std::vector<sparse::Pivot>* pivots;
};

/// R of any q̈ by `moving`, and q̈ by `at_rest`, whose value_of_slot holds what the entries of the system are made of.
/// Precondition: no constraints.
WrittenDynamics write_dynamics(const Program& program, const FlatProgram& moving, const FlatProgram& at_rest, const WrittenPlan& plan);

}  // namespace maupertuis::dynamics

#pragma once
#include "fields/field_motion.hpp"

#include <optional>
#include <vector>

namespace maupertuis {

/// Whether the elements of a mesh still follow the slopes of its fields.
///
/// On elements that follow a field its coefficients of Legendre's polynomials fall fast. Where a wave steepens towards
/// a jump of its slope they do not: the highest one of some element comes near to the slope itself, and what the mesh
/// goes on with is no solution of the field any more. Measured beside what the start has there.
class SteepeningWatch {
 public:
  /// Whether waves are as fast as their fields or slopes let them: ∂²ℒ by velocities and slopes holds these. Else they
  /// do not overtake each other.
  static bool may_steepen(const FieldEquations& equations);
  SteepeningWatch(const FieldEquations& equations, std::vector<int> cells, int order);

  enum class Follows { Well, Barely, Not };
  /// At the moment of the mesh; the first one is that of the start.
  Follows look(const FieldMotion& mesh);
  /// The first moment at which the mesh did not follow.
  std::optional<double> lost() const { return lost_; }
  /// W0660.
  void warn(Diagnostics& diagnostics) const;

 private:
  double part_of_highest(const FieldMotion& mesh, std::size_t field, std::size_t along, bool rates);

  const FieldEquations& equations_;
  std::vector<int> cells_;
  int order_;
  std::vector<double> from_, width_;  // of the domain, along each direction
  std::vector<double> steepest_;      // |φ_x| so far, [varied × directions]
  std::optional<double> at_start_, lost_;
};

/// W0661 where a run whose energy is conserved has lost it by far more than rounding.
void warn_of_drift(const FieldRunResult& run, const FieldEquations& equations, Diagnostics& diagnostics);

}  // namespace maupertuis

#pragma once
#include "kernel/workspace/inverse.hpp"
#include "kernel/workspace/stage_unknowns.hpp"

namespace maupertuis::workspace {

/// Whether an inverse that code has found solves for a right side in which all coordinates take part, each in its own
/// measure: it was mirrored, which only a symmetric M₀ allows, and solutions by it are not corrected.
class InverseProbe {
 public:
  InverseProbe(const Expansion& x, const ResidualPlaces& residual) : x_(x), residual_(residual) {}
  InverseProbe(const InverseProbe&) = delete;

  /// Code has been loaded.
  void make_room();
  void constants_changed() { is_set_ = false; }
  /// Leaves its solution and the tangents along it in the arguments.
  bool holds(const Inverse& inverse, StageUnknowns& unknowns, Tangents& tangents);

 private:
  void set(const Inverse& inverse);

  const Expansion& x_;
  const ResidualPlaces& residual_;
  Doubles right_side_;    // [stride] a row
  Doubles largest_rest_;  // [stride] that a solution for it may leave; what is no residual may be anything
  bool is_set_ = false;   // for these parameters
};

}  // namespace maupertuis::workspace

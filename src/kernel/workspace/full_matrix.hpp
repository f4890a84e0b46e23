#pragma once
#include "kernel/workspace/residual_places.hpp"
#include "kernel/workspace/tangents.hpp"

#include <optional>
#include <span>
#include <vector>

namespace maupertuis::workspace {

/// M₀ = ∂R/∂(q̈, λ) at order 0, bordered by the constraints, of one point. It is found when it is asked for.
class FullMatrix {
 public:
  FullMatrix(const Expansion& x, const ResidualPlaces& residual, Tangents& tangents);
  FullMatrix(const FullMatrix&) = delete;

  /// Another point; `alone`, as an output between steps is: its coefficients are not corrected.
  void begin(bool alone) { is_known_ = false, alone_ = alone; }
  bool is_of_point_alone() const { return alone_; }
  /// Row by row [(n + m) × (n + m)].
  const std::vector<double>& values();
  double at(std::size_t row, std::size_t column) { return values()[row * x_.unknowns + column]; }
  bool is_finite() { return x_.engine.are_finite(values().data(), x_.unknowns, x_.unknowns, x_.unknowns); }
  /// Whether it is symmetric at all points: then it can be inverted without pivots, and its inverse read by rows or
  /// columns alike.
  bool has_symmetric_pattern();

 private:
  void find();
  void find_by_tangents();
  void sweep_block(std::size_t first);
  bool can_be_fetched_in_eights() const;
  void fetch_eights();
  void fetch(std::size_t i, const double* column, std::size_t step, std::size_t first, std::size_t last);

  const Expansion& x_;
  const ResidualPlaces& residual_;
  Tangents& tangents_;
  const bool in_eights_;
  bool is_known_ = false, alone_ = false;
  std::vector<double> values_;             // empty until it is asked for
  std::vector<double> block_tangents_;     // [slots × 8]
  std::vector<sparse::Edge> edges_;        // that M₀ goes through
  std::optional<bool> symmetric_pattern_;  // once it was asked for
};

}  // namespace maupertuis::workspace

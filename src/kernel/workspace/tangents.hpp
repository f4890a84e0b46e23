#pragma once
#include "kernel/workspace/expansion.hpp"

#include <span>

namespace maupertuis::workspace {

/// How the slots of a point change with q̈ and λ, and the coefficients of a stage with it: coefficient k + 2 − ℓ of a
/// slot of lag ℓ follows q̈_k with its tangent of order 0. Of up to 16 unknowns the tangents in the direction of each
/// are kept, so that corrections are products with a matrix; of more, those in one direction.
class Tangents {
 public:
  static constexpr std::size_t most_of_each = 16;

  Tangents(const Expansion& x, ExpansionInCode& in_code);
  Tangents(const Tangents&) = delete;

  bool are_of_each() const { return are_of_each_; }
  /// In the direction of each unknown (`are_of_each()`), or of these unknowns (else).
  void find_of_each() { find(x_.unknowns); }
  void find_along(std::span<const double> unknowns);
  /// Slot by slot: of one unknown; those that were found along unknowns.
  const double* of(std::size_t unknown) const { return values_.data() + unknown * x_.memory.stride; }
  double* along() { return values_.data(); }
  const packed::TangentMatrix& matrix() const { return matrix_; }

  /// What q̈_k changes in the coefficients of the stage: by all tangents, or by those in one direction.
  void correct(int stage, const double* weights) { x_.engine.correct(x_.tables, stage, matrix_, weights); }
  void correct_along(int stage, const double* direction, double weight);

 private:
  void find(std::size_t directions);

  const Expansion& x_;
  ExpansionInCode& in_code_;
  const bool are_of_each_;
  Doubles values_;  // [unknowns × stride], or [stride]
  packed::TangentMatrix matrix_;
};

}  // namespace maupertuis::workspace

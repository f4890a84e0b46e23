#pragma once
#include <maupertuis/evaluate.hpp>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace maupertuis {

/// Whether functions have a common root next to a point, asked of numbers of 100 digits: what double takes for a root
/// may be a flat place, 10⁻⁴⁰ beside 1, or the neighbourhood of a multiple root, (x − a)⁴ multiplied out.
class PreciseRoots {
 public:
  /// Cost: the derivatives of all functions by all unknowns, as formulas.
  PreciseRoots(std::span<const Expr> functions, std::span<const Expr> unknowns);
  ~PreciseRoots();

  /// Newton's method from `start`, which binds every symbol; `sizes` [unknowns]: 0 for what no length is measured in,
  /// as multipliers. Its steps have to end: below 10⁻⁶⁰ of the sizes, or as a geometric series, as at multiple roots,
  /// of which less than 10⁻³⁰ is left, or less than 10⁻¹² where no function can be told from 0; what is left is added
  /// at once. Functions of none of the unknowns are not looked at, and one that a step cannot change has to vanish.
  /// What the functions leave open of the unknowns stays as it is. Nothing where that takes too long, leads farther
  /// away than `farthest` sizes, or through a place without values.
  std::optional<std::vector<double>> near(const Bindings& start, std::span<const double> sizes, double farthest) const;

 private:
  class Way;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace maupertuis

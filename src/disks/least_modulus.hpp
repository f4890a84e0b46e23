#pragma once
#include "disks/reals.hpp"

#include <cmath>

namespace maupertuis::disk_rules {
namespace {

/// A lower bound of |a + b s + c s²| on |s| ≤ r: |a| − |b| r − |c| r², or |c| (|s₁| − r) (|s₂| − r) with its roots, so
/// that the square of a distance that shrinks, (d − v s)², is told from 0 up to r = d/v; the former ends at 0.41 of
/// that.
template <class V>
V least_modulus(double a, double b, double c, const V& r) {
  const double size_of_b = std::abs(b), size_of_c = std::abs(c);
  const V none = all<V>(0);
  const V by_terms = larger(none, all<V>(std::abs(a)) - (r * size_of_c + all<V>(size_of_b)) * r);
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) {
    const V gap = all<V>(std::sqrt(a / c)) - r;
    return select(none < gap, larger(by_terms, gap * gap * size_of_c), by_terms);
  }
  const double q = 0.5 * (size_of_b + std::sqrt(discriminant));  // |c s₁|, the larger root; s₂ = a/q
  if (!(q > 0)) return by_terms;
  const V of_larger = all<V>(q) - r * size_of_c, of_smaller = all<V>(std::abs(a) / q) - r;
  const V both = select(none < of_larger, select(none < of_smaller, of_larger * of_smaller, none), none);
  return larger(by_terms, both);
}

}  // namespace
}  // namespace maupertuis::disk_rules

#pragma once
#include <algorithm>
#include <cmath>

namespace maupertuis {

/// A lower bound of |a + b s + c s²| on |s| ≤ r: |a| − |b| r − |c| r², or |c| (|s₁| − r) (|s₂| − r) with its roots, so
/// that the square of a distance that shrinks, (d − v s)², is told from 0 up to r = d/v; the former ends at 0.41 of
/// that.
inline double least_modulus(double a, double b, double c, double r) {
  const double by_terms = std::max(0.0, std::abs(a) - (std::abs(b) + std::abs(c) * r) * r);
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) {
    const double root = std::sqrt(a / c);
    return root > r ? std::max(by_terms, std::abs(c) * (root - r) * (root - r)) : by_terms;
  }
  const double q = 0.5 * (std::abs(b) + std::sqrt(discriminant));  // |c s₁|, the larger root; s₂ = a/q
  const double larger = q - std::abs(c) * r, smaller = std::abs(a) / q - r;
  return q > 0 && larger > 0 && smaller > 0 ? std::max(by_terms, larger * smaller) : by_terms;
}

}  // namespace maupertuis

#pragma once
#include "integrator/taylor/roots.hpp"
#include "integrator/taylor/switches_code.hpp"

#include <algorithm>
#include <cmath>

/// Where a polynomial comes down to zero, up to rounding, and goes back.
namespace maupertuis::taylor {
namespace touches {

/// From left to right through halves, until a part lies within the rounding error whole.
template <class T>
class Search {
 public:
  Search(const ScaledPolynomialOf<T>& polynomial, std::int8_t side)
      : polynomial_(polynomial), side_(side), clear_(side * polynomial.p[0] > polynomial.error_up_to(T(0))) {}

  std::optional<T> in(const T& low, const T& high, std::vector<T> b) {
    const T error = polynomial_.error_up_to(high);
    const auto [least, most] = std::minmax_element(b.begin(), b.end());
    if (*least > error) return clear_ = true, std::nullopt;
    const T middle = T(0.5) * (low + high);
    if (*most <= 8 * error || high - low < T(1e-14)) {
      const T lowest = bottom(middle);
      const T there = side_ * crossings::value(std::span<const T>(polynomial_.p), lowest);
      return clear_ && there <= polynomial_.error_up_to(lowest) ? std::optional<T>(lowest) : std::nullopt;
    }
    std::vector<T> right = crossings::split(b);
    if (const auto left = in(low, middle, std::move(b))) return left;
    return in(middle, high, std::move(right));
  }

  /// Newton for p′ = 0.
  T bottom(T x) const {
    for (int turn = 0; turn < 30; ++turn) {
      T slope = T(0), curvature = T(0);
      for (std::size_t k = polynomial_.p.size(); k-- > 1;) {
        curvature = curvature * x + slope;
        slope = slope * x + T(k) * polynomial_.p[k];
      }
      if (curvature == 0) break;
      const T better = x - slope / curvature;
      using std::abs;
      if (!(abs(better - x) < T(1e-3))) break;
      x = better;
    }
    return std::clamp(x, T(0), T(1));
  }

 private:
  const ScaledPolynomialOf<T>& polynomial_;
  std::int8_t side_;
  bool clear_;  // of zero, so far
};

}  // namespace touches

template <class T>
std::optional<T> touching(const ScaledPolynomialOf<T>& polynomial, std::int8_t side, bool ends_at_root) {
  using std::abs;
  const std::span<const T> p = polynomial.p;
  if (p.empty() || side == 0) return std::nullopt;
  T rest = T(0);
  for (std::size_t k = 1; k < p.size(); ++k) rest += abs(p[k]);
  if (side * p[0] > rest + watching::unit<T>() * polynomial.reach) return std::nullopt;
  if (p.size() == 1) return std::nullopt;
  std::vector<T> b = crossings::to_bernstein(p, side);
  // Positive but for the ends: it comes to zero nowhere between them, however near to them it is.
  const T error = watching::unit<T>() * polynomial.reach;
  const bool is_positive = std::all_of(b.begin() + 1, b.end() - 1, [&](const T& c) { return c > error; });
  if (is_positive && (ends_at_root || b.back() > error)) return std::nullopt;
  return touches::Search<T>(polynomial, side).in(T(0), T(1), std::move(b));
}

namespace touches {

/// Where it begins at a zero of this order, what it has of lower powers is rounding, and is no touch.
template <class T>
void take_out_zero(ScaledPolynomialOf<T>& polynomial, std::size_t order) {
  std::fill_n(polynomial.p.begin(), std::min(order, polynomial.p.size()), T(0));
}

/// The same polynomial over [0, end] alone.
template <class T>
ScaledPolynomialOf<T> up_to(ScaledPolynomialOf<T> polynomial, const std::optional<T>& end) {
  T power = T(1);
  for (T& c : polynomial.p) {
    c *= power;
    if (end) power *= *end;
  }
  return polynomial;
}

}  // namespace touches

}  // namespace maupertuis::taylor

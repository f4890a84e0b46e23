#pragma once
#include "integrator/taylor/crossing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace maupertuis::taylor {
namespace crossings {

template <class T>
T value(std::span<const T> p, const T& x) {
  T sum = T(0);
  for (std::size_t k = p.size(); k-- > 0;) sum = sum * x + p[k];
  return sum;
}

/// Powers of x to Bernstein polynomials on [0, 1], in their place: b_i = Σ_k C(i,k)/C(d,k) p_k.
template <class T>
std::vector<T> to_bernstein(std::vector<T> b, int side) {
  const std::size_t degree = b.size() - 1;
  T binomial = T(1);
  for (std::size_t k = 0; k <= degree; ++k) {
    b[k] *= side / binomial;
    binomial = binomial * T(degree - k) / T(k + 1);
  }
  for (std::size_t pass = 1; pass <= degree; ++pass)
    for (std::size_t i = degree; i >= pass; --i) b[i] += b[i - 1];
  return b;
}

/// De Casteljau: the coefficients on the left half stay in b, those on the right half are returned.
template <class T>
std::vector<T> split(std::vector<T>& b) {
  std::vector<T> right(b.size());
  const std::size_t degree = b.size() - 1;
  for (std::size_t level = 0; level <= degree; ++level) {
    right[degree - level] = b[degree];
    for (std::size_t i = degree; i > level; --i) b[i] = T(0.5) * (b[i] + b[i - 1]);
  }
  return right;
}

template <class T>
std::vector<T> to_bernstein(std::span<const T> p, int side) {
  return to_bernstein(std::vector<T>(p.begin(), p.end()), side);
}

template <class T>
int sign_changes(const std::vector<T>& b) {
  int changes = 0;
  T last = T(0);
  for (const T& x : b) {
    if (x == 0) continue;
    if (last != 0 && (x > 0) != (last > 0)) ++changes;
    last = x;
  }
  return changes;
}

template <class T>
class Search {
 public:
  Search(std::span<const T> p, int side, const T& unit, const T& scale)
      : p_(p), side_(side), unit_(unit), scale_(scale) {}

  std::optional<T> in(const T& low, const T& high, std::vector<T> b) const {
    const T tolerance = error_up_to(high);
    if (*std::min_element(b.begin(), b.end()) >= -tolerance) return std::nullopt;
    if (b.front() < -error_up_to(low)) return low;
    if (b.front() >= 0 && b.back() < -tolerance && sign_changes(b) == 1) return refine(low, high);
    const T middle = T(0.5) * (low + high);
    if (!(low < middle && middle < high) || high - low < std::numeric_limits<T>::epsilon() / 16)
      return b.back() < -tolerance ? std::optional<T>(high) : std::nullopt;
    std::vector<T> right = split(b);
    if (const auto left = in(low, middle, std::move(b))) return left;
    return in(middle, high, std::move(right));
  }

 private:
  T error_up_to(const T& x) const {
    using std::abs;
    T reach = T(0);
    for (std::size_t k = p_.size(); k-- > 1;) reach = (reach + abs(p_[k])) * x;
    return unit_ * (scale_ + reach);
  }

  T side_value(const T& x) const { return side_ * value(p_, x); }

  /// Secants, with half the weight of an end that stays (Illinois), and a bisection in every third turn; [low, high]
  /// brackets one simple root.
  T refine(T low, T high) const {
    T at_low = side_value(low), at_high = side_value(high);
    if (at_low <= 0) return low;
    T of_low = at_low, of_high = at_high;  // weights
    int stays = 0;                         // the end that stayed in the last turn: −1 low, 1 high
    for (int turn = 0; turn < most_turns && at_high < 0; ++turn) {
      T x = T(0.5) * (low + high);
      if (!(low < x && x < high)) break;
      if (turn % 3 != 2) {
        const T secant = low + (high - low) * (of_low / (of_low - of_high));
        if (low < secant && secant < high) x = secant;
      }
      const T y = side_value(x);
      if (y == 0) return x;
      const int moves = y > 0 ? -1 : 1;
      (y > 0 ? low : high) = x;
      (y > 0 ? at_low : at_high) = y;
      (y > 0 ? of_low : of_high) = y;
      if (stays == -moves) (y > 0 ? of_high : of_low) *= T(0.5);
      stays = -moves;
    }
    return at_low <= -at_high ? low : high;
  }

  static constexpr int most_turns = std::max(200, 3 * std::numeric_limits<T>::digits);

  std::span<const T> p_;
  int side_;
  T unit_, scale_;
};

}  // namespace crossings

template <class T>
std::optional<T> first_crossing(std::span<const T> p, int side, const std::type_identity_t<T>& unit,
                                const std::type_identity_t<T>& scale) {
  using std::abs;
  while (p.size() > 1 && p.back() == 0) p = p.first(p.size() - 1);
  if (p.empty()) return std::nullopt;
  T reach = T(0);
  for (std::size_t k = 1; k < p.size(); ++k) reach += abs(p[k]);
  if (side * p[0] >= reach) return std::nullopt;
  return crossings::Search<T>(p, side, unit, scale).in(T(0), T(1), crossings::to_bernstein(p, side));
}

}  // namespace maupertuis::taylor

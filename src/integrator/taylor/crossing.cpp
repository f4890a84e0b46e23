#include "integrator/taylor/crossing.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace maupertuis::taylor {
namespace {

using Coefficients = std::vector<double>;

double value(std::span<const double> p, double x) {
  double sum = 0;
  for (std::size_t k = p.size(); k-- > 0;) sum = sum * x + p[k];
  return sum;
}

/// Powers of x to Bernstein polynomials on [0, 1]: b_i = Σ_k C(i,k)/C(d,k) p_k.
Coefficients to_bernstein(std::span<const double> p, int side) {
  const std::size_t degree = p.size() - 1;
  Coefficients b(p.begin(), p.end());
  double binomial = 1;
  for (std::size_t k = 0; k <= degree; ++k) {
    b[k] *= side / binomial;
    binomial = binomial * static_cast<double>(degree - k) / static_cast<double>(k + 1);
  }
  for (std::size_t pass = 1; pass <= degree; ++pass)
    for (std::size_t i = degree; i >= pass; --i) b[i] += b[i - 1];
  return b;
}

/// De Casteljau: the coefficients on the left half stay in b, those on the right half are returned.
Coefficients split(Coefficients& b) {
  Coefficients right(b.size());
  const std::size_t degree = b.size() - 1;
  for (std::size_t level = 0; level <= degree; ++level) {
    right[degree - level] = b[degree];
    for (std::size_t i = degree; i > level; --i) b[i] = 0.5 * (b[i] + b[i - 1]);
  }
  return right;
}

int sign_changes(const Coefficients& b) {
  int changes = 0;
  double last = 0;
  for (const double x : b) {
    if (x == 0) continue;
    if (last != 0 && (x > 0) != (last > 0)) ++changes;
    last = x;
  }
  return changes;
}

class Search {
 public:
  Search(std::span<const double> p, int side, double unit, double scale)
      : p_(p), side_(side), unit_(unit), scale_(scale) {}

  std::optional<double> in(double low, double high, Coefficients b) const {
    const double tolerance = error_up_to(high);
    if (*std::min_element(b.begin(), b.end()) >= -tolerance) return std::nullopt;
    if (b.front() < -error_up_to(low)) return low;
    if (b.front() >= 0 && b.back() < -tolerance && sign_changes(b) == 1) return refine(low, high);
    const double middle = 0.5 * (low + high);
    if (!(low < middle && middle < high) || high - low < 1e-17)
      return b.back() < -tolerance ? std::optional(high) : std::nullopt;
    Coefficients right = split(b);
    if (const auto left = in(low, middle, std::move(b))) return left;
    return in(middle, high, std::move(right));
  }

 private:
  double error_up_to(double x) const {
    double reach = 0;
    for (std::size_t k = p_.size(); k-- > 1;) reach = (reach + std::abs(p_[k])) * x;
    return unit_ * (scale_ + reach);
  }

  double side_value(double x) const { return side_ * value(p_, x); }

  /// Bisection with a secant in every other turn; [low, high] brackets one simple root.
  double refine(double low, double high) const {
    double at_low = side_value(low), at_high = side_value(high);
    if (at_low <= 0) return low;
    for (int turn = 0; turn < 200 && at_high < 0; ++turn) {
      double x = 0.5 * (low + high);
      if (!(low < x && x < high)) break;
      if (turn % 2 == 0) {
        const double secant = low + (high - low) * (at_low / (at_low - at_high));
        if (low < secant && secant < high) x = secant;
      }
      const double y = side_value(x);
      if (y == 0) return x;
      (y > 0 ? low : high) = x;
      (y > 0 ? at_low : at_high) = y;
    }
    return at_low <= -at_high ? low : high;
  }

  std::span<const double> p_;
  int side_;
  double unit_, scale_;
};

}  // namespace

std::optional<double> first_crossing(std::span<const double> p, int side, double unit, double scale) {
  while (p.size() > 1 && p.back() == 0) p = p.first(p.size() - 1);
  if (p.empty()) return std::nullopt;
  double reach = 0;
  for (std::size_t k = 1; k < p.size(); ++k) reach += std::abs(p[k]);
  if (side * p[0] >= reach) return std::nullopt;
  return Search(p, side, unit, scale).in(0, 1, to_bernstein(p, side));
}

}  // namespace maupertuis::taylor

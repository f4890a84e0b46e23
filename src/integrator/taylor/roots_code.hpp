#pragma once
#include "integrator/taylor/roots.hpp"
#include "integrator/taylor/switches_code.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::taylor {
namespace touches {

/// From left to right through halves, until a part lies within the rounding error whole.
template <class T>
class Search {
 public:
  Search(const ScaledPolynomialOf<T>& polynomial, std::int8_t side) : polynomial_(polynomial), side_(side) {}

  std::optional<T> in(const T& low, const T& high, std::vector<T> b) {
    const T error = watching::unit<T>() * polynomial_.reach;
    const auto [least, most] = std::minmax_element(b.begin(), b.end());
    if (*least > error) return clear_ = true, std::nullopt;
    const T middle = T(0.5) * (low + high);
    if (*most <= 8 * error || high - low < T(1e-14)) {
      const T lowest = bottom(middle);
      return clear_ && side_ * crossings::value(std::span<const T>(polynomial_.p), lowest) <= error
                 ? std::optional<T>(lowest)
                 : std::nullopt;
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
  bool clear_ = false;  // of zero, so far
};

}  // namespace touches

template <class T>
std::optional<T> touching(const ScaledPolynomialOf<T>& polynomial, std::int8_t side) {
  using std::abs;
  const std::span<const T> p = polynomial.p;
  if (p.empty() || side == 0) return std::nullopt;
  T rest = T(0);
  for (std::size_t k = 1; k < p.size(); ++k) rest += abs(p[k]);
  if (side * p[0] > rest + watching::unit<T>() * polynomial.reach) return std::nullopt;
  touches::Search<T> search(polynomial, side);
  return search.in(T(0), T(1), crossings::to_bernstein(p, side));
}

namespace touches {

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

/// As long as the remainder stays below the rounding error, over the best of all disks.
template <class T>
typename RootSearchOf<T>::Piece RootSearchOf<T>::piece(Slot slot, const T& x, const T& most) {
  using std::abs;
  retrace_.expand_about(T(h_ * x));
  const double length = static_cast<double>(abs(h_) * most);
  const int last = retrace_.order() + 1;
  disks_.begin(rows_.of(retrace_.row(0), retrace_.stride(), retrace_.order(), std::ilogb(length)));
  const int known = disks_.last_order(slot);
  const T unit = watching::unit<T>();
  const T scale = retrace_.scale(slot);
  const auto polynomial_over = [&](double part) {  // of `most`
    return watching::scaled<T>(std::min(last, known), T(h_ * most * T(part)), scale,
                               [&](int k) { return retrace_.row(k)[slot]; });
  };
  constexpr double most_of_radius = 0.45, least_of_radius = 0.02;
  double best = 0;
  T remainder = T(0);
  const double least = static_cast<double>(resolution_ / most);
  double radius = 8 * length;
  for (int i = 0; i < 200 && best < 1 && most_of_radius * radius > std::max(best, least) * length; ++i, radius /= 1.5) {
    disks_.evaluate(radius);
    const double tail = disks_.tail(slot);
    if (!(tail < std::numeric_limits<double>::infinity())) continue;
    for (double part = std::min(1.0, most_of_radius * radius / length);
         part > best && part * length > least_of_radius * radius; part *= 0.75) {
      const double ratio = part * length / radius;
      const T left_out = tail == 0 ? T(0) : T(tail) * T(std::pow(ratio, known + 1) / (1 - ratio));
      const auto polynomial = polynomial_over(part);
      if (!(left_out <= unit * polynomial.reach)) continue;
      best = part, remainder = left_out;
      break;
    }
  }
  if (!(best > least)) return {{}, T(0)};
  Piece result{polynomial_over(best), T(best) * most};
  result.polynomial.scale += remainder / unit;
  result.polynomial.reach += remainder / unit;
  for (const T& c : result.polynomial.p)
    if (!(abs(c) <= std::numeric_limits<T>::max())) return {{}, T(0)};
  return result;
}

/// Times are rounded, the parts of a step are not: a function of t is looked at where t + h x is a number of the type,
/// so that its root is known better than t is. Steps of a few roundings of t have no such places.
template <class T>
T RootSearchOf<T>::at_a_time(const T& x) const {
  using std::abs;
  constexpr double most = 1e-6;  // of the step
  const T time = t_.hi + (t_.lo + h_ * x);
  const T near = ((time - t_.hi) - t_.lo) / h_;
  return abs(near - x) <= T(most) ? near : x;
}

/// Secants on the function itself, whose digits near the root are its own and not those of the polynomial.
template <class T>
T RootSearchOf<T>::refined(Slot slot, const Piece& piece, const T& begin, const T& root) {
  using std::abs;
  const auto& p = piece.polynomial.p;
  T slope = T(0);
  for (std::size_t k = p.size(); k-- > 1;) slope = slope * root + T(k) * p[k];
  T x = begin + piece.width * root;
  if (slope == 0) return x;
  for (int turn = 0; turn < 2; ++turn) {
    const T there = at_a_time(x), change = value(slot, there) / slope * piece.width;
    if (!(abs(change) <= T(1e-6) * piece.width)) break;
    x = there - change;
  }
  return std::clamp(x, begin, T(begin + piece.width));
}

/// Looks for the other side of a point where the function is not analytic, and for what its sign does there.
template <class T>
typename RootSearchOf<T>::Gap RootSearchOf<T>::gap(Slot slot, const T& x, const T& until, std::int8_t side) {
  using std::abs;
  Gap result{until, side, std::nullopt};
  const auto sign_at = [&](const T& at) { return watching::sign(value(slot, at)); };
  T beyond = resolution_;
  for (;; beyond *= 2) {
    if (x + beyond >= until) break;
    const Piece there = piece(slot, T(x + beyond), std::min(beyond, T(until - x - beyond)));
    if (there.width > 0) {
      result.end = x + beyond;
      break;
    }
  }
  result.side = sign_at(result.end);
  if (side == 0 || result.side == 0 || result.side == side) return result;
  T low = x, high = result.end, at_low = abs(value(slot, low)), at_high = abs(value(slot, high));
  const T before = std::max(at_low, at_high);
  for (int turn = 0; turn < 2 * std::numeric_limits<T>::digits; ++turn) {
    const T middle = T(0.5) * (low + high);
    if (!(low < middle && middle < high)) break;
    const T there = value(slot, middle);
    (watching::sign(there) == side ? low : high) = middle;
    (watching::sign(there) == side ? at_low : at_high) = abs(there);
  }
  // A zero gets smaller on both sides, a jump does not.
  const bool is_zero = std::max(at_low, at_high) <= T(0.5) * before || std::max(at_low, at_high) == 0;
  result.root = RootOf<T>{high, is_zero ? RootKind::Crossing : RootKind::Jump};
  return result;
}

template <class T>
std::optional<RootOf<T>> RootSearchOf<T>::first(Slot slot, Watched& watched, const T& until, bool wants_touching,
                                                bool wants_jumps) {
  T x = T(0);
  while (x < until) {
    const Piece now = piece(slot, x, T(until - x));
    if (now.width == 0) {
      const Gap beyond = gap(slot, x, until, watched.side);
      watched.at_zero = false;
      if (beyond.root && (beyond.root->kind == RootKind::Crossing || wants_jumps)) return beyond.root;
      watched = {beyond.side, false};
      x = beyond.end;
      continue;
    }
    if (watched.side == 0)
      watched.side = watched.at_zero ? now.polynomial.direction(watched.order) : watching::sign(now.polynomial.p[0]);
    const auto root = crossing(now.polynomial, watched);
    watched.at_zero = false;  // the step goes on from it, wherever it ends
    if (wants_touching) {
      const auto touch = touching(touches::up_to(now.polynomial, root), watched.side);
      const T end = root ? *root : T(1);
      if (touch && (!root || *touch < T(0.999))) return RootOf<T>{T(x + now.width * end * *touch), RootKind::Touching};
    }
    if (root) return RootOf<T>{std::min(until, refined(slot, now, x, *root)), RootKind::Crossing};
    x += now.width;
  }
  return std::nullopt;
}

}  // namespace maupertuis::taylor

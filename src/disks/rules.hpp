#pragma once
#include "disks/reals.hpp"
#include "kernel/program/program.hpp"

#include <cmath>
#include <limits>

/// The rules of docs/design/safe_steps.md: from bounds of the operands on a disk to those of the result. Most follow
/// from |f(w) − f(w₀)| ≤ |w − w₀| sup |f′|, the supremum taken over the disk of the operand, which is convex.
///
/// V is double, one disk, or Lanes: eight disks about one centre, one a lane. Arithmetic goes over all lanes at once;
/// rules of other functions are those of one disk, lane by lane.
namespace maupertuis::disk_rules {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Rules of lanes are inlined: a structure of vectors that is handed over by memory is copied in parts, for which the
/// next load of a whole vector has to wait.
template <class V>
struct Bounds {
  V reach, tail, low, high;  // |f| lies in [low, high]
};

namespace {

/// A rule of one disk, lane by lane: f(a, b).
template <class F>
Bounds<double> lane_by_lane(F&& f, const Bounds<double>& a, const Bounds<double>& b) {
  return f(a, b);
}
template <class F>
Bounds<Lanes> lane_by_lane(F&& f, const Bounds<Lanes>& a, const Bounds<Lanes>& b) {
  Bounds<Lanes> out;
  for (int l = 0; l < lanes; ++l) {
    const Bounds<double> lane = f(Bounds<double>{a.reach[l], a.tail[l], a.low[l], a.high[l]},
                                  Bounds<double>{b.reach[l], b.tail[l], b.low[l], b.high[l]});
    out.reach[l] = lane.reach, out.tail[l] = lane.tail, out.low[l] = lane.low, out.high[l] = lane.high;
  }
  return out;
}

template <class V>
[[gnu::always_inline]] inline Bounds<V> unbounded() {
  return {all<V>(infinity), all<V>(infinity), all<V>(0), all<V>(infinity)};
}
template <class V>
[[gnu::always_inline]] inline Bounds<V> where(const decltype(V{} < V{}) & mask, const Bounds<V>& a,
                                              const Bounds<V>& b) {
  return {select(mask, a.reach, b.reach), select(mask, a.tail, b.tail), select(mask, a.low, b.low),
          select(mask, a.high, b.high)};
}

/// u, v: |a₀|, |b₀|.
template <class V>
[[gnu::always_inline]] inline Bounds<V> product(double u, double v, const Bounds<V>& a, const Bounds<V>& b) {
  const V reach = smaller(b.reach * u + a.reach * v + a.reach * b.reach, a.high * b.high + all<V>(u * v));
  return {reach, reach, a.low * b.low, a.high * b.high};
}

/// a/b − a₀/b₀ = ((a − a₀) − (a₀/b₀)(b − b₀))/b; ratio: |a₀/b₀|.
template <class V>
[[gnu::always_inline]] inline Bounds<V> quotient(double ratio, const Bounds<V>& a, const Bounds<V>& b) {
  const V high = a.high / b.low;
  const V reach = smaller((a.reach + b.reach * ratio) / b.low, high + all<V>(ratio));
  return where<V>(all<V>(0) < b.low, {reach, reach, a.low / b.high, high}, unbounded<V>());
}

/// √a; value: √a₀. A disk about 0 is one of a branch point.
template <class V>
[[gnu::always_inline]] inline Bounds<V> square_root(double value, const Bounds<V>& a) {
  const V low = root(a.low), high = root(a.high);
  const V reach = smaller(a.reach * 0.5 / low, high + all<V>(value));
  return where<V>(all<V>(0) < a.low, {reach, reach, low, high}, unbounded<V>());
}

/// x^(n/2) of a small odd n.
template <class V>
[[gnu::always_inline]] inline V of_halves(const V& x, int n) {
  V size = root(x);
  for (int left = std::abs(n); left > 1; left -= 2) size = size * x;
  return n < 0 ? all<V>(1) / size : size;
}

/// The same as power(), by roots and products.
template <class V>
[[gnu::always_inline]] inline Bounds<V> half_power(double value, const Bounds<V>& a, int n) {
  const V at_low = of_halves(a.low, n), at_high = of_halves(a.high, n);
  const V slope = (n < 2 ? at_low / a.low : at_high / a.high) * (0.5 * std::abs(n));
  const V low = n < 0 ? at_high : at_low, high = n < 0 ? at_low : at_high;
  const V reach = smaller(slope * a.reach, high + all<V>(value));
  return where<V>(all<V>(0) < a.low, {reach, reach, low, high}, unbounded<V>());
}

}  // namespace

/// a^c; value: |a₀^c|.
Bounds<double> power(const Bounds<double>& a, double c, double value);
/// sin a with s = |sin a₀|, c = |cos a₀|; cos a with both exchanged.
Bounds<double> sine(const Bounds<double>& a, double s, double c);
/// sinh a and cosh a; w: |a₀|, value: |f(a₀)|.
Bounds<double> hyperbolic(const Bounds<double>& a, double w, double value);
/// f(a), or f(a, b) of atan2: w and v are the values of the operands at the centre, value that of |f|.
Bounds<double> function(Kind f, const Bounds<double>& a, const Bounds<double>* b, double w, double v, double value);

}  // namespace maupertuis::disk_rules

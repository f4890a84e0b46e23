#pragma once
#include "kernel/lanes/plan.hpp"
#include "kernel/series/rules.hpp"
#include "kernel/series/sine_cosine.hpp"

/// What vectors of W lanes do in their own way where the reference rules run over them: products are fused with sums,
/// divisions by an order are products, and elementary functions come lane by lane. The rules find these by their
/// argument.
namespace maupertuis::series {
namespace {

template <int W>
inline void add_product(Vec<W>& sum, const Vec<W>& a, const Vec<W>& b) {
  for (int i = 0; i < Vec<W>::parts; ++i) sum.part[i] = fused(a.part[i], b.part[i], sum.part[i]);
}

template <int W>
inline Vec<W> over_order(const Vec<W>& x, int k) {
  return x / Divisor(k);
}

template <int W>
inline Vec<W> chosen(const Vec<W>& condition, const Vec<W>& where_not_zero, const Vec<W>& where_zero) {
  return select(condition == Vec<W>(0), where_zero, where_not_zero);
}

template <int W>
inline void sine_cosine(const Vec<W>& x, Vec<W>& sine, Vec<W>& cosine) {
  const SineCosine<W> both(x);
  sine = both.sine, cosine = both.cosine;
}

/// f(x, y) one lane after the other.
template <int W, class F>
inline Vec<W> by_lane(const Vec<W>& x, const Vec<W>& y, F&& f) {
  alignas(64) double first[W], second[W];
  x.store(first), y.store(second);
  for (int lane = 0; lane < W; ++lane) first[lane] = f(first[lane], second[lane]);
  return Vec<W>::load(first);
}

template <int W>
inline Vec<W> sqrt(const Vec<W>& x) {
  return by_lane(x, x, [](double a, double) { return __builtin_sqrt(a); });
}
template <int W>
inline Vec<W> pow(const Vec<W>& x, const Vec<W>& y) {
  return by_lane(x, y, [](double a, double b) { return lanes::power_function(a, b); });
}
template <int W>
inline Vec<W> elementary(Kind function, const Vec<W>& x, const Vec<W>& y) {
  return by_lane(x, y, [function](double a, double b) { return lanes::elementary_function(function, a, b); });
}

}  // namespace
}  // namespace maupertuis::series

#pragma once
#include "kernel/series/vector.hpp"

#include <cmath>

/// What rules are written in: V is double, or Lanes with a disk a lane, as wide as the registers that a file is
/// compiled for. Results do not depend on that: nothing is fused. Unnamed, since a linker keeps one copy of an inline
/// function, and that must not be one with instructions that the processor lacks.
namespace maupertuis::disk_rules {
namespace {

constexpr int lanes = series::register_width;
typedef double Lanes __attribute__((vector_size(8 * lanes)));
using Masks = decltype(Lanes{} < Lanes{});

template <class V>
inline V all(double x) {
  return V{} + x;
}

inline double select(bool condition, double a, double b) { return condition ? a : b; }
inline Lanes select(const Masks& condition, const Lanes& a, const Lanes& b) { return condition ? a : b; }

template <class V>
inline V smaller(const V& x, const V& y) {
  return x < y ? x : y;
}
template <class V>
inline V larger(const V& x, const V& y) {
  return y < x ? x : y;
}

inline double root(double x) { return std::sqrt(x); }
#if defined(__AVX512F__)
inline Lanes root(const Lanes& x) { return _mm512_maskz_sqrt_pd(0xff, x); }
#elif defined(__AVX2__)
inline Lanes root(const Lanes& x) { return _mm256_sqrt_pd(x); }
#else
inline Lanes root(const Lanes& x) { return Lanes{std::sqrt(x[0]), std::sqrt(x[1])}; }
#endif

/// f(x, y), lane by lane.
template <class F>
inline double lane_by_lane(F&& f, double x, double y) {
  return f(x, y);
}
template <class F>
inline Lanes lane_by_lane(F&& f, const Lanes& x, const Lanes& y) {
  Lanes out;
  for (int l = 0; l < lanes; ++l) out[l] = f(x[l], y[l]);
  return out;
}

}  // namespace
}  // namespace maupertuis::disk_rules

#pragma once
#include <maupertuis/rough_powers.hpp>
#include "integrator/ensemble/lane_steps.hpp"

#include <cstdint>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

/// See lane_steps.hpp. Nothing inline of the standard library is called here: a linker keeps one copy of an inline
/// function, and that must not be one with instructions that the processor lacks.
namespace maupertuis::ensemble {
namespace {

#if defined(__AVX512F__)
constexpr std::size_t register_width = 8;
#elif defined(__AVX2__)
constexpr std::size_t register_width = 4;
#else
constexpr std::size_t register_width = 2;
#endif

/// Lanes that go through a register together.
template <std::size_t Width>
struct Register {
  typedef double Reals __attribute__((vector_size(8 * Width), may_alias));
  typedef std::int64_t Integers __attribute__((vector_size(8 * Width), may_alias));
};
template <>
struct Register<1> {
  typedef double Reals __attribute__((may_alias));
  typedef std::int64_t Integers __attribute__((may_alias));
};

/// a b + c, rounded once, on every processor; WebAssembly, which has no such instruction, rounds twice.
#if defined(__wasm__)
template <class V>
inline V fused(V a, V b, V c) {
  return a * b + c;
}
#else
inline double fused(double a, double b, double c) { return __builtin_fma(a, b, c); }
template <class V>
inline V fused(V a, V b, V c) {
#if defined(__AVX512F__)
  if constexpr (sizeof(V) == 64) return _mm512_fmadd_pd(a, b, c);
#endif
#if defined(__AVX2__) && defined(__FMA__)
  if constexpr (sizeof(V) == 32) return _mm256_fmadd_pd(a, b, c);
  if constexpr (sizeof(V) == 16) return _mm_fmadd_pd(a, b, c);
#endif
  for (std::size_t lane = 0; lane < sizeof(V) / sizeof(double); ++lane)
    c[lane] = __builtin_fma(a[lane], b[lane], c[lane]);
  return c;
}
#endif

constexpr double infinity = __builtin_huge_val();
constexpr double epsilon = 0x1p-52;

template <std::size_t Width>
class Steps {
 public:
  using V = typename Register<Width>::Reals;
  using I = typename Register<Width>::Integers;

  Steps(const LaneArrays& lanes, std::size_t first) : a_(lanes), first_(first) {}

  void choose_length(const double* fresh) const {
    const V before = get(a_.length);
    V after = reached(before);
    after = before < infinity ? after : before;
    put(a_.length, fresh ? (get(fresh) != 0 ? after : before) : after);
  }

  bool cut_to_end() const {
    const V left = (get(a_.end) - get(a_.t_high)) - get(a_.t_low), length = get(a_.length);
    const auto within = length < absolute(left);
    put(a_.step, within ? (left < 0 ? -length : length) : left);
    put(a_.reaches, within ? V{} : V{} + 1);
    const auto long_enough = (length > 2 * epsilon * absolute(get(a_.t_high))) & (length >= V{} + 1e-290);
    put(a_.shrinks, long_enough ? V{} : V{} + 1);
    // A requested time is looked for within two steps: what rounding decides is decided where it is sampled.
    const auto passes_by = within & long_enough & (get(a_.quality) > a_.least_quality) &
                           (absolute(get(a_.next) - get(a_.t_high)) > 2 * length);
    return vanishes_somewhere(passes_by ? V{} + 1 : V{});
  }

  bool exceed(double limit) const {
    V all_within = V{} + 1;
    for (std::size_t i = 0; i < a_.freedoms; ++i)
      all_within = absolute(get(a_.q_high + i * a_.width)) > limit ? V{} : all_within;
    return vanishes_somewhere(all_within);
  }

  /// q − q_0 and q̇ − q̇_0 by Horner's rule, added with what earlier additions left behind, as DenseOutput::advance does.
  void advance() const {
    const V tau = get(a_.step);
    for (std::size_t i = 0; i < a_.freedoms; ++i) {
      const std::size_t at = i * a_.width;
      const double* c = a_.coefficients + static_cast<std::size_t>(a_.order + 1) * a_.row + at;
      V dq{}, dv{}, a{};  // Σ c_k τ^{k−2}, Σ k c_k τ^{k−2}, Σ k (k − 1) c_k τ^{k−2} over k ≥ 2
      for (int k = a_.order + 1; k >= 2; --k, c -= a_.row) {
        const V of_rate = get(c) * a_.whole[k];
        dq = fused(dq, tau, get(c));
        dv = fused(dv, tau, of_rate);
        a = fused(a, tau, of_rate * a_.whole[k - 1]);
      }
      put(a_.acceleration + at, a);
      add(a_.q_high + at, a_.q_low + at, fused(dq, tau, get(a_.v_high + at) + get(a_.v_low + at)) * tau);
      add(a_.v_high + at, a_.v_low + at, dv * tau);
    }
    const auto arrives = get(a_.reaches) != 0;
    add(a_.t_high, a_.t_low, tau);
    put(a_.t_high, arrives ? get(a_.end) : get(a_.t_high));
    put(a_.t_low, arrives ? V{} : get(a_.t_low));
  }

  void find_sizes() const {
    const V r = get(a_.radius);
    const std::size_t size = a_.freedoms * a_.width;
    for (std::size_t i = 0; i < a_.freedoms; ++i) {
      const std::size_t at = i * a_.width;
      const double* c = a_.coefficients + static_cast<std::size_t>(a_.order + 1) * a_.row + at;
      V q{}, v{}, a{};
      for (int k = a_.order + 1; k >= 2; --k, c -= a_.row) {
        const V of_q = absolute(get(c)), of_rate = of_q * a_.whole[k];
        q = fused(q, r, of_q), v = fused(v, r, of_rate), a = fused(a, r, of_rate * a_.whole[k - 1]);
      }
      const V first = absolute(get(c));
      put(a_.sizes + at, fused(q, r, first) * r);
      put(a_.sizes + size + at, fused(v, r, first));
      put(a_.sizes + 2 * size + at, a);
    }
  }

 private:
  V get(const double* from) const { return *reinterpret_cast<const V*>(from + first_); }
  void put(double* to, V value) const { *reinterpret_cast<V*>(to + first_) = value; }
  V coefficient(int k, std::size_t i) const {
    return get(a_.coefficients + static_cast<std::size_t>(k) * a_.row + i * a_.width);
  }
  static V absolute(V x) {
    I bits;
    __builtin_memcpy(&bits, &x, sizeof bits);
    bits = bits & 0x7fffffffffffffff;
    __builtin_memcpy(&x, &bits, sizeof bits);
    return x;
  }
  static V larger(V x, V y) { return x > y ? x : y; }

  /// Knuth's TwoSum: Compensated::add.
  void add(double* high, double* low, V increment) const {
    const V b = get(low) + increment, a = get(high);
    const V sum = a + b, part = sum - a;
    put(low, (a - (sum - part)) + (b - part));
    put(high, sum);
  }

  // ---------------------------------------------------------------------------------------------------- step length

  V velocity(std::size_t i, int k) const { return absolute(coefficient(k + 1, i)) * a_.whole[k + 1]; }

  /// The size of coordinate i's velocity over a step of length h: see integrator/taylor/step_size.cpp.
  V size_of(std::size_t i, V h, V inverse_of_h) const {
    V size{}, power = V{} + 1;
    const int last = a_.order - 2 < 3 ? a_.order - 2 : 3;
    for (int k = 0; k <= last; ++k, power *= h) size = larger(size, velocity(i, k) * power);
    if (vanishes_somewhere(size)) size = size_of_late(i, h, size);
    return larger(size, epsilon * absolute(get(a_.q_high + i * a_.width)) * inverse_of_h);
  }

  /// A coordinate that others set in motion late begins with a higher power of time.
  V size_of_late(std::size_t i, V h, V size) const {
    V power = (h * h) * (h * h);
    for (int k = 4; k <= a_.order; ++k, power *= h) size = size == 0 ? velocity(i, k) * power : size;
    return size;
  }

  static bool vanishes_somewhere(V x) {
#if defined(__AVX512F__)
    if constexpr (Width == 8) return _mm512_cmp_pd_mask(x, V{}, _CMP_EQ_OQ) != 0;
#endif
    const double* const lanes = reinterpret_cast<const double*>(&x);
    bool any = false;
    for (std::size_t lane = 0; lane < Width; ++lane) any = any || lanes[lane] == 0;
    return any;
  }

  /// factor · min over the last orders of the radius of convergence that each tells, the earlier ones widened.
  V reached(V h) const {
    constexpr double log2_widened = 0.32192809488736235;  // of 1.25
    constexpr int most = 6;
    const int p = a_.order, last = p - (p - 5 > 2 ? p - 5 : p - 1 < 2 ? p - 1 : 2);
    const V inverse_of_h = 1.0 / h;
    V largest[most];
#pragma GCC unroll 6
    for (int e = 0; e < most; ++e) largest[e] = V{};
    for (std::size_t i = 0; i < a_.freedoms; ++i) {
      const V inverse = 1.0 / size_of(i, h, inverse_of_h);
      const double* c = a_.coefficients + static_cast<std::size_t>(p + 1) * a_.row + i * a_.width;
#pragma GCC unroll 6
      for (int e = 0; e < most; ++e, c -= a_.row) {
        if (e > last) break;
        // 0/0 is no estimate: a comparison with NaN is false.
        largest[e] = larger(absolute(get(c)) * a_.whole[p + 1 - e] * inverse, largest[e]);
      }
    }
    V exponent = V{} + infinity;
#pragma GCC unroll 6
    for (int e = 0; e < most; ++e) {
      if (e > last) break;
      const V by_order = rough_log2<V, I>(largest[e]) * a_.inverse[p - e] + (e > 1 ? log2_widened : 0.0);
      exponent = ((largest[e] > 0) & (by_order < exponent)) ? by_order : exponent;
    }
    const V length = exp2_of(exponent) * get(a_.factor);
    return exponent < infinity ? length : V{} + infinity;
  }

  static V log2_of(V x) { return rough_log2<V, I>(x); }
  static V exp2_of(V x) { return rough_exp2<V, I>(x); }

  const LaneArrays& a_;
  std::size_t first_;
};

/// f(Steps) for all lanes, a register at a time.
template <std::size_t Width, class F>
inline void for_registers(const LaneArrays& lanes, F&& f) {
  for (std::size_t first = 0; first < lanes.width; first += Width) f(Steps<Width>(lanes, first));
}
template <class F>
inline void for_lanes(const LaneArrays& lanes, F&& f) {
  if (lanes.width >= register_width) return for_registers<register_width>(lanes, f);
  if constexpr (register_width > 4)
    if (lanes.width == 4) return for_registers<4>(lanes, f);
  if constexpr (register_width > 2)
    if (lanes.width == 2) return for_registers<2>(lanes, f);
  for_registers<1>(lanes, f);
}

void choose_length(const LaneArrays& lanes, const double* fresh) {
  for_lanes(lanes, [fresh](auto steps) { steps.choose_length(fresh); });
}
bool cut_to_end(const LaneArrays& lanes) {
  bool any = false;
  for_lanes(lanes, [&any](auto steps) { any = steps.cut_to_end() || any; });
  return any;
}
bool exceed(const LaneArrays& lanes, double limit) {
  bool any = false;
  for_lanes(lanes, [&any, limit](auto steps) { any = steps.exceed(limit) || any; });
  return any;
}
void advance(const LaneArrays& lanes) {
  for_lanes(lanes, [](auto steps) { steps.advance(); });
}

void find_sizes(const LaneArrays& lanes) {
  for_lanes(lanes, [](auto steps) { steps.find_sizes(); });
}

inline LaneSteps steps_of_this_file() { return {choose_length, cut_to_end, exceed, advance, find_sizes}; }

}  // namespace
}  // namespace maupertuis::ensemble

#pragma once
#include <cstddef>
#include <cstdint>
#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

/// W doubles and their arithmetic, on the registers that the file is compiled for. It is compiled once for each
/// instruction set, hence the unnamed namespace, and calls nothing inline of the standard library: a linker keeps one
/// copy of an inline function, and that must not be one with instructions that the processor lacks.
///
/// Results do not depend on W nor on the instruction set: products are fused with sums exactly where fma() is
/// written (the compiler fuses nothing: -ffp-contract=off), one correctly rounded operation everywhere but in
/// WebAssembly, which has none: fma() rounds twice there, and exact_fma() computes the error of the product.
namespace maupertuis::series {
namespace {

#if defined(__AVX512F__)
constexpr int register_width = 8;
#elif defined(__AVX2__)
constexpr int register_width = 4;
#else
constexpr int register_width = 2;
#endif

template <int Width>
struct Register {
  typedef double Reals __attribute__((vector_size(8 * Width), may_alias));
  typedef std::int64_t Integers __attribute__((vector_size(8 * Width), may_alias));
};
template <>
struct Register<1> {
  typedef double Reals __attribute__((may_alias));
  typedef std::int64_t Integers __attribute__((may_alias));
};

#if defined(__wasm__)
constexpr bool has_fused = false;
template <class Reals>
inline Reals fused(Reals a, Reals b, Reals c) {
  return a * b + c;
}
#else
constexpr bool has_fused = true;
inline double fused(double a, double b, double c) { return __builtin_fma(a, b, c); }
#endif
#if defined(__AVX512F__)
inline Register<8>::Reals fused(Register<8>::Reals a, Register<8>::Reals b, Register<8>::Reals c) {
  return _mm512_fmadd_pd(a, b, c);
}
#endif
#if defined(__AVX2__) && defined(__FMA__)
inline Register<4>::Reals fused(Register<4>::Reals a, Register<4>::Reals b, Register<4>::Reals c) {
  return _mm256_fmadd_pd(a, b, c);
}
inline Register<2>::Reals fused(Register<2>::Reals a, Register<2>::Reals b, Register<2>::Reals c) {
  return _mm_fmadd_pd(a, b, c);
}
#elif defined(__aarch64__)
inline Register<2>::Reals fused(Register<2>::Reals a, Register<2>::Reals b, Register<2>::Reals c) {
  return vfmaq_f64(c, a, b);
}
#elif !defined(__wasm__)
inline Register<2>::Reals fused(Register<2>::Reals a, Register<2>::Reals b, Register<2>::Reals c) {
  return Register<2>::Reals{__builtin_fma(a[0], b[0], c[0]), __builtin_fma(a[1], b[1], c[1])};
}
#endif

template <int W>
struct Mask;

template <int W>
struct Vec {
  static constexpr int width = W < register_width ? W : register_width;  // of a register
  static constexpr int parts = W / width;
  using Reals = typename Register<width>::Reals;
  using Integers = typename Register<width>::Integers;

  Reals part[parts];

  Vec() = default;
  explicit Vec(double x) : Vec(all(x)) {}
  static Vec load(const double* from) {
    Vec out;
    for (int i = 0; i < parts; ++i) out.part[i] = *reinterpret_cast<const Reals*>(from + i * width);
    return out;
  }
  static Vec all(double x) {
    Vec out;
    for (int i = 0; i < parts; ++i) out.part[i] = Reals{} + x;
    return out;
  }
  void store(double* to) const {
    for (int i = 0; i < parts; ++i) *reinterpret_cast<Reals*>(to + i * width) = part[i];
  }
};

#define MAUP_VECTOR_OPERATOR(op)                                                \
  template <int W>                                                              \
  inline Vec<W> operator op(Vec<W> a, const Vec<W>& b) {                        \
    for (int i = 0; i < Vec<W>::parts; ++i) a.part[i] = a.part[i] op b.part[i]; \
    return a;                                                                   \
  }                                                                             \
  template <int W>                                                              \
  inline Vec<W> operator op(Vec<W> a, double b) {                               \
    for (int i = 0; i < Vec<W>::parts; ++i) a.part[i] = a.part[i] op b;         \
    return a;                                                                   \
  }
MAUP_VECTOR_OPERATOR(+)
MAUP_VECTOR_OPERATOR(-)
MAUP_VECTOR_OPERATOR(*)
MAUP_VECTOR_OPERATOR(/)
#undef MAUP_VECTOR_OPERATOR

template <int W>
inline Vec<W> operator-(Vec<W> a) {
  for (int i = 0; i < Vec<W>::parts; ++i) a.part[i] = -a.part[i];
  return a;
}

/// a b + c, rounded once.
template <int W>
inline Vec<W> fma(Vec<W> a, const Vec<W>& b, const Vec<W>& c) {
  for (int i = 0; i < Vec<W>::parts; ++i) a.part[i] = fused(a.part[i], b.part[i], c.part[i]);
  return a;
}
template <int W>
inline Vec<W> fma(Vec<W> a, double b, const Vec<W>& c) {
  return fma(a, Vec<W>::all(b), c);
}

/// a b + c where the last bits of the product are what is wanted. Without a fused product they come from halves of the
/// factors (T. J. Dekker, 1971): right where the result is a number of 53 bits or the error of the product, and factors
/// are below 2⁹⁹⁶.
template <int W>
inline Vec<W> exact_fma(const Vec<W>& a, double b, const Vec<W>& c) {
  if constexpr (has_fused) {
    return fma(a, b, c);
  } else {
    constexpr double splitter = 0x1p27 + 1;
    const Vec<W> product = a * b, wide = a * splitter, a_high = wide - (wide - a), a_low = a - a_high;
    const double b_wide = splitter * b, b_high = b_wide - (b_wide - b), b_low = b - b_high;
    const Vec<W> error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    return (product + c) + error;
  }
}

/// One truth value a lane.
template <int W>
struct Mask {
  typename Vec<W>::Integers part[Vec<W>::parts];
};

template <int W>
inline Mask<W> operator<(const Vec<W>& a, const Vec<W>& b) {
  Mask<W> out;
  for (int i = 0; i < Vec<W>::parts; ++i) out.part[i] = a.part[i] < b.part[i];
  return out;
}
template <int W>
inline Mask<W> operator==(const Vec<W>& a, const Vec<W>& b) {
  Mask<W> out;
  for (int i = 0; i < Vec<W>::parts; ++i) out.part[i] = a.part[i] == b.part[i];
  return out;
}

inline bool holds_in_all(std::int64_t mask) { return mask != 0; }
template <class Integers>
inline bool holds_in_all(Integers mask) {
  std::int64_t both = -1;
  for (std::size_t i = 0; i < sizeof(Integers) / sizeof(std::int64_t); ++i) both &= mask[i];
  return both != 0;
}
template <int W>
inline bool holds_everywhere(const Mask<W>& mask) {
  bool all = true;
  for (int i = 0; i < Vec<W>::parts; ++i) all = all && holds_in_all(mask.part[i]);
  return all;
}

/// a where the mask holds, else b.
template <int W>
inline Vec<W> select(const Mask<W>& mask, Vec<W> a, const Vec<W>& b) {
  for (int i = 0; i < Vec<W>::parts; ++i) a.part[i] = mask.part[i] ? a.part[i] : b.part[i];
  return a;
}

template <int W>
inline Vec<W> absolute(const Vec<W>& a) {
  return select(a < Vec<W>::all(0), -a, a);
}

/// a / d by d's reciprocal, corrected: correctly rounded as a division is (P. Markstein, 1990), at a fraction of its
/// cost. An infinite a gives NaN.
struct Divisor {
  explicit Divisor(double d) : value(d), reciprocal(1 / d) {}
  double value, reciprocal;
};
template <int W>
inline Vec<W> operator/(const Vec<W>& a, const Divisor& d) {
  if constexpr (!has_fused) return a / d.value;
  const Vec<W> quotient = a * d.reciprocal;
  return fma(fma(-quotient, d.value, a), d.reciprocal, quotient);
}

}  // namespace
}  // namespace maupertuis::series

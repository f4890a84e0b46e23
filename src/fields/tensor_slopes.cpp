#include "fields/tensor_slopes.hpp"

#include "fields/wide_lanes.hpp"

namespace maupertuis {
namespace {

constexpr int most_points = 21;

struct Product {
  double* to;
  const double *base, *u, *even, *odd;
  double scale;
  std::size_t stride;
  int p;
  bool keeps_even;
};

// Attributes of a type are lost where it is an argument of a template: memory is seen through lanes_at alone.
typedef double Wide __attribute__((vector_size(64)));
[[gnu::always_inline]] inline void load(Wide& value, const double* place) { value = lanes_at(place); }
[[gnu::always_inline]] inline void load(double& value, const double* place) { value = *place; }
[[gnu::always_inline]] inline void store(double* place, const Wide& value) { lanes_at(place) = value; }
[[gnu::always_inline]] inline void store(double* place, const double& value) { *place = value; }

template <class V>
[[gnu::always_inline]] inline void put(const Product& x, std::size_t at, const V& slope) {
  V value = {};
  if (x.base) load(value, x.base + at);
  store(x.to + at, value + x.scale * slope);
}

/// One column of elements, V of them; P: the order, where it is known to the compiler, or 0. The value at the opposite
/// point has what is odd, or of slopes what is even, with the other sign.
template <class V, int P, bool KeepsEven>
[[gnu::always_inline]] inline void column(const Product& x, std::size_t i) {
  const int p = P ? P : x.p, half = (p + 1) / 2;
  V sum[(most_points + 1) / 2] = {}, difference[(most_points + 1) / 2] = {};
  for (int m = 0; m < half; ++m) {
    V low = {}, high = {};
    load(low, x.u + static_cast<std::size_t>(m) * x.stride + i);
    load(high, x.u + static_cast<std::size_t>(p - m) * x.stride + i);
    sum[m] = low + high, difference[m] = low - high;
  }
  // What the sums are compared with: twice the middle value, or the innermost sum.
  const bool middle = p % 2 == 0;
  V reference = sum[half - 1];
  if (middle) load(reference, x.u + static_cast<std::size_t>(half) * x.stride + i), reference *= 2.0;
  for (int j = 0; j < half; ++j) {
    V a = x.odd[j * half] * difference[0], b = x.even[j * half] * (sum[0] - reference);
    for (int m = 1; m < half; ++m) {
      a += x.odd[j * half + m] * difference[m];
      if (middle || m + 1 < half) b += x.even[j * half + m] * (sum[m] - reference);
    }
    put<V>(x, static_cast<std::size_t>(j) * x.stride + i, a + b);
    put<V>(x, static_cast<std::size_t>(p - j) * x.stride + i, KeepsEven ? b - a : a - b);
  }
  if (!middle) return;
  V value = {};
  for (int m = 0; m < half; ++m)
    value += KeepsEven ? x.even[half * half + m] * (sum[m] - reference) : x.odd[half * half + m] * difference[m];
  put<V>(x, static_cast<std::size_t>(half) * x.stride + i, value);
}

/// The last columns are done once more where their number is no multiple of eight.
template <int P, bool KeepsEven>
[[gnu::always_inline]] inline void columns(const Product& x, std::size_t count) {
  if (count < kWide) {
    for (std::size_t i = 0; i < count; ++i) column<double, P, KeepsEven>(x, i);
    return;
  }
  for (std::size_t i = 0; i + kWide <= count; i += kWide) column<Wide, P, KeepsEven>(x, i);
  if (count % kWide) column<Wide, P, KeepsEven>(x, count - kWide);
}

template <int P>
[[gnu::always_inline]] inline void columns(const Product& x, std::size_t count) {
  x.keeps_even ? columns<P, true>(x, count) : columns<P, false>(x, count);
}

/// A module for browsers has the general order alone: the others, written out in vectors of 128 bits, have 50 kB.
#ifdef __EMSCRIPTEN__
void all_columns(const Product& x, std::size_t count) { columns<0>(x, count); }
#else
MAUP_LANES void all_columns(const Product& x, std::size_t count) {
  switch (x.p) {
    case 2:
      return columns<2>(x, count);
    case 3:
      return columns<3>(x, count);
    case 4:
      return columns<4>(x, count);
    case 5:
      return columns<5>(x, count);
    case 6:
      return columns<6>(x, count);
    case 8:
      return columns<8>(x, count);
    default:
      return columns<0>(x, count);
  }
}
#endif

}  // namespace

EvenOddProduct::EvenOddProduct(const std::vector<double>& matrix, int order, bool keeps_even)
    : p_(order), keeps_even_(keeps_even) {
  const int points = p_ + 1, half = points / 2;
  for (int j = 0; j < half + points % 2; ++j)
    for (int m = 0; m < half; ++m) {
      const double low = matrix[static_cast<std::size_t>(j * points + m)],
                   high = matrix[static_cast<std::size_t>(j * points + p_ - m)];
      even_.push_back((low + high) / 2);
      odd_.push_back((low - high) / 2);
    }
}

EvenOddProduct EvenOddProduct::slopes(const Lobatto& rule) { return {rule.derivative, rule.order, false}; }

EvenOddProduct EvenOddProduct::stiffness(const Lobatto& rule) {
  const std::size_t points = rule.x.size();
  const std::vector<double>& d = rule.derivative;
  std::vector<double> out(points * points, 0);
  for (std::size_t j = 0; j < points; ++j)
    for (std::size_t m = 0; m < points; ++m)
      for (std::size_t i = 0; i < points; ++i)
        out[j * points + m] -= rule.w[i] / rule.w[j] * d[i * points + j] * d[i * points + m];
  return {out, rule.order, true};
}

void EvenOddProduct::apply(double* to, const double* base, const double* u, double scale, std::size_t stride,
                           std::size_t count) const {
  all_columns({to, base, u, even_.data(), odd_.data(), scale, stride, p_, keeps_even_}, count);
}

}  // namespace maupertuis

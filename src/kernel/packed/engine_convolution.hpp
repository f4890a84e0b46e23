// Part of engine_code.hpp: products of series.
namespace maupertuis::packed::MAUP_ENGINE {
namespace {

/// Σ_{j=0..N} a_j b_{N−j}, from the middle outward in four chains; the outermost terms, whose factors may just have
/// been found, are added to the sum of all others. Written out for each N, so that no loop ends in a branch that the
/// processor did not foresee.
template <int N>
Vector convolution_of(const double* a, const double* b, std::ptrdiff_t stride) {
  if constexpr (N == 0) return load(a) * load(b);
  Vector sums[4] = {all(0), all(0), all(0), all(0)};
  constexpr int middle = N / 2;
#pragma GCC unroll 64
  for (int i = 0; i <= N; ++i) {
    const int j = i % 2 == 0 ? middle - i / 2 : middle + (i + 1) / 2;
    if (j <= 0 || j >= N) continue;
    sums[i % 4] += load(a + j * stride) * load(b + (N - j) * stride);
  }
  const Vector inner = N <= 3 ? sums[0] + sums[1] : (sums[0] + sums[1]) + (sums[2] + sums[3]);
  return (inner + load(a + N * stride) * load(b)) + load(a) * load(b + N * stride);
}

inline Vector long_convolution(const double* a, const double* b, int n, std::ptrdiff_t stride) {
  Vector even = all(0), odd = all(0);
  for (int j = 0; j < n; j += 2) {
    even += load(a + j * stride) * load(b + (n - j) * stride);
    odd += load(a + (j + 1) * stride) * load(b + (n - j - 1) * stride);
  }
  if (n % 2 == 0) even += load(a + n * stride) * load(b);
  return even + odd;
}

using WrittenOut = Vector (*)(const double*, const double*, std::ptrdiff_t);
const WrittenOut convolutions[] = {convolution_of<0>,  convolution_of<1>,  convolution_of<2>,  convolution_of<3>,
                                   convolution_of<4>,  convolution_of<5>,  convolution_of<6>,  convolution_of<7>,
                                   convolution_of<8>,  convolution_of<9>,  convolution_of<10>, convolution_of<11>,
                                   convolution_of<12>, convolution_of<13>, convolution_of<14>, convolution_of<15>,
                                   convolution_of<16>, convolution_of<17>, convolution_of<18>, convolution_of<19>,
                                   convolution_of<20>, convolution_of<21>, convolution_of<22>, convolution_of<23>};
constexpr int most_written_out = 23;

/// Σ_{j=0..n} a_j b_{n−j}
inline Vector convolution(const double* a, const double* b, int n, std::ptrdiff_t stride) {
  return n <= most_written_out ? convolutions[n](a, b, stride) : long_convolution(a, b, n, stride);
}

}  // namespace
}  // namespace maupertuis::packed::MAUP_ENGINE

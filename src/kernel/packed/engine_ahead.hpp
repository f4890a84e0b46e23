// Part of engine_code.hpp: sums of products for the next four stages at once, so that a coefficient is read once for
// all of them. After stage s, one of 4, 8, 12, …, of the stages s + 1 + r with r = 0 … 3:
//
//     Σ_j a_j b_{k−j}     j = 0   1   …                          k − 1   k
//                             │   │   ├──── final after stage s ────┤   │   │
//                             └───┴── b is newer than that    a is ──┴───┘
//
// The middle is summed here; the ends, r + 1 terms on each side or fewer where an operand is known earlier, are what
// the stage itself adds.
namespace maupertuis::packed::MAUP_ENGINE {
namespace {

/// Four sums and as many coefficients need the registers of AVX-512: with 16 of half the width a step takes longer than
/// without.
#ifdef __AVX512F__
constexpr bool makes_sums_ahead = true;
#else
constexpr bool makes_sums_ahead = false;
#endif

inline bool begins_sums_ahead(int stage) { return makes_sums_ahead && stage > 0 && stage % rolled_group == 0; }
inline bool has_sums_ahead(int stage) { return makes_sums_ahead && stage > rolled_group; }

/// Terms at an end that are left to stage s + 1 + r, where that operand is known so many orders earlier.
constexpr int left_out(int r, int ahead) { return r + 1 > ahead ? r + 1 - ahead : 0; }

inline double* sum_ahead(const Tables& t, const Convolution& c, int r) {
  return t.sums + (c.number * rolled_group + static_cast<std::size_t>(r)) * lanes;
}

/// For j from 4 up to what is final, a_j meets a window of four coefficients of b that slides by one.
template <int AAhead, int BAhead>
void make_sums(const Tables& t, const Convolution& c, int stage) {
  const auto stride = static_cast<std::ptrdiff_t>(t.stride);
  const double *const a = t.rows + c.first_a, *const b = t.rows + c.first_b;
  const auto at = [stride](const double* operand, int order) { return load(operand + order * stride); };
  const int m = stage + 3 - c.lag;  // the order of the stage that follows
  Vector sum[rolled_group], window[rolled_group];
#pragma GCC unroll 4
  for (int r = 0; r < rolled_group; ++r) {
    sum[r] = all(0);
#pragma GCC unroll 4
    for (int j = left_out(r, BAhead); j < rolled_group; ++j) sum[r] += at(a, j) * at(b, m + r - j);
#pragma GCC unroll 4
    for (int i = left_out(r, AAhead); i <= r; ++i) sum[r] += at(a, m + r - i) * at(b, i);
    window[r] = at(b, m + r - rolled_group);
  }
  for (int j = rolled_group; j < m; ++j) {
    const Vector factor = at(a, j);
#pragma GCC unroll 4
    for (int r = 0; r < rolled_group; ++r) sum[r] += factor * window[r];
#pragma GCC unroll 4
    for (int r = rolled_group - 1; r > 0; --r) window[r] = window[r - 1];
    window[0] = at(b, m - j - 1);
  }
#pragma GCC unroll 4
  for (int r = 0; r < rolled_group; ++r) save(sum_ahead(t, c, r), sum[r]);
}

using MakeSums = void (*)(const Tables&, const Convolution&, int stage);
constexpr MakeSums make_sums_of[3][3] = {{make_sums<0, 0>, make_sums<0, 1>, make_sums<0, 2>},
                                         {make_sums<1, 0>, make_sums<1, 1>, make_sums<1, 2>},
                                         {make_sums<2, 0>, make_sums<2, 1>, make_sums<2, 2>}};

void make_sums_ahead(const Tables& t, int stage) {
  for (const Convolution *c = t.convolutions, *last = c + t.convolution_count; c != last; ++c)
    if (c->goes_ahead) make_sums_of[c->a_ahead][c->b_ahead](t, *c, stage);
}

/// sum + Σ_i x_{k−i} y_i of the terms that were left to this stage, the newest last.
inline Vector add_end(Vector sum, const double* x, const double* y, int first, int count, std::ptrdiff_t stride) {
  for (int i = count - 1; i >= first; --i) sum += load(x - i * stride) * load(y + i * stride);
  return sum;
}

inline Vector completed_sum(const Tables& t, const Convolution& c, int r, std::ptrdiff_t offset) {
  const auto stride = static_cast<std::ptrdiff_t>(t.stride);
  const double *const a = t.rows + c.first_a, *const b = t.rows + c.first_b;
  const Vector sum = add_end(load(sum_ahead(t, c, r)), a + offset, b, c.lacks_newest_a, r + 1 - c.a_ahead, stride);
  return add_end(sum, b + offset, a, c.lacks_newest_b, r + 1 - c.b_ahead, stride);
}

}  // namespace
}  // namespace maupertuis::packed::MAUP_ENGINE

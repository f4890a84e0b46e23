// Part of engine_code.hpp: sums of products that later stages will want, four stages at once, so that each coefficient is read once for all of them. With
// D_a = lag − lag of a (D_b likewise), before stage s, m = s + 2 − lag, the operand a is final up to order m − 1 + D_a.
namespace maupertuis::packed::MAUP_ENGINE {
namespace {

/// Of convolutions of one class.
template <int Lag, int A, int B>
class SumsAhead {
 public:
  SumsAhead(const Tables& tables, int stage) : sums_(tables.sums), stride_(static_cast<std::ptrdiff_t>(tables.stride)), stage_(stage) {}

  void add_up(const ReadyConvolution& c) const {
    if (stage_ < rolled_group) return alone(c);
    switch (stage_ % rolled_group) {
      case 0: return begin_group(c);
      case 1: return pass_on<1>(c);
      case 2: return pass_on<2>(c);
      default: return pass_on<3>(c);
    }
  }

 private:
  static constexpr int larger_of(int x, int y) { return x > y ? x : y; }
  double* sum_at(const ReadyConvolution& c, int position) const { return sums_ + (c.number * rolled_group + static_cast<unsigned>(position)) * lanes; }
  Vector at(const double* operand, int order) const { return load(operand + order * stride_); }

  /// Of the stage s + 1: all that is final.
  void alone(const ReadyConvolution& c) const {
    const int m = stage_ + 3 - Lag;
    Vector sum = all(0);
    for (int j = larger_of(0, 1 - B); j <= m - larger_of(0, 1 - A); ++j) sum += at(c.a, j) * at(c.b, m - j);
    save(sum_at(c, stage_ % rolled_group), sum);
  }

  /// Of the stages s + 1 … s + 4, with m the order of the first: a_j for 4 ≤ j < m meets b_{m+r−j} of all four stages r, which slide by one from j to j + 1.
  void begin_group(const ReadyConvolution& c) const {
    const int m = stage_ + 3 - Lag;
    Vector sum[rolled_group], window[rolled_group];
#pragma GCC unroll 8
    for (int r = 0; r < rolled_group; ++r) {
      sum[r] = all(0);
#pragma GCC unroll 8
      for (int j = larger_of(0, 1 + r - B); j < rolled_group; ++j) sum[r] += at(c.a, j) * at(c.b, m + r - j);
#pragma GCC unroll 8
      for (int i = larger_of(0, 1 + r - A); i <= r; ++i) sum[r] += at(c.a, m + r - i) * at(c.b, i);
      window[r] = at(c.b, m + r - rolled_group);
    }
    const double *a = c.a + rolled_group * stride_, *b = c.b + (m - rolled_group) * stride_;
    const auto turn = [&] {
      const Vector a_j = load(a);
      a += stride_, b -= stride_;
#pragma GCC unroll 8
      for (int r = 0; r < rolled_group; ++r) sum[r] += a_j * window[r];
#pragma GCC unroll 8
      for (int r = rolled_group - 1; r > 0; --r) window[r] = window[r - 1];
      window[0] = load(b);
    };
#pragma GCC unroll 8
    for (int odd = 0; odd < 3 - Lag; ++odd) turn();
    for (int left = stage_ - rolled_group; left > 0; left -= rolled_group) {
#pragma GCC unroll 8
      for (int r = 0; r < rolled_group; ++r) turn();
    }
#pragma GCC unroll 8
    for (int r = 0; r < rolled_group; ++r) save(sum_at(c, r), sum[r]);
  }

  /// What stage s, the `Passed`-th of its group, has made final, for those that follow in the group: at a distance t the newest a meets b_{t−D_a}.
  template <int Passed>
  void pass_on(const ReadyConvolution& c) const {
    const Vector a = at(c.a, stage_ + 2 - Lag + A), b = at(c.b, stage_ + 2 - Lag + B);
#pragma GCC unroll 8
    for (int t = 1; Passed + t <= rolled_group; ++t) {
      double* const place = sum_at(c, Passed + t - 1);
      Vector sum = load(place);
      if (t >= A) sum += a * at(c.b, t - A);
      if (t >= B) sum += b * at(c.a, t - B);
      save(place, sum);
    }
  }

  double* sums_;
  std::ptrdiff_t stride_;
  int stage_;
};

template <int Lag, int A, int B>
void add_up_run(const Tables& tables, const ConvolutionRun& run, int stage) {
  const SumsAhead<Lag, A, B> sums(tables, stage);
  for (std::uint32_t i = run.first; i < run.last; ++i) sums.add_up(tables.convolutions[i]);
}

/// By lag and how far the operands are ahead, which is at most that.
using AddUpRun = void (*)(const Tables&, const ConvolutionRun&, int stage);
constexpr AddUpRun add_up_of_lag_2[3][3] = {{add_up_run<2, 0, 0>, add_up_run<2, 0, 1>, add_up_run<2, 0, 2>},
                                            {add_up_run<2, 1, 0>, add_up_run<2, 1, 1>, add_up_run<2, 1, 2>},
                                            {add_up_run<2, 2, 0>, add_up_run<2, 2, 1>, add_up_run<2, 2, 2>}};
constexpr AddUpRun add_up_of_lag_1[2][2] = {{add_up_run<1, 0, 0>, add_up_run<1, 0, 1>}, {add_up_run<1, 1, 0>, add_up_run<1, 1, 1>}};

[[maybe_unused]] void add_up_ahead(const Tables& tables, int stage) {
  for (std::size_t i = 0; i < tables.convolution_run_count; ++i) {
    const ConvolutionRun& run = tables.convolution_runs[i];
    if (run.lag == 0) add_up_run<0, 0, 0>(tables, run, stage);
    else if (run.lag == 1) add_up_of_lag_1[run.a_ahead][run.b_ahead](tables, run, stage);
    else add_up_of_lag_2[run.a_ahead][run.b_ahead](tables, run, stage);
  }
}

/// Four sums and as many coefficients of 8 lanes need the registers of AVX-512: with 16 of half the width a step takes 1.2 times as long as without.
#ifdef __AVX512F__
constexpr auto worthwhile_sums_ahead = add_up_ahead;
#else
constexpr void (*worthwhile_sums_ahead)(const Tables&, int) = nullptr;
#endif

}  // namespace
}  // namespace maupertuis::packed::MAUP_ENGINE

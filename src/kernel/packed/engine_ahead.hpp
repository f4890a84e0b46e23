// Part of engine_code.hpp: sums of products that later stages will want, four stages at once, so that each coefficient is read once for all of them. With
// D_a = lag − lag of a (D_b likewise), before stage s, m = s + 2 − lag, the operand a is final up to order m − 1 + D_a.
namespace maupertuis::packed::MAUP_ENGINE {
namespace {

/// Sums of the stages after it are made four at once.
constexpr int first_late_stage = rolled_group;

/// Of convolutions of one class. The sums of the first stages are whole; after `first_late_stage` what a stage has made final itself is left to the next
/// one, so that these sums need not wait for it.
template <int Lag, int A, int B>
class SumsAhead {
 public:
  SumsAhead(const Tables& tables, int stage) : stride_(static_cast<std::ptrdiff_t>(tables.stride)), stage_(stage), m_(stage + 3 - Lag) {}

  /// Of the stage after S: all that is final.
  template <int S>
  void add_up_alone(const ReadyConvolution& c) const {
    constexpr int m = S + 3 - Lag;
    Vector sum = all(0);
    for (int j = larger_of(0, 1 - B); j <= m - larger_of(0, 1 - A); ++j) sum += at(c.a, j) * at(c.b, m - j);
    save(sum_at(c, S), sum);
  }

  static constexpr int larger_of(int x, int y) { return x > y ? x : y; }
  /// Of orders that are final before stage s + 1 + r, the highest are not in its sum where they come from stage s + r.
  static constexpr int before(int r) { return r == 0 ? 2 : 1 + r; }
  static double* sum_at(const ReadyConvolution& c, int position) { return c.sums + position * static_cast<int>(lanes); }
  Vector at(const double* operand, int order) const { return load(operand + order * stride_); }

  /// Of the stages s + 1 … s + 4, with m the order of the first: a_j for 4 ≤ j < m meets b_{m+r−j} of all four stages r, which slide by one from j to j + 1.
  void begin_group(const ReadyConvolution& c) const {
    Vector sum[rolled_group], window[rolled_group];
#pragma GCC unroll 8
    for (int r = 0; r < rolled_group; ++r) {
      sum[r] = all(0);
#pragma GCC unroll 8
      for (int j = larger_of(0, before(r) - B); j < rolled_group; ++j) sum[r] += at(c.a, j) * at(c.b, m_ + r - j);
#pragma GCC unroll 8
      for (int i = larger_of(0, before(r) - A); i <= r; ++i) sum[r] += at(c.a, m_ + r - i) * at(c.b, i);
      window[r] = at(c.b, m_ + r - rolled_group);
    }
    const double *a = c.a + rolled_group * stride_, *b = c.b + (m_ - rolled_group) * stride_;
    const auto turn = [&](int first) {
      const Vector a_j = load(a);
      a += stride_, b -= stride_;
#pragma GCC unroll 8
      for (int r = first; r < rolled_group; ++r) sum[r] += a_j * window[r];
#pragma GCC unroll 8
      for (int r = rolled_group - 1; r > 0; --r) window[r] = window[r - 1];
      window[0] = load(b);
    };
    for (int left = stage_ - rolled_group; left > 0; left -= rolled_group) {
#pragma GCC unroll 8
      for (int r = 0; r < rolled_group; ++r) turn(0);
    }
#pragma GCC unroll 8
    for (int odd = 1; odd < 3 - Lag; ++odd) turn(0);
    turn(A == 0 ? 1 : 0);  // a_{m−1} b_1
#pragma GCC unroll 8
    for (int r = 0; r < rolled_group; ++r) save(sum_at(c, r), sum[r]);
  }

  /// What stage s, the `Passed`-th of its group, has made final, for those after the next one in the group: at a distance t the newest a meets b_{t−D_a}.
  template <int Passed>
  void pass_on(const ReadyConvolution& c) const {
    const Vector a = at(c.a, m_ - 1 + A), b = at(c.b, m_ - 1 + B);
#pragma GCC unroll 8
    for (int t = 2; Passed + t <= rolled_group; ++t) {
      double* const place = sum_at(c, Passed + t - 1);
      save(place, load(place) + a * at(c.b, t - A) + b * at(c.a, t - B));
    }
  }

  std::ptrdiff_t stride_;
  int stage_, m_;                        // m: the order that stage s + 1 finds
};

/// Of late stages the first, second and third of each group of four; the fourth makes nothing final that any but the next stage reads. The stages before
/// them, by their numbers.
enum Position { First = first_late_stage, Second, Third };

template <int Lag, int A, int B, int position>
void add_up_run(const Tables& tables, const ConvolutionRun& run, int stage) {
  const SumsAhead<Lag, A, B> sums(tables, stage);
  for (const ReadyConvolution* c = run.first; c != run.last; ++c) {
    if constexpr (position < First) sums.template add_up_alone<position>(*c);
    else if constexpr (position == First) sums.begin_group(*c);
    else sums.template pass_on<position - First>(*c);
  }
}

using AddUpRun = void (*)(const Tables&, const ConvolutionRun&, int stage);
/// By ConvolutionRun::kind.
template <int p>
constexpr AddUpRun add_up[] = {add_up_run<0, 0, 0, p>, add_up_run<1, 0, 0, p>, add_up_run<1, 0, 1, p>, add_up_run<1, 1, 0, p>, add_up_run<1, 1, 1, p>,
                               add_up_run<2, 0, 0, p>, add_up_run<2, 0, 1, p>, add_up_run<2, 0, 2, p>, add_up_run<2, 1, 0, p>, add_up_run<2, 1, 1, p>,
                               add_up_run<2, 1, 2, p>, add_up_run<2, 2, 0, p>, add_up_run<2, 2, 1, p>, add_up_run<2, 2, 2, p>};

/// By stages before the late ones, and by Position.
constexpr const AddUpRun* add_up_at[] = {add_up<0>, add_up<1>, add_up<2>, add_up<3>, add_up<First>, add_up<Second>, add_up<Third>};

[[maybe_unused]] void add_up_ahead(const Tables& tables, int stage) {
  const int position = stage < first_late_stage ? stage : First + stage % rolled_group;
  if (position > Third) return;
  const AddUpRun* const kinds = add_up_at[position];
  const ConvolutionRun* const last = tables.convolution_runs + tables.convolution_run_count;
  for (const ConvolutionRun* run = tables.convolution_runs; run != last; ++run) kinds[run->kind](tables, *run, stage);
}

/// Four sums and as many coefficients of 8 lanes need the registers of AVX-512: with 16 of half the width a step takes 1.2 times as long as without.
#ifdef __AVX512F__
constexpr auto worthwhile_sums_ahead = add_up_ahead;
#else
constexpr void (*worthwhile_sums_ahead)(const Tables&, int) = nullptr;
#endif

}  // namespace
}  // namespace maupertuis::packed::MAUP_ENGINE

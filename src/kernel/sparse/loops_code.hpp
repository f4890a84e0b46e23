// No include guard: each loops_*.cpp compiles this once, for its own instruction set.
#include "kernel/sparse/loops.hpp"

namespace maupertuis::sparse {
namespace {

/// sum − a b; fused where the processor can, which halves the time of what waits for it.
inline double minus(double sum, double a, double b) {
#if defined(__FMA__)
  return __builtin_fma(-a, b, sum);
#else
  return sum - a * b;
#endif
}

/// Products below 0: as many as the sums of the run have.
template <int Products, bool Starts>
void one_by_one(const SweepTables& t, const SweepRun& run, double* x) {
  const SweepSum *sum = t.sums + run.first, *const last = t.sums + run.last;
  const int count = Products >= 0 ? Products : static_cast<int>(sum->last - sum->first);
  const double *scale = t.scale + run.first, *factor = t.factors + sum->first;
  const std::uint32_t* operand = t.operand + sum->first;
  for (; sum != last; ++sum, ++scale, factor += count, operand += count) {
    double value = Starts ? *scale * x[sum->target] : 0;
    for (int k = 0; k < count; ++k) value = minus(value, -factor[k], x[operand[k]]);
    x[sum->target] = value;
  }
}

template <int Sides, bool Starts>
void recurrence(const SweepTables& t, const SweepRun& run, double* x) {
  const SweepSum *sum = t.sums + run.first, *const last = t.sums + run.last;
  const double *scale = t.scale + run.first, *factor = t.factors + sum->first;
  double side[Sides], joint = x[t.operand[sum->first + 1]];
  for (int j = 0; j < Sides; ++j) side[j] = x[t.operand[sum[j].first]];
  for (; sum != last; sum += Sides + 1, scale += Sides + 1, factor += 3 * Sides + 1) {
    double next = scale[Sides] * x[sum[Sides].target];
    for (int j = 0; j < Sides; ++j) {
      const double without_joint = minus(Starts ? scale[j] * x[sum[j].target] : 0, -factor[2 * j], side[j]);
      next = minus(next, -factor[2 * Sides + j], without_joint);
      x[sum[j].target] = side[j] = minus(without_joint, -factor[2 * j + 1], joint);
    }
    x[sum[Sides].target] = joint = minus(next, -factor[3 * Sides], joint);
  }
}

template <bool Starts>
void run_sums(const SweepTables& t, const SweepRun& run, double* x) {
  using RunSums = void (*)(const SweepTables&, const SweepRun&, double*);
  static constexpr RunSums by_sides[] = {nullptr, recurrence<1, Starts>, recurrence<2, Starts>, recurrence<3, Starts>,
                                         recurrence<4, Starts>};
  static constexpr RunSums by_products[] = {one_by_one<0, Starts>, one_by_one<1, Starts>, one_by_one<2, Starts>,
                                            one_by_one<3, Starts>, one_by_one<4, Starts>, one_by_one<-1, Starts>};
  const std::uint32_t products = t.sums[run.first].last - t.sums[run.first].first;
  (run.sides > 0 ? by_sides[run.sides] : by_products[products < 5 ? products : 5])(t, run, x);
}

void sweep(const SweepTables& t, double* x) {
  for (const SweepRun* run = t.runs; run != t.last_run; ++run)
    t.sums[run->first].starts ? run_sums<true>(t, *run, x) : run_sums<false>(t, *run, x);
}

double size(double x) { return __builtin_fabs(x); }

/// Smallest pivot in units of its terms and of its usual size; NaN where it is not finite.
void pivot_run(const FactorTables& t, const FactorRun& run, double& least) {
  const FactorProduct* product = t.products + run.first_product;
  for (std::uint32_t i = run.first; i < run.last; ++i) {
    const FactorSum& sum = t.sums[i];
    double v = t.entries[sum.entry], largest = size(v);
    if (t.usual_size[sum.pivot] > largest) largest = t.usual_size[sum.pivot];
    for (std::uint32_t k = 0; k < run.products; ++k, ++product) {
      const double term = t.factors[product->lower] * t.factors[product->upper];
      v -= term;
      largest += size(term);
    }
    if (!(largest < __builtin_inf())) least = __builtin_nan("");
    if (size(v) < least * largest) least = size(v) / largest;
    t.inverse[sum.pivot] = 1 / v;
  }
}

template <int Products, bool Divides>
void factor_run(const FactorTables& t, const FactorRun& run) {
  const int count = Products >= 0 ? Products : static_cast<int>(run.products);
  const FactorProduct* product = t.products + run.first_product;
  for (std::uint32_t i = run.first; i < run.last; ++i, product += count) {
    const FactorSum& sum = t.sums[i];
    double v = t.entries[sum.entry];
    for (int k = 0; k < count; ++k) v = minus(v, t.factors[product[k].lower], t.factors[product[k].upper]);
    t.factors[sum.target] = Divides ? v * t.inverse[sum.pivot] : v;
  }
}

template <bool Divides>
void factor_run(const FactorTables& t, const FactorRun& run) {
  switch (run.products) {
    case 0:
      return factor_run<0, Divides>(t, run);
    case 1:
      return factor_run<1, Divides>(t, run);
    case 2:
      return factor_run<2, Divides>(t, run);
    case 3:
      return factor_run<3, Divides>(t, run);
    default:
      return factor_run<-1, Divides>(t, run);
  }
}

double factor(const FactorTables& t) {
  double least = 1;
  for (const FactorRun* run = t.runs; run != t.last_run; ++run) {
    if (run->kind == FactorRun::Pivot)
      pivot_run(t, *run, least);
    else if (run->kind == FactorRun::Lower)
      factor_run<false>(t, *run);
    else
      factor_run<true>(t, *run);
  }
  return least;
}

Loops loops_of_this_file() { return {factor, sweep}; }

}  // namespace
}  // namespace maupertuis::sparse

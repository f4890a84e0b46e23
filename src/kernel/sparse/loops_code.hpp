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

/// Products below 0: as many as the run has.
template <int Products, bool Starts>
void sums(const SweepTables& t, const SumRun& run, double* x) {
  const int count = Products >= 0 ? Products : static_cast<int>(run.products);
  const double* factor = t.factors + run.first_product;
  const std::uint32_t* operand = t.operand + run.first_product;
  for (std::uint32_t i = run.first; i < run.last; ++i, factor += count, operand += count) {
    double sum = Starts ? t.scale[i] * x[t.target[i]] : 0;
    for (int k = 0; k < count; ++k) sum = minus(sum, -factor[k], x[operand[k]]);
    x[t.target[i]] = sum;
  }
}

template <bool Starts>
void sums(const SweepTables& t, const SumRun& run, double* x) {
  switch (run.products) {
    case 0: return sums<0, Starts>(t, run, x);
    case 1: return sums<1, Starts>(t, run, x);
    case 2: return sums<2, Starts>(t, run, x);
    case 3: return sums<3, Starts>(t, run, x);
    case 4: return sums<4, Starts>(t, run, x);
    default: return sums<-1, Starts>(t, run, x);
  }
}

void sweep(const SweepTables& t, double* x) {
  for (const SumRun* run = t.runs; run != t.last_run; ++run)
    run->starts ? sums<true>(t, *run, x) : sums<false>(t, *run, x);
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
    case 0: return factor_run<0, Divides>(t, run);
    case 1: return factor_run<1, Divides>(t, run);
    case 2: return factor_run<2, Divides>(t, run);
    case 3: return factor_run<3, Divides>(t, run);
    default: return factor_run<-1, Divides>(t, run);
  }
}

double factor(const FactorTables& t) {
  double least = 1;
  for (const FactorRun* run = t.runs; run != t.last_run; ++run) {
    if (run->kind == FactorRun::Pivot) pivot_run(t, *run, least);
    else if (run->kind == FactorRun::Lower) factor_run<false>(t, *run);
    else factor_run<true>(t, *run);
  }
  return least;
}

void block(const BlockRow* row, const BlockRow* last, const BlockTerm* terms, const double* entries, double* z) {
  typedef double Vector __attribute__((vector_size(64), aligned(8)));
  for (; row != last; ++row) {
    Vector sum = {};
    for (std::uint32_t k = row->first; k < row->last; ++k)
      sum += entries[terms[k].entry] * *reinterpret_cast<const Vector*>(z + std::size_t{8} * terms[k].operand);
    *reinterpret_cast<Vector*>(z + std::size_t{8} * row->target) = sum;
  }
}

Loops loops_of_this_file() { return {factor, sweep, block}; }

}  // namespace
}  // namespace maupertuis::sparse

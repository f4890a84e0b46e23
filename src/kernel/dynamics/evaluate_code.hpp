// No include guard: each evaluate_*.cpp compiles this once, for its own instruction set.
#include "kernel/dynamics/evaluate.hpp"
#include "kernel/jet/sine_cosine.hpp"

namespace maupertuis::dynamics {
namespace {

/// Counts below 0 are those of the run.
template <int Linear, int Products, bool Divides>
void sums(const FlatTables& t, const SumRun& run) {
  const int linear = Linear >= 0 ? Linear : static_cast<int>(run.linear);
  const int products = Products >= 0 ? Products : static_cast<int>(run.products);
  const double *c = t.linear_coefficient + run.first_linear, *d = t.product_coefficient + run.first_product;
  const Cell *from = t.linear_cell + run.first_linear, *a = t.product_a + run.first_product, *b = t.product_b + run.first_product;
  double* const x = t.cells;
  for (std::uint32_t i = run.first; i < run.last; ++i) {
    double sum = 0, rest = 0;
    for (int k = 0; k < linear; ++k) sum += c[k] * x[from[k]];
    for (int k = 0; k < products; ++k) rest += d[k] * x[a[k]] * x[b[k]];
    sum += rest;
    x[t.sum_out[i]] = Divides ? sum / x[t.sum_divisor[i]] : sum;
    c += linear, from += linear, d += products, a += products, b += products;
  }
}

template <int Linear>
void sums_of(const FlatTables& t, const SumRun& run) {
  if (run.divides) return sums<Linear, -1, true>(t, run);
  switch (run.products) {
    case 0: return sums<Linear, 0, false>(t, run);
    case 1: return sums<Linear, 1, false>(t, run);
    case 2: return sums<Linear, 2, false>(t, run);
    default: return sums<Linear, -1, false>(t, run);
  }
}

void sums(const FlatTables& t, const SumRun& run) {
  switch (run.linear) {
    case 0: return sums_of<0>(t, run);
    case 1: return sums_of<1>(t, run);
    case 2: return sums_of<2>(t, run);
    case 3: return sums_of<3>(t, run);
    default: return sums_of<-1>(t, run);
  }
}

void sines(const FlatTables& t, const SineRun& run) {
  alignas(64) double angle[8];
  for (int lane = 0; lane < 8; ++lane) angle[lane] = t.cells[run.angle[static_cast<std::size_t>(lane)]];
  const jet::SineCosine<8> both(jet::Vec<8>::load(angle));
  both.sine.store(t.cells + run.out);
  both.cosine.store(t.cells + run.out + 8);
}

void evaluate(const FlatTables& t) {
  for (std::size_t i = 0; i < t.step_count; ++i) switch (const FlatStep& step = t.steps[i]; step.kind) {
      case FlatStep::Sum: sums(t, t.sums[step.index]); break;
      case FlatStep::Sine: sines(t, t.sines[step.index]); break;
      case FlatStep::Function: case FlatStep::Choose: t.other(t.context, step);
    }
}

}  // namespace
}  // namespace maupertuis::dynamics

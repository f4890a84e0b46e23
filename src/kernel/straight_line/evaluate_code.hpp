// No include guard: each evaluate_*.cpp compiles this once, for its own instruction set.
#include "kernel/series/sine_cosine.hpp"
#include "kernel/straight_line/evaluate.hpp"

namespace maupertuis::straight {
namespace {

/// Counts below 0 are those of the run.
template <int Linear, int Products, int Triples = 0>
void sums(const EvaluationTables& t, const SumRun& run) {
  const int linear = Linear >= 0 ? Linear : static_cast<int>(run.linear);
  const int products = Products >= 0 ? Products : static_cast<int>(run.products);
  const int triples = Triples >= 0 ? Triples : static_cast<int>(run.triples);
  const CellTerm *p = t.linear + run.first_linear, *q = t.products + run.first_product,
                 *r = t.triples + run.first_triple;
  const Cell* scale = run.first_scale == no_scale ? nullptr : t.scales + run.first_scale;
  double *const x = t.cells, *out = x + run.out;
  for (std::uint32_t i = 0; i < run.count; ++i, p += linear, q += products, r += triples) {
    double sum = 0;
    for (int k = 0; k < linear; ++k) sum += p[k].factor * x[p[k].a];
    if constexpr (Products != 0 || Triples != 0) {
      double rest = 0;
      for (int k = 0; k < products; ++k) rest += q[k].factor * x[q[k].a] * x[q[k].b];
      for (int k = 0; k < triples; ++k) rest += r[k].factor * x[r[k].a] * x[r[k].b] * x[r[k].c];
      sum += rest;
    }
    if (scale) sum = sum * x[scale[0]] / x[scale[1]], scale += 2;
    *out++ = sum;
  }
}

template <int Linear>
void sums_of(const EvaluationTables& t, const SumRun& run) {
  switch (run.products) {
    case 0:
      return sums<Linear, 0>(t, run);
    case 1:
      return sums<Linear, 1>(t, run);
    case 2:
      return sums<Linear, 2>(t, run);
    default:
      return sums<Linear, -1>(t, run);
  }
}

void sums(const EvaluationTables& t, const SumRun& run) {
  if (run.triples > 0) {
    if (run.linear > 0 || run.products > 0 || run.triples > 2) return sums<-1, -1, -1>(t, run);
    return run.triples == 1 ? sums<0, 0, 1>(t, run) : sums<0, 0, 2>(t, run);
  }
  switch (run.linear) {
    case 0:
      return sums_of<0>(t, run);
    case 1:
      return sums_of<1>(t, run);
    case 2:
      return sums_of<2>(t, run);
    case 3:
      return sums_of<3>(t, run);
    default:
      return sums_of<-1>(t, run);
  }
}

void wides(const EvaluationTables& t, const WideRun& run) {
  using Vector = series::Vec<8>;
  const CellTerm* term = t.wide_terms + run.first_term;
  double* out = t.cells + run.out;
  for (std::uint32_t i = 0; i < run.count; ++i, out += 8) {
    Vector sum = Vector::all(0);
    for (std::uint32_t k = 0; k < run.terms; ++k, ++term)
      sum = sum + Vector::load(t.cells + term->b) * (term->factor * t.cells[term->a]);
    sum.store(out);
  }
}

void magnitudes(const EvaluationTables& t, const SizeRun& run) {
  const CellTerm* term = t.size_terms + run.first_term;
  const double* const x = t.cells;
  for (double *out = t.cells + run.out, *const last = out + run.count; out != last; ++out) {
    double sum = 0;
    for (const CellTerm* const end = term + run.terms; term != end; ++term)
      sum += __builtin_fabs(term->factor * x[term->a] * x[term->b] * x[term->c]);
    *out = sum;
  }
}

void larger(const EvaluationTables& t, const SizeRun& run) {
  const CellTerm* term = t.size_terms + run.first_term;
  for (double *out = t.cells + run.out, *const last = out + run.count; out != last; ++out, ++term) {
    const double a = __builtin_fabs(t.cells[term->a]), b = __builtin_fabs(t.cells[term->b]);
    *out = a < b ? b : a;
  }
}

void sines(const EvaluationTables& t, const AngleStep& step) {
  alignas(64) double angle[8];
  for (int lane = 0; lane < 8; ++lane) angle[lane] = t.cells[step.angle[static_cast<std::size_t>(lane)]];
  const series::SineCosine<8> both(series::Vec<8>::load(angle));
  both.sine.store(t.cells + step.out);
  both.cosine.store(t.cells + step.out + 8);
}

void evaluate(const EvaluationTables& t, const EvaluationStep* step, const EvaluationStep* last) {
  for (; step != last; ++step) switch (step->kind) {
      case EvaluationStep::Sums:
        sums(t, t.sums[step->index]);
        break;
      case EvaluationStep::Wides:
        wides(t, t.wides[step->index]);
        break;
      case EvaluationStep::Magnitudes:
        magnitudes(t, t.sizes[step->index]);
        break;
      case EvaluationStep::Larger:
        larger(t, t.sizes[step->index]);
        break;
      case EvaluationStep::Angles:
        sines(t, t.angles[step->index]);
        break;
      case EvaluationStep::Other:
        t.other(t.context, step->index);
    }
}

}  // namespace
}  // namespace maupertuis::straight

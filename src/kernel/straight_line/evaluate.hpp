#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

/// The loops that run a straight line, compiled for several instruction sets; the best one of the processor is taken at
/// run time. Plain pointers, so that no inline function of a container is compiled for a processor that may not be
/// there.
namespace maupertuis::straight {

/// Place of a number among those of an evaluation.
using Cell = std::uint32_t;

/// factor · a · b · c, as many of the operands as the list holds that it stands in.
struct CellTerm {
  double factor;
  Cell a, b, c;
};

/// Sums that do not wait for each other, of as many terms each: (Σ f a + Σ f a b + Σ f a b c) · times / over. Results
/// and terms follow each other.
struct SumRun {
  std::uint32_t linear, products, triples;  // terms of each sum
  std::uint32_t count;                      // sums
  Cell out;
  std::uint32_t first_linear, first_product, first_triple;
  /// where `times` and `over` of each stand; none where neither is there
  std::uint32_t first_scale;
};
inline constexpr std::uint32_t no_scale = ~std::uint32_t{0};

/// Wide sums: Σ f a · (8 numbers from b on).
struct WideRun {
  std::uint32_t terms, count;
  Cell out;  // 8 cells each
  std::uint32_t first_term;
};

/// Σ |f a b c| of as many terms each, or max(|a|, |b|) of one term.
struct SizeRun {
  std::uint32_t terms, count;
  Cell out;
  std::uint32_t first_term;
};

/// Sines of up to 8 angles to `out` … and cosines to `out + 8` ….
struct AngleStep {
  std::array<Cell, 8> angle;
  Cell out;
};

struct EvaluationStep {
  enum Kind : std::uint8_t { Sums, Wides, Magnitudes, Larger, Angles, Other } kind;
  std::uint32_t index;
};

struct EvaluationTables {
  const SumRun* sums;
  const WideRun* wides;
  const SizeRun* sizes;  // Magnitudes, Larger
  const AngleStep* angles;
  const CellTerm *linear, *products, *triples, *wide_terms, *size_terms;
  const Cell* scales;  // `times` and `over` in turn
  double* cells;       // aligned to 64 bytes
  void* context;       // of `other`
  void (*other)(void* context, std::uint32_t index);
};

using Evaluate = void (*)(const EvaluationTables& tables, const EvaluationStep* first, const EvaluationStep* last);

/// Null where the compiler lacks the instructions.
Evaluate baseline_evaluate();
Evaluate avx2_evaluate();
Evaluate avx512_evaluate();

}  // namespace maupertuis::straight

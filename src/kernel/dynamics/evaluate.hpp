#pragma once
#include "kernel/dynamics/flat_program.hpp"

/// Runs a flat program on its cells. Compiled for several instruction sets; the best one of the processor is taken at run time.
namespace maupertuis::dynamics {

/// Plain pointers, so that no inline function of a container is compiled for a processor that may not be there.
struct FlatTables {
  const FlatStep* steps;
  std::size_t step_count;
  const SumRun* sums;
  const SineRun* sines;
  const Cell *sum_out, *sum_divisor, *linear_cell, *product_a, *product_b;
  const double *linear_coefficient, *product_coefficient;
  double* cells;               // aligned to 64 bytes
  void* context;               // of `other`
  void (*other)(void* context, const FlatStep& step);  // functions and choices
};

using Evaluate = void (*)(const FlatTables& tables);

/// Null where the compiler lacks the instructions.
Evaluate baseline_evaluate();
Evaluate avx2_evaluate();
Evaluate avx512_evaluate();
/// The best one that this processor has.
Evaluate best_evaluate();

}  // namespace maupertuis::dynamics

#pragma once
#include <cstddef>
#include <cstdint>

/// The loops of the sparse solver, compiled for several instruction sets; the best one of the processor is taken at run
/// time. Plain pointers, so that no inline function of a container is compiled for a processor that may not be there.
namespace maupertuis::sparse {

/// x_target = scale · x_target + Σ factor · x_operand, of operands that are known before.
struct SweepSum {
  std::uint32_t target, pivot;
  std::uint32_t first, last;  // products; those of all sums follow each other
  bool starts;                // at a value that is there; else at 0
  bool negates;               // forward: the pivot is −1
};

/// Sums of one shape one after the other, or of a recurrence (LoopSweep) so many sides and a joint for each link. The
/// last product of a joint has the factor from joint to joint.
struct SweepRun {
  std::uint32_t first, last;  // sums
  std::uint32_t sides;        // 0: none is a recurrence
};
inline constexpr std::size_t most_sides = 4;

struct SweepTables {
  const SweepRun *runs, *last_run;
  const SweepSum* sums;
  const std::uint32_t* operand;
  const double *scale, *factors;
};

/// An entry of L or U, or a pivot.
struct FactorSum {
  std::uint32_t target;  // in the factors
  std::uint32_t entry;   // it starts from
  std::uint32_t pivot;   // Pivot: its number; Upper: it is divided by
};
struct FactorProduct {
  std::uint32_t lower, upper;  // in the factors
};
struct FactorRun {
  enum Kind : std::uint8_t { Pivot, Lower, Upper } kind;
  std::uint32_t products, first, last, first_product;
};

struct FactorTables {
  const FactorRun *runs, *last_run;
  const FactorSum* sums;
  const FactorProduct* products;
  const double *entries, *usual_size;
  double *factors, *inverse;
};

struct Loops {
  double (*factor)(const FactorTables& tables);
  void (*sweep)(const SweepTables& tables, double* x);
};

Loops baseline_loops();
/// Null pointers where the compiler lacks the instructions.
Loops avx2_loops();
Loops avx512_loops();
/// The best one that this processor has.
const Loops& loops();

}  // namespace maupertuis::sparse

#pragma once
#include "kernel/sparse/tangent_graph.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// A program made ready for lanes. What depends on its structure alone is found once: through which operands tangents
/// at order 0 go, and which of them vanish, so that M₀ and the corrections of stored slots are short lists of products.
namespace maupertuis::lanes {

struct Pair {
  std::uint32_t factor, tangent;
};

/// tangents[out] = Σ factor · tangent over pairs, or of a Select the tangent whose factor is not 0.
struct Combination {
  std::uint32_t out, first, last;
  bool chooses;
};

struct MassEntry {
  std::uint32_t row, column, tangent;
};

struct CorrectionTerm {
  std::uint32_t direction, tangent;
};
/// A stored slot follows the accelerations: slot += Σ tangent · direction.
struct Correction {
  Slot slot;
  std::uint32_t first, last;
};

/// Plain arrays, for code that calls nothing of the standard library.
struct PlanView {
  const Instruction* instructions;
  const Term* terms;
  const Run* runs;
  std::size_t run_count;
  const sparse::Edge* factors;
  std::size_t factor_count;
  const Pair* pairs;
  const Combination* combinations;
  std::size_t combination_count, tangent_count;
  const MassEntry* mass;
  std::size_t mass_count;
  const Correction* corrections;
  const CorrectionTerm* correction_terms;
  std::size_t corrections_end[3];  // by lag
  const Slot* residual;
  std::size_t unknowns, stride;
  int first_stage;
};

class Plan {
 public:
  /// The program must outlive the plan. Precondition: it has no constraints.
  explicit Plan(const Program& program);
  PlanView view() const;

 private:
  void add_result(std::span<const sparse::Edge> edges);
  void add_corrections(const Program& program);
  std::uint32_t tangent_of(Slot slot, std::size_t direction) const;

  /// The directions in which a slot moves, ascending, and where its tangents are.
  struct Moves {
    std::vector<std::uint32_t> directions;
    std::uint32_t first = 0;
  };

  const Program& program_;
  std::vector<Moves> moves_;  // [slots]
  std::uint32_t tangents_ = 0;
  std::vector<sparse::Edge> factors_;  // edges whose factors are computed
  std::vector<Pair> pairs_;
  std::vector<Combination> combinations_;
  std::vector<MassEntry> mass_;
  std::vector<Correction> corrections_;
  std::vector<CorrectionTerm> correction_terms_;
  std::size_t corrections_end_[3] = {};
};

/// The elementary functions of the reference interpreter, one lane at a time.
double elementary_function(Kind function, double x, double y);
double power_function(double x, double y);

using Expander = void (*)(const PlanView& plan, double* rows, const double* constants, double* quality, double* scratch,
                          int stages);
/// One function a width: W = 1, 2, 4, 8, 16; null where the build lacks the instruction set.
struct Expanders {
  Expander of_width[5] = {};
};
Expanders baseline_expanders();
Expanders avx2_expanders();
Expanders avx512_expanders();

}  // namespace maupertuis::lanes

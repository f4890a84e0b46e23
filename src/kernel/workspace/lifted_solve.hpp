#pragma once
#include "kernel/packed/layout.hpp"
#include "kernel/reference/reference.hpp"
#include "kernel/sparse/graph_product.hpp"
#include "kernel/sparse/parts.hpp"
#include "kernel/sparse/sparse_solver.hpp"
#include "kernel/workspace/lifted_code.hpp"
#include "kernel/workspace/lifted_places.hpp"

#include <optional>

namespace maupertuis::workspace {

using reference::Doubles;
using reference::Memory;

/// M₀ x = b for systems so large that a full M₀ costs more. The mass matrix of a chain is full, but the accelerations
/// of its points follow from each other by a few products a link. With these accelerations as unknowns beside q̈ the
/// system is larger and sparse (sparse::LiftedSystem), and solving it costs as much a link however many links there
/// are.
///
/// Its pivots are chosen once, and may become small where the motion goes. So the first solution of each step is put
/// into the equations again. What it leaves of b decides: the step is solved here, perhaps with a correction of each
/// solution; or by the full matrix, which alone tells what is singular.
class LiftedSolve {
 public:
  /// `program`: as it was before it was packed; `strip`: by which it was.
  LiftedSolve(const Program& program, const sparse::Strip& strip, const packed::PackedProgram& packed,
              std::size_t stride);

  void set_constants(const Memory& memory);
  /// From then on solutions are machine code, made whenever pivots are chosen; where that cannot be the loops go on.
  void compile(const CompileOptions& options);
  /// Of the pivots in use; nothing where no code was asked for, or no pivots are chosen yet.
  const std::optional<CompileReport>& compile_report() const { return code_.report(); }
  /// For each point that `memory` holds at order 0, first of all; false: there are no acceptable pivots, and the full
  /// matrix is to decide.
  bool has_pivots(const Memory& memory);
  /// The factors at the point; false: the full matrix is to decide.
  bool factor(const Memory& memory);
  /// The first solution after factor(), as in solve(), and corrected if it is rough; false: it does not hold, and the
  /// full matrix is to decide; b is as it was.
  bool solve_first(const Memory& memory, std::span<double> b);
  /// Without factor(): −M₀⁻¹, [padded × padded] with padded = unknowns rounded up to a multiple of 8, aligned to 64
  /// bytes; what is beyond the unknowns has to be 0, and stays so. Up to 48 unknowns a product with it takes less than
  /// a solution. Nothing is checked. False: there is no code for that.
  bool negative_inverse(const Memory& memory, double* inverse);
  /// b → q̈_k and λ_k in place.
  void solve(std::span<double> b);
  /// Whether the solutions of a stage are good as they come.
  bool is_direct(int stage) const { return !refines_ && !is_rough(stage); }
  /// M₀ x = R as it stands in a row of the packed program: x and the tangents in its direction, slot by slot.
  const double* solve_row(const double* row);
  /// Whether that gives x also in the cells of blocks that copy coordinates.
  bool solves_for_copies() const { return bool{code_}; }
  /// In the direction of the last solution, of a stage, those of the stored slots of the packed program; null where
  /// they are too rough.
  const double* tangents(int stage) const { return is_rough(stage) ? nullptr : cells_.data(); }
  /// Whether the solution of a stage is to be improved by a second one for what the first leaves of b. A solution in
  /// parts leaves up to 40 times as much as one from link to link, since it closes the gaps between parts by forces,
  /// which are large where a chain is heavy. Only q̈₀ is worth it: with q̈₁ solved for twice as well, energies of runs
  /// err by as much as without.
  bool is_rough(int stage) const { return in_parts_ && stage == 0; }

  /// The smallest pivot in units of its terms and of its size where the pivots were chosen; by code 1 where all are
  /// sound, else 0.
  double least_pivot() const { return least_pivot_; }
  /// Nothing before the first factor(), and where there are no pivots.
  const sparse::SparseSolver* solver() const { return solver_ ? &*solver_ : nullptr; }

 private:
  bool fail();
  void assemble(const Memory& memory);
  bool choose_pivots(const Memory& memory);
  double remainder(std::span<const double> b);
  void add_correction();
  bool make_code(std::span<const double> sample);
  using Parts = std::vector<std::vector<std::uint32_t>>;
  bool choose_parts(const std::vector<std::vector<double>>& samples, const std::vector<sparse::Pivot>& pivots);
  bool try_parts(const std::vector<std::vector<double>>& samples, const Parts& parts);
  bool is_symmetric(std::span<const double> sample);
  sparse::EntryWriter entries_in_line() const;
  straight::StraightLine columns();
  void drop_solver();
  void run_factor(const Memory& memory);
  void run_solve(std::span<const double> b, double* x);

  const Program& program_;
  const sparse::Strip& strip_;
  std::optional<sparse::LiftedSystem> system_;
  std::optional<sparse::Assembly> assembly_;
  std::optional<sparse::GraphProduct> product_;
  std::optional<sparse::SparseSolver> solver_;
  std::optional<LiftedPlaces> places_;
  std::vector<double> entries_;   // [entries]
  bool has_entries_ = false;      // of this point
  std::vector<double> residual_;  // [unknowns] b − M₀ x
  Doubles cells_, change_;        // [stride + columns]
  Doubles row_;                   // [stride] b, where code reads it
  double least_pivot_ = 1;
  bool refines_ = false;  // each solution of this step
  int failures_ = 0;
  LiftedCode code_;
  bool in_parts_ = false, parts_failed_ = false;
};

}  // namespace maupertuis::workspace

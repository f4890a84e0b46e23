#pragma once
#include "kernel/interpreter/compiled.hpp"
#include "kernel/interpreter/elementary.hpp"
#include "kernel/interpreter/interpreter.hpp"
#include "kernel/interpreter/lifted_solve.hpp"
#include "kernel/interpreter/point_section.hpp"
#include "kernel/jet/bordered_solver.hpp"
#include "kernel/packed/engine.hpp"

namespace maupertuis {

using interpreter::Memory;

/// Its stages are in workspace.cpp, the solution of a stage in workspace_solution.cpp, what is read of it in workspace_values.cpp.
struct KernelWorkspace::Impl {
  /// Up to here the correction of a stage is a product with a small matrix, and so is the solution where M is positive definite.
  static constexpr std::size_t most_by_matrix = 16;

  /// How the stages after the first are solved: with a look at each solution; or directly, by −M⁻¹ (of few unknowns, or by code) or by sparse factors, with one
  /// look at the end.
  enum class LaterStages { StepByStep, ByInverse, ByLifting };

  Impl(const Kernel& k, int p)
      : kernel(k), strip(strip_for(k.program())), packed(packed::pack(k.program(), {strip.order, strip.whole})), program(packed.program), order(p),
        orders(p + 2 + (-2 - program.first_stage)), memory(program, orders, packed.cells), parameters(program.parameters, 0.0),
        sides(program.switches.size(), 1), unknowns(program.unknowns),
        by_matrix(unknowns <= most_by_matrix), producer(program.slots, nullptr), at_point(program) {
    solution.assign(padded_unknowns(), 0.0);
    rough = solution;
    unknown = {solution.data(), unknowns};
    tangent.assign(by_matrix ? unknowns * memory.stride : memory.stride, 0.0);
    if (by_matrix) answers.assign(tangent.size(), 0.0);
    for (std::size_t d = 0; by_matrix && d < unknowns; ++d) tangent[d * memory.stride + d] = 1;
    if (!by_matrix && unknowns == program.freedoms) lifted.emplace(kernel.program(), strip, packed, memory.stride);
    if (unknowns <= packed::most_by_inverse) inverse.assign(padded_unknowns() * padded_unknowns(), 0.0);
    for (const Instruction& i : program.instructions) producer[i.out] = &i;
    interpreter::set_leaves(memory, 0.0, orders);
    residual_vectors = find_residual_vectors();
    residual_side_by_side = is_residual_side_by_side();
    mass_in_eights = has_mass_in_eights();
    find_own_vectors();
    corrects_points = outputs_follow_accelerations();
    bind();
  }

  /// For solutions in parts, whose lanes are those of the packs then.
  static sparse::Strip strip_for(const Program& p) {
    return p.unknowns == p.freedoms && p.unknowns > packed::most_by_inverse ? sparse::strip_of(p) : sparse::Strip{};
  }

  std::size_t padded_unknowns() const { return packed::padded(unknowns); }
  void bind();
  void compute_constants();
  KernelStatus run(double t, std::span<const double> q, std::span<const double> v, int stages);
  void run_first_stages();
  KernelStatus run_step_by_step(int stage);
  void run_stage(int stage);
  bool runs_on() const;
  bool run_later_stages(int stages);
  void renew_blocks(int stage, int stages);
  bool adds_up_ahead() const { return engine.add_up_ahead && order > packed::rolled_group; }
  void run_along(int stage);
  bool outputs_follow_accelerations() const;
  bool run_compiled(int stages);
  bool inverts();
  void set_probe();
  bool run_directly(int stage);
  void set_accelerations(int stage, const double* solution, int sign) { engine.set_accelerations(tables, stage, solution, unknowns, sign); }
  bool are_coefficients_finite(int stages) const;
  void adopt(interpreter::CompiledCode code);
  void find_tangents(std::size_t directions);
  void find_direction();
  void sweep_block(std::size_t first);
  KernelStatus factor(int stages);
  KernelStatus without_solution(KernelStatus status);
  KernelStatus factor_anew();
  KernelStatus factor_full();
  void need_full();
  bool is_residual_side_by_side() const;
  void find_own_vectors();
  bool has_symmetric_pattern();
  bool has_mass_in_eights() const;
  void fetch_eights();
  void fetch_mass(std::size_t i, const double* tangents, std::size_t step, std::size_t first, std::size_t last);
  KernelStatus solve(int stage);
  void solve_factored();
  void fetch_residual(int stage);
  bool solve_twice(int stage);
  bool solve_twice_by_inverse(int stage);
  bool add_rough_solution();
  void add_residual(int stage);
  std::pair<Slot, Slot> find_residual_vectors() const;
  void correct(int stage);
  void correct(int stage, const double* direction, double weight);
  bool constraints_agree();
  bool keeps(std::size_t constraint) const { return by_lifting || !solver || solver->keeps(constraint); }
  double coefficient(Slot slot, int k) const;

  Kernel kernel;
  sparse::Strip strip;
  packed::PackedProgram packed;
  const Program& program;            // of `packed`
  int order, orders;
  interpreter::Memory memory;
  packed::Tables tables;
  packed::TangentMatrix tangents;    // by_matrix: the engine's view of `tangent`
  const packed::Engine& engine = packed::engine();
  std::optional<packed::ReadyProgram> ready;
  std::vector<packed::Order> of_orders;  // those below 0, which nothing reads, then [orders]
  interpreter::Doubles lane_coefficients;  // [packed.coefficients]
  std::vector<double> parameters;
  std::vector<std::int8_t> sides;
  bool stale = true;                 // constants to be computed
  std::size_t unknowns;              // n + m
  std::optional<jet::BorderedSolver> solver;
  std::vector<double> bordered;      // [(n + m) × (n + m)] ∂R/∂(q̈, λ) at order 0; empty until it is asked for
  bool has_full = false;             // bordered is that of this point
  std::optional<interpreter::LiftedSolve> lifted;
  interpreter::Doubles solution;     // q̈_k and λ_k, padded
  std::span<double> unknown;         // [n + m] of it: −R_k, then q̈_k and λ_k
  std::pair<Slot, Slot> residual_vectors;  // see find_residual_vectors()
  bool residual_side_by_side = false;
  std::vector<std::int8_t> own;      // see packed::InverseSolution
  std::optional<bool> symmetric_pattern;  // of M₀, once it was asked for
  bool mass_in_eights = false;       // see has_mass_in_eights()
  bool has_direction = false;        // `tangent` is that of q̈_k, if `owed` is taken from it
  const double* owed = nullptr;      // tangents in the direction of what the first solution was wrong by; null: nothing
  interpreter::Doubles rough;        // a solution that is being corrected, padded
  bool by_matrix, by_inverse = false, by_lifting = false;
  LaterStages later = LaterStages::StepByStep;
  interpreter::Doubles inverse;      // by_inverse or LaterStages::ByInverse: −M⁻¹, padded rows and columns
  interpreter::Doubles answers;      // scratch of Engine::run_stages_by_inverse
  interpreter::Doubles tangent_row, passing_row;  // scratch of code
  interpreter::Doubles probe;        // [stride] the right side of inverts()
  interpreter::Doubles largest_rest;  // [stride] that a solution for it may leave; what is no residual may be anything
  bool has_probe = false;            // for these parameters
  interpreter::Doubles tangent;      // by_matrix: ∂slot/∂q^(lag) for each unknown [n + m × stride], else for one direction
  std::vector<double> block_tangent; // [slots × 8]
  std::vector<std::uint32_t> of_mass;  // instructions that M₀ goes through
  std::vector<const Instruction*> producer;  // [slots]
  interpreter::PointSection at_point;
  bool alone = false;                // a point whose coefficients are not corrected
  bool corrects_points = true;       // something that is read at a point alone depends on q̈
  std::size_t singular = 0, contradicting = 0;
  int last_stage = 0;
  interpreter::CompiledCode compiled;
  interpreter::Doubles sums;         // of rolled code: [convolutions × rolled_group × 8]
  packed::CompiledArguments arguments;
};

}  // namespace maupertuis

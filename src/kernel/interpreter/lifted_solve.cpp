#include "kernel/interpreter/lifted_solve.hpp"

#include "kernel/interpreter/sampled_states.hpp"

#include <algorithm>
#include <tuple>

namespace maupertuis::interpreter {
namespace {

/// A pivot that lost more than this to cancellation, or is so much smaller than where pivots were chosen: the full matrix decides.
constexpr double least_sound_pivot = 1e-7;
/// What a solution may leave of b, in units of the error bound of that remainder: without a correction, with one, and after it.
constexpr double sound = 16, tolerable = 1e6, corrected = 16;
bool is_power_of_two(int x) { return (x & (x - 1)) == 0; }

std::vector<bool> stored_slots(const Program& program, const packed::PackedProgram& packed) {
  std::vector<bool> stored(program.slots, false);
  for (Slot slot = 0; slot < program.slots; ++slot) stored[slot] = packed.number[slot] < packed.program.stored_end[2];
  return stored;
}

}  // namespace

LiftedSolve::LiftedSolve(const Program& program, const packed::PackedProgram& packed, std::size_t stride)
    : program_(program), stored_(packed.program.stored_end[2]), system_(sparse::lift(program, stored_slots(program, packed))) {
  if (!system_) return;
  assembly_.emplace(*system_, program, packed.number);
  for (std::uint32_t column = 0; column < system_->size; ++column) {
    const Slot number = packed.number[system_->slot_of_column[column]];
    cell_of_column_.push_back(number != no_slot ? number : static_cast<std::uint32_t>(stride + column));
  }
  product_.emplace(*system_);
  entries_.resize(system_->entries.size());
  residual_.resize(program.unknowns);
  cells_.assign(stride + system_->size, 0.0);
  change_ = cells_;
}

void LiftedSolve::set_constants(const Memory& memory) {
  if (assembly_) assembly_->set_constants(memory.constants.data());
}

bool LiftedSolve::choose_pivots(const Memory& memory) {
  if (!is_finite(entries_)) return false;
  std::vector<std::vector<double>> samples{entries_};
  const double t = program_.time == no_slot ? 0 : memory.row(0)[memory.program.time];
  for (auto& sample : sampled_entries(program_, *system_, memory.constants, t, {memory.row(0), program_.freedoms},
                                      {memory.row(1), program_.freedoms}))
    samples.push_back(std::move(sample));
  const auto pivots = sparse::eliminate(*system_, samples, {});
  if (!pivots) return false;
  solver_.emplace(*system_, *pivots, cell_of_column_);
  // What the full matrix costs: its solution, and the tangents in the direction of that.
  if (solver_->solve_products() < program_.unknowns * program_.unknowns + system_->edges.size()) {
    make_code();
    return true;
  }
  drop_solver();
  system_.reset();
  return false;
}

// ------------------------------------------------------------------------------------------------------------------ machine code

void LiftedSolve::compile(const CompileOptions& options) {
  options_ = options;
  if (solver_) make_code();
}

/// The code belongs to the pivots of this solver alone.
void LiftedSolve::make_code() {
  code_ = {};
  if (!options_) return;
  std::vector<std::uint32_t> wanted;
  for (std::uint32_t column = 0; column < system_->size; ++column)
    if (system_->wanted[column]) wanted.push_back(cell_of_column_[column]);
  std::vector<straight::StraightLine> lines{solver_->written_solve(wanted)};
  if (options_->long_run) lines.push_back(solver_->written_factor(least_sound_pivot));
  for (const straight::StraightLine& line : lines) scratch_.resize(std::max(scratch_.size(), straight::scratch_size(line)));
  std::tie(code_, report_) = straight::compile(lines, *options_);
}

void LiftedSolve::drop_solver() {
  solver_.reset();
  code_ = {};
  report_.reset();
}

void LiftedSolve::run_solve(std::span<const double> b, double* x) {
  if (code_) code_(0, solver_->factors(), solver_->inverse_pivots(), b.data(), x, scratch_.data());
  else solver_->solve(b, x);
}

/// Code tells no more of pivots than whether they are sound.
void LiftedSolve::run_factor() {
  if (!code_ || !options_->long_run) {
    least_pivot_ = solver_->factor(entries_);
    return;
  }
  code_(1, entries_.data(), solver_->usual_sizes(), solver_->factors(), solver_->inverse_pivots(), scratch_.data());
  least_pivot_ = straight::sound(scratch_.data()) ? 1 : 0;
}

/// Other pivots may do better; they are chosen anew, less and less often.
bool LiftedSolve::fail() {
  if (is_power_of_two(++failures_)) drop_solver();
  return false;
}

bool LiftedSolve::factor(const Memory& memory) {
  if (!system_ || (!solver_ && !is_power_of_two(failures_))) return fail();
  (*assembly_)(memory.row(0), entries_);
  if (!solver_ && !choose_pivots(memory)) return fail();
  run_factor();
  refines_ = false;
  return least_pivot_ > least_sound_pivot || fail();
}

double LiftedSolve::remainder(std::span<const double> b) {
  return product_->remainder(entries_, {cells_.data(), b.size()}, b, residual_, cells_.data(), cell_of_column_, stored_);
}

/// The solution for what is left of b.
void LiftedSolve::add_correction() {
  run_solve(residual_, change_.data());
  for (std::size_t i = 0; i < stored_; ++i) cells_[i] += change_[i];
}

bool LiftedSolve::solve_first(std::span<double> b) {
  run_solve(b, cells_.data());
  const double left = remainder(b);
  if (!(left <= tolerable)) return fail();
  refines_ = left > sound;
  if (refines_) {
    add_correction();
    if (!(remainder(b) <= corrected)) return fail();
  }
  std::copy_n(cells_.begin(), b.size(), b.begin());
  return true;
}

void LiftedSolve::solve(std::span<double> b) {
  run_solve(b, cells_.data());
  if (refines_) {
    remainder(b);
    add_correction();
  }
  std::copy_n(cells_.begin(), b.size(), b.begin());
}

}  // namespace maupertuis::interpreter

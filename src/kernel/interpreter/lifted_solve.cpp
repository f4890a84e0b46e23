#include "kernel/interpreter/lifted_solve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

namespace maupertuis::interpreter {
namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

/// A pivot that lost more than this to cancellation, or is so much smaller than where pivots were chosen: the full matrix decides.
constexpr double least_sound_pivot = 1e-7;
/// What a solution may leave of b, in units of the error bound of that remainder: without a correction, with one, and after it.
constexpr double sound = 16, tolerable = 1e6, corrected = 16;
/// States at which pivots are judged, besides the one at hand.
constexpr int generic_states = 3, special_states = 12;

bool is_power_of_two(int x) { return (x & (x - 1)) == 0; }

bool is_finite(std::span<const double> values) {
  double check = 0;
  for (const double x : values) check += x * 0;
  return check == 0;
}

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
  order_rows();
  entries_.resize(system_->entries.size());
  z_.resize(system_->size);
  residual_.resize(program.unknowns);
  cells_.assign(stride + system_->size, 0.0);
  change_ = cells_;
}

/// The tangents slot by slot, then what is b.
void LiftedSolve::order_rows() {
  const std::size_t n = system_->size;
  std::vector<std::vector<std::uint32_t>> entries(n);
  for (std::uint32_t e = 0; e < system_->entries.size(); ++e) entries[system_->entries[e].row].push_back(e);
  std::vector<std::uint32_t> column(n, none), residual(n, none);
  for (const std::uint32_t e : system_->minus_one) {
    column[system_->entries[e].row] = system_->entries[e].column;
    std::erase(entries[system_->entries[e].row], e);
  }
  for (std::uint32_t i = 0; i < system_->row_of_residual.size(); ++i) residual[system_->row_of_residual[i]] = i;
  std::vector<std::uint32_t> order;
  for (const std::uint32_t row : system_->rows_of_slots) if (residual[row] == none) order.push_back(row);
  order.insert(order.end(), system_->row_of_residual.begin(), system_->row_of_residual.end());
  for (const std::uint32_t row : order) {
    const auto first = static_cast<std::uint32_t>(row_entries_.size());
    for (const std::uint32_t e : entries[row]) row_entries_.push_back({e, system_->entries[e].column});
    rows_.push_back({column[row], residual[row], first, static_cast<std::uint32_t>(row_entries_.size())});
  }
}

void LiftedSolve::set_constants(const Memory& memory) {
  if (assembly_) assembly_->set_constants(memory.constants.data());
}

/// Angles anywhere, lengths up to twice as long, other velocities. Special states hold multiples of a right angle, where a sine or
/// cosine vanishes that a pivot must not depend on.
void LiftedSolve::set_random_state(Memory& memory, const Memory& around, int state) const {
  std::mt19937 random(static_cast<unsigned>(20 + state));
  const auto uniform = [&] { return static_cast<double>(random()) / 2147483648.0 - 1; };
  set_leaves(memory, program_.time == no_slot ? 0 : around.row(0)[around.program.time], 1 - program_.first_stage);
  for (int k = 0; k < 3; ++k) {
    std::fill_n(memory.row(k), program_.unknowns, 0.0);
    for (std::size_t i = 0; k < 2 && i < program_.freedoms; ++i) {
      const double now = around.row(k)[i];
      const double generic = now * (1 + 0.5 * uniform()) + (now == 0 || state > 0 ? 3 * uniform() : 0);
      const double special = std::floor(2 * uniform()) * (std::numbers::pi / 2);
      memory.row(k)[i] = k == 0 && state >= generic_states && uniform() < 0.5 ? special : generic;
    }
  }
  for (int stage = program_.first_stage; stage <= 0; ++stage) run_section(memory, Dynamics, stage);
}

std::vector<std::vector<double>> LiftedSolve::sampled_entries(const Memory& memory) const {
  std::vector<std::vector<double>> samples{entries_};
  Memory sample(program_, 1 - program_.first_stage, program_.slots);
  std::copy_n(memory.constants.begin(), sample.constants.size(), sample.constants.begin());
  prepare_terms(sample);
  std::vector<Slot> same(program_.slots);
  std::iota(same.begin(), same.end(), Slot{0});
  sparse::Assembly assembly(*system_, program_, same);
  assembly.set_constants(sample.constants.data());
  for (int state = 0; state < generic_states + special_states; ++state) {
    set_random_state(sample, memory, state);
    std::vector<double> entries(entries_.size());
    assembly(sample.row(0), entries);
    if (is_finite(entries)) samples.push_back(std::move(entries));
  }
  return samples;
}

bool LiftedSolve::choose_pivots(const Memory& memory) {
  if (!is_finite(entries_)) return false;
  const auto pivots = sparse::eliminate(*system_, sampled_entries(memory), {});
  if (!pivots) return false;
  solver_.emplace(*system_, *pivots, cell_of_column_);
  // What the full matrix costs: its solution, and the tangents in the direction of that.
  if (solver_->solve_products() < program_.unknowns * program_.unknowns + system_->edges.size()) return true;
  solver_.reset();
  system_.reset();
  return false;
}

/// Other pivots may do better; they are chosen anew, less and less often.
bool LiftedSolve::fail() {
  if (is_power_of_two(++failures_)) solver_.reset();
  return false;
}

bool LiftedSolve::factor(const Memory& memory) {
  if (!system_ || (!solver_ && !is_power_of_two(failures_))) return fail();
  (*assembly_)(memory.row(0), entries_);
  if (!solver_ && !choose_pivots(memory)) return fail();
  least_pivot_ = solver_->factor(entries_);
  refines_ = false;
  return least_pivot_ > least_sound_pivot || fail();
}

/// residual_ = b − M₀ x. Returns its largest part in units of a bound of the rounding errors with which it was computed (running error
/// analysis: N. J. Higham, Accuracy and Stability of Numerical Algorithms, §3.3). Below 1 the solution cannot be told from an exact one.
double LiftedSolve::remainder(std::span<const double> b) {
  constexpr double unit = std::numeric_limits<double>::epsilon() / 2;
  for (std::size_t i = 0; i < b.size(); ++i) z_[i] = {cells_[i], 0};
  double worst = 0;
  for (const Row& row : rows_) {
    double sum = 0, size = 0, error = 0;
    for (std::uint32_t k = row.first; k < row.last; ++k) {
      const double factor = entries_[row_entries_[k].entry];
      const WithError& z = z_[row_entries_[k].column];
      sum += factor * z.value;
      size += std::abs(factor * z.value);
      error += std::abs(factor) * z.error;
    }
    error += unit * size;
    double left = 0;
    if (row.residual == none) {
      z_[row.column] = {sum, error};
      if (cell_of_column_[row.column] < stored_) left = cells_[cell_of_column_[row.column]] - sum;
    } else {
      left = residual_[row.residual] = b[row.residual] - sum;
    }
    if (!(std::abs(left) <= worst * error)) worst = std::abs(left) / error;
  }
  return worst;
}

/// The solution for what is left of b.
void LiftedSolve::add_correction() {
  solver_->solve(residual_, change_.data());
  for (std::size_t i = 0; i < stored_; ++i) cells_[i] += change_[i];
}

bool LiftedSolve::solve_first(std::span<double> b) {
  solver_->solve(b, cells_.data());
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
  solver_->solve(b, cells_.data());
  if (refines_) {
    remainder(b);
    add_correction();
  }
  std::copy_n(cells_.begin(), b.size(), b.begin());
}

}  // namespace maupertuis::interpreter

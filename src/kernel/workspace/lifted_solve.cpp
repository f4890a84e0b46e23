#include "kernel/workspace/lifted_solve.hpp"

#include "kernel/packed/code.hpp"
#include "kernel/packed/engine.hpp"
#include "kernel/reference/sampled_states.hpp"
#include "kernel/straight_line/widen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace maupertuis::workspace {
namespace {

/// A pivot that lost more than this to cancellation, or is so much smaller than where pivots were chosen: the full
/// matrix decides.
constexpr double least_sound_pivot = 1e-7;
/// What a solution may leave of b, in units of the error bound of that remainder: without a correction, with one, and
/// after it.
constexpr double sound = 16, tolerable = 1e6, corrected = 16;
bool is_power_of_two(int x) { return (x & (x - 1)) == 0; }

std::vector<bool> stored_slots(const Program& program, const packed::PackedProgram& packed) {
  std::vector<bool> stored(program.slots, false);
  for (Slot slot = 0; slot < program.slots; ++slot) stored[slot] = packed.number[slot] < packed.program.stored_end[2];
  return stored;
}

}  // namespace

LiftedSolve::LiftedSolve(const Program& program, const sparse::Strip& strip, const packed::PackedProgram& packed,
                         std::size_t stride)
    : program_(program), strip_(strip), system_(sparse::lift(program, stored_slots(program, packed))) {
  if (!system_) return;
  assembly_.emplace(*system_, program, packed.number);
  places_.emplace(*system_, packed, stride);
  product_.emplace(*system_);
  entries_.resize(system_->entries.size());
  residual_.resize(program.unknowns);
  cells_.assign(stride + system_->size, 0.0);
  row_.assign(stride, 0.0);
  change_ = cells_;
}

void LiftedSolve::set_constants(const Memory& memory) {
  if (assembly_) assembly_->set_constants(memory.constants.data(), entries_);
}

bool LiftedSolve::choose_pivots(const Memory& memory) {
  assemble(memory);
  if (!reference::is_finite(entries_)) return false;
  std::vector<std::vector<double>> samples{entries_};
  const double t = program_.time == no_slot ? 0 : memory.row(0)[memory.program.time];
  for (auto& sample :
       reference::sampled_entries(program_, *system_, memory.constants, t, {memory.row(0), program_.freedoms},
                                  {memory.row(1), program_.freedoms}))
    samples.push_back(std::move(sample));
  const auto pivots = sparse::eliminate(*system_, samples, {});
  if (!pivots) return false;
  if (code_.options() && !parts_failed_ && program_.unknowns > packed::most_by_inverse &&
      choose_parts(samples, *pivots))
    return true;
  solver_.emplace(*system_, *pivots, places_->cell_of_column);
  // What the full matrix costs: its solution, and the tangents in the direction of that.
  if (solver_->solve_products() < program_.unknowns * program_.unknowns + system_->edges.size()) {
    make_code(samples[1]);
    return true;
  }
  drop_solver();
  system_.reset();
  return false;
}

// -------------------------------------------------------------------------------------------------------- machine code

/// With pivots for code, from the next factorization on.
void LiftedSolve::compile(const CompileOptions& options) {
  code_.ask(options);
  drop_solver();
}

/// The code belongs to the pivots of this solver alone.
bool LiftedSolve::make_code(std::span<const double> sample) {
  if (!code_.options()) return false;
  std::vector<straight::StraightLine> lines{solver_->written_solve({places_->wanted(*system_), places_->residual})};
  if (code_.options()->long_run) {
    code_.factor_line = lines.size();
    lines.push_back(solver_->written_factor(entries_in_line(), least_sound_pivot));
  }
  if (program_.unknowns <= packed::most_by_inverse && is_symmetric(sample)) {
    code_.columns_line = lines.size();
    lines.push_back(columns());
  }
  return code_.compile(lines);
}

/// From the first two arrays of a line: values at order 0 and constants.
sparse::EntryWriter LiftedSolve::entries_in_line() const {
  using straight::Builder;
  const auto constant = [this](Builder& to, ConstantId id) {
    const Constant& c = program_.constants[id];
    return c.kind == Kind::Number ? to.literal(c.value) : to.given(sparse::ConstantArray, id);
  };
  // the first term whose condition holds is taken, the last one if none does
  const auto choice = [this](Builder& to, std::uint32_t index) {
    const sparse::Edge& edge = system_->edges[index];
    straight::Value out = to.literal(edge.index + 1 == edge.y);
    for (std::uint32_t t = edge.y - 1; t-- > edge.x;)
      out = to.choose(to.given(sparse::ConstantArray, program_.terms[t].coefficient), to.literal(t == edge.index), out);
    return out;
  };
  return {*system_,
          {.value = [this](Builder& to, Slot slot) { return to.given(sparse::NowArray, places_->number[slot]); },
           .constant = constant,
           .choice = choice}};
}

/// Of M₀⁻¹ at a sampled state, where the pattern of M₀ allows it.
bool LiftedSolve::is_symmetric(std::span<const double> sample) {
  if (!sparse::has_symmetric_pattern(program_)) return false;
  constexpr double tolerance = 1e-6;
  const std::size_t n = program_.unknowns;
  solver_->factor(sample);
  std::vector<double> inverse, unit(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    unit[i] = 1;
    solver_->solve(unit, change_.data());
    unit[i] = 0;
    inverse.insert(inverse.end(), change_.begin(), change_.begin() + static_cast<std::ptrdiff_t>(n));
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!(std::abs(inverse[i * n + j] - inverse[j * n + i]) <=
            tolerance * std::sqrt(std::abs(inverse[i * n + i] * inverse[j * n + j]))))
        return false;
  return true;
}

/// All columns of −M₀⁻¹, eight side by side. A coordinate's column has the rows of those that are eliminated after it,
/// by eights, since these do not wait for the others; the rest is its mirror image.
straight::StraightLine LiftedSolve::columns() {
  using packed::lanes;
  const std::uint32_t n = static_cast<std::uint32_t>(program_.unknowns),
                      eights = static_cast<std::uint32_t>(packed::padded(n) / lanes);
  const std::vector<std::uint32_t> order = solver_->order_of_columns();
  const auto turn = [&](std::size_t eight) {  // the middle of their turns, no two alike
    double sum = 0, count = 0;
    for (std::size_t i = eight * lanes; i < std::min<std::size_t>(n, (eight + 1) * lanes); ++i)
      sum += order[i], ++count;
    return std::pair(sum / count, eight);
  };
  code_.mirrored.assign(eights, {});
  std::vector<sparse::SparseSolver::RightSide> sides(eights);
  for (std::uint32_t eight = 0; eight < eights; ++eight) {
    sides[eight].places.assign(n, sparse::no_place);
    for (std::uint32_t i = eight * lanes; i < std::min(n, (eight + 1) * lanes); ++i)
      sides[eight].places[i] = i - eight * lanes;
    for (std::uint32_t i = 0; i < n; ++i)
      if (turn(i / lanes) >= turn(eight)) sides[eight].wanted.push_back({i, i * eights + eight});
    for (std::size_t other = 0; other < eights; ++other)
      if (turn(other) > turn(eight)) code_.mirrored[eight].push_back(other);
  }
  return straight::in_columns(solver_->written_columns(entries_in_line(), sides), sparse::UnitArray,
                              sparse::ColumnArray, lanes);
}

bool LiftedSolve::negative_inverse(const Memory& memory, double* inverse) {
  using packed::lanes;
  if (code_.columns_line == 0) return false;
  alignas(64) static constexpr auto units = [] {
    std::array<double, lanes * lanes> out{};
    for (std::size_t i = 0; i < lanes; ++i) out[i * lanes + i] = -1;
    return out;
  }();
  code_.run(code_.columns_line, memory.row(0), memory.constants.data(), units.data(), inverse);
  const std::size_t padded = packed::padded(program_.unknowns);
  for (std::size_t eight = 0; eight < code_.mirrored.size(); ++eight)
    for (const std::size_t other : code_.mirrored[eight])
      packed::engine().transpose(inverse + other * lanes * padded + eight * lanes, padded,
                                 inverse + eight * lanes * padded + other * lanes, padded);
  return true;
}

/// Parts that are alike, a lane of a vector each. Their factors are code too, in an order of its own.
bool LiftedSolve::choose_parts(const std::vector<std::vector<double>>& samples,
                               const std::vector<sparse::Pivot>& pivots) {
  const std::uint32_t first = sparse::nearest_coordinates(*system_)[pivots.front().column];
  Parts parts = strip_.parts;
  if (!parts.empty() && strip_.ends_at(first))
    for (auto& part : parts) std::reverse(part.begin(), part.end());
  return try_parts(samples, parts) || try_parts(samples, sparse::cut_into_parts(*system_, first));
}

bool LiftedSolve::try_parts(const std::vector<std::vector<double>>& samples, const Parts& parts) {
  using straight::Places;
  if (parts.empty()) return false;
  const auto chosen = sparse::eliminate(*system_, samples, {}, parts);
  if (!chosen) return false;
  solver_.emplace(*system_, *chosen, places_->cell_of_column);
  Places factors(solver_->factor_count()), inverse(chosen->size());
  auto solve = straight::widen(solver_->written_solve({places_->wanted(*system_), places_->residual}),
                               {{sparse::FactorArray, &factors}, {sparse::InverseArray, &inverse}}, {});
  auto factor = straight::widen(solver_->written_factor(entries_in_line(), least_sound_pivot), {},
                                {{sparse::FactorOutArray, &factors}, {sparse::FactorInverseArray, &inverse}});
  code_.factor_line = 1;
  in_parts_ = solve && factor && code_.compile({std::move(*solve), std::move(*factor)});
  if (!in_parts_) drop_solver();
  return in_parts_;
}

void LiftedSolve::drop_solver() {
  solver_.reset();
  code_.drop();
  in_parts_ = false;
}

void LiftedSolve::run_solve(std::span<const double> b, double* x) {
  if (!code_) return solver_->solve(b, x);
  for (std::size_t i = 0; i < b.size(); ++i) row_[places_->residual[i]] = b[i];
  code_.run(0, solver_->factors(), solver_->inverse_pivots(), row_.data(), x);
}

const double* LiftedSolve::solve_row(const double* row) {
  if (code_)
    code_.run(0, solver_->factors(), solver_->inverse_pivots(), row, cells_.data());
  else
    solver_->solve(row, places_->residual, cells_.data());
  return cells_.data();
}

/// Code tells no more of pivots than whether they are sound.
void LiftedSolve::run_factor(const Memory& memory) {
  if (code_.factor_line == 0) {
    assemble(memory);
    least_pivot_ = solver_->factor(entries_);
    return;
  }
  code_.run(code_.factor_line, memory.row(0), memory.constants.data(), solver_->usual_sizes(), solver_->factors(),
            solver_->inverse_pivots());
  least_pivot_ = code_.is_sound() ? 1 : 0;
}

void LiftedSolve::assemble(const Memory& memory) {
  if (!std::exchange(has_entries_, true)) (*assembly_)(memory.row(0), entries_);
}

/// Other pivots may do better; they are chosen anew, less and less often.
bool LiftedSolve::fail() {
  parts_failed_ = parts_failed_ || in_parts_;
  if (is_power_of_two(++failures_)) drop_solver();
  return false;
}

bool LiftedSolve::has_pivots(const Memory& memory) {
  has_entries_ = false;
  if (!system_) return fail();
  return solver_ || (is_power_of_two(failures_) && choose_pivots(memory)) || fail();
}

bool LiftedSolve::factor(const Memory& memory) {
  run_factor(memory);
  refines_ = false;
  return least_pivot_ > least_sound_pivot || fail();
}

double LiftedSolve::remainder(std::span<const double> b) {
  return product_->remainder(entries_, {cells_.data(), b.size()}, b, residual_, cells_.data(), places_->cell_of_column,
                             in_parts_ ? 0 : places_->stored);
}

/// The solution for what is left of b.
void LiftedSolve::add_correction() {
  run_solve(residual_, change_.data());
  for (std::size_t i = 0; i < places_->stored; ++i) cells_[i] += change_[i];
}

bool LiftedSolve::solve_first(const Memory& memory, std::span<double> b) {
  assemble(memory);
  run_solve(b, cells_.data());
  const double left = remainder(b);
  if (!(left <= tolerable)) return fail();
  refines_ = left > sound && !in_parts_;
  if (left > sound || in_parts_) add_correction();
  if (left > sound && !(remainder(b) <= corrected)) return fail();
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

}  // namespace maupertuis::workspace

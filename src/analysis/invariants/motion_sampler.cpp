#include "analysis/invariants/motion_sampler.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/jacobian.hpp>
#include <maupertuis/transform.hpp>

#include "symbolic/evaluate/normalize.hpp"

#include <algorithm>
#include <functional>

namespace maupertuis::invariants {

using evaluation::mix;

ExprVector in_state_variables(const MechanicalSystem& system, const ExprVector& v) {
  return in_terms_of_motion(system, expand_time_derivatives(v));
}

namespace {

/// ∂rows/∂symbols, entry by entry.
ExprMatrix slopes_of(const ExprVector& rows, const ExprVector& symbols, Context& context) {
  ExprMatrix out{rows.size(), symbols.size(), ExprVector(rows.size() * symbols.size(), context.number(0))};
  for (const auto& [row, column, value] : jacobian(rows, symbols)) out.entries[row * symbols.size() + column] = value;
  return out;
}

/// Of a degenerate Lagrangian some rows are none of Lagrange's: M and Aᵀ are what the rows say. A row that sets a free
/// acceleration to zero gives it a symbol instead, which is drawn anew at each point.
void take_rows_as_they_are(const EquationsOfMotion& equations, MotionRows& rows) {
  const MechanicalSystem& system = *equations.system;
  Context& context = *system.context;
  const ExprVector balance = in_state_variables(system, equations.balance());
  ExprVector accelerations;
  for (const Coordinate& c : system.coordinates) accelerations.push_back(c.acceleration);
  rows.mass = slopes_of(balance, accelerations, context);
  rows.reaction = slopes_of(balance, equations.multipliers, context);
  for (Expr& entry : rows.reaction.entries) entry = -entry;
  ExprMap at_rest;
  ExprVector unknowns = accelerations;
  unknowns.insert(unknowns.end(), equations.multipliers.begin(), equations.multipliers.end());
  for (const Expr& unknown : unknowns) at_rest.emplace(unknown, context.number(0));
  rows.bias = substitute(balance, at_rest);
  for (const std::size_t f : equations.degenerate->free)
    for (std::size_t i = 0; i < balance.size(); ++i)
      if (balance[i] == accelerations[f])
        rows.bias[i] = -context.symbol("free acceleration of " + system.coordinates[f].name, Role::Auxiliary);
}

}  // namespace

MotionRows motion_rows(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  MotionRows rows{equations.system, mass_matrix(equations), bias(equations), {}, {}, {}, {}, false};
  rows.mass.entries = in_state_variables(system, rows.mass.entries);
  rows.bias = in_state_variables(system, rows.bias);
  if (equations.degenerate) take_rows_as_they_are(equations, rows);
  if (!system.constrained()) return rows;
  rows.constraint = constraint_matrix(equations);
  rows.constraint.entries = in_state_variables(system, rows.constraint.entries);
  rows.acceleration = in_state_variables(system, constraint_bias(equations));
  ExprMap at_rest;
  for (const Coordinate& c : system.coordinates) at_rest.emplace(c.velocity, system.context->number(0));
  for (const Expr& rate : substitute(in_state_variables(system, equations.constraint_rates), at_rest))
    rows.velocity.push_back(-rate);
  return rows;
}

ExprVector conservative_residual(const EquationsOfMotion& equations) {
  ExprVector q;
  for (const Coordinate& c : equations.system->coordinates) q.push_back(c.q);
  return in_state_variables(*equations.system, variational_residual(equations.lagrangian, q));
}

MotionRows conservative_rows(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  MotionRows rows{equations.system, mass_matrix(equations), {}, {}, {}, {}, {}, true};
  rows.mass.entries = in_state_variables(system, rows.mass.entries);
  ExprMap at_rest;
  for (const Coordinate& c : system.coordinates) at_rest.emplace(c.acceleration, system.context->number(0));
  rows.bias = substitute(conservative_residual(equations), at_rest);
  return rows;
}

bool is_nonlinear_in_velocities(const EquationsOfMotion& equations) {
  if (!equations.system->constrained()) return false;
  const ExprMatrix a = constraint_matrix(equations);
  for (const Expr& s : symbols_of(expand_time_derivatives(a.entries)))
    if (s.role() == Role::Coordinate && s.order() > 0) return true;
  return false;
}

MotionSampler::MotionSampler(const MotionRows& rows, std::vector<Expr> functions, bool with_rates, std::uint64_t seed)
    : system_(rows.system),
      n_(rows.system->coordinates.size()),
      m_(rows.constraint.rows),
      functions_(functions.size()),
      with_rates_(with_rates),
      seed_(seed) {
  std::vector<Expr> roots;
  const auto append = [&](const std::vector<Expr>& more) {
    const std::size_t first = roots.size();
    roots.insert(roots.end(), more.begin(), more.end());
    return first;
  };
  functions = in_state_variables(*system_, functions);
  append(functions);
  constraint_ = append(rows.constraint.entries);
  velocity_ = append(rows.velocity);
  if (with_rates) {
    mass_ = append(rows.mass.entries);
    bias_ = append(rows.bias);
    reaction_ = append(rows.reaction.entries);
    own_reaction_ = !rows.reaction.entries.empty();
    acceleration_ = append(rows.acceleration);
    rates_ = roots.size();
    for (const Expr& f : functions) roots.push_back(total_time_derivative(f));
  }
  tape_ = std::make_unique<evaluation::Tape>(evaluation::flatten_arguments(roots));
  stale_ = std::make_unique<evaluation::StaleNodes>(*tape_);
  hints_ = evaluation::field_hints(*tape_);
  find_orders();
  for (const Parameter& p : system_->parameters) parameters_.push_back(p.symbol);
  seed_ = mix(seed_);
  numbers_ = std::make_unique<GivenNumbers>(evaluation::agreeing_primes(hints_, seed_), hints_, seed_);
}

void MotionSampler::find_orders() {
  highest_order_.assign(tape_->size(), 0);
  parametric_.assign(tape_->size(), 1);
  for (evaluation::Position at = 0; at < tape_->size(); ++at) {
    const Expr e = tape_->expression(at);
    if (e.is_symbol() && e.role() == Role::Coordinate) highest_order_[at] = static_cast<std::uint8_t>(e.order());
    if (e.is_symbol()) parametric_[at] = e.role() == Role::Parameter || e.role() == Role::Constant;
    for (const evaluation::Position argument : tape_->arguments(at)) {
      highest_order_[at] = std::max(highest_order_[at], highest_order_[argument]);
      parametric_[at] &= parametric_[argument];
    }
  }
}

/// Evaluates what depends on coordinates of this order or a higher one; the rest stays.
void MotionSampler::evaluate_again(int from_order) {
  bool angles = false;
  for (evaluation::Position p = 0; p < tape_->size(); ++p)
    angles |= highest_order_[p] >= from_order &&
              (tape_->kind(p) == Kind::Sin || tape_->kind(p) == Kind::Cos || tape_->kind(p) == Kind::Tan);
  if (angles) numbers_->symbols_changed();
  evaluation::run(*tape_, *numbers_, at_, [&](evaluation::Position p) { return highest_order_[p] >= from_order; });
}

const PrimeField& MotionSampler::field() const { return numbers_->field(); }

ParameterRoots MotionSampler::draw_parameters() {
  ParameterRoots roots;
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    seed_ = mix(seed_);
    const Value x = field().from_residue(seed_ % field().prime());
    roots.push_back(field().multiply(x, x));
  }
  return roots;
}

std::optional<ParameterRoots> MotionSampler::usable_parameters() {
  for (int attempt = 0; attempt < 40; ++attempt) {
    ParameterRoots roots = draw_parameters();
    if (draw(roots)) return roots;
    if (singular_) return std::nullopt;
  }
  return std::nullopt;
}

void MotionSampler::bind_parameters(const ParameterRoots& roots) {
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    numbers_->give(parameters_[i], field().multiply(roots[i], roots[i]));
}

/// Random velocities, the dependent ones from A q̇ = a₀.
bool MotionSampler::bind_velocities() {
  const auto root = [&](std::size_t i) { return at_[tape_->roots()[i]]; };
  // Columns in reverse: the solution leaves the first coordinates free, and these are drawn.
  FieldMatrix rows(m_, n_ + 1);
  for (std::size_t i = 0; i < m_; ++i) {
    for (std::size_t j = 0; j < n_; ++j) rows.at(i, n_ - 1 - j) = root(constraint_ + i * n_ + j);
    rows.at(i, n_) = root(velocity_ + i);
  }
  std::vector<Value> drawn(n_);
  FieldMatrix shifted = rows;
  for (std::size_t j = 0; j < n_; ++j) {
    drawn[j] = numbers_->symbol(system_->coordinates[n_ - 1 - j].velocity);
    for (std::size_t i = 0; i < m_; ++i)
      shifted.at(i, n_) = field().subtract(shifted.at(i, n_), field().multiply(rows.at(i, j), drawn[j]));
  }
  const auto correction = solve(std::move(shifted), field());
  if (!correction) return false;
  for (std::size_t j = 0; j < n_; ++j)
    numbers_->give(system_->coordinates[n_ - 1 - j].velocity, field().add(drawn[j], (*correction)[j]));
  return true;
}

bool MotionSampler::bind_accelerations() {
  const auto root = [&](std::size_t i) { return at_[tape_->roots()[i]]; };
  const std::size_t size = n_ + m_;
  FieldMatrix bordered(size, size + 1);
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t j = 0; j < n_; ++j) bordered.at(i, j) = root(mass_ + i * n_ + j);
    for (std::size_t k = 0; k < m_; ++k) {
      bordered.at(i, n_ + k) =
          field().negate(own_reaction_ ? root(reaction_ + i * m_ + k) : root(constraint_ + k * n_ + i));
      bordered.at(n_ + k, i) = root(constraint_ + k * n_ + i);
    }
    bordered.at(i, size) = field().negate(root(bias_ + i));
  }
  for (std::size_t k = 0; k < m_; ++k) bordered.at(n_ + k, size) = root(acceleration_ + k);
  // Redundant constraints leave multipliers open; accelerations must not be.
  const auto solution = solve(std::move(bordered), field(), n_);
  if (!solution) return false;
  for (std::size_t i = 0; i < n_; ++i) numbers_->give(system_->coordinates[i].acceleration, (*solution)[i]);
  return true;
}

MotionSampler::Sample MotionSampler::collect() const {
  Sample sample;
  for (std::size_t i = 0; i < functions_; ++i) sample.values.push_back(at_[tape_->roots()[i]]);
  for (std::size_t i = 0; with_rates_ && i < functions_; ++i) sample.rates.push_back(at_[tape_->roots()[rates_ + i]]);
  for (const Coordinate& c : system_->coordinates) sample.velocities.push_back(numbers_->symbol(c.velocity));
  return sample;
}

std::optional<MotionSampler::Sample> MotionSampler::draw(const ParameterRoots& roots) {
  auto sample = attempt(roots);
  if (sample || !lost_in_roots_) return sample;
  numbers_->let_roots_be_free();
  return attempt(roots);
}

std::optional<MotionSampler::Sample> MotionSampler::attempt(const ParameterRoots& roots) {
  lost_in_roots_ = false;
  constexpr int attempts = 400;
  int mends = evaluation::mends_allowed(*tape_), unsolved = 0;
  bool mended = false, solved = false;  // solved: some velocities and accelerations were given values
  bind_parameters(roots);
  for (int attempt = 0; attempt < attempts && unsolved < 8; attempt += !mended) {
    interrupt_of(*system_->context).throw_if_asked();
    if (!mended) numbers_->set_seed(seed_ = mix(seed_));
    if (!mended || solved) stale_->all();
    mended = solved = false;
    for (const Coordinate& c : system_->coordinates)
      for (const Expr& symbol : {c.velocity, c.acceleration}) numbers_->take_back(symbol);
    try {
      evaluation::run(*tape_, *numbers_, at_, std::ref(*stale_));
      solved = true;
      if (m_ > 0) {
        if (!bind_velocities()) {
          ++unsolved;
          continue;
        }
        evaluate_again(1);
      }
      if (with_rates_) {
        if (!bind_accelerations()) {
          ++unsolved;
          singular_ = true;
          continue;
        }
        evaluate_again(2);
      }
      singular_ = false;
      return collect();
    } catch (const evaluation::Redraw& redraw) {
      if (redraw.at < parametric_.size() && parametric_[redraw.at]) return std::nullopt;
      mended = mends-- > 0 && stale_->mend(*numbers_, redraw);
    }
  }
  lost_in_roots_ = unsolved < 8;
  return std::nullopt;
}

}  // namespace maupertuis::invariants

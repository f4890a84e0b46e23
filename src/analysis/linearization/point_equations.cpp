#include "analysis/linearization/point_equations.hpp"

#include "analysis/linearization/free_of_time.hpp"
#include "analysis/linearization/turns.hpp"

#include <maupertuis/contact_mode.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/expression_lock.hpp>
#include <maupertuis/kinds.hpp>
#include <maupertuis/reactions.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

/// Inputs of every program here, in this order: q, v, a, λ, t, u, u', u''.
namespace maupertuis {
namespace {

/// u of all inputs, then u', then u''.
ExprVector inputs_and_rates(const MechanicalSystem& system) {
  ExprVector out;
  for (const Input& u : system.inputs) out.push_back(u.symbol);
  for (std::size_t i = 0; i < 2 * system.inputs.size(); ++i) out.push_back(system.context->time_derivative(out[i]));
  return out;
}

class Lowering {
 public:
  explicit Lowering(const EquationsOfMotion& equations) {
    const MechanicalSystem& system = *equations.system;
    coordinates_ = system.coordinates.size();
    for (const Coordinate& c : system.coordinates) inputs_.push_back(c.q);
    for (const Coordinate& c : system.coordinates) inputs_.push_back(c.velocity);
    for (const Coordinate& c : system.coordinates) inputs_.push_back(c.acceleration);
    inputs_.insert(inputs_.end(), equations.multipliers.begin(), equations.multipliers.end());
    inputs_.push_back(system.context->time());
    for (const Expr& u : inputs_and_rates(system)) inputs_.push_back(u);
    for (std::size_t i = inputs_.size() - 2 * system.inputs.size(); i < inputs_.size(); ++i)
      held_.emplace(inputs_[i], system.context->number(0));
    for (const Parameter& p : system.parameters) parameters_.push_back(p.symbol);
  }

  /// Inputs are held: their rates vanish.
  ExprVector plain(std::span<const Expr> expressions) const {
    return substitute(expand_time_derivatives(expressions), held_);
  }
  DifferentiableKernel rows(std::span<const Expr> expressions) const {
    return build_differentiable({inputs_, parameters_, expand_time_derivatives(expressions)}, 0, inputs_.size());
  }
  /// The same where nothing moves.
  DifferentiableKernel resting_rows(std::span<const Expr> expressions) const {
    ExprMap at_rest;
    const std::size_t n = coordinates_;
    for (std::size_t i = n; i < 3 * n; ++i) at_rest.emplace(inputs_[i], inputs_[i].context().number(0));
    return build_differentiable({inputs_, parameters_, substitute(plain(expressions), at_rest)}, 0, inputs_.size());
  }
  FunctionKernel function(std::span<const Expr> expressions) const {
    return build_function({inputs_, parameters_, plain(expressions)});
  }

 private:
  ExprVector inputs_, parameters_;
  ExprMap held_;
  std::size_t coordinates_ = 0;
};

ExprVector chosen(const EquationsOfMotion& equations, Constraint::Level level, bool rates) {
  ExprVector out;
  for (std::size_t i = 0; i < equations.system->constraints.size(); ++i)
    if (equations.system->constraints[i].level == level)
      out.push_back(rates ? equations.constraint_rates[i] : equations.system->constraints[i].value);
  return out;
}

/// The inputs' formulas, and those of their rates.
ExprVector formulas(const MechanicalSystem& system) { return in_terms_of_motion(system, inputs_and_rates(system)); }

/// Reactions stand for forces in q, q̇, q̈ and λ; those that the model does not determine stay symbols.
ExprVector with_reactions(const EquationsOfMotion& equations, std::span<const Expr> outputs) {
  ExprVector out(outputs.begin(), outputs.end());
  const auto is_reaction = [&](const Expr& s) {
    return s.role() == Role::Multiplier &&
           std::find(equations.multipliers.begin(), equations.multipliers.end(), s) == equations.multipliers.end();
  };
  const std::vector<Expr> symbols = symbols_of(out);
  if (std::none_of(symbols.begin(), symbols.end(), is_reaction)) return out;
  ExprMap forces;
  for (const Reaction& r : reactions(equations))
    if (r.value) forces.emplace(r.symbol, r.value);
  return substitute(out, forces);
}

/// Of the constraints that were found for a degenerate Lagrangian those that no row of these equations holds.
ExprVector kept_relations(const EquationsOfMotion& equations) {
  ExprVector out;
  if (!equations.degenerate) return out;
  const std::vector<Constraint>& held = equations.system->constraints;
  for (const FoundConstraint& found : equations.degenerate->chain.constraints)
    if (std::none_of(held.begin(), held.end(), [&](const Constraint& c) { return c.value == found.value; }))
      out.push_back(found.value);
  return out;
}

ExprVector kept_in_rest(const EquationsOfMotion& equations) {
  ExprVector out = chosen(equations, Constraint::Level::Position, false);
  for (const ExprVector& more : {chosen(equations, Constraint::Level::Velocity, true), kept_relations(equations)})
    out.insert(out.end(), more.begin(), more.end());
  return out;
}

bool switches_within(Expr e) {
  const ExprVector nodes = topological_order({&e, 1});
  return std::any_of(nodes.begin(), nodes.end(), [](const Expr& node) { return has_switch(node.kind()); });
}

/// Q(q, u) = −∂W/∂q for some W while u is held: no velocity, no time, ∂Q_i/∂q_j symmetric.
bool has_potential(const ExprVector& forces, const MechanicalSystem& system) {
  ExprVector must_vanish;
  const auto add = [&](Expr e) {
    if (!e.is_zero()) must_vanish.push_back(e);
  };
  for (std::size_t i = 0; i < forces.size(); ++i) {
    if (forces[i].is_zero()) continue;
    add(differentiate(forces[i], system.context->time()));
    for (const Coordinate& c : system.coordinates) add(differentiate(forces[i], c.velocity));
  }
  if (std::all_of(forces.begin(), forces.end(), [](Expr e) { return e.is_zero(); })) return true;
  for (std::size_t i = 0; i < forces.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      add(differentiate(forces[i], system.coordinates[j].q) - differentiate(forces[j], system.coordinates[i].q));
  return must_vanish.empty() || zero_test(must_vanish).verdict == Verdict::Zero;
}

/// ∂h_E/∂q of a Lagrangian of the first order that keeps h_E, a function of q alone: where every velocity follows from
/// q.
ExprVector slopes_of_kept_energy(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  if (system.constraints.size() != system.coordinates.size() || !equations.power.is_zero()) return {};
  for (const Constraint& c : system.constraints)
    if (!c.forceless || c.level != Constraint::Level::Velocity) return {};
  const Expr energy = Lowering(equations).plain({&equations.energy_function, 1}).front();
  ExprVector q, by_velocity;
  for (const Coordinate& c : system.coordinates) {
    q.push_back(c.q);
    by_velocity.push_back(differentiate(energy, c.velocity));
  }
  return zero_test(by_velocity).verdict == Verdict::Zero ? gradient(energy, q) : ExprVector();
}

}  // namespace

PointEquations::Impl::Impl(const EquationsOfMotion& equations, std::span<const Expr> measured)
    : system(equations.system),
      balance_rows(Lowering(equations).plain(equations.balance())),
      measured(measured.begin(), measured.end()),
      kept_rows(Lowering(equations).plain(kept_in_rest(equations))),
      momentum_rows(Lowering(equations).plain(equations.momenta)),
      n(system->coordinates.size()),
      m(system->constraints.size()),
      k(system->inputs.size()),
      holonomic(0),
      balance(Lowering(equations).rows(equations.balance())),
      positions(Lowering(equations).rows(chosen(equations, Constraint::Level::Position, false))),
      velocities(Lowering(equations).rows(chosen(equations, Constraint::Level::Velocity, true))),
      accelerations(Lowering(equations).rows(equations.constraint_accelerations)),
      momenta(Lowering(equations).rows(equations.momenta)),
      resting(Lowering(equations).resting_rows(equations.balance())),
      rates(Lowering(equations).rows(equations.constraint_rates)),
      relations(Lowering(equations).rows(kept_relations(equations))),
      outputs(Lowering(equations).rows(with_reactions(equations, measured))),
      input_formulas(Lowering(equations).function(formulas(*system))),
      inputs(input_formulas),
      energy(Lowering(equations).function({&equations.energy_function, 1})),
      energy_workspace(energy),
      friction(Lowering(equations).function(equations.dissipative_terms)),
      energy_slopes(Lowering(equations).rows(slopes_of_kept_energy(equations))) {
  for (std::size_t i = 0; i < m; ++i)
    if (system->constraints[i].level == Constraint::Level::Position) position_rows.push_back(i);
  holonomic = position_rows.size();
  for (const Expr& y : with_reactions(equations, measured)) output_switches.push_back(switches_within(y));
  for (const Parameter& p : system->parameters) parameters.push_back(p.si_value);
  set_parameters();
  const Lowering lowering(equations);
  ExprVector all = lowering.plain(equations.balance());
  for (const Constraint& c : system->constraints) all.push_back(lowering.plain({&c.value, 1}).front());
  const bool is_free_of_time = free_of_time(all, *system);
  known_autonomous = is_free_of_time;
  const std::vector<Expr> symbols = symbols_of(all);
  if (std::find(symbols.begin(), symbols.end(), system->context->time()) != symbols.end()) rows_in_time = all;
  has_energy =
      is_free_of_time && holonomic == m && has_potential(lowering.plain(equations.generalized_forces), *system);
  is_periodic.assign(n, false);
  turns_by_parameters.assign(n, false);
}

/// A drive whose amplitude is 0 is none.
bool PointEquations::Impl::is_autonomous() const {
  if (!known_autonomous) {
    const ExpressionLock lock(*system->context);
    known_autonomous = free_of_time(substitute(rows_in_time, exact_parameters(*this)), *system);
  }
  return *known_autonomous;
}

/// v·∂D/∂v; not a number where D has no value.
Power PointEquations::Impl::power_of_friction(const OperatingPoint& point) {
  std::vector<double> force(n);
  friction.evaluate(gather(point), force);
  Power out;
  for (std::size_t i = 0; i < n; ++i) out.value += force[i] * point.v[i], out.size += std::abs(force[i] * point.v[i]);
  return out;
}

void PointEquations::Impl::set_parameters() {
  for (Rows* rows : {&balance, &positions, &velocities, &accelerations, &momenta, &resting, &rates, &relations,
                     &outputs, &energy_slopes}) {
    rows->values.set_parameters(parameters);
    rows->entries.set_parameters(parameters);
  }
  inputs.set_parameters(parameters);
  energy_workspace.set_parameters(parameters);
  friction.set_parameters(parameters);
}

std::vector<double> PointEquations::Impl::gather(const OperatingPoint& point) const {
  std::vector<double> out;
  for (const auto* part : {&point.q, &point.v, &point.a, &point.multipliers})
    out.insert(out.end(), part->begin(), part->end());
  out.push_back(point.t);
  out.insert(out.end(), point.inputs.begin(), point.inputs.end());
  if (point.input_rates.empty()) out.resize(out.size() + 2 * k);
  out.insert(out.end(), point.input_rates.begin(), point.input_rates.end());
  return out;
}

Vector PointEquations::Impl::value(Rows& rows, const OperatingPoint& point) const {
  Vector out(static_cast<Index>(rows.kernel.size()));
  rows.values.evaluate(gather(point), {out.data(), rows.kernel.size()});
  return out;
}

RowsAtPoint PointEquations::Impl::at(Rows& rows, const OperatingPoint& point) const {
  const std::size_t count = rows.kernel.size();
  std::vector<double> numbers(count + rows.kernel.entries.size());
  rows.entries.evaluate(gather(point), numbers);
  const auto size = static_cast<Index>(count);
  Matrix all = Matrix::Zero(size, static_cast<Index>(3 * n + m + 1 + 3 * k));
  for (std::size_t e = 0; e < rows.kernel.entries.size(); ++e)
    all(static_cast<Index>(rows.kernel.entries[e].row), static_cast<Index>(rows.kernel.entries[e].column)) =
        numbers[count + e];
  const auto N = static_cast<Index>(n), m_ = static_cast<Index>(m), k_ = static_cast<Index>(k);
  return {to_eigen(std::vector<double>(numbers.begin(), numbers.begin() + size)),
          all.leftCols(N),
          all.middleCols(N, N),
          all.middleCols(2 * N, N),
          all.middleCols(3 * N, m_),
          all.rightCols(3 * k_)};
}

double PointEquations::Impl::energy_at(const OperatingPoint& point) {
  double out = 0;
  energy_workspace.evaluate(gather(point), {&out, 1});
  return out;
}

std::vector<double> PointEquations::Impl::inputs_and_rates_at(double t) {
  std::vector<double> at(3 * n + m + 1 + 3 * k), out(3 * k);
  at[3 * n + m] = t;
  inputs.evaluate(at, out);
  return out;
}

Bindings values_at(const PointEquations::Impl& e, const OperatingPoint& point) {
  Bindings out;
  for (std::size_t i = 0; i < e.system->parameters.size(); ++i) out[e.system->parameters[i].symbol] = e.parameters[i];
  for (std::size_t i = 0; i < e.n; ++i) {
    const Coordinate& c = e.system->coordinates[i];
    out[c.q] = point.q[i], out[c.velocity] = point.v[i], out[c.acceleration] = point.a[i];
  }
  out[e.system->context->time()] = point.t;
  for (std::size_t i = 0; i < e.system->inputs.size(); ++i) out[e.system->inputs[i].symbol] = point.inputs[i];
  for (std::size_t i = 0; i < point.multipliers.size(); ++i)
    out[e.system->constraints[i].multiplier] = point.multipliers[i];
  return out;
}

ExprMap exact_parameters(const PointEquations::Impl& e) {
  ExprMap out;
  for (std::size_t i = 0; i < e.system->parameters.size(); ++i) {
    const Parameter& p = e.system->parameters[i];
    const bool is_written = p.value && p.si_value == e.parameters[i];
    out.emplace(p.symbol, is_written ? p.value : e.system->context->number(Rational::from_double(e.parameters[i])));
  }
  return out;
}

OperatingPoint random_point(const PointEquations::Impl& e, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto numbers = [&](std::size_t count, double size) {
    std::vector<double> out(count);
    for (double& x : out) x = size * (2 * std::generate_canonical<double, 53>(random) - 1);
    return out;
  };
  OperatingPoint point{0, numbers(e.n, 1), numbers(e.n, 1), numbers(e.n, 1), numbers(e.m, 1), numbers(e.k, 1)};
  const std::vector<double> sizes = typical_sizes(*e.system, {});
  for (std::size_t i = 0; i < e.n; ++i)
    for (auto* part : {&point.q, &point.v, &point.a}) (*part)[i] *= sizes[i];
  for (std::size_t i = 0; i < e.n; ++i) point.q[i] += 0.37 * sizes[i];  // away from symmetric places
  return point;
}

std::vector<double> typical_sizes(const MechanicalSystem& system, const MotionState& start) {
  std::vector<double> out;
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    const Coordinate& c = system.coordinates[i];
    double size = 0;
    if (c.kind != "angle" && !c.dimension.same_as(Dimension{}))
      for (const Parameter& p : system.parameters)
        if (p.dimension == c.dimension) size = std::max(size, std::abs(p.si_value));
    if (size == 0 && c.kind != "angle")
      for (std::size_t j = 0; j < start.q.size(); ++j) {  // one size for all: a start may lie near zero in one of them
        const Coordinate& other = system.coordinates[j];
        if (other.kind != "angle" && other.dimension == c.dimension) size = std::max(size, std::abs(start.q[j]));
      }
    out.push_back(size > 0 ? size : 1);
  }
  return out;
}

// ------------------------------------------------------------------------------------------------------------ the
// class

namespace {

constexpr std::uint64_t states_of_friction = 32;  // at which its power is looked at
constexpr int compared_states = 3;

/// Whether R and the constraints are the same 2π further, as numbers tell it.
bool repeats(PointEquations::Impl& e, std::size_t i) {
  for (int s = 0; s < compared_states; ++s) {
    OperatingPoint here = random_point(e, 1744 + static_cast<std::uint64_t>(s)), there = here;
    there.q[i] += 2 * std::numbers::pi;
    for (auto* rows : {&e.balance, &e.positions, &e.velocities}) {
      const Vector a = e.value(*rows, here), b = e.value(*rows, there);
      if (!a.allFinite() || (a - b).size() == 0) continue;
      if (!((a - b).lpNorm<Eigen::Infinity>() <= 1e-10 * (1e-300 + a.lpNorm<Eigen::Infinity>()))) return false;
    }
  }
  return true;
}

/// Numbers first: they refute most.
void find_turns_by_parameters(PointEquations::Impl& e) {
  for (std::size_t i = 0; i < e.n; ++i)
    if (e.turns_by_parameters[i]) e.is_periodic[i] = repeats(e, i) && repeats_each_turn(e, i, exact_parameters(e));
}

}  // namespace

PointEquations::PointEquations(const EquationsOfMotion& equations, std::span<const Expr> outputs) {
  check_one_mode(*equations.system, "PointEquations");
  const ExpressionLock lock(*equations.system->context);
  impl_ = std::make_unique<Impl>(equations, outputs);
  for (std::size_t i = 0; i < impl_->n; ++i) {
    if (impl_->system->coordinates[i].kind != "angle" && !impl_->system->dimensionless) continue;
    impl_->is_periodic[i] = repeats(*impl_, i) && repeats_each_turn(*impl_, i, {});
    impl_->turns_by_parameters[i] = !impl_->is_periodic[i];
  }
  find_turns_by_parameters(*impl_);
}
PointEquations::~PointEquations() = default;
PointEquations::PointEquations(PointEquations&&) noexcept = default;

const MechanicalSystem& PointEquations::system() const { return *impl_->system; }
bool PointEquations::autonomous() const { return impl_->is_autonomous(); }
bool PointEquations::energy_never_grows() const {
  if (!impl_->has_energy) return false;
  for (std::uint64_t s = 0; s < states_of_friction; ++s)
    if (impl_->power_of_friction(random_point(*impl_, 31 + s)).is_given()) return false;
  return true;
}

/// At all distances: what pumps within some distance of the point alone keeps a motion from coming to rest there.
bool PointEquations::energy_never_grows_near(const OperatingPoint& point) const {
  if (!impl_->has_energy) return false;
  constexpr double farthest = 0.1, nearest = 1e-8, step = 0.3;  // of the sizes of coordinates
  std::uint64_t seed = 31;
  bool has_value = false;
  for (double size = farthest; size > nearest; size *= step) {
    has_value = false;
    for (std::uint64_t s = 0; s < states_of_friction; ++s) {
      const OperatingPoint away = random_point(*impl_, seed++);
      OperatingPoint near = point;
      for (std::size_t i = 0; i < impl_->n; ++i) near.q[i] += size * away.q[i], near.v[i] += size * away.v[i];
      const Power power = impl_->power_of_friction(near);
      if (power.is_given()) return false;
      has_value = has_value || std::isfinite(power.value);
    }
  }
  return has_value;
}

const std::vector<bool>& PointEquations::periodic() const { return impl_->is_periodic; }
double PointEquations::parameter(std::size_t index) const { return impl_->parameters[index]; }

void PointEquations::set_parameter(std::size_t index, double value) {
  const ExpressionLock lock(*impl_->system->context);
  impl_->parameters[index] = value;
  impl_->set_parameters();
  find_turns_by_parameters(*impl_);
  if (!impl_->rows_in_time.empty()) impl_->known_autonomous.reset();
}

std::vector<double> PointEquations::inputs_at(double t) const {
  std::vector<double> out = impl_->inputs_and_rates_at(t);
  out.resize(impl_->k);
  return out;
}

}  // namespace maupertuis

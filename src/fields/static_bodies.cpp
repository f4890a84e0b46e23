#include "fields/static_bodies.hpp"

#include <maupertuis/coupled_fields.hpp>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace maupertuis {
namespace {

Expr at_rest(const MechanicalSystem& system, Expr e) {
  ExprMap still;
  for (const Input& input : system.inputs)
    if (input.formula) still[input.symbol] = input.formula;
  e = substitute(expand_time_derivatives(e), still);
  still.clear();
  for (const Coordinate& c : system.coordinates) still[c.velocity] = still[c.acceleration] = system.context->number(0);
  return substitute(e, still);
}

}  // namespace

/// Coordinates on which nothing depends may keep a velocity; such a motion is no rest.
std::string StaticBodies::read_start(const FieldEquations& equations) {
  const MechanicalSystem& system = *equations.bodies->system;
  start_ = Eigen::VectorXd::Zero(size());
  for (const StartValue& v : equations.body_start) {
    if (v.coordinate >= system.coordinates.size()) continue;
    const double value = evaluate(equations.system().expanded(v.value), values_);
    if (v.order == 0) start_(static_cast<Eigen::Index>(v.coordinate)) = value;
    if (v.order != 1 || value == 0) continue;
    const Expr q = system.coordinates[v.coordinate].q;
    const bool free_to_turn =
        std::all_of(equations.bodies->residual.begin(), equations.bodies->residual.end(), [&](const Expr& row) {
          return zero_test(differentiate(expand_time_derivatives(row), q)).verdict == Verdict::Zero;
        });
    if (free_to_turn) return "A body turns steadily, so that its bodies do not rest.";
  }
  return start_.allFinite() ? "" : "The start of its bodies has no value.";
}

std::string StaticBodies::read(const FieldEquations& equations) {
  equations_ = &equations;
  if (!equations.bodies) return "";
  const EquationsOfMotion& bodies = *equations.bodies;
  const MechanicalSystem& system = *bodies.system;
  for (const Parameter& p : equations.model->parameters) values_[p.symbol] = p.si_value;
  for (const Parameter& p : system.parameters) values_[p.symbol] = p.si_value;
  for (const Coordinate& c : system.coordinates) q_.push_back(c.q);
  std::vector<Expr> rows;
  for (std::size_t i = 0; i < bodies.residual.size(); ++i)
    rows.push_back(-at_rest(system, bodies.residual[i] - bodies.dissipative_terms[i]));
  for (const Constraint& c : system.constraints) {
    if (c.level == Constraint::Level::Velocity)
      return "A constraint of its bodies is one of velocities, which holds them wherever they are.";
    lambda_.push_back(c.multiplier);
    const Expr value = at_rest(system, c.value);
    for (std::size_t i = 0; i < q_.size(); ++i) rows[i] = rows[i] + c.multiplier * differentiate(value, q_[i]);
    rows.push_back(value);
  }
  roots_ = {-at_rest(system, bodies.lagrangian_expanded)};
  roots_.insert(roots_.end(), rows.begin(), rows.end());
  std::vector<Expr> unknowns = q_;
  unknowns.insert(unknowns.end(), lambda_.begin(), lambda_.end());
  for (const Expr& row : rows)
    for (const Expr& z : unknowns) roots_.push_back(differentiate(row, z));
  for (std::size_t i = 0; i < 1 + rows.size(); ++i) {
    const Expr e = roots_[i];
    ExprMap fixed;
    for (const Expr& z : unknowns) fixed[z] = system.context->number(Rational(618034, 1000000));
    if (system.context->depends_on_time(substitute(e, fixed).id()))
      return "Its bodies are driven, so that they have no rest.";
    for (const Expr& symbol : symbols_of({&e, 1}))
      if (!values_.count(symbol) && std::find(unknowns.begin(), unknowns.end(), symbol) == unknowns.end())
        return "A force on its bodies has no value at rest.";
  }
  const SpaceVariable& x = equations.system().space.front();
  const double length = std::abs(evaluate(equations.system().expanded(x.to), values_) -
                                 evaluate(equations.system().expanded(x.from), values_));
  for (const Coordinate& c : system.coordinates)
    least_scale_.push_back(c.dimension.same_as(x.dimension) ? length : c.dimension.same_as(Dimension{}) ? 1 : 0);
  evaluated_.emplace(roots_);
  return read_start(equations);
}

double StaticBodies::scale(Eigen::Index coordinate, double value) const {
  return std::max({std::abs(value), std::abs(start_(coordinate)), least_scale_[static_cast<std::size_t>(coordinate)]});
}

StaticBodies::Values StaticBodies::at(const Eigen::VectorXd& z) const {
  std::unordered_map<Expr, double, ExprHash> unknowns;
  for (Eigen::Index i = 0; i < size(); ++i)
    unknowns[i < coordinates() ? q_[static_cast<std::size_t>(i)]
                               : lambda_[static_cast<std::size_t>(i - coordinates())]] = z(i);
  const std::vector<double> v = (*evaluated_)([&](Expr symbol) {
    const auto found = unknowns.find(symbol);
    return found != unknowns.end() ? found->second : values_.at(symbol);
  });
  Values out;
  out.energy = v[0];
  out.force.resize(size());
  out.slopes.resize(size(), size());
  std::size_t next = 1;
  for (Eigen::Index i = 0; i < size(); ++i) out.force(i) = v[next++];
  for (Eigen::Index i = 0; i < size(); ++i)
    for (Eigen::Index j = 0; j < size(); ++j) out.slopes(i, j) = v[next++];
  return out;
}

std::optional<std::string> StaticBodies::contact_passed(const Eigen::VectorXd& z) const {
  if (!equations_->bodies) return std::nullopt;
  const MechanicalSystem& system = *equations_->bodies->system;
  Bindings at = values_;
  for (Eigen::Index i = 0; i < coordinates(); ++i) at[q_[static_cast<std::size_t>(i)]] = z(i);
  at[system.context->time()] = 0;
  for (std::size_t k = 0; k < system.contacts.size(); ++k)
    if (evaluate(at_rest(system, as_constraint(system.contacts[k]).value), at) < 0) return system.contact_label(k);
  return std::nullopt;
}

}  // namespace maupertuis

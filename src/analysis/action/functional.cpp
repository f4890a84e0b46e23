#include "analysis/action/functional.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/size_of_terms.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace maupertuis::action {
namespace {

ExprVector plain(const MechanicalSystem& system, std::span<const Expr> expressions) {
  return expand_time_derivatives(in_terms_of_motion(system, expressions));
}

/// The upper triangle of ∂²f/∂x∂x, without entries that vanish identically, appended to `outputs`.
void append_hessian(Expr f, const ExprVector& x, ExprVector& outputs, std::vector<std::pair<Index, Index>>& entries) {
  const std::vector<Expr> slope = gradient(f, x);
  for (std::size_t a = 0; a < x.size(); ++a) {
    const std::vector<Expr> second = gradient(slope[a], std::span(x).subspan(a));
    for (std::size_t b = a; b < x.size(); ++b)
      if (!second[b - a].is_zero()) {
        entries.emplace_back(static_cast<Index>(a), static_cast<Index>(b));
        outputs.push_back(second[b - a]);
      }
  }
}

Expr auxiliary(Context& context, const char* name, Index i) {
  return context.symbol(std::string(name) + std::to_string(i), Role::Auxiliary);
}

}  // namespace

OrderOfCoordinates::OrderOfCoordinates(const MechanicalSystem& system) {
  const auto place_in = [](const std::vector<Index>& list, Index i) {
    return static_cast<Index>(std::find(list.begin(), list.end(), i) - list.begin());
  };
  for (const HigherDerivative& h : system.higher) {
    bases.push_back(static_cast<Index>(h.coordinate));
    rates_of_others.push_back(static_cast<Index>(h.rate));
    momenta.push_back(static_cast<Index>(h.momentum));
  }
  for (Index i = 0; i < static_cast<Index>(system.coordinates.size()); ++i) {
    if (std::count(momenta.begin(), momenta.end(), i) > 0) continue;
    configurations.push_back(i);
    if (std::count(bases.begin(), bases.end(), i) == 0) tops.push_back(i);
  }
  for (std::size_t k = 0; k < bases.size(); ++k)
    rates.emplace_back(place_in(configurations, bases[k]), place_in(tops, rates_of_others[k]));
}

Functional::Functional(const EquationsOfMotion& equations)
    : n_(static_cast<Index>(equations.system->coordinates.size())),
      k_(static_cast<Index>(equations.system->integral_constraints.size())),
      orders_(*equations.system),
      parameters_(parameter_values(*equations.system)) {
  build_density(equations);
  build_constraints(equations);
}

void Functional::prepare(Order& order, const FunctionSource& source) {
  order.kernel = build_function(source);
  order.work.emplace(order.kernel);
  order.work->set_parameters(parameters_);
  order.out.resize(source.outputs.size());
}

void Functional::build_density(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  Context& context = *system.context;
  ExprVector functions{equations.lagrangian_expanded}, values;
  for (const IntegralConstraint& c : system.integral_constraints) {
    functions.push_back(c.integrand);
    values.push_back(c.value);
  }
  functions = plain(system, functions);
  wanted_ = Vector::Zero(k_);
  const Bindings bindings = parameter_bindings(system);
  const ExprVector numbers = plain(system, values);
  for (Index i = 0; i < k_; ++i) wanted_[i] = maupertuis::evaluate(numbers[static_cast<std::size_t>(i)], bindings);

  ExprVector x;
  for (const Coordinate& c : system.coordinates) x.push_back(c.q);
  for (const Coordinate& c : system.coordinates) x.push_back(c.velocity);
  FunctionSource source;
  source.inputs = x;
  source.inputs.push_back(context.time());
  Expr weighted = functions[0];
  for (Index i = 0; i < k_; ++i) {
    source.inputs.push_back(auxiliary(context, "integral_multiplier_", i));
    weighted = weighted + source.inputs.back() * functions[static_cast<std::size_t>(i + 1)];
  }
  for (const Parameter& p : system.parameters) source.parameters.push_back(p.symbol);
  source.outputs = functions;
  prepare(density_[0], source);
  build_sizes(source, functions, context.time());
  for (const Expr& slope : gradient(weighted, x)) source.outputs.push_back(slope);
  for (Index i = 0; i < k_; ++i)
    for (const Expr& slope : gradient(functions[static_cast<std::size_t>(i + 1)], x)) source.outputs.push_back(slope);
  prepare(density_[1], source);
  append_hessian(weighted, x, source.outputs, entries_);
  prepare(density_[2], source);
  in_.assign(source.inputs.size(), 0.0);
  explicit_time_ = density_[1].kernel.uses(static_cast<std::size_t>(2 * n_));
}

void Functional::build_sizes(const FunctionSource& density, const ExprVector& functions, Expr time) {
  FunctionSource source = density;
  source.outputs.clear();
  for (const Expr& f : functions) source.outputs.push_back(size_of_terms(f));
  for (const Expr& f : functions) source.outputs.push_back(differentiate(f, time));
  prepare(sizes_, source);
}

void Functional::build_constraints(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  ExprVector functions;
  for (const Constraint& c : system.constraints)
    if (c.level == Constraint::Level::Position) functions.push_back(c.value);
  r_ = static_cast<Index>(functions.size());
  if (r_ == 0) return;
  functions = plain(system, functions);
  FunctionSource source;
  for (const Coordinate& c : system.coordinates) source.inputs.push_back(c.q);
  const ExprVector q = source.inputs;
  source.inputs.push_back(system.context->time());
  for (const Parameter& p : system.parameters) source.parameters.push_back(p.symbol);
  source.outputs = functions;
  Expr weighted = system.context->number(0);
  for (Index i = 0; i < r_; ++i) {
    const std::vector<Expr> row = gradient(functions[static_cast<std::size_t>(i)], q);
    for (std::size_t j = 0; j < row.size(); ++j)
      if (!row[j].is_zero()) {
        position_entries_.emplace_back(i, static_cast<Index>(j));
        source.outputs.push_back(row[j]);
      }
  }
  prepare(positions_, source);
  for (Index i = 0; i < r_; ++i) {
    source.inputs.push_back(auxiliary(*system.context, "position_multiplier_", i));
    weighted = weighted + source.inputs.back() * functions[static_cast<std::size_t>(i)];
  }
  source.outputs.clear();
  append_hessian(weighted, q, source.outputs, curvature_entries_);
  prepare(curvature_, source);
}

void Functional::evaluate(double t, const double* q, const double* v, const Vector& multipliers, int order,
                          Density& out) {
  std::copy_n(q, n_, in_.begin());
  std::copy_n(v, n_, in_.begin() + n_);
  in_[static_cast<std::size_t>(2 * n_)] = t;
  for (Index i = 0; i < k_; ++i) in_[static_cast<std::size_t>(2 * n_ + 1 + i)] = multipliers[i];
  Order& chosen = density_[order];
  chosen.work->evaluate(in_, chosen.out);
  out.finite = std::all_of(chosen.out.begin(), chosen.out.end(), [](double x) { return std::isfinite(x); });
  const double* next = chosen.out.data();
  out.lagrangian = *next++;
  out.integrals = Eigen::Map<const Vector>(next, k_);
  next += k_;
  if (order == 0) return;
  out.gradient = Eigen::Map<const Vector>(next, 2 * n_);
  next += 2 * n_;
  out.integral_gradients = Eigen::Map<const Matrix>(next, 2 * n_, k_);
  next += 2 * n_ * k_;
  if (order == 1) return;
  out.hessian = Matrix::Zero(2 * n_, 2 * n_);
  for (const auto& [a, b] : entries_) out.hessian(a, b) = out.hessian(b, a) = *next++;
}

Sensitivity Functional::sensitivity(double t, const double* q, const double* v, const Vector& multipliers) {
  evaluate(t, q, v, Vector::Zero(k_), 1, density_here_);
  sizes_.work->evaluate(in_, sizes_.out);
  const Vector by =
      density_here_.gradient.cwiseAbs() + density_here_.integral_gradients.cwiseAbs() * multipliers.cwiseAbs();
  Sensitivity out{0, by.head(n_), by.tail(n_), 0};
  for (Index i = 0; i <= k_; ++i) {
    const double weight = i == 0 ? 1 : std::abs(multipliers[i - 1]);
    out.terms += weight * sizes_.out[static_cast<std::size_t>(i)];
    out.by_time += weight * std::abs(sizes_.out[static_cast<std::size_t>(k_ + 1 + i)]);
  }
  return out;
}

void Functional::constraints_at(double t, const Vector& q, Vector& values, Matrix& rows) {
  values.resize(r_);
  rows = Matrix::Zero(r_, n_);
  if (r_ == 0) return;
  constraint_in_.assign(q.data(), q.data() + n_);
  constraint_in_.push_back(t);
  positions_.work->evaluate(constraint_in_, positions_.out);
  values = Eigen::Map<const Vector>(positions_.out.data(), r_);
  for (std::size_t e = 0; e < position_entries_.size(); ++e)
    rows(position_entries_[e].first, position_entries_[e].second) = positions_.out[static_cast<std::size_t>(r_) + e];
}

Matrix Functional::constraint_curvature(double t, const Vector& q, const Vector& mu) {
  Matrix out = Matrix::Zero(n_, n_);
  if (r_ == 0) return out;
  constraint_in_.assign(q.data(), q.data() + n_);
  constraint_in_.push_back(t);
  constraint_in_.insert(constraint_in_.end(), mu.data(), mu.data() + r_);
  curvature_.work->evaluate(constraint_in_, curvature_.out);
  for (std::size_t e = 0; e < curvature_entries_.size(); ++e) {
    const auto [a, b] = curvature_entries_[e];
    out(a, b) = out(b, a) = curvature_.out[e];
  }
  return out;
}

}  // namespace maupertuis::action

#include "fields/semi_discrete.hpp"
#include "linear_algebra/dense.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/system_expressions.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>

/// Elements of a field without inertia, a massless beam that carries masses, are at rest at every moment: their rows
/// ∂L/∂c + Q = 0 give them by the coordinates that have mass, c = −H⁻¹ (F + B q), where they are linear.
namespace maupertuis {
namespace {

/// Rows of the coordinates that are to follow, F(t) + H c + B q, with H and B numbers.
struct FollowingRows {
  Eigen::MatrixXd own, others;  // H, B
  ExprVector at_zero;           // F
};

ExprVector symbols_of_followers(const MechanicalSystem& system, const std::vector<std::size_t>& which) {
  ExprVector out;
  for (const std::size_t i : which) out.push_back(system.coordinates[i].q);
  return out;
}

/// Coordinates of elements whose velocities stand nowhere and on which constraints, contacts and friction do not act.
std::vector<std::size_t> massless_coordinates(const MechanicalSystem& system, const std::vector<std::size_t>& of_fields,
                                              Expr lagrangian) {
  std::vector<Expr> roots{lagrangian}, acting;
  roots.push_back(expand_time_derivatives(system.dissipation_function()));
  for (const Expr& force : system.generalized_forces()) roots.push_back(expand_time_derivatives(force));
  for (const Constraint& c : system.constraints) acting.push_back(expand_time_derivatives(c.value));
  for (const Contact& c : system.contacts) {
    acting.push_back(expand_time_derivatives(c.gap));
    for (const Expr& slip : c.friction.slip) acting.push_back(expand_time_derivatives(slip));
  }
  const std::vector<Expr> seen = symbols_of(roots), held = symbols_of(acting);
  const auto holds = [](const std::vector<Expr>& list, Expr e) {
    return std::find(list.begin(), list.end(), e) != list.end();
  };
  std::vector<std::size_t> out;
  for (const std::size_t i : of_fields) {
    const Coordinate& c = system.coordinates[i];
    if (!holds(seen, c.velocity) && !holds(held, c.q) && !holds(held, c.velocity)) out.push_back(i);
  }
  return out;
}

/// Nothing where a row is not linear, or holds a velocity.
std::optional<FollowingRows> rows_of(const MechanicalSystem& system, const std::vector<std::size_t>& which,
                                     Expr lagrangian, const Bindings& numbers) {
  const auto n = static_cast<Eigen::Index>(which.size()), all = static_cast<Eigen::Index>(system.coordinates.size());
  FollowingRows out{Eigen::MatrixXd(n, n), Eigen::MatrixXd(n, all), {}};
  const ExprVector forces = system.generalized_forces(),
                   slopes = gradient(lagrangian, symbols_of_followers(system, which));
  ExprVector every;
  ExprMap zero;
  for (const Coordinate& c : system.coordinates)
    every.push_back(c.q), zero[c.q] = zero[c.velocity] = system.context->number(0);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Expr row = slopes[at] + expand_time_derivatives(forces[which[at]]);
    const ExprVector parts = gradient(row, every);
    for (Eigen::Index j = 0; j < all; ++j) {
      const Expr part = parts[static_cast<std::size_t>(j)];
      const std::vector<Expr> symbols = symbols_of({&part, 1});
      if (!std::all_of(symbols.begin(), symbols.end(), [&](const Expr& s) { return numbers.count(s) > 0; }))
        return std::nullopt;
      out.others(i, j) = evaluate(part, numbers);
    }
    out.at_zero.push_back(substitute(row, zero));
    const std::vector<Expr> in_row = symbols_of({&row, 1});
    for (const Coordinate& c : system.coordinates)
      if (std::find(in_row.begin(), in_row.end(), c.velocity) != in_row.end()) return std::nullopt;
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto column = static_cast<Eigen::Index>(which[static_cast<std::size_t>(i)]);
    out.own.col(i) = out.others.col(column);
    out.others.col(column).setZero();
  }
  return out;
}

}  // namespace

void SemiDiscrete::follow_at_once() {
  MechanicalSystem& system = model_.system;
  for (const PlaceCoordinate& p : equations_->model->attached)
    if (p.moves) return;  // its value is no coordinate of the elements
  std::vector<std::size_t> of_fields;
  for (const auto& row : coordinates_)
    for (const auto& c : row)
      if (c) of_fields.push_back(*c);
  const Expr lagrangian = expand_time_derivatives(equations_->system().expanded(system.lagrangian()));
  const std::vector<std::size_t> which = massless_coordinates(system, of_fields, lagrangian);
  if (which.empty() || which.size() == system.coordinates.size()) return;
  const auto rows = rows_of(system, which, lagrangian, numbers_);
  if (!rows) return;
  Eigen::LLT<Eigen::MatrixXd> stiffness(Eigen::MatrixXd(-rows->own));
  if (stiffness.info() != Eigen::Success) return;  // nothing holds them: the run says so
  const Eigen::MatrixXd inverse = stiffness.solve(Eigen::MatrixXd::Identity(rows->own.rows(), rows->own.cols())),
                        by_others = inverse * rows->others;
  ExprMap values;
  for (std::size_t i = 0; i < which.size(); ++i) {
    std::vector<Expr> terms;
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t j = 0; j < which.size(); ++j)
      terms.push_back(constant(inverse(row, static_cast<Eigen::Index>(j))) * rows->at_zero[j]);
    for (std::size_t j = 0; j < system.coordinates.size(); ++j)
      if (const double share = by_others(row, static_cast<Eigen::Index>(j)); share != 0)
        terms.push_back(constant(share) * system.coordinates[j].q);
    values[system.coordinates[which[i]].q] = system.context->sum(terms);
  }
  put_in_place(which, values);
}

bool SemiDiscrete::has_massless_elements() const {
  const MechanicalSystem& system = model_.system;
  const Expr lagrangian = expand_time_derivatives(equations_->system().expanded(system.lagrangian()));
  const auto is_massless = [&](std::size_t i) {
    const Expr velocity = system.coordinates[i].velocity,
               mass = differentiate(differentiate(lagrangian, velocity), velocity);
    const std::vector<Expr> symbols = symbols_of({&mass, 1});
    return std::all_of(symbols.begin(), symbols.end(), [&](const Expr& s) { return numbers_.count(s) > 0; }) &&
           evaluate(mass, numbers_) == 0;
  };
  return std::any_of(coordinates_.begin(), coordinates_.end(), [&](const auto& row) {
    return std::any_of(row.begin(), row.end(), [&](const auto& c) { return c && is_massless(*c); });
  });
}

/// Their forces do their work on the coordinates that are left; their starts are no choice.
void SemiDiscrete::put_in_place(const std::vector<std::size_t>& which, const ExprMap& values) {
  MechanicalSystem& system = model_.system;
  const std::set<std::size_t> gone(which.begin(), which.end());
  std::vector<AppliedForce> forces;
  for (const AppliedForce& f : system.forces) {
    if (f.kind != AppliedForce::Kind::Generalized || !gone.count(f.coordinate)) {
      forces.push_back(f);
      continue;
    }
    const Expr value = values.at(system.coordinates[f.coordinate].q);
    for (std::size_t j = 0; j < system.coordinates.size(); ++j) {
      AppliedForce share = f;
      share.coordinate = j, share.target = system.coordinates[j].name;
      share.components = {f.components.front() * differentiate(value, system.coordinates[j].q)};
      if (!share.components.front().is_zero()) forces.push_back(std::move(share));
    }
  }
  system.forces = std::move(forces);
  std::vector<StartValue>& start = model_.experiment.start;
  start.erase(
      std::remove_if(start.begin(), start.end(), [&](const StartValue& v) { return gone.count(v.coordinate) > 0; }),
      start.end());
  for (const std::size_t i : which) {
    const Coordinate& c = system.coordinates[i];
    const Expr value = values.at(c.q), rate = total_time_derivative(value);
    moving_[c.q] = value, moving_[c.velocity] = rate, moving_[c.acceleration] = total_time_derivative(rate);
  }
  for (std::size_t a = 0; a < values_.size(); ++a)
    for (std::size_t dof = 0; dof < values_[a].size(); ++dof)
      if (coordinates_[a][dof] && gone.count(*coordinates_[a][dof])) {
        values_[a][dof] = moving_.at(values_[a][dof]);
        coordinates_[a][dof].reset();
      }
  remove_coordinates(gone);
  for_each_expression(system, [&](Expr& e) {
    if (e) e = substitute(e, moving_);
  });
}

}  // namespace maupertuis

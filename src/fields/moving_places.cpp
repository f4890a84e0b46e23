#include "fields/semi_discrete.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/system_expressions.hpp>

#include "linear_algebra/quadrature.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

/// Loads and beads: values at places that are functions of coordinates and t.
namespace maupertuis {
namespace {

/// The numbers a_k of Σ a_k P_k(ξ), f known at the points of a rule that is exact for f P_k.
std::vector<double> legendre_parts(const Lobatto& rule, const std::vector<double>& f) {
  std::vector<double> out(rule.x.size() - 1, 0);
  for (std::size_t q = 0; q < rule.x.size(); ++q) {
    double before = 0, p = 1;
    for (std::size_t k = 0; k < out.size(); ++k) {
      const double n = static_cast<double>(k);
      out[k] += (n + 0.5) * rule.w[q] * p * f[q];
      before = std::exchange(p, ((2 * n + 1) * rule.x[q] * p - n * before) / (n + 1));
    }
  }
  return out;
}

/// P_0 … P_last of an expression.
std::vector<Expr> legendre_polynomials(Expr xi, std::size_t last) {
  std::vector<Expr> p{xi.context().number(1), xi};
  while (p.size() <= last) {
    const Rational n(static_cast<std::int64_t>(p.size()) - 1);
    p.push_back(xi.context().number((2 * n + 1) / (n + 1)) * xi * p.back() -
                xi.context().number(n / (n + 1)) * p[p.size() - 2]);
  }
  return p;
}

}  // namespace

/// Σ N_j(X) c_j of one element, by_space times differentiated: a polynomial in X.
Expr SemiDiscrete::polynomial_in(std::size_t element, std::size_t a, int by_space, Expr place) const {
  const Lobatto rule(mesh_.degree + 1);
  const double left = mesh_.borders[element], half = (mesh_.borders[element + 1] - left) / 2;
  std::map<std::size_t, std::vector<double>> functions;  // [dof] at the points of the rule
  for (std::size_t q = 0; q < rule.x.size(); ++q)
    for (const ElementSpace::Part& part : spaces_[a].in(element, rule.x[q])) {
      std::vector<double>& f = functions[part.dof];
      f.resize(rule.x.size(), 0);
      f[q] += part.of[by_space];
    }
  const Expr xi = constant(1 / half) * (place - constant(left)) - constant(1);
  const std::vector<Expr> p = legendre_polynomials(xi, static_cast<std::size_t>(mesh_.degree));
  std::vector<std::vector<Expr>> parts(p.size());
  for (const auto& [dof, f] : functions) {
    const std::vector<double> numbers = legendre_parts(rule, f);
    for (std::size_t k = 0; k < numbers.size(); ++k)
      if (std::abs(numbers[k]) > 1e-15) parts[k].push_back(constant(numbers[k]) * values_[a][dof]);
  }
  std::vector<Expr> terms;
  for (std::size_t k = 0; k < p.size(); ++k) terms.push_back(equations_->system().context->sum(parts[k]) * p[k]);
  return equations_->system().context->sum(terms);
}

/// u(X) or u_x(X), a polynomial in each element. Steps end where X passes from one to the next.
Expr SemiDiscrete::along_place(std::size_t a, int by_space, Expr place) const {
  Context& context = *equations_->system().context;
  std::vector<Expr> branches;
  for (std::size_t e = 0; e < elements(); ++e) {
    if (e + 1 < elements()) {
      const Expr sides[] = {place, constant(mesh_.borders[e + 1])};
      branches.push_back(context.function(Kind::Less, sides));
    }
    branches.push_back(polynomial_in(e, a, by_space, place));
  }
  return branches.size() == 1 ? branches.front() : context.function(Kind::Piecewise, branches);
}

/// Values at places that move are no coordinates of the elements: they are functions of those, of
/// coordinates and of t.
bool SemiDiscrete::set_moving_places(Diagnostics& diagnostics) {
  const FieldSystem& s = equations_->system();
  std::set<std::size_t> gone;
  for (const PlaceCoordinate& p : equations_->model->attached) {
    if (!p.moves) continue;
    if (refuse_turning(p, diagnostics) || refuse_contact(p, diagnostics) || !follow(p, diagnostics)) return false;
    std::size_t a = 0;
    while (equations_->varied[a] != p.jet.field) ++a;
    const Coordinate& c = model_.system.coordinates[p.coordinate];
    const Expr value = along_place(a, p.jet.space[0], s.expanded(p.place)), rate = total_time_derivative(value);
    moving_[c.q] = value, moving_[c.velocity] = rate, moving_[c.acceleration] = total_time_derivative(rate);
    gone.insert(p.coordinate);
    forced_ = forced_ || !differentiate(s.expanded(p.place), s.context->time()).is_zero();
  }
  if (moving_.empty()) return true;
  share_forces(gone);
  remove_coordinates(gone);
  for_each_expression(model_.system, [&](Expr& e) {
    if (e) e = substitute(e, moving_);
  });
  return true;
}

/// E0508: u_x(X)' = u_xt + X' u_xx jumps at the borders of elements, and a momentum of it would be hit there.
bool SemiDiscrete::refuse_turning(const PlaceCoordinate& p, Diagnostics& diagnostics) const {
  if (p.jet.space[0] == 0) return false;
  const MechanicalSystem& system = model_.system;
  const Coordinate& c = system.coordinates[p.coordinate];
  std::vector<Expr> roots{expand_time_derivatives(system.lagrangian())};
  for (const Constraint& k : system.constraints) roots.push_back(total_time_derivative(k.value));
  const std::vector<Expr> symbols = symbols_of(roots);
  if (std::find(symbols.begin(), symbols.end(), c.velocity) == symbols.end()) return false;
  diagnostics.error(
      "E0508", p.span, fmt::format("not supported yet: a run in which inertia turns with {}", c.name),
      "The curvatures of the elements jump at their borders, and with them the angular velocity of what rolls there.",
      "Leave the rotary inertia and the constraint on the slope out, or put them at a constant place.");
  return true;
}

/// E0508: a gap between the elements of one field, whose polynomials meet to rounding alone.
bool SemiDiscrete::refuse_contact(const PlaceCoordinate& p, Diagnostics& diagnostics) const {
  const MechanicalSystem& system = model_.system;
  const Coordinate& c = system.coordinates[p.coordinate];
  for (const Contact& contact : system.contacts) {
    bool acts = !differentiate(expand_time_derivatives(contact.gap), c.q).is_zero();
    for (const Expr& slip : contact.friction.slip) acts = acts || !differentiate(slip, c.velocity).is_zero();
    if (!acts) continue;
    diagnostics.error("E0508", contact.span,
                      fmt::format("not supported yet: a run with a contact of {}, at a place that moves", c.name),
                      "Contacts act at constant places of a field, and on coordinates; the surface that a field makes "
                      "along a path is "
                      "one of each element for itself.",
                      "Write the contact of the coordinate that moves along the field, or at a constant place.");
    return true;
  }
  return false;
}

/// The run ends where a place leaves the domain, by more than rounding; it begins inside.
bool SemiDiscrete::follow(const PlaceCoordinate& p, Diagnostics& diagnostics) {
  const FieldSystem& s = equations_->system();
  const double a = mesh_.borders.front(), b = mesh_.borders.back(), rounding = 1e-12 * (b - a);
  const Expr x = s.expanded(p.place), inside = (x - constant(a - rounding)) * (constant(b + rounding) - x);
  Bindings at_start = numbers_;
  at_start[s.context->time()] = begin();
  for (const Coordinate& c : model_.system.coordinates) at_start[c.q] = 0;
  for (const StartValue& v : model_.experiment.start)
    if (v.order == 0) at_start[model_.system.coordinates[v.coordinate].q] = number(v.value);
  if (evaluate(inside, at_start) < 0) {
    diagnostics.error("E0289", p.span, "this place lies outside of the domain at the start",
                      "The field has no value there.", "Let it begin between the ends.");
    return false;
  }
  ModelEvent leaves;
  leaves.name = fmt::format("{} leaves the domain", model_.system.coordinates[p.coordinate].name);
  leaves.function = inside, leaves.direction = -1, leaves.action = ModelEvent::Action::Stop, leaves.span = p.span;
  departures_.push_back(leaves.name);
  model_.experiment.events.push_back(std::move(leaves));
  return true;
}

/// A force F on u(X) does the virtual work F N_j(X) δc_j.
void SemiDiscrete::share_forces(const std::set<std::size_t>& gone) {
  std::vector<AppliedForce> kept, shared;
  for (const AppliedForce& f : model_.system.forces)
    (f.kind == AppliedForce::Kind::Generalized && gone.count(f.coordinate) ? shared : kept).push_back(f);
  model_.system.forces = std::move(kept);
  for (const AppliedForce& f : shared) {
    const Expr value = moving_.at(model_.system.coordinates[f.coordinate].q);
    for (std::size_t a = 0; a < spaces_.size(); ++a)
      for (std::size_t dof = 0; dof < spaces_[a].size(); ++dof)
        if (coordinates_[a][dof])
          generalized_force(a, dof, f.components.front() * differentiate(value, values_[a][dof]), f.span);
  }
}

}  // namespace maupertuis

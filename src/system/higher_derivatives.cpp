#include "system/elaboration.hpp"

#include <fmt/format.h>

#include <algorithm>

/// Lagrangians that hold q'': L* = L(q, v, v', t) + p (q' − v) takes the place of L (Ostrogradsky), and what the
/// experiment says of q'', q''' and q'''' is said by v, v' and p.
namespace maupertuis::elaboration {
namespace {

Expr derivative_symbol(Elaboration& e, std::size_t coordinate, int order) {
  return e.context.symbol(e.system().coordinates[coordinate].name, Role::Coordinate, order);
}

bool stands_in(Expr symbol, Expr e) {
  const ExprVector symbols = symbols_of({&e, 1});
  return std::find(symbols.begin(), symbols.end(), symbol) != symbols.end();
}

/// Where q'' stands: in L = …, in L += …, or in an L that is claimed beside masses and springs.
Span place_of_lagrangian(const MechanicalSystem& s) {
  if (s.lagrangian_given) return s.lagrangian_given->span;
  return s.lagrangian_extra.empty() ? s.claims.front().span : s.lagrangian_extra.front().span;
}

/// E0259 where the model has something that takes the state to be (q, q').
bool refuse_beside_higher(Elaboration& e) {
  const MechanicalSystem& s = e.system();
  const Experiment& x = e.experiment();
  const bool sets =
      std::any_of(x.events.begin(), x.events.end(), [](const ModelEvent& event) { return !event.sets.empty(); });
  const bool masses = std::any_of(s.points.begin(), s.points.end(), [](const Point& p) { return bool(p.mass); });
  const bool is_claim = !s.lagrangian_given && s.lagrangian_extra.empty();  // springs give what L is then
  const char* what = !s.constraints.empty()            ? "constraints"
                     : s.has_modes()                   ? "contacts or dry friction"
                     : !s.integral_constraints.empty() ? "an integral of its path that is held"
                     : !s.gauges.empty()               ? "gauges"
                     : !s.rates.empty()                ? "rates"
                     : !s.bodies.empty() || masses     ? "particles or bodies"
                     : sets                            ? "an event that sets values"
                     : is_claim                        ? "springs"
                                                       : nullptr;
  if (!what) return false;
  e.diagnostics.error("E0259", place_of_lagrangian(s),
                      fmt::format("an acceleration stands in the Lagrangian of a model with {}", what),
                      "With q'' in L a state is (q, q', q'', q'''), and nothing says yet how the two go together.",
                      "Write the Lagrangian without q'', or leave the other out.");
  return true;
}

std::string free_name(Elaboration& e, std::string name) {
  while (e.table.find(name)) name += "_";
  return name;
}

std::size_t add_coordinate(Elaboration& e, const std::string& wanted, const Dimension& dimension, Span span) {
  Coordinate c;
  c.name = free_name(e, wanted);
  c.q = e.context.symbol(c.name, Role::Coordinate, 0);
  c.velocity = e.context.symbol(c.name, Role::Coordinate, 1);
  c.acceleration = e.context.symbol(c.name, Role::Coordinate, 2);
  c.dimension = e.dimension(dimension);
  c.span = span;
  e.system().coordinates.push_back(std::move(c));
  return e.system().coordinates.size() - 1;
}

/// p₂ = ∂L/∂q'' and p₁ = ∂L/∂q' − dp₂/dt. False, and E0259, where p₁ would hold accelerations of coordinates of which
/// no q'' stands in L.
bool add_higher(Elaboration& e, std::size_t i, Expr lagrangian) {
  MechanicalSystem& s = e.system();
  const Coordinate c = s.coordinates[i];
  HigherDerivative h;
  h.coordinate = i;
  h.acceleration_momentum = differentiate(lagrangian, c.acceleration);
  h.velocity_momentum =
      differentiate(lagrangian, c.velocity) - expand_time_derivatives(total_time_derivative(h.acceleration_momentum));
  for (std::size_t j = 0; j < s.coordinates.size(); ++j) {
    if (e.higher.count(j) || !stands_in(s.coordinates[j].acceleration, h.velocity_momentum)) continue;
    e.diagnostics.error("E0259", place_of_lagrangian(s),
                        fmt::format("`{}''` is coupled with `{}'`, whose own acceleration does not stand in L", c.name,
                                    s.coordinates[j].name),
                        "The two equations are of different orders; starts of such systems are not worked out.", "");
    return false;
  }
  h.rate = add_coordinate(e, "v_" + c.name, c.dimension / e.time(), c.span);
  h.momentum = add_coordinate(e, "p1_" + c.name, s.lagrangian_dimension * e.time() / c.dimension, c.span);
  s.higher.push_back(std::move(h));
  return true;
}

/// What q' and its derivatives are in the state (q, v, p; q', v', p').
class Replacement {
 public:
  explicit Replacement(Elaboration& e) : e_(e) {
    const MechanicalSystem& s = e.system();
    for (const HigherDerivative& h : s.higher) {
      const Coordinate& v = s.coordinates[h.rate];
      in_lagrangian_.emplace(derivative_symbol(e, h.coordinate, 1), v.q);
      in_lagrangian_.emplace(derivative_symbol(e, h.coordinate, 2), v.velocity);
    }
    in_formulas_ = in_lagrangian_;
    for (const HigherDerivative& h : s.higher) add_third_and_fourth(h);
  }

  Expr lagrangian(Expr value) const { return substitute(expand_time_derivatives(value), in_lagrangian_); }
  /// Fourth derivatives first: they are given by third ones.
  Expr formula(Expr value) const {
    return substitute(substitute(expand_time_derivatives(value), fourth_), in_formulas_);
  }

 private:
  /// q''' from p₁ = p and q'''' from the equation of motion, both linear in them. Where several are coupled by
  /// ∂²L/∂q''∂q'' they have no short form: q''' is v'' then.
  void add_third_and_fourth(const HigherDerivative& h) {
    const MechanicalSystem& s = e_.system();
    const Expr third = derivative_symbol(e_, h.coordinate, 3), fourth = derivative_symbol(e_, h.coordinate, 4);
    const Expr zero = e_.number(0), slope = differentiate(h.velocity_momentum, third);
    bool alone = !slope.is_zero() && zero_test(slope).verdict == Verdict::Nonzero;
    for (const HigherDerivative& other : s.higher)
      if (other.coordinate != h.coordinate)
        alone = alone && !stands_in(derivative_symbol(e_, other.coordinate, 3), h.velocity_momentum);
    if (!alone) {
      in_formulas_.emplace(third, s.coordinates[h.rate].acceleration);
      return;
    }
    const Expr p = s.coordinates[h.momentum].q;
    in_formulas_.emplace(third,
                         substitute((p - substitute(h.velocity_momentum, {{third, zero}})) / slope, in_lagrangian_));
    // dp₁/dt − ∂L/∂q + ∂D/∂q' − Q = 0
    const Coordinate& c = s.coordinates[h.coordinate];
    const Expr row = expand_time_derivatives(total_time_derivative(h.velocity_momentum)) -
                     differentiate(s.higher_lagrangian, c.q) +
                     differentiate(expand_time_derivatives(s.dissipation_function()), c.velocity) -
                     expand_time_derivatives(s.generalized_forces()[h.coordinate]);
    fourth_.emplace(fourth, -substitute(row, {{fourth, zero}}) / slope);
  }

  Elaboration& e_;
  ExprMap in_lagrangian_, in_formulas_, fourth_;
};

void replace_lagrangian(MechanicalSystem& s, const Replacement& replace) {
  for (auto* list : {&s.kinetic, &s.potential, &s.generalized_potential, &s.lagrangian_extra})
    for (EnergyTerm& term : *list) term.value = replace.lagrangian(term.value);
  const Expr zero = s.context->number(0);
  Expr joined = zero;
  for (const HigherDerivative& h : s.higher)
    joined = joined + s.coordinates[h.momentum].q * (s.coordinates[h.coordinate].velocity - s.coordinates[h.rate].q);
  if (s.lagrangian_given)
    s.lagrangian_given->value = replace.lagrangian(s.lagrangian_given->value) + joined;
  else
    s.lagrangian_extra.push_back({joined, "L", s.lagrangian_extra.front().span});
}

/// v = q', v' = q'' and p = p₁ of what is given for q, q', q'', q'''; what is not given is 0. That q' = v follows.
void extend_start(Elaboration& e, std::vector<StartValue>& start) {
  if (start.empty()) return;
  const MechanicalSystem& s = e.system();
  const ExprMap at_start{{e.context.time(), e.experiment().start_time ? e.experiment().start_time : e.number(0)}};
  ExprMap values = at_start;
  for (const Input& input : s.inputs) {
    Expr value = expand_time_derivatives(input.formula);
    for (int order = 0; order <= 2; ++order, value = total_time_derivative(value))
      values.emplace(e.context.symbol(input.name, Role::Input, order), substitute(value, at_start));
  }
  for (const StartValue& given : start)
    values.insert_or_assign(derivative_symbol(e, given.coordinate, given.order), given.value);
  for (std::size_t i = 0; i < s.coordinates.size(); ++i)
    for (int order = 0; order <= 3; ++order) values.emplace(derivative_symbol(e, i, order), e.number(0));
  for (const HigherDerivative& h : s.higher) {
    const auto given = [&](int order) {
      return std::find_if(start.begin(), start.end(),
                          [&](const StartValue& v) { return v.coordinate == h.coordinate && v.order == order; });
    };
    StartValue momentum{h.momentum, 0, substitute(h.velocity_momentum, values), start.front().span, {}, 1};
    if (const auto first = given(1); first != start.end()) first->coordinate = h.rate, first->order = 0;
    if (const auto second = given(2); second != start.end()) second->coordinate = h.rate, second->order = 1;
    const auto third = given(3);
    if (third != start.end()) momentum.span = third->span, start.erase(third);
    start.push_back(std::move(momentum));
  }
}

/// v = q' at the ends of the path, as they say it, and p free: L* does not hold p', so that no end asks anything of it.
void extend_ends(const MechanicalSystem& s, PathEnds& path) {
  for (const HigherDerivative& h : s.higher) {
    path.from.push_back(path.from_rates[h.coordinate]), path.from.emplace_back();
    path.to.push_back(path.to_rates[h.coordinate]), path.to.emplace_back();
  }
}

/// The same of a path that is given: v is its slope, and p what p₁ is along it.
void extend_path(const MechanicalSystem& s, PathFormulas& path) {
  ExprMap along;
  for (std::size_t i = 0; i < path.q.size(); ++i) {
    Expr value = path.q[i];
    for (int order = 0; order <= 3; ++order) {
      along.emplace(s.context->symbol(s.coordinates[i].name, Role::Coordinate, order), value);
      value = expand_time_derivatives(total_time_derivative(value));
    }
  }
  for (const HigherDerivative& h : s.higher) {
    path.q.push_back(along.at(s.coordinates[h.coordinate].velocity));
    path.q.push_back(substitute(h.velocity_momentum, along));
  }
}

void extend_paths(const MechanicalSystem& s, Experiment& x) {
  if (x.path) extend_ends(s, *x.path);
  if (x.given_path) extend_path(s, *x.given_path);
  for (Expectation& one : x.expectations)
    if (auto* along = std::get_if<expectation::ActionAlong>(&one.kind)) extend_path(s, along->along);
}

}  // namespace

void replace_higher_derivatives(Elaboration& e) {
  MechanicalSystem& s = e.system();
  if (e.higher.empty() || e.diagnostics.has_errors() || refuse_beside_higher(e)) return;
  s.higher_lagrangian = expand_time_derivatives(s.lagrangian());
  const std::set<std::size_t> seen = e.higher;
  for (const std::size_t i : seen)
    if (!add_higher(e, i, s.higher_lagrangian)) return;
  const Replacement replace(e);
  replace_lagrangian(s, replace);
  visit_experiment(
      e.experiment(), [&](Expr& x) { x = replace.formula(x); },
      [&](std::vector<StartValue>& start) { extend_start(e, start); });
  extend_paths(s, e.experiment());
}

}  // namespace maupertuis::elaboration

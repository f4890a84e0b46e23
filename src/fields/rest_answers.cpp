#include "fields/rest_answers.hpp"

#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/repeated_evaluation.hpp>

#include "fields/careful_sum.hpp"
#include "fields/given_fields.hpp"
#include "fields/resting_fields.hpp"
#include "fields/small_motions.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

/// Values of expressions at one rest of two.
class AtRest {
 public:
  AtRest(const FieldEquations& equations, const RestingFields& rest)
      : equations_(equations), s_(equations.system()), rest_(rest) {
    for (const Parameter& p : equations.model->parameters) values_[p.symbol] = p.si_value;
    values_[s_.context->time()] = 0;
    if (equations.bodies) add_bodies(*equations.bodies->system);
    for (const PlaceValue& place : equations.model->places) {
      std::vector<double> at;
      for (const Expr& x : place.place) at.push_back(evaluate(s_.expanded(x), values_));
      at.resize(2);
      values_[place.symbol] = place.side != 0 ? std::nan("") : jet_at(*s_.jet_of(place.jet), at[0], at[1]);
    }
  }
  double answer(const FieldQuestion& question) const {
    return question.total ? total(question.value) : evaluate(s_.expanded(question.value), values_);
  }

 private:
  void add_bodies(const MechanicalSystem& system) {
    for (const Parameter& p : system.parameters) values_[p.symbol] = p.si_value;
    for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
      const Coordinate& c = system.coordinates[i];
      values_[c.q] = rest_.bodies()(static_cast<Eigen::Index>(i));
      values_[c.velocity] = values_[c.acceleration] = 0;
    }
  }
  double jet_at(const FieldJet& jet, double x, double y) const {
    if (!rest_.space().has(jet)) return std::nan("");
    return jet.time > 0 ? 0 : rest_.value(jet, x, y);
  }
  double total(Expr density) const {
    const Expr root[] = {with_given_fields(s_, s_.expanded(density))};
    const RepeatedEvaluation at(root);
    const StaticSpace& space = rest_.space();
    CarefulSum sum;
    for (Eigen::Index q = 0; q < space.points(); ++q) {
      const double x = space.place(0, q), y = s_.space.size() > 1 ? space.place(1, q) : 0;
      sum.add(space.weights()(q) * at([&](Expr symbol) {
                                     if (symbol == s_.space[0].symbol) return x;
                                     if (s_.space.size() > 1 && symbol == s_.space[1].symbol) return y;
                                     const auto jet = s_.jet_of(symbol);
                                     return jet ? jet_at(*jet, x, y) : values_.at(symbol);
                                   }).front());
    }
    return sum.value();
  }

  const FieldEquations& equations_;
  const FieldSystem& s_;
  const RestingFields& rest_;
  Bindings values_;
};

/// Whether a velocity of a coordinate turns up in the forces at rest, friction left out.
bool bodies_act_sideways(const EquationsOfMotion& bodies) {
  const MechanicalSystem& system = *bodies.system;
  ExprMap still;
  for (const Coordinate& c : system.coordinates) still[c.velocity] = still[c.acceleration] = system.context->number(0);
  for (std::size_t i = 0; i < bodies.residual.size(); ++i)
    for (const Coordinate& c : system.coordinates) {
      const Expr row = expand_time_derivatives(bodies.residual[i] - bodies.dissipative_terms[i]);
      if (!substitute(differentiate(row, c.velocity), still).is_zero()) return true;
    }
  return false;
}

/// Dirichlet's theorem; where the energy falls a motion leaves the rest, unless forces act sideways on velocities.
std::string stability_of(const FieldEquations& equations, const FieldEquilibrium& rest) {
  if (!rest.lowest) return "undecided";
  if (rest.falling == 0) return *rest.lowest > 0 ? "stable" : "undecided";
  const FieldSystem& s = equations.system();
  const Expr density = density_of(equations);
  bool sideways = equations.bodies && bodies_act_sideways(*equations.bodies);
  for (const Expr& one : s.jets_in(density))
    for (const Expr& two : s.jets_in(density))
      sideways = sideways || (s.jet_of(one)->time > 0 && s.jet_of(two)->time == 0 &&
                              !differentiate(differentiate(density, one), two).is_zero());
  return sideways ? "undecided" : "unstable";
}

}  // namespace

RestAnswers answers_at_rest(const FieldEquations& equations, const std::vector<FieldQuestion>& questions) {
  RestAnswers out;
  const auto rest = rest_in_numbers(equations, out.trouble);
  if (!rest) return out;
  const AtRest finest(equations, *rest->finest), before(equations, *rest->before);
  for (const FieldQuestion& q : questions) {
    const double value = finest.answer(q);
    out.values.push_back({value, rest->error(value, before.answer(q))});
  }
  out.stability = stability_of(equations, rest->values);
  return out;
}

}  // namespace maupertuis

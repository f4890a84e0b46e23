#include "analysis/invariants/named_constants.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/kinds.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/system_expressions.hpp>

#include <algorithm>

namespace maupertuis::invariants {
namespace {

bool is_constant(const Expr& e) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::all_of(symbols.begin(), symbols.end(),
                     [](const Expr& s) { return s.role() == Role::Parameter || s.role() == Role::Constant; });
}

/// Square roots of parameters and of products of these are drawn with them.
bool is_drawn(const Expr& base) {
  if (base.is(Kind::Product)) {
    for (std::size_t i = 0; i < base.size(); ++i)
      if (!base[i].is_number() && !is_drawn(base[i])) return false;
    return true;
  }
  if (base.is(Kind::Power)) return base[1].is_number() && base[1].number().is_integer() && is_drawn(base[0]);
  return base.is(Kind::Symbol);
}

bool is_other_power(const Expr& e) {
  if (!e.is(Kind::Power)) return false;
  if (!e[1].is_number()) return true;
  const Rational& exponent = e[1].number();
  if (exponent.is_integer()) return false;
  return !(exponent * Rational(2)).is_integer() || !is_drawn(e[0]);
}

/// π, functions of constants, and their powers that are no square roots of parameters.
bool is_to_be_named(const Expr& e) {
  if (e.is(Kind::Pi)) return true;
  return (is_function(e.kind()) || has_switch(e.kind()) || is_other_power(e)) && is_constant(e);
}

/// sin(π/2) and the like: 0 or ±1, which frames hold as they were written.
bool is_of_quarter_turns(const Expr& e) {
  if (!e.is(Kind::Sin) && !e.is(Kind::Cos) && !e.is(Kind::Tan)) return false;
  const Expr turn = e[0];
  if (turn.is(Kind::Pi)) return true;
  return turn.is(Kind::Product) && turn.size() == 2 && turn[0].is_number() && turn[1].is(Kind::Pi) &&
         (turn[0].number() * Rational(2)).is_integer();
}

/// A function of a sum with a multiple of π.
bool turns_by_pi(const Expr& e) {
  if (!is_function(e.kind()) || !e[0].is(Kind::Sum)) return false;
  for (std::size_t i = 0; i < e[0].size(); ++i) {
    const Expr term = e[0][i];
    const std::vector<Expr> nodes = topological_order({&term, 1});
    if (symbols_of({&term, 1}).empty() &&
        std::any_of(nodes.begin(), nodes.end(), [](const Expr& node) { return node.is(Kind::Pi); }))
      return true;
  }
  return false;
}

/// The outermost ones in the expressions of a system, each with the parameter that takes its place.
class Constants {
 public:
  explicit Constants(const MechanicalSystem& system) : system_(system) {}

  void take(const Expr& e) {
    keeps_pi_ = keeps_pi_ || turns_by_pi(e) || is_of_quarter_turns(e);
    if (is_of_quarter_turns(e)) return;
    if (is_to_be_named(e)) return add(e);
    for (std::size_t i = 0; i < e.size(); ++i)
      if (seen_.insert(e[i]).second) take(e[i]);
  }

  /// sin(q + π/2) is cos q, and sin(π/2) is 1: no other number may stand in the place of π then.
  void leave_pi_where_angles_turn_by_it() {
    if (!keeps_pi_) return;
    const auto holds_pi = [&](const Parameter& p) { return meaning_.at(p.symbol).is(Kind::Pi); };
    const auto found = std::find_if(parameters_.begin(), parameters_.end(), holds_pi);
    if (found == parameters_.end()) return;
    places_.erase(meaning_.at(found->symbol));
    meaning_.erase(found->symbol);
    parameters_.erase(found);
  }

  const std::vector<Parameter>& parameters() const { return parameters_; }
  const ExprMap& places() const { return places_; }    // constant → parameter
  const ExprMap& meaning() const { return meaning_; }  // parameter → constant

  /// Whether some are functions of each other or of parameters that fractions can express: the sine and cosine of one
  /// angle, roots.
  bool related() const {
    return std::any_of(places_.begin(), places_.end(), [&](const auto& place) {
      const Expr& constant = place.first;
      return constant.is(Kind::Power) || (constant.is(Kind::Sin) && places_.contains(cos(constant[0])));
    });
  }

 private:
  void add(const Expr& constant) {
    if (places_.contains(constant)) return;
    Parameter p;
    p.name = to_plain(constant, ReadingOrder{});
    p.symbol = system_.context->symbol(p.name, Role::Parameter);
    p.si_value = evaluate(constant, parameter_bindings(system_));
    p.value = system_.context->number(Rational::from_double(p.si_value));  // to rounding: no formula is made of it
    p.used = true;
    places_.emplace(constant, p.symbol);
    meaning_.emplace(p.symbol, constant);
    parameters_.push_back(std::move(p));
  }

  const MechanicalSystem& system_;
  std::unordered_set<Expr, ExprHash> seen_;
  bool keeps_pi_ = false;
  std::vector<Parameter> parameters_;
  ExprMap places_, meaning_;
};

ReadableForm with(const ExprMap& meaning, ReadableForm form) {
  if (form.value) form.value = substitute(form.value, meaning);
  for (Intermediate& part : form.intermediates) part.value = substitute(part.value, meaning);
  return form;
}

}  // namespace

std::optional<NamedConstants> with_named_constants(const EquationsOfMotion& equations) {
  const MechanicalSystem& given = *equations.system;
  if (equations.degenerate || !given.contacts.empty() || !given.frictions.empty()) return std::nullopt;
  auto system = std::make_shared<MechanicalSystem>(given);
  Constants constants(given);
  for_each_expression(*system, [&](Expr& e) {
    if (e) constants.take(e);
  });
  constants.leave_pi_where_angles_turn_by_it();
  if (constants.parameters().empty()) return std::nullopt;
  const auto name = [&](Expr& e) {
    if (e) e = substitute(e, constants.places());
  };
  for_each_expression(*system, name);
  for (Definition& d : system->definitions) name(d.value), name(d.formula);
  system->parameters.insert(system->parameters.end(), constants.parameters().begin(), constants.parameters().end());
  Diagnostics unheard;  // these are equations that have been derived already
  auto derived = euler_lagrange(system, unheard);
  if (!derived) return std::nullopt;
  return NamedConstants{std::move(*derived), constants.meaning(), constants.related()};
}

void put_back(const ExprMap& meaning, Invariants& found) {
  for (ConservedFunction& i : found.integrals) {
    i.value = substitute(i.value, meaning);
    i.readable = with(meaning, std::move(i.readable));
    for (Expr& change : i.characteristic) change = substitute(change, meaning);
  }
  for (IntegralRelation& r : found.relations) r.value = with(meaning, std::move(r.value));
  for (PoissonBracket& b : found.brackets) b.value = with(meaning, std::move(b.value));
  for (BalanceLaw& law : found.balance_laws)
    law.quantity = with(meaning, std::move(law.quantity)), law.rate = with(meaning, std::move(law.rate));
  for (Invariants::OnOneSide& side : found.on_one_side) side.value = substitute(side.value, meaning);
}

}  // namespace maupertuis::invariants

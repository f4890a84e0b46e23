#include "system/constraint_checks.hpp"

#include "system/elaboration.hpp"

#include <maupertuis/kinds.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis::elaboration {

Bindings scattered_state(Elaboration& e, double shift) {
  Bindings b = e.values;
  double next = shift;
  const auto bind = [&](Expr symbol) {
    next = std::fmod(next + 0.6180339887498949, 1.0);
    b[symbol] = 0.3 + next;
  };
  for (const Coordinate& c : e.system().coordinates) bind(c.q), bind(c.velocity);
  for (const Input& u : e.system().inputs) bind(u.symbol);
  bind(e.context.time());
  return b;
}

namespace {

using syntax::Expression;

/// How the language calls the first function that is not smooth; empty if there is none.
std::string_view first_switch(Expr value) {
  const Expr roots[] = {value};
  for (const Expr& x : topological_order(roots))
    if (has_switch(x.kind())) return name_of(x.kind());
  return {};
}

/// Where the text calls the function, or names an input or definition that does; the whole side if nothing is found.
Span culprit_of_switch(Elaboration& e, const Expression& x, const std::string& word) {
  if ((x.kind == Expression::Kind::Call && x.text == word) ||
      (x.kind == Expression::Kind::Piecewise && word == "piecewise"))
    return x.span;
  if (x.kind == Expression::Kind::Name) {
    for (const Input& u : e.system().inputs)
      if (u.name == x.text && !first_switch(u.formula).empty()) return x.span;
    const Declaration* d = e.table.find(x.text);
    for (const Expr& part : d ? d->value.parts : ExprVector{})
      if (!first_switch(substitute(part, e.exact_definitions)).empty()) return x.span;
  }
  for (const syntax::ExpressionPtr& a : x.arguments) {
    const Span s = culprit_of_switch(e, *a, word);
    if (s.end > s.begin) return s;
  }
  return {};
}

/// Values at two states. Constraints that are equal, or opposite, have the same up to the sign.
struct Fingerprint {
  std::size_t index = 0;
  double first = 0, second = 0;
};

/// Whether a state has values for everything in it. It has none for a field or its x without a place, which is refused
/// later.
bool has_values(Expr value, const Bindings& state) {
  const std::vector<Expr> symbols = symbols_of({&value, 1});
  return std::all_of(symbols.begin(), symbols.end(), [&](Expr s) { return state.count(s) > 0; });
}

/// In order of size, so that equal constraints are neighbours.
std::vector<Fingerprint> fingerprints(Elaboration& e) {
  const Bindings states[] = {scattered_state(e, 0.37), scattered_state(e, 0.71)};
  std::vector<Fingerprint> out;
  ExprVector values;
  for (std::size_t i = 0; i < e.system().constraints.size(); ++i)
    if (const Expr value = e.system().constraints[i].value; has_values(value, states[0]))
      out.push_back({i}), values.push_back(value);
  const std::vector<double> first = maupertuis::evaluate(values, states[0]);
  const std::vector<double> second = maupertuis::evaluate(values, states[1]);
  for (std::size_t k = 0; k < out.size(); ++k) out[k].first = first[k], out[k].second = second[k];
  out.erase(std::remove_if(out.begin(), out.end(),
                           [](const Fingerprint& f) { return !std::isfinite(f.first) || !std::isfinite(f.second); }),
            out.end());
  std::stable_sort(out.begin(), out.end(),
                   [](const Fingerprint& a, const Fingerprint& b) { return std::abs(a.first) < std::abs(b.first); });
  return out;
}

/// +1 or −1 where the two seem equal or opposite; 0 else.
int seems_equal(const Fingerprint& a, const Fingerprint& b) {
  const auto near = [](double x, double y) { return std::abs(x - y) <= 1e-9 * (std::abs(x) + std::abs(y)); };
  if (near(a.first, b.first) && near(a.second, b.second)) return 1;
  return near(a.first, -b.first) && near(a.second, -b.second) ? -1 : 0;
}

}  // namespace

bool refuse_switch(Elaboration& e, const syntax::ConstraintStatement& s, Expr value) {
  const std::string word(first_switch(value));
  if (word.empty()) return false;
  Span at = culprit_of_switch(e, *s.left, word);
  if (at.end <= at.begin) at = culprit_of_switch(e, *s.right, word);
  if (at.end <= at.begin) at = s.left->span;
  e.diagnostics.error(
      "E0426", at, fmt::format("a constraint cannot be made of {}", word),
      "The force of a constraint follows from its second derivative along the motion, which has no value "
      "where such a function switches.",
      "Write a smooth relation; an inequality is written with `contact`.");
  return true;
}

bool refuse_without_coordinates(Elaboration& e, const Constraint& c) {
  const Expr roots[] = {c.value};
  ExprVector motion;
  ExprMap at_zero;
  for (const Expr& s : symbols_of(roots))
    if (s.role() == Role::Coordinate) motion.push_back(s), at_zero[s] = e.number(0);
  // In x = x + l the coordinate cancels.
  if (!motion.empty() && zero_test(gradient(c.value, motion)).verdict != Verdict::Zero) return false;
  const std::optional<double> difference = constant_value(e, motion.empty() ? c.value : substitute(c.value, at_zero));
  e.diagnostics.error("E0423", c.span, "this constraint contains no coordinate",
                      !difference ? "It is a relation of parameters and time, which no motion can fulfil or break."
                      : *difference == 0 ? "It is true whatever the motion: it constrains nothing."
                                         : "With the values of the parameters it is false, whatever the motion.",
                      "Write a relation of coordinates or velocities; what follows from parameters is a `let`.");
  return true;
}

bool refuse_identity(Elaboration& e, const Constraint& c) {
  if (zero_test(c.value).verdict != Verdict::Zero) return false;
  e.diagnostics.error("E0424", c.span, "this constraint is always true",
                      "Its two sides are the same function: every motion obeys it, and it exerts no force.",
                      "Check its names and signs, or leave it out.");
  return true;
}

void warn_of_repetition(Elaboration& e) {
  if (e.diagnostics.has_errors()) return;  // a constraint may hold what was refused
  const std::vector<Constraint>& list = e.system().constraints;
  const std::vector<Fingerprint> all = fingerprints(e);
  for (std::size_t k = 1; k < all.size(); ++k) {
    const int sign = seems_equal(all[k - 1], all[k]);
    const Constraint& a = list[std::min(all[k - 1].index, all[k].index)];
    const Constraint& b = list[std::max(all[k - 1].index, all[k].index)];
    if (sign == 0 || zero_test(a.value - Rational(sign) * b.value).verdict != Verdict::Zero) continue;
    e.diagnostics.warning(
        "W0425", b.span, "this constraint is written already",
        fmt::format("It is that of line {}: the motion stays the same, but which of the two exerts the force is not "
                    "determined.",
                    e.texts.locate(a.span).line),
        "Leave one of them out.");
  }
}

}  // namespace maupertuis::elaboration

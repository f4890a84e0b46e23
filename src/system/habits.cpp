#include "system/elaboration.hpp"

#include <maupertuis/spelling.hpp>

#include <fmt/format.h>

#include <algorithm>

/// Formulas as they stand on paper and do not stand in the model language: e^x, d/dt θ, dθ/dt, 9.81 m/s^2. Each is
/// told as a whole, with what to write instead; its parts are then no mistakes of their own. d/dt (r^2 θ') alone is
/// read: its brackets say what is differentiated.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;
using syntax::Operator;

bool is_free_word(Elaboration& e, const Expression& x) {
  if (x.kind != Expression::Kind::Name || x.primes != 0 || x.text == "pi" || x.text == e.system().independent)
    return false;
  return !e.table.find(x.text) && !e.table.is_lost(x.text);
}

bool is_plain_binary(const Expression& x, Operator op) {
  return x.kind == Expression::Kind::Binary && x.op == op && !x.bracketed;
}

/// Without the brackets that it may stand in.
Span operands(const Expression& x) { return cover(x.arguments[0]->span, x.arguments[1]->span); }

bool joins(const Expression& x, Operator op) { return x.kind == Expression::Kind::Binary && x.op == op; }

bool is_plain_product(const Expression& x) {
  return is_plain_binary(x, Operator::Juxtapose) || is_plain_binary(x, Operator::Multiply);
}

std::string text_inside(Elaboration& e, const Expression& x) {
  std::string text(e.texts.slice(x.span));
  return x.bracketed && text.size() > 2 ? text.substr(1, text.size() - 2) : text;
}

bool exponential(Elaboration& e, const Expression& x) {
  if (!joins(x, Operator::Power) || !is_free_word(e, *x.arguments[0]) || x.arguments[0]->text != "e") return false;
  e.diagnostics.error("E0201", operands(x), "`e` is not declared", "The exponential function has a name of its own.",
                      fmt::format("Write exp({}).", text_inside(e, *x.arguments[1])));
  return true;
}

// ------------------------------------------------------------------------------------------------ derivatives by t

/// The order of d, d^2, dt, dt^2; 0 where it is something else.
int order_of_word(Elaboration& e, const Expression& x, const char* word) {
  const bool square = is_plain_binary(x, Operator::Power) && x.arguments[1]->kind == Expression::Kind::Number &&
                      x.arguments[1]->text == "2";
  const Expression& name = square ? *x.arguments[0] : x;
  return is_free_word(e, name) && name.text == word ? (square ? 2 : 1) : 0;
}

/// The last factor of a product; the span from its begin on.
const Expression& factor_at_end(const Expression& x) { return is_plain_product(x) ? *x.arguments[1] : x; }

void tell_derivative(Elaboration& e, Span span, const Expression& of, int order) {
  const bool named = (of.kind == Expression::Kind::Name || of.kind == Expression::Kind::Member) && !of.bracketed;
  const std::string primes(static_cast<std::size_t>(order), '\'');
  const std::string text =
      of.bracketed || named ? std::string(e.texts.slice(of.span)) : fmt::format("({})", e.texts.slice(of.span));
  e.diagnostics.error("E0201", span, fmt::format("`{}` is no derivative here", e.texts.slice(span)),
                      "A derivative by the time is written with a prime; d and dt would be names.",
                      fmt::format("Write {}{}.", text, primes));
}

/// d/dt θ, m d/dt (l θ'), d²/dt² x
bool derivative_operator(Elaboration& e, const Expression& x) {
  if (!joins(x, Operator::Juxtapose) && !joins(x, Operator::Multiply)) return false;
  const Expression& quotient = *x.arguments[0];
  if (!is_plain_binary(quotient, Operator::Divide)) return false;
  const Expression& d = factor_at_end(*quotient.arguments[0]);
  const int order = order_of_word(e, d, "d");
  if (order == 0 || order_of_word(e, *quotient.arguments[1], "dt") != order) return false;
  tell_derivative(e, cover(d.span, x.arguments[1]->span), *x.arguments[1], order);
  return true;
}

/// d and the operand of d/dt (…): brackets say how far the derivative reaches, so that it can be read.
struct BracketedDerivative {
  const Expression* factor = nullptr;  // what stands before the d; null: nothing
  const Expression* of = nullptr;
  int order = 1;
};

std::optional<BracketedDerivative> bracketed_derivative(Elaboration& e, const Expression& x) {
  if (!joins(x, Operator::Juxtapose) || !x.arguments[1]->bracketed) return std::nullopt;
  const Expression& quotient = *x.arguments[0];
  if (!is_plain_binary(quotient, Operator::Divide)) return std::nullopt;
  const Expression& before = *quotient.arguments[0];
  const int order = order_of_word(e, factor_at_end(before), "d");
  if (order == 0 || order_of_word(e, *quotient.arguments[1], "dt") != order) return std::nullopt;
  return BracketedDerivative{is_plain_product(before) ? before.arguments[0].get() : nullptr, x.arguments[1].get(),
                             order};
}

/// dθ/dt, d²θ/dt²
bool quotient_of_differentials(Elaboration& e, const Expression& x) {
  if (!joins(x, Operator::Divide)) return false;
  const int order = order_of_word(e, *x.arguments[1], "dt");
  if (order == 0) return false;
  const Expression& numerator = *x.arguments[0];
  if (order == 2 && is_plain_product(numerator) && order_of_word(e, factor_at_end(*numerator.arguments[0]), "d") == 2) {
    const Expression& d = factor_at_end(*numerator.arguments[0]);
    tell_derivative(e, cover(d.span, x.arguments[1]->span), *numerator.arguments[1], 2);
    return true;
  }
  const Expression& word = factor_at_end(numerator);
  if (order != 1 || !is_free_word(e, word) || word.text.size() < 2 || word.text[0] != 'd') return false;
  const std::vector<std::string> names = e.table.names();
  const syntax::Spelling spelled = syntax::right_spelling("dot_" + word.text.substr(1), names);  // θ' for dtheta and dθ
  if (spelled.text.empty()) return false;
  const Span span = cover(word.span, x.arguments[1]->span);
  e.diagnostics.error("E0201", span, fmt::format("`{}` is no derivative here", e.texts.slice(span)),
                      "A derivative by the time is written with a prime; d and dt would be names.",
                      fmt::format("Write {}.", spelled.text));
  return true;
}

// ----------------------------------------------------------------------------------------------- units in formulas

bool is_written_number(const Expression& x) {
  const bool pi = x.kind == Expression::Kind::Name && x.text == "pi" && x.primes == 0;
  if (x.kind == Expression::Kind::Number || pi) return true;
  return (x.kind == Expression::Kind::Binary || x.kind == Expression::Kind::Unary) &&
         std::all_of(x.arguments.begin(), x.arguments.end(), [](const auto& a) { return is_written_number(*a); });
}

/// kg, s^2, (kg K): nothing but words of units. `free` counts those that are no names of the model.
bool is_written_unit(Elaboration& e, const Expression& x, int& free) {
  if (is_plain_binary(x, Operator::Power))
    return x.arguments[1]->kind == Expression::Kind::Number && is_written_unit(e, *x.arguments[0], free);
  if (x.kind == Expression::Kind::Binary &&
      (x.op == Operator::Juxtapose || x.op == Operator::Multiply || x.op == Operator::Divide))
    return is_written_unit(e, *x.arguments[0], free) && is_written_unit(e, *x.arguments[1], free);
  if (x.kind != Expression::Kind::Name || x.primes != 0 || !find_unit(x.text)) return false;
  free += is_free_word(e, x);
  return true;
}

/// 9.81 m/s^2 in a formula.
bool number_with_unit(Elaboration& e, const Expression& x) {
  if (e.dimensionless) return false;
  int free = 0;
  const Expression* left = &x;
  const Expression* quantity = &x;  // without factors behind it that are names of the model: the t of 2 rad/s t
  const bool outermost = joins(x, Operator::Juxtapose) || joins(x, Operator::Multiply) || joins(x, Operator::Divide);
  while ((left == &x && outermost) || is_plain_product(*left) || is_plain_binary(*left, Operator::Divide)) {
    if (is_written_number(*left)) break;
    const int before = free;
    if (!is_written_unit(e, *left->arguments[1], free)) return false;
    const bool is_factor = left == quantity && free == before && !joins(*left, Operator::Divide);
    left = left->arguments[0].get();
    if (is_factor) quantity = left;
  }
  if (left == &x || free == 0 || !is_written_number(*left)) return false;
  const std::string number(e.texts.slice(left->span));
  if (number.find('/') != std::string::npos)
    return false;  // 1/2 m: a mass that is not declared, sooner than half a metre
  const Span whole = operands(x);
  const std::uint32_t end = quantity == &x ? whole.end : quantity->span.end;
  std::string unit(e.texts.slice({left->span.end, end, whole.source}));
  const std::string_view dot = "·";  // of two bytes, and ° begins with the first of them
  while (unit.starts_with(dot) || unit.starts_with(' ') || unit.starts_with('*'))
    unit.erase(0, unit.starts_with(dot) ? dot.size() : 1);
  e.diagnostics.error("E0312", whole,
                      fmt::format("`{}` stands in a formula without brackets around its unit", e.texts.slice(whole)),
                      "In a formula a unit stands in square brackets, so that it cannot be taken for a name.",
                      fmt::format("Write {} [{}]{}.", number, unit, e.texts.slice({end, whole.end, whole.source})));
  return true;
}

}  // namespace

std::optional<Value> derivative_of_bracket(Elaboration& e, const Expression& x, const Place& place) {
  const auto found = bracketed_derivative(e, x);
  if (!found) return std::nullopt;
  Place inner = place;
  inner.expected.reset();
  const Value rate = time_derivative(e, evaluate_formula(e, *found->of, inner), found->order, x);
  if (!found->factor) return rate;
  const Value factor = evaluate_formula(e, *found->factor, inner);
  return rate.poisoned || factor.poisoned ? Value::poison() : multiply(e, factor, rate, x);
}

bool tell_habit(Elaboration& e, const Expression& x) {
  return exponential(e, x) || derivative_operator(e, x) || quotient_of_differentials(e, x) || number_with_unit(e, x);
}

}  // namespace maupertuis::elaboration

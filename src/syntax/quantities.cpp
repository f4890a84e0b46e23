#include "syntax/expression_parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <numeric>

/// Quantity places and units (rules 1 and 8). Which words are units is not known here: a number followed only by
/// words is kept as a quantity, and `system` decides.
namespace maupertuis::syntax {
namespace {

using namespace std::string_view_literals;
using Kind = Expression::Kind;

constexpr int kLargestExponent = 99;

// `third`: the token after `after` and one more, which ends sec^2.
bool is_unit_word(const Token& token, const Token& after, const Token& third) {
  const auto ends = [](const Token& t) { return t.kind == Token::Kind::End || t.is(",") || t.is(")"); };
  const bool seconds = token.is("sec") && (ends(after) || (after.is("^") && ends(third)));  // `system` says: write s
  const Function* function = find_function(token.text);
  if (function && function->bare && !seconds) return false;  // 2 cos θ; but min is a unit too
  return token.kind == Token::Kind::Name && !is_clause_word(token.text) && !token.is("pi") && !after.is("'") &&
         !after.is(".");
}

bool is_pi(const Token& token) { return token.kind == Token::Kind::Name && token.is("pi"); }

bool is_function_of_numbers(const Token& token) {
  if (token.kind != Token::Kind::Name || !find_function(token.text)) return false;
  constexpr std::array others = {"piecewise"sv, "dot"sv, "cross"sv, "norm"sv, "multiplier"sv, "reaction"sv};
  return std::find(others.begin(), others.end(), token.text) == others.end();
}

}  // namespace

ExpressionParser::Node ExpressionParser::quantity() {
  const std::size_t start = index_;
  const std::size_t warnings = warnings_.size();
  std::vector<const Token*> signs;
  while (peek().is("-") || peek().is("+")) {
    if (signs.size() > 1) break;
    signs.push_back(&next());
  }
  if (Node node = quantity_or_null()) {
    for (; !signs.empty(); signs.pop_back()) {
      if (signs.back()->is("-")) node = negate(*signs.back(), std::move(node));
    }
    return node;
  }
  index_ = start;
  warnings_.resize(warnings);
  return formula();
}

// How many tokens a number takes that begins there: 3, pi, (1 + 2), sqrt(2); 0 where none does.
std::size_t ExpressionParser::tokens_of_number(std::size_t ahead) const {
  const Token& first = peek(ahead);
  if (first.kind == Token::Kind::Number || is_pi(first)) return 1;
  const bool function = is_function_of_numbers(first) && peek(ahead + 1).is("(");
  if (!first.is("(") && !function) return 0;
  int depth = 0;
  for (std::size_t i = ahead + (function ? 1 : 0);; ++i) {
    const Token& token = peek(i);
    depth += token.is("(") ? 1 : token.is(")") ? -1 : 0;
    if (depth == 0) return i + 1 - ahead;
    const bool word = token.kind == Token::Kind::Name && !is_pi(token) && !is_function_of_numbers(token);
    const bool vector = token.is(",") && depth == 1 && !function;
    if (token.kind == Token::Kind::End || word || vector || token.is("[") || token.is("'")) return 0;
  }
}

// 1/2, 10 pi, 2*10^-5, sqrt(2), (1 + 2)/3: what a sign or a power joins to the number that stands there.
ExpressionParser::Node ExpressionParser::constant() {
  Node left = constant_power();
  while (true) {
    const auto written = product_operator(peek());
    const bool number_after_number = !written && peek().kind == Token::Kind::Number;  // the 1 of 5 1/s
    if (number_after_number || tokens_of_number(written ? 1 : 0) == 0) return left;
    if (written) next();
    Node right = constant_power();
    left = binary(written.value_or(Operator::Juxtapose), std::move(left), std::move(right));
  }
}

ExpressionParser::Node ExpressionParser::constant_power() {
  const Token& token = peek();
  Node base;
  if (token.is("(")) {
    base = bracket();
  } else if (token.kind == Token::Kind::Number) {
    base = make(Kind::Number, next().span);
    base->text = token.text;
  } else {
    base = primary();
  }
  const bool powered = peek().is("^") && tokens_of_number(peek(1).is("-") ? 2 : 1) > 0;
  if (!powered) return base;
  next();
  const Nesting nesting(*this);
  return binary(Operator::Power, std::move(base), exponent());
}

// A number or a vector, unit words or none, and then the end of the place; null if that is not what stands there.
ExpressionParser::Node ExpressionParser::quantity_or_null() {
  Node value;
  const std::size_t first = index_;
  if (tokens_of_number(0) > 0) {
    value = constant();
  } else if (peek().is("(")) {
    value = bracket(true);
    if (value->kind != Kind::Vector) return nullptr;
  } else {
    return nullptr;
  }
  if (!ends_quantity(peek())) {
    auto unit = units();
    if (!unit || !ends_quantity(peek())) return nullptr;
    if (ambiguous_slash_) {
      const bool all_names = std::all_of(unit->factors.begin(), unit->factors.end(), [&](const auto& factor) {
        return context_.declarations.contains(factor.word);
      });
      if (all_names) return nullptr;
      refuse_ambiguous_slash();
    }
    note(*unit);
    value = make(Kind::Quantity, cover(value->span, unit->span), {value});
    value->unit = std::move(unit);
  }
  for (std::size_t i = first; i < index_; ++i)
    if (context_.list.tokens[i].kind == Token::Kind::Number) check_number(context_.list.tokens[i]);
  return value;
}

void ExpressionParser::refuse_ambiguous_slash() {
  const std::string words(text_of(*ambiguous_slash_)), time = context_.declarations.independent();
  const bool ends_with_time = !time.empty() && words.ends_with(" " + time);
  fail("E0118", *ambiguous_slash_, fmt::format("`{}` has two meanings", words),
       "It is not clear whether the second unit belongs to the denominator.",
       fmt::format("Write /({}) if both belong below the slash, else put the second one before it.", words) +
           (ends_with_time ? fmt::format(" The time stands behind the brackets of a unit: 5 [N/s] {}.", time) : ""));
}

bool ExpressionParser::ends_quantity(const Token& token) const {
  if (token.kind == Token::Kind::End || (token.kind == Token::Kind::Name && is_clause_word(token.text))) return true;
  return token.is(",") || token.is(")") || token.is("=") || token.is("±") || token.is("..") || token.is(":") ||
         token.is("<=") || token.is(">=");
}

UnitExpression ExpressionParser::bracketed_unit() {
  const Span open = next().span;
  UnitExpression unit;
  const bool one = peek().is("1") || (peek().kind == Token::Kind::Number && peek().text == "1" && peek(1).is("]"));
  if (one) {
    next();
  } else if (auto read = units()) {
    unit = std::move(*read);
  } else {
    fail("E0119", peek().span, fmt::format("expected a unit, found {}", describe(peek())),
         "Square brackets hold a unit.", "Write for example [N], [kg m^2/s], [1/s] or [1].");
  }
  if (!peek().is("]")) {
    fail("E0119", peek().span, fmt::format("expected `]` after the unit, found {}", describe(peek())),
         "Square brackets hold a unit.", "Write for example [N], [kg m^2/s], [1/s] or [1].");
  }
  if (ambiguous_slash_) refuse_ambiguous_slash();
  unit.span = cover(open, next().span);
  note(unit);
  return unit;
}

void ExpressionParser::note(const UnitExpression& unit) const {
  if (context_.units) context_.units->push_back(unit);
}

// kg m^2/s^2, J/(kg K), 1/s, /s: nothing, and the cursor anywhere, if it is none of these.
std::optional<UnitExpression> ExpressionParser::units() {
  ambiguous_slash_.reset();
  UnitExpression unit;
  const Span first = peek().span;
  if (peek().kind == Token::Kind::Number && peek().text == "1" && peek(1).is("/")) next();
  if (!unit_factors(unit, 1)) return std::nullopt;
  unit.span = cover(first, previous().span);
  return unit;
}

bool ExpressionParser::unit_factors(UnitExpression& unit, int sign) {
  bool any = false;
  bool divided = false;  // one factor stands after the last slash: a further one belongs nobody knows where
  Span denominator;
  while (true) {
    const bool slash = accept("/");
    const bool times = !slash && any && (accept("*") || accept("·"));
    const Span here = peek().span;
    if (slash && peek().is("(")) {
      const Nesting nesting(*this);
      next();
      if (!unit_factors(unit, -sign) || !accept(")")) return false;
      divided = false;
    } else if (is_unit_word(peek(), peek(1), peek(3))) {
      if (!slash && divided && !ambiguous_slash_) ambiguous_slash_ = cover(denominator, here);
      if (!unit_factor(unit, slash ? -sign : sign)) return false;
      if (slash) {
        divided = true;
        denominator = here;
      }
    } else {
      return any && !slash && !times;
    }
    any = true;
  }
}

bool ExpressionParser::unit_factor(UnitExpression& unit, int sign) {
  UnitExpression::Factor factor;
  factor.word = peek().text;
  factor.span = next().span;
  if (accept("^") && !unit_exponent(factor)) return false;
  factor.span = cover(factor.span, previous().span);
  factor.exponent_numerator *= sign;
  unit.factors.push_back(std::move(factor));
  return true;
}

// 2, -2, (1/2), (-3/2), 0.5, 1.5
bool ExpressionParser::unit_exponent(UnitExpression::Factor& factor) {
  const auto whole = [&](int& value) {
    const Token& token = peek();
    if (token.kind != Token::Kind::Number || token.text.size() > 2 ||
        token.text.find_first_not_of("0123456789") != std::string_view::npos) {
      return false;
    }
    next();
    value = std::stoi(std::string(token.text));
    return value <= kLargestExponent;
  };
  const bool brackets = accept("(");
  const bool negative = accept("-");
  const std::string_view text = peek().text;
  if (!brackets && peek().kind == Token::Kind::Number && text.size() == 3 && std::isdigit(text[0]) &&
      text.substr(1) == ".5") {
    next();
    factor.exponent_numerator = 2 * (text[0] - '0') + 1;
    factor.exponent_denominator = 2;
  } else if (!whole(factor.exponent_numerator)) {
    return false;
  } else if (brackets && accept("/") && (!whole(factor.exponent_denominator) || factor.exponent_denominator == 0)) {
    return false;
  }
  if (brackets && !accept(")")) return false;
  const int common = std::gcd(factor.exponent_numerator, factor.exponent_denominator);
  factor.exponent_numerator /= common;
  factor.exponent_denominator /= common;
  if (negative) factor.exponent_numerator = -factor.exponent_numerator;
  return true;
}

}  // namespace maupertuis::syntax

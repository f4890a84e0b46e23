#include "syntax/expression_parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

/// Quantity places and units (rules 1 and 8). Which words are units is not known here: a number followed only by
/// words is kept as a quantity, and `system` decides.
namespace maupertuis::syntax {
namespace {

using Kind = Expression::Kind;

constexpr int kLargestExponent = 99;

bool is_unit_word(const Token& token, const Token& after) {
  const Function* function = find_function(token.text);
  if (function && function->bare) return false;  // 2 cos θ; but min is a unit too
  return token.kind == Token::Kind::Name && !is_clause_word(token.text) && !token.is("pi") && !after.is("'") && !after.is(".");
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

// NUMBER or VECTOR, unit words or none, and then the end of the place; null if that is not what stands there.
ExpressionParser::Node ExpressionParser::quantity_or_null() {
  Node value;
  if (peek().kind == Token::Kind::Number) {
    value = make(Kind::Number, next().span);
    value->text = previous().text;
  } else if (peek().is("(")) {
    value = bracket();
    if (value->kind != Kind::Vector) return nullptr;
  } else {
    return nullptr;
  }
  if (ends_quantity(peek())) {
    if (value->kind == Kind::Number) check_number(previous());
    return value;
  }
  const Token& number = previous();
  auto unit = units();
  if (!unit || !ends_quantity(peek())) return nullptr;
  if (ambiguous_slash_) {
    const bool all_names = std::all_of(unit->factors.begin(), unit->factors.end(),
                                       [&](const auto& factor) { return context_.declarations.contains(factor.word); });
    if (all_names) return nullptr;
    fail("E0118", *ambiguous_slash_, fmt::format("`{}` has two meanings", text_of(*ambiguous_slash_)),
         "It is not clear whether the second unit belongs to the denominator.",
         fmt::format("Write /({}) if both belong below the slash, else put the second one before it.", text_of(*ambiguous_slash_)));
  }
  if (value->kind == Kind::Number) check_number(number);
  Node node = make(Kind::Quantity, cover(value->span, unit->span), {value});
  node->unit = std::move(unit);
  return node;
}

bool ExpressionParser::ends_quantity(const Token& token) const {
  if (token.kind == Token::Kind::End || (token.kind == Token::Kind::Name && is_clause_word(token.text))) return true;
  return token.is(",") || token.is(")") || token.is("=") || token.is("±") || token.is("..") || token.is(":") || token.is("<=") || token.is(">=");
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
    fail("E0119", peek().span, fmt::format("expected a unit, found {}", describe(peek())), "Square brackets hold a unit.",
         "Write for example [N], [kg m^2/s], [1/s] or [1].");
  }
  if (!peek().is("]")) {
    fail("E0119", peek().span, fmt::format("expected `]` after the unit, found {}", describe(peek())), "Square brackets hold a unit.",
         "Write for example [N], [kg m^2/s], [1/s] or [1].");
  }
  if (ambiguous_slash_) {
    fail("E0118", *ambiguous_slash_, fmt::format("`{}` has two meanings", text_of(*ambiguous_slash_)),
         "It is not clear whether the second unit belongs to the denominator.",
         fmt::format("Write /({}) if both belong below the slash, else put the second one before it.", text_of(*ambiguous_slash_)));
  }
  unit.span = cover(open, next().span);
  return unit;
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
    } else if (is_unit_word(peek(), peek(1))) {
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

// 2, -2, (1/2), (-3/2), 0.5
bool ExpressionParser::unit_exponent(UnitExpression::Factor& factor) {
  const auto whole = [&](int& value) {
    const Token& token = peek();
    if (token.kind != Token::Kind::Number || token.text.size() > 2 || token.text.find_first_not_of("0123456789") != std::string_view::npos) {
      return false;
    }
    next();
    value = std::stoi(std::string(token.text));
    return value <= kLargestExponent;
  };
  const bool brackets = accept("(");
  const bool negative = accept("-");
  if (!brackets && peek().kind == Token::Kind::Number && peek().text == "0.5") {
    next();
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

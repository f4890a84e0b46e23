#include "syntax/layout.hpp"

#include <maupertuis/syntax_tree.hpp>

/// Expressions back to tokens, with the brackets that the grammar needs.
namespace maupertuis::syntax {
namespace {

using Kind = Expression::Kind;

enum class Level { Disjunction, Conjunction, Comparison, Sum, Product, Power, Postfix };

Level level_of(const Expression& e) {
  if (e.bracketed) return Level::Postfix;
  if (e.kind == Kind::Unary) return Level::Sum;
  if (e.kind == Kind::Quantity) return e.unit_bracketed ? Level::Power : Level::Product;
  if (e.kind == Kind::Call && e.bare) return Level::Power;
  if (e.kind != Kind::Binary) return Level::Postfix;
  switch (e.op) {
    case Operator::Or:
      return Level::Disjunction;
    case Operator::And:
      return Level::Conjunction;
    case Operator::Add:
    case Operator::Subtract:
      return Level::Sum;
    case Operator::Power:
      return Level::Power;
    case Operator::Less:
    case Operator::LessEqual:
    case Operator::Greater:
    case Operator::GreaterEqual:
      return Level::Comparison;
    case Operator::Multiply:
    case Operator::Juxtapose:
    case Operator::Divide:
    case Operator::Dot:
    case Operator::Cross:
    case Operator::Negate:
      break;
  }
  return Level::Product;
}

std::string_view sign_of(Operator op) {
  switch (op) {
    case Operator::Add:
      return "+";
    case Operator::Subtract:
    case Operator::Negate:
      return "-";
    case Operator::Multiply:
      return "*";
    case Operator::Juxtapose:
      return "";
    case Operator::Divide:
      return "/";
    case Operator::Dot:
      return "·";
    case Operator::Cross:
      return "×";
    case Operator::Power:
      return "^";
    case Operator::Less:
      return "<";
    case Operator::LessEqual:
      return "<=";
    case Operator::Greater:
      return ">";
    case Operator::GreaterEqual:
      return ">=";
    case Operator::And:
      return "and";
    case Operator::Or:
      return "or";
  }
  return "";
}

class Printer {
 public:
  std::vector<Token> tokens;

  // `e`, in brackets if it binds less tightly than `least`.
  void print(const Expression& e, Level least) {
    const bool brackets = e.bracketed || level_of(e) < least;
    if (brackets) sign("(");
    body(e);
    if (brackets) sign(")");
  }

 private:
  void put(Token::Kind kind, std::string_view text) {
    Token token;
    token.kind = kind;
    token.text = text;
    tokens.push_back(token);
  }
  void sign(std::string_view text) { put(Token::Kind::Sign, text); }
  void name(std::string_view text) { put(Token::Kind::Name, text); }
  void primes(int count) {
    for (int i = 0; i < count; ++i) sign("'");
  }

  void body(const Expression& e) {
    switch (e.kind) {
      case Kind::Number:
        return put(Token::Kind::Number, e.text);
      case Kind::Quantity:
        return quantity(e);
      case Kind::Name:
        return name(e.text), primes(e.primes);
      case Kind::Member:
        return print(*e.arguments[0], Level::Postfix), sign("."), name(e.text), primes(e.primes);
      case Kind::Call:
        return call(e, nullptr), primes(e.primes);
      case Kind::Vector:
        return list(e.arguments);
      case Kind::Binary:
        return binary(e);
      case Kind::Unary:
        return sign("-"), print(*e.arguments[0], Level::Product);
      case Kind::TimeDerivative:
        return derivative(e);
      case Kind::Piecewise:
        return piecewise(e);
    }
  }

  void list(const std::vector<ExpressionPtr>& parts) {
    sign("(");
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (i > 0) sign(",");
      print(*parts[i], Level::Sum);
    }
    sign(")");
  }

  void quantity(const Expression& e) {
    print(*e.arguments[0], Level::Postfix);
    if (e.unit_bracketed) sign("[");
    unit(*e.unit, e.unit_bracketed);
    if (e.unit_bracketed) sign("]");
  }

  // N m s^-2: powers as they are, without the slash that the text may have had.
  void unit(const UnitExpression& unit, bool bracketed) {
    if (unit.factors.empty() && bracketed) put(Token::Kind::Number, "1");
    for (const UnitExpression::Factor& factor : unit.factors) {
      name(factor.word);
      if (factor.exponent_numerator == 1 && factor.exponent_denominator == 1) continue;
      sign("^");
      if (factor.exponent_denominator != 1) sign("(");
      if (factor.exponent_numerator < 0) sign("-");
      number(factor.exponent_numerator < 0 ? -factor.exponent_numerator : factor.exponent_numerator);
      if (factor.exponent_denominator != 1) sign("/"), number(factor.exponent_denominator), sign(")");
    }
  }

  void number(int value) {
    spellings_.push_back(std::to_string(value));
    put(Token::Kind::Number, spellings_.back());
  }

  void call(const Expression& e, const Expression* exponent) {
    name(e.text);
    tokens.back().field = true;  // no blank before the bracket
    if (exponent) sign("^"), put(Token::Kind::Number, exponent->text);
    if (e.bare)
      print(*e.arguments[0], Level::Product);
    else
      list(e.arguments);
  }

  void derivative(const Expression& e) {
    const Expression& operand = *e.arguments[0];
    const bool brackets = !operand.bracketed && operand.kind != Kind::Vector;
    if (brackets) sign("(");
    print(operand, Level::Disjunction);
    if (brackets) sign(")");
    primes(e.primes);
  }

  void piecewise(const Expression& e) {
    name("piecewise");
    sign("(");
    for (std::size_t i = 0; i + 1 < e.arguments.size(); i += 2) {
      print(*e.arguments[i], Level::Disjunction);
      sign(":");
      print(*e.arguments[i + 1], Level::Sum);
      sign(",");
    }
    name("else");
    sign(":");
    print(*e.arguments.back(), Level::Sum);
    sign(")");
  }

  void binary(const Expression& e) {
    const Expression& left = *e.arguments[0];
    const Expression& right = *e.arguments[1];
    if (e.op == Operator::Power) return power(left, right);
    const Level level = level_of_operator(e);
    print(left, level == Level::Comparison ? Level::Sum : level);
    if (e.op == Operator::And || e.op == Operator::Or)
      name(sign_of(e.op));
    else if (e.op != Operator::Juxtapose)
      sign(sign_of(e.op));
    const auto tighter = static_cast<Level>(static_cast<int>(level) + 1);
    // `x 2` would be read, but with a warning, and `2 3` not at all.
    const bool number = e.op == Operator::Juxtapose && begins_with_number(right);
    print(right, number ? Level::Postfix : tighter, number);
  }

  void print(const Expression& e, Level least, bool force) {
    const bool brackets = force && !e.bracketed;
    if (brackets) sign("(");
    print(e, brackets ? Level::Disjunction : least);
    if (brackets) sign(")");
  }

  static Level level_of_operator(const Expression& e) {
    Expression plain;
    plain.kind = e.kind;
    plain.op = e.op;
    return level_of(plain);
  }

  static bool begins_with_number(const Expression& e) {
    if (e.bracketed) return false;
    if (e.kind == Kind::Number || e.kind == Kind::Quantity) return true;
    return e.kind == Kind::Binary && begins_with_number(*e.arguments[0]);
  }

  void power(const Expression& base, const Expression& exponent) {
    const bool whole = exponent.kind == Kind::Number && !exponent.bracketed &&
                       exponent.text.find_first_not_of("0123456789") == std::string::npos;
    if (base.kind == Kind::Call && base.bare && !base.bracketed && whole && base.text != "reaction" &&
        base.text != "multiplier") {
      return call(base, &exponent);
    }
    print(base, Level::Postfix);
    sign("^");
    const bool negative =
        exponent.kind == Kind::Unary && !exponent.bracketed && level_of(*exponent.arguments[0]) >= Level::Power;
    if (negative) sign("-");
    print(negative ? *exponent.arguments[0] : exponent, Level::Power);
  }

  std::deque<std::string> spellings_;  // of the exponents of units
};

}  // namespace

std::string to_string(const Expression& expression) {
  Printer printer;
  printer.print(expression, Level::Disjunction);
  return lay_out(printer.tokens);
}

}  // namespace maupertuis::syntax

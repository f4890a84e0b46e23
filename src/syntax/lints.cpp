#include "syntax/expression_parser.hpp"

#include <fmt/format.h>

/// Warnings about formulas that read otherwise than they were probably meant (rules 2 and 3).
namespace maupertuis::syntax {
namespace {

using Kind = Expression::Kind;

bool is_binary(const Expression& e, Operator op) { return e.kind == Kind::Binary && !e.bracketed && e.op == op; }

// The factor that stands last in an expression that is written without brackets.
const Expression& last_factor(const Expression& e) {
  const Expression* last = &e;
  while (!last->bracketed &&
         ((last->kind == Kind::Binary && last->op != Operator::Power) || last->kind == Kind::Unary)) {
    last = last->arguments.back().get();
  }
  return *last;
}

// cos θ or cos^2 θ; null if it is something else.
const Expression* bare_call(const Expression& e) {
  if (is_binary(e, Operator::Power)) return bare_call(*e.arguments[0]);
  return e.kind == Kind::Call && e.bare && !e.bracketed ? &e : nullptr;
}

bool is_plain_factor(const Expression& e) {
  return !e.bracketed &&
         (e.kind == Kind::Name || e.kind == Kind::Member ||
          (is_binary(e, Operator::Power) && !e.arguments[0]->bracketed && e.arguments[0]->kind == Kind::Name));
}

}  // namespace

void ExpressionParser::lint_product(const Expression& left, Operator op, const Expression& right) {
  const Expression& before = last_factor(left);
  const bool denominator_is_name = is_binary(left, Operator::Divide) && !before.bracketed &&
                                   (before.kind == Kind::Name || before.kind == Kind::Member);
  const bool derivative = before.text == "dt" && !context_.declarations.contains("dt");  // d/dt θ: `system` tells it
  // x^2/2a, without a blank: 2a looks like one thing. In 1/2m it is the half that does.
  const bool denominator_is_joined = is_binary(left, Operator::Divide) && before.kind == Kind::Number &&
                                     before.span.end == right.span.begin &&
                                     last_factor(*left.arguments[0]).kind != Kind::Number;
  if (op == Operator::Juxtapose && (denominator_is_name || denominator_is_joined) && is_plain_factor(right) &&
      !derivative) {
    const Expression& numerator = last_factor(*left.arguments[0]);
    const Span span = cover(numerator.span, right.span);
    warn("W0101", span, fmt::format("`{}` multiplies by {}", text_of(span), text_of(right)),
         "Products without a sign bind as division does, from left to right.",
         fmt::format("Write {}/({} {}) if {} belongs to the denominator, else put {} before the slash.",
                     text_of(numerator), text_of(before), text_of(right), text_of(right), text_of(right)));
  }
  const Expression* function = bare_call(before);
  if (op == Operator::Divide && function && right.kind == Kind::Number) {
    const Span span = cover(before.span, right.span);
    const std::string argument = text_of(*function->arguments[0]);
    warn("W0102", span, fmt::format("`{}` divides the value of {}, not its argument", text_of(span), function->text),
         fmt::format("Without brackets {} takes {} alone.", function->text, argument),
         fmt::format("Write {0}({1}/{2}) for the {0} of {1}/{2}, or 1/{2} {3}.", function->text, argument,
                     text_of(right), text_of(before)));
  }
  if (op == Operator::Juxtapose && function && is_meant_in_argument(*function->arguments[0], right)) {
    const Span span = cover(before.span, right.span);
    warn("W0104", span,
         fmt::format("`{}` multiplies by {}", text_of(span), right.text == "t" ? "the time" : right.text),
         fmt::format("Without brackets {} takes {} alone.", function->text, text_of(*function->arguments[0])),
         fmt::format("Write {}({} {}).", function->text, text_of(*function->arguments[0]), right.text));
  }
  if (op == Operator::Divide && right.kind == Kind::Number && is_binary(before, Operator::Power) &&
      before.arguments[1]->kind == Kind::Number && before.arguments[1]->text == "1") {
    const Span span = cover(before.span, right.span);
    const std::string base = text_of(*before.arguments[0]);
    warn("W0110", span, fmt::format("`{}` divides {} by {}", text_of(span), base, right.text),
         "A power binds before a division.", fmt::format("Write {}^(1/{}) for the root.", base, right.text));
  }
  if (op == Operator::Divide && right.kind == Kind::Quantity && right.unit_bracketed && !right.bracketed &&
      before.kind == Kind::Number) {
    const Span span = cover(before.span, right.span);
    const std::string number = text_of(*right.arguments[0]),
                      unit = text_of({right.arguments[0]->span.end, right.span.end, right.span.source});
    warn("W0109", span, fmt::format("`{}` divides by {}", text_of(span), text_of(right)),
         "A unit in brackets belongs to the number right before it.",
         fmt::format("Write {0}{1}/{2} for that part of the unit, {0}/({2}{1}) for the quotient.", text_of(before),
                     unit, number));
  }
  if (op == Operator::Juxtapose && right.kind == Kind::Number && left.kind != Kind::Number) {
    const Span span = cover(before.span, right.span);
    warn("W0105", span, fmt::format("`{}` is a product", text_of(span)), "A number after a factor multiplies it.",
         fmt::format("Write {0}^{1} for the power, or {1} {0} for the product.", text_of(before), right.text));
  }
}

/// 5 [mm]^2 is 25 mm².
void ExpressionParser::lint_power(const Expression& base, const Expression& exponent) {
  if (base.kind != Kind::Quantity || !base.unit_bracketed || base.bracketed) return;
  const Span span = cover(base.span, exponent.span);
  const std::string quantity = text_of(base), power = text_of(exponent);
  warn("W0111", span, fmt::format("`{}` is {} to the power {}", text_of(span), quantity, power),
       "A unit in brackets belongs to the number before it, and the power takes both.",
       fmt::format("Write ({})^{} for this, and put the power into the brackets where the unit alone is meant.",
                   quantity, power));
}

/// cos ω t without units, where no dimension tells; cos n θ with a parameter n.
bool ExpressionParser::is_meant_in_argument(const Expression& argument, const Expression& right) const {
  const Declarations& declared = context_.declarations;
  if (right.kind != Kind::Name || right.primes != 0 || right.bracketed) return false;
  if (declared.dimensionless() && right.text == declared.independent()) return true;
  const bool factor = argument.kind == Kind::Name && argument.primes == 0 &&
                      declared.kind(argument.text) == Declarations::Kind::Parameter;
  return factor && declared.kind(right.text) == Declarations::Kind::Angle;
}

void ExpressionParser::lint_sum(const Expression& left, const Expression& right) {
  const Expression* function = bare_call(last_factor(left));
  if (!function || right.kind != Kind::Name || right.bracketed) return;
  const Expression& argument = last_factor(*function->arguments[0]);
  const auto is_angle = [&](const Expression& e) {
    return e.kind == Kind::Name && e.primes == 0 && context_.declarations.kind(e.text) == Declarations::Kind::Angle;
  };
  if (!is_angle(argument) || !is_angle(right)) return;
  const Span span = cover(function->span, right.span);
  const Span inner = cover(function->arguments[0]->span, right.span);
  warn("W0103", span, fmt::format("`{}` adds an angle to the value of {}", text_of(span), function->text),
       fmt::format("Without brackets {} takes {} alone.", function->text, text_of(*function->arguments[0])),
       fmt::format("Write {}({}).", function->text, text_of(inner)));
}

}  // namespace maupertuis::syntax

#include "syntax/expression_parser.hpp"

#include <maupertuis/spelling.hpp>

#include <fmt/format.h>

#include <algorithm>

/// Formulas: operators, brackets, names.
namespace maupertuis::syntax {
namespace {

using Kind = Expression::Kind;

constexpr int kDeepestNesting = 200;
constexpr int kDeepestTree = 2000;

bool starts_factor(const Token& token) {
  return token.kind == Token::Kind::Number || token.is("(") ||
         (token.kind == Token::Kind::Name && !is_clause_word(token.text));
}

bool is_not_a_number(std::string_view word) {
  return word == "nan" || word == "NaN" || word == "NAN" || word == "inf" || word == "Inf" || word == "INF" ||
         word == "infinity" || word == "Infinity";
}

}  // namespace

// A number however it is written: no name stands in it but pi.
bool ExpressionParser::is_constant(const Expression& e) {
  const bool number = e.kind == Kind::Number || e.kind == Kind::Binary || e.kind == Kind::Unary ||
                      e.kind == Kind::Call || (e.kind == Kind::Name && e.text == "pi" && e.primes == 0);
  return number &&
         std::all_of(e.arguments.begin(), e.arguments.end(), [](const ExpressionPtr& a) { return is_constant(*a); });
}

std::optional<Operator> ExpressionParser::product_operator(const Token& token) {
  if (token.is("*")) return Operator::Multiply;
  if (token.is("/")) return Operator::Divide;
  if (token.is("·")) return Operator::Dot;
  if (token.is("×")) return Operator::Cross;
  return std::nullopt;
}

ExpressionParser::Nesting::Nesting(ExpressionParser& p) : parser(p) {
  if (++parser.nesting_ <= kDeepestNesting) return;
  --parser.nesting_;
  parser.fail("E0108", parser.peek().span, "the formula is nested too deeply",
              fmt::format("Brackets, signs and exponents may be nested {} deep.", kDeepestNesting),
              "Name its parts with `let`.");
}

// ------------------------------------------------------------------------------------------------- building nodes

ExpressionParser::Node ExpressionParser::make(Expression::Kind kind, Span span, std::initializer_list<Node> arguments) {
  auto node = std::make_shared<Expression>();
  node->kind = kind;
  node->span = span;
  node->arguments.assign(arguments.begin(), arguments.end());
  return finish(std::move(node));
}

// Sets the depth of a node whose arguments are complete.
ExpressionParser::Node ExpressionParser::finish(Node node) {
  node->depth = 1;
  for (const ExpressionPtr& argument : node->arguments) node->depth = std::max(node->depth, argument->depth + 1);
  if (node->depth > kDeepestTree) {
    fail("E0108", node->span, "the formula is too long",
         fmt::format("A formula may have {} operations in a row.", kDeepestTree),
         "Name its parts with `let`, or add to an energy with `+=`.");
  }
  return node;
}

ExpressionParser::Node ExpressionParser::binary(Operator op, Node left, Node right) {
  const Span span = cover(left->span, right->span);
  Node node = make(Kind::Binary, span, {std::move(left), std::move(right)});
  node->op = op;
  return node;
}

ExpressionParser::Node ExpressionParser::negate(const Token& sign, Node operand) {
  const Span span = cover(sign.span, operand->span);
  Node node = make(Kind::Unary, span, {std::move(operand)});
  node->op = Operator::Negate;
  return node;
}

// ------------------------------------------------------------------------------------------------------ operators

ExpressionParser::Node ExpressionParser::sum() {
  Node left = signed_product();
  while (peek().is("+") || peek().is("-")) {
    const Operator op = next().is("+") ? Operator::Add : Operator::Subtract;
    Node right = signed_product();
    lint_sum(*left, *right);
    left = binary(op, std::move(left), std::move(right));
  }
  return left;
}

ExpressionParser::Node ExpressionParser::signed_product() {
  if (!peek().is("-") && !peek().is("+")) return product();
  const Nesting nesting(*this);
  const Token& sign = next();
  Node operand = signed_product();
  return sign.is("-") ? negate(sign, std::move(operand)) : operand;
}

ExpressionParser::Node ExpressionParser::product() {
  Node left = power();
  while (true) {
    const auto written = product_operator(peek());
    if (!written && !starts_factor(peek())) return left;
    if (written) next();
    const Operator op = written.value_or(Operator::Juxtapose);
    Node right = written ? signed_power() : power();
    lint_product(*left, op, *right);
    left = binary(op, std::move(left), std::move(right));
  }
}

ExpressionParser::Node ExpressionParser::signed_power() {
  if (!peek().is("-") && !peek().is("+")) return power();
  const Nesting nesting(*this);
  const Token& sign = next();
  Node operand = signed_power();
  return sign.is("-") ? negate(sign, std::move(operand)) : operand;
}

ExpressionParser::Node ExpressionParser::power() {
  Node base = postfix();
  if (!accept("^")) return base;
  const Nesting nesting(*this);
  Node power = exponent();
  lint_power(*base, *power);
  return binary(Operator::Power, std::move(base), std::move(power));
}

ExpressionParser::Node ExpressionParser::exponent() {
  if (!peek().is("-") && !peek().is("+")) return power();
  const Nesting nesting(*this);
  const Token& sign = next();
  Node operand = exponent();
  return sign.is("-") ? negate(sign, std::move(operand)) : operand;
}

ExpressionParser::Node ExpressionParser::postfix() {
  Node node = primary();
  while (true) {
    const Token& token = peek();
    if (token.is(".")) {
      next();
      if (node->kind == Kind::Number)
        fail("E0105", cover(node->span, token.span), "a decimal point stands between digits");
      const Name member = used_name("a component or field after `.`");
      node = make(Kind::Member, cover(node->span, member.span), {node});
      node->text = member.text;
      node->name_span = member.span;
    } else if (token.is("'")) {
      next();
      const bool at_place =  // u(l)'
          node->kind == Kind::Call && context_.declarations.kind(node->text) == Declarations::Kind::Field;
      const bool named = (node->kind == Kind::Name || node->kind == Kind::Member || at_place) && !node->bracketed;
      if (!named && !node->bracketed && node->kind != Kind::TimeDerivative && node->kind != Kind::Vector) {
        fail("E0125", token.span,
             fmt::format("`{}` has no time derivative that could be written with '", text_of(*node)),
             "The prime belongs to a name, a field of a point or body, or a bracket.",
             fmt::format("Write ({})' or dot({}).", text_of(*node), text_of(*node)));
      }
      if (!named && node->kind != Kind::TimeDerivative) node = make(Kind::TimeDerivative, node->span, {node});
      ++node->primes;
      node->span = cover(node->span, token.span);
      refuse_time_of_derivative(*node);
    } else {
      return node;
    }
  }
}

// ------------------------------------------------------------------------------------------------------- operands

// [a, b], as one writes for another program.
bool ExpressionParser::opens_a_list() const {
  int depth = 0;
  for (std::size_t i = 0; index_ + i < end_; ++i) {
    depth += peek(i).is("(") || peek(i).is("[") ? 1 : peek(i).is(")") || peek(i).is("]") ? -1 : 0;
    if (depth == 0) return false;
    if (depth == 1 && peek(i).is(",")) return true;
  }
  return false;
}

ExpressionParser::Node ExpressionParser::primary() {
  const Token& token = peek();
  if (token.kind == Token::Kind::Number) return number();
  if (token.is("(")) return bracket();
  if (token.is("friction") && peek(1).is("(")) return arguments_of(next(), {"friction"});
  if (token.kind != Token::Kind::Name || is_clause_word(token.text)) {
    fail_expected("a number, a name or a bracket",
                  !token.is("[")   ? ""
                  : opens_a_list() ? "A vector stands in round brackets: (a, b)."
                                   : "A unit in square brackets stands directly after a number: 3 [J].");
  }
  if (const Function* function = find_function(token.text)) return call(*function);
  if (context_.declarations.complex() && peek(1).is("(") && !context_.declarations.contains(token.text))
    if (const Function* function = find_complex_function(token.text)) return call(*function);
  return name();
}

ExpressionParser::Node ExpressionParser::number() {
  const Token& token = next();
  check_number(token);
  Node node = make(Kind::Number, token.span);
  node->text = token.text;
  if (peek().is("[")) node = with_bracketed_unit(std::move(node));
  if (peek().kind == Token::Kind::Number) {
    const auto is_digits = [](std::string_view text) {
      return text.find_first_not_of("0123456789") == std::string_view::npos;
    };
    std::string help = fmt::format("Write {} * {}", token.text, peek().text);
    if (is_digits(token.text) && is_digits(peek().text))
      help += fmt::format(", or {}{} if it is one number", token.text, peek().text);
    fail("E0123", cover(token.span, peek().span), "two numbers stand side by side",
         "A product of numbers needs a sign between them.", help + ".");
  }
  return node;
}

// `2e1` is the number 20, unless e1 is a name of the model: then nobody can know.
void ExpressionParser::check_number(const Token& token) {
  const std::size_t e = token.text.find_first_of("eE");
  if (e == std::string_view::npos) return;
  const std::string_view word = token.text.substr(e);
  if (!context_.declarations.contains(word)) return;
  const std::string_view digits = token.text.substr(0, e);
  fail("E0117", token.span, fmt::format("`{}` is a number and also {} times {}", token.text, digits, word),
       fmt::format("{} is a name of this model.", word),
       fmt::format("Write {} {} for the product, or {}.0{} for the number.", digits, word, digits, word));
}

ExpressionParser::Node ExpressionParser::name() {
  const Token& token = next();
  const bool declared = context_.declarations.contains(token.text);
  if (!declared && is_not_a_number(token.text)) {
    fail("E0105", token.span, fmt::format("`{}` is not a number", token.text), "Every quantity of a model is finite.",
         "Write a finite number.");
  }
  check_application(token);
  if (peek().is("(") && context_.declarations.kind(token.text) == Declarations::Kind::Field)
    return value_at_place(token);
  Node node = make(Kind::Name, token.span);
  node->text = token.text;
  node->name_span = token.span;
  if (peek().is("[") && token.is("pi")) return with_bracketed_unit(std::move(node));
  if (peek().is("[")) {
    refuse_brackets_of_function(token);
    fail("E0119", peek().span, fmt::format("a unit in square brackets cannot follow `{}`", token.text),
         "A name has its unit from its declaration; in formulas only numbers are given units.",
         "Write the unit after a number: 3 [J].");
  }
  return node;
}

// u(3 m), u_x(l), w(1 m, 2 m): the value of a field at a place.
ExpressionParser::Node ExpressionParser::value_at_place(const Token& field) {
  const Nesting nesting(*this);
  next();
  std::vector<Node> place;
  do place.push_back(quantity());
  while (accept(","));
  if (!peek().is(")")) fail_expected("`,` or `)` after the place");
  Node node = make(Kind::Call, cover(field.span, next().span));
  node->text = field.text;
  node->name_span = field.span;
  node->arguments.assign(place.begin(), place.end());
  return finish(node);
}

// p_θ in an expectation, for a coordinate θ; elsewhere `system` says that the name is not declared.
bool ExpressionParser::is_momentum(std::string_view name) const {
  const std::size_t cut = name.find('_');
  if (cut == std::string::npos) return false;
  const Declarations::Kind kind = context_.declarations.kind(name.substr(cut + 1));
  const std::string_view head = name.substr(0, cut);
  return (head == "p" || head == "P" || head == "momentum") &&
         (kind == Declarations::Kind::Coordinate || kind == Declarations::Kind::Angle);
}

// x'(t), as one writes on paper.
void ExpressionParser::refuse_time_of_derivative(const Expression& rate) {
  const std::string& independent = context_.declarations.independent();
  const bool named = rate.kind == Expression::Kind::Name && !rate.bracketed;
  if (!named || !peek().is("(") || !peek(1).is(independent) || !peek(2).is(")")) return;
  const std::string text = text_of(rate);
  fail("E0121", cover(rate.span, peek(2).span),
       fmt::format("`{0}({1})` would be {0} times {2}", text, independent,
                   independent == "t" ? "the time" : independent),
       fmt::format("{} depends on {} by itself.", text, independent == "t" ? "time" : independent),
       fmt::format("Write {}.", text));
}

// A name before a bracket is a factor, θ(t) is a habit, and anything else is a function that does not exist.
void ExpressionParser::check_application(const Token& name) {
  if (!peek().is("(")) return;
  using Declared = Declarations::Kind;
  const Declared kind = context_.declarations.kind(name.text);
  const std::string& independent = context_.declarations.independent();
  const bool of_time = peek(1).is(independent) && peek(2).is(")");
  if (of_time &&
      (kind == Declared::Coordinate || kind == Declared::Angle || kind == Declared::Field || kind == Declared::Input)) {
    const bool time = independent == "t";
    fail("E0121", cover(name.span, peek(2).span),
         fmt::format("`{0}({1})` would be {0} times {2}", name.text, independent, time ? "the time" : independent),
         fmt::format("{} depends on {} by itself.", name.text, time ? "time" : independent),
         kind == Declared::Field && time
             ? fmt::format("Write {0}; at a place that moves with the time {0}(v t), or {0}(1 t) where it has no unit.",
                           name.text)
             : fmt::format("Write {}.", name.text));
  }
  if (name.is("dt") && previous().is("dt") && context_.list.tokens[index_ - 2].is("/"))
    return;  // d/dt (…): `system` tells it
  if (kind != Declared::None || is_predefined(name.text) || energy_of(name.text) || is_momentum(name.text)) return;
  if (name.is("i") && context_.declarations.complex()) return;
  if (context_.lost && std::any_of(context_.lost->begin(), context_.lost->end(),
                                   [&](const Name& lost) { return lost.text == name.text; }))
    return;
  unknown_before_bracket(name);
}

// Cos[θ], as one writes for another program.
void ExpressionParser::refuse_brackets_of_function(const Token& name) {
  std::string lower(name.text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const Function* function = find_function(lower);
  if (!function) return;
  std::size_t i = 1;
  while (peek(i).kind != Token::Kind::End && !peek(i).is("]")) ++i;
  const std::string argument = i > 1 && peek(i).is("]") ? text_of(cover(peek(1).span, peek(i - 1).span)) : "…";
  fail("E0119", peek().span, fmt::format("`{}` is followed by square brackets", name.text),
       "Arguments of functions stand in round brackets; square ones hold a unit.",
       fmt::format("Write {}({}).", function->name, argument));
}

// mgl(1 - cos θ), arctan(x), sine(x): what it was meant to be, with the text to write.
void ExpressionParser::unknown_before_bracket(const Token& name) {
  const std::string bracket = text_to_closing_bracket();
  const std::string message = fmt::format("`{}` is neither a function nor a name of this model", name.text);
  if (const std::string_view formula = formula_of_habit(name.text); !formula.empty()) {
    fail("E0122", name.span, message, "The language has one spelling for each function.",
         fmt::format("Write {}.", formula));
  }
  if (const std::string_view function = function_of_habit(name.text); !function.empty()) {
    fail("E0122", name.span, message, "The language has one spelling for each function.",
         fmt::format("Write {}{}.", function, bracket));
  }
  if (const Spelling right = right_spelling(name.text, context_.declarations.names()); !right.text.empty()) {
    const bool applied = find_function(right.text.substr(right.text.rfind(' ') + 1)) != nullptr;
    fail("E0122", name.span, message, right.reason,
         fmt::format("Write {}{}{}.", right.text, applied ? "" : " ", bracket));
  }
  std::vector<std::string> candidates;
  for (const Function& function : functions()) candidates.emplace_back(function.name);
  const std::string near = did_you_mean(name.text, candidates);
  fail("E0122", name.span, message, "Before a bracket stands a function or a factor.",
       near.empty() ? "Declare it with `param` or `let` if it is a factor." : fmt::format("Did you mean `{}`?", near));
}

// From the bracket that opens here to its partner; (…) where that is long.
std::string ExpressionParser::text_to_closing_bracket() const {
  constexpr std::size_t longest = 60;
  int depth = 0;
  for (std::size_t i = 0; index_ + i < end_; ++i) {
    depth += peek(i).is("(") ? 1 : peek(i).is(")") ? -1 : 0;
    if (depth > 0) continue;
    const std::string text = text_of(cover(peek().span, peek(i).span));
    return text.size() <= longest && text.find('\n') == std::string::npos ? text : "(…)";
  }
  return "(…)";
}

ExpressionParser::Node ExpressionParser::bracket(bool of_quantities) {
  const Nesting nesting(*this);
  const Token& open = next();
  if (peek().is(")"))
    fail("E0126", cover(open.span, peek().span), "these brackets are empty", "",
         "Write a formula or a vector in them.");
  std::vector<Node> parts;
  do parts.push_back(of_quantities ? quantity() : in_condition_ ? disjunction() : sum());
  while (accept(","));
  if (!peek().is(")")) fail_expected("`,` or `)`");
  const Span span = cover(open.span, next().span);
  if (parts.size() == 1) {
    Node node = parts.front();
    if (node->bracketed) node = std::make_shared<Expression>(*node);
    node->bracketed = true;
    node->span = span;
    return peek().is("[") && is_constant(*node) ? with_bracketed_unit(std::move(node)) : node;
  }
  if (parts.size() > 3) {
    fail("E0126", span, fmt::format("this vector has {} components", parts.size()),
         "A model is two- or three-dimensional.", "Write (a, b) or (a, b, c).");
  }
  Node vector = make(Kind::Vector, span);
  vector->arguments.assign(parts.begin(), parts.end());
  finish(vector);
  return peek().is("[") ? with_bracketed_unit(std::move(vector)) : vector;
}

// 3 [J], pi [rad/s], (2 pi) [rad/s], (1, 2) [m]
ExpressionParser::Node ExpressionParser::with_bracketed_unit(Node value) {
  UnitExpression unit = bracketed_unit();
  Node node = make(Kind::Quantity, cover(value->span, unit.span), {value});
  node->unit = std::move(unit);
  node->unit_bracketed = true;
  return node;
}

// ----------------------------------------------------------------------------------------- restricted operands

ExpressionParser::Node ExpressionParser::operand(std::string_view what) {
  if (peek().is("(")) return bracket();
  if (peek().kind != Token::Kind::Name || is_clause_word(peek().text) || find_function(peek().text)) {
    fail_expected(what, "Here stands the name of a point or a vector in brackets.");
  }
  const Name word = used_name(what);
  Node node = make(Kind::Name, word.span);
  node->text = word.text;
  node->name_span = word.span;
  return node;
}

ExpressionParser::Node ExpressionParser::variable() {
  if (peek().kind != Token::Kind::Name || is_clause_word(peek().text) || find_function(peek().text)) {
    fail_expected("a coordinate or its velocity");
  }
  return postfix();
}

}  // namespace maupertuis::syntax

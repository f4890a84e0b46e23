#include "syntax/expression_parser.hpp"

#include <fmt/format.h>

#include <utility>

/// Applications of functions, with and without brackets (rules 2, 3 and 7), and piecewise.
namespace maupertuis::syntax {
namespace {

using Kind = Expression::Kind;

}  // namespace

ExpressionParser::Node ExpressionParser::call(const Function& function) {
  const Token& name = next();
  if (name.is("piecewise")) return piecewise(name);
  if ((name.is("reaction") || name.is("multiplier")) && !peek().is("(")) return bare_reaction(name);
  Node exponent;
  const std::string written_exponent = peek().is("^") ? function_exponent(name, exponent) : std::string();
  Node node;
  if (peek().is("(")) {
    node = arguments_of(name, function);
  } else if (function.bare) {
    node = bare_argument(name, exponent);
  } else {
    const bool argument = peek().kind == Token::Kind::Name && !is_clause_word(peek().text);
    fail("E0113", name.span, fmt::format("`{}` needs brackets", name.text),
         "Only circular and hyperbolic functions are written without them.",
         fmt::format("Write {}({}).", name.text, argument ? peek().text : "…"));
  }
  if (!exponent) return node;
  node = binary(Operator::Power, std::move(node), std::move(exponent));
  return node;
}

// The 2 of sin^2 θ. sin^-1 has two meanings and gets none.
std::string ExpressionParser::function_exponent(const Token& function, Node& exponent) {
  const Token& sign = next();
  const Function& entry = *find_function(function.text);
  if (!entry.bare) {
    fail("E0113", cover(function.span, sign.span),
         fmt::format("`{}` takes no exponent before its argument", function.text), "",
         fmt::format("Write {}(…)^2.", function.text));
  }
  if (peek().is("-")) {
    const Span span = cover(function.span, peek(1).span);
    fail("E0115", span, fmt::format("`{}` has two meanings", text_of(span)),
         "Some read the inverse function in it, others the reciprocal.",
         fmt::format("Write a{0}(…) or 1/{0}(…).", function.text));
  }
  const Token& number = peek();
  if (number.kind != Token::Kind::Number || number.text.find_first_not_of("0123456789") != std::string_view::npos) {
    fail("E0115", cover(function.span, number.span),
         fmt::format("only a whole number may stand in `{}^…`", function.text), "",
         fmt::format("Write {}(…)^… for any other power.", function.text));
  }
  next();
  exponent = make(Kind::Number, number.span);
  exponent->text = number.text;
  return std::string(number.text);
}

// One name, with primes and fields, and perhaps a number attached: cos 2θ, cos P.x'.
ExpressionParser::Node ExpressionParser::bare_argument(const Token& function, const Node& exponent) {
  const std::string head = exponent ? fmt::format("{}^{}", function.text, exponent->text) : std::string(function.text);
  const Token& first = peek();
  const bool numbered = first.kind == Token::Kind::Number && peek(1).kind == Token::Kind::Name &&
                        !is_clause_word(peek(1).text) && !find_function(peek(1).text);
  if (first.is("-")) {
    const std::string after(peek(1).text);
    fail("E0113", cover(function.span, peek(1).span),
         fmt::format("`{}` without brackets cannot take a sign", function.text),
         fmt::format("Without brackets {} takes one name.", function.text), fmt::format("Write {}(-{}).", head, after));
  }
  if (first.kind == Token::Kind::Number && !(numbered && peek(1).attached)) {
    fail("E0113", cover(function.span, first.span), fmt::format("what `{}` applies to is not clear", function.text),
         fmt::format("Without brackets {} takes one name, optionally with a number attached: {} 2θ.", function.text,
                     function.text),
         numbered ? fmt::format("Write {}({} {}).", head, first.text, peek(1).text)
                  : fmt::format("Write {}({} …).", head, first.text));
  }
  if (first.kind == Token::Kind::Name && find_function(first.text)) {
    fail("E0113", cover(function.span, first.span),
         fmt::format("`{}` without brackets cannot take another function", function.text),
         fmt::format("Without brackets {} takes one name.", function.text),
         fmt::format("Write {}({} …).", head, first.text));
  }
  if (!numbered && (first.kind != Token::Kind::Name || is_clause_word(first.text))) {
    fail_expected(fmt::format("the argument of `{}`", function.text));
  }
  Node argument = numbered ? make(Kind::Number, first.span) : nullptr;
  if (numbered) {
    check_number(first);
    argument->text = next().text;
  }
  Node word = postfix();
  argument = argument ? binary(Operator::Juxtapose, std::move(argument), std::move(word)) : std::move(word);
  if (peek().is("^")) {
    const std::string shown = text_of(*argument);
    const Token& power = peek(1);
    fail("E0114", cover(function.span, power.span), fmt::format("`{} {}^{}` has two meanings", head, shown, power.text),
         fmt::format("It is not clear whether {} or {} is raised.", shown, function.text),
         fmt::format("Write {}^{} {} or {}({}^{}).", function.text, power.text, shown, function.text, shown,
                     power.text));
  }
  Node node = make(Kind::Call, cover(function.span, argument->span), {argument});
  node->text = function.text;
  node->name_span = function.span;
  node->bare = true;
  return node;
}

ExpressionParser::Node ExpressionParser::arguments_of(const Token& name, const Function& function) {
  const Nesting nesting(*this);
  const bool outer = std::exchange(in_condition_, false);
  const Token& open = next();
  std::vector<Node> arguments;
  if (!peek().is(")")) {
    do arguments.push_back(sum());
    while (accept(","));
  }
  in_condition_ = outer;
  if (!peek().is(")")) fail_expected("`,` or `)`");
  const Span span = cover(name.span, next().span);
  const auto count = static_cast<int>(arguments.size());
  if (count < function.least || (function.most > 0 && count > function.most)) {
    const std::string wanted = function.least == function.most ? fmt::format("{}", function.least)
                               : function.most == 0            ? fmt::format("at least {}", function.least)
                                                               : fmt::format("{} or {}", function.least, function.most);
    fail("E0116", cover(open.span, span),
         fmt::format("`{}` takes {} argument{}, not {}", name.text, wanted, wanted == "1" ? "" : "s", count));
  }
  if (name.is("dot") && count == 1) {
    Node operand = arguments.front();
    const bool named = (operand->kind == Kind::Name || operand->kind == Kind::Member) && !operand->bracketed;
    if (named || operand->kind == Kind::TimeDerivative) {
      ++operand->primes;
      operand->span = span;
      return operand;
    }
    if (operand->kind != Kind::Vector) operand->bracketed = true;
    Node derivative = make(Kind::TimeDerivative, span, {operand});
    derivative->primes = 1;
    return derivative;
  }
  Node node = make(Kind::Call, span);
  node->text = name.text;
  node->name_span = name.span;
  node->arguments.assign(arguments.begin(), arguments.end());
  return finish(node);
}

ExpressionParser::Node ExpressionParser::bare_reaction(const Token& word) {
  const Name target = used_name(fmt::format("the name of a constraint after `{}`", word.text));
  Node argument = make(Kind::Name, target.span);
  argument->text = target.text;
  argument->name_span = target.span;
  Node node = make(Kind::Call, cover(word.span, target.span), {argument});
  node->text = word.text;
  node->name_span = word.span;
  node->bare = true;
  return node;
}

// ------------------------------------------------------------------------------------------------------ piecewise

ExpressionParser::Node ExpressionParser::piecewise(const Token& name) {
  const Nesting nesting(*this);
  if (!peek().is("(")) fail_expected("`(` after `piecewise`", "Write piecewise(x < 0 : a, else : b).");
  next();
  const bool outer = std::exchange(in_condition_, false);
  std::vector<Node> arguments;
  while (!accept("else")) {
    arguments.push_back(condition());
    expect(":", "the condition");
    arguments.push_back(sum());
    if (!peek().is(",")) fail_expected("`,` and `else : …`", "The last case of piecewise is `else : …`.");
    next();
  }
  if (arguments.empty())
    fail("E0116", name.span, "`piecewise` has no condition", "", "Write piecewise(x < 0 : a, else : b).");
  expect(":", "`else`");
  arguments.push_back(sum());
  in_condition_ = outer;
  if (!peek().is(")")) fail_expected("`)` after the last case");
  Node node = make(Kind::Piecewise, cover(name.span, next().span));
  node->text = name.text;
  node->name_span = name.span;
  node->arguments.assign(arguments.begin(), arguments.end());
  return finish(node);
}

ExpressionParser::Node ExpressionParser::condition() {
  const bool outer = std::exchange(in_condition_, true);
  Node node = disjunction();
  in_condition_ = outer;
  const bool decides = node->kind == Kind::Binary && node->op >= Operator::Less;
  if (!decides)
    fail("E0128", node->span, fmt::format("`{}` is not a condition", text_of(*node)), "",
         "Conditions use < <= > >= and or.");
  return node;
}

ExpressionParser::Node ExpressionParser::disjunction() {
  Node left = conjunction();
  while (accept("or")) left = binary(Operator::Or, std::move(left), conjunction());
  return left;
}

ExpressionParser::Node ExpressionParser::conjunction() {
  Node left = comparison();
  while (accept("and")) left = binary(Operator::And, std::move(left), comparison());
  return left;
}

ExpressionParser::Node ExpressionParser::comparison() {
  const auto compares = [](const Token& token) -> std::optional<Operator> {
    if (token.is("<")) return Operator::Less;
    if (token.is("<=")) return Operator::LessEqual;
    if (token.is(">")) return Operator::Greater;
    if (token.is(">=")) return Operator::GreaterEqual;
    return std::nullopt;
  };
  Node left = sum();
  const auto op = compares(peek());
  if (!op) return left;
  next();
  Node node = binary(*op, std::move(left), sum());
  if (compares(peek())) {
    fail("E0128", peek().span, "comparisons do not chain", "", "Write 0 < x and x < 1.");
  }
  return node;
}

}  // namespace maupertuis::syntax

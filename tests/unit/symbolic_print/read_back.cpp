#include "../forgotten_kind.hpp"
#include "typeset_reader.hpp"

#include <maupertuis/functions.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/syntax_tree.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

using namespace maupertuis;

/// Plain text is model language: the parser reads it back, and the tree that it builds has the value of the expression.
namespace {

constexpr std::array<const char*, 4> parameters{"a", "b", "m1", "k"};
constexpr std::array<const char*, 3> coordinates{"x", "θ1", "θ2"};

double value_of_name(const std::string& name, int primes) {
  double value = 0.37 + 0.21 * primes;
  for (const char c : name) value = std::fmod(value * 1.7 + static_cast<unsigned char>(c) * 0.013, 1.3) + 0.2;
  return value;
}

double evaluate(const syntax::Expression& e) {
  using K = syntax::Expression::Kind;
  using O = syntax::Operator;
  const auto arg = [&](std::size_t i) { return evaluate(*e.arguments[i]); };
  if (e.kind == K::Number) return std::stod(e.text);
  if (e.kind == K::Name) return e.text == "pi" ? std::acos(-1.0) : value_of_name(e.text, e.primes);
  if (e.kind == K::Unary) return -arg(0);
  if (e.kind == K::Piecewise) return arg(0) != 0 ? arg(1) : arg(2);
  if (e.kind == K::Binary) {
    if (e.op == O::Add) return arg(0) + arg(1);
    if (e.op == O::Subtract) return arg(0) - arg(1);
    if (e.op == O::Multiply || e.op == O::Juxtapose) return arg(0) * arg(1);
    if (e.op == O::Divide) return arg(0) / arg(1);
    if (e.op == O::Power) return std::pow(arg(0), arg(1));
    if (e.op == O::Less) return arg(0) < arg(1);
    if (e.op == O::LessEqual) return arg(0) <= arg(1);
    if (e.op == O::And) return arg(0) != 0 && arg(1) != 0;
    if (e.op == O::Or) return arg(0) != 0 || arg(1) != 0;
  }
  if (e.kind == K::Call) {
    const std::map<std::string, double (*)(double)> functions{{"sin", std::sin},   {"cos", std::cos},
                                                              {"tan", std::tan},   {"exp", std::exp},
                                                              {"sqrt", std::sqrt}, {"abs", std::fabs}};
    if (e.text == "min") return std::min(arg(0), arg(1));
    if (e.text == "step") return arg(0) >= 0;
    if (e.text == "log") return std::log(arg(0));
    if (const auto f = functions.find(e.text); f != functions.end()) return f->second(arg(0));
  }
  throw std::logic_error("a formula that these tests do not print");
}

double evaluate(Expr e) {
  const auto arg = [&](std::size_t i) { return evaluate(e[i]); };
  if (e.is_number()) return e.number().to_double();
  if (e.is(Kind::Pi)) return std::acos(-1.0);
  if (e.is_symbol()) return value_of_name(e.name(), e.order());
  if (e.is(Kind::Sum)) {
    double s = 0;
    for (std::size_t i = 0; i < e.size(); ++i) s += arg(i);
    return s;
  }
  if (e.is(Kind::Product)) {
    double p = 1;
    for (std::size_t i = 0; i < e.size(); ++i) p *= arg(i);
    return p;
  }
  if (e.is(Kind::Power)) return std::pow(arg(0), arg(1));
  if (e.is(Kind::Sin)) return std::sin(arg(0));
  if (e.is(Kind::Cos)) return std::cos(arg(0));
  if (e.is(Kind::Tan)) return std::tan(arg(0));
  if (e.is(Kind::Exp)) return std::exp(arg(0));
  if (e.is(Kind::Abs)) return std::fabs(arg(0));
  if (e.is(Kind::Less)) return arg(0) < arg(1);
  if (e.is(Kind::LessEqual)) return arg(0) <= arg(1);
  if (e.is(Kind::And)) return arg(0) != 0 && arg(1) != 0;
  if (e.is(Kind::Or)) return arg(0) != 0 || arg(1) != 0;
  if (e.is(Kind::Min)) return std::min(arg(0), arg(1));
  if (e.is(Kind::Step)) return arg(0) >= 0;
  if (e.is(Kind::Log)) return std::log(arg(0));
  if (e.is(Kind::Piecewise)) return arg(0) != 0 ? arg(1) : arg(2);
  throw std::logic_error("an expression that these tests do not make");
}

Expr random_expression(Context& c, const std::vector<int>& choices, std::size_t& next, int depth) {
  const auto pick = [&](int n) { return choices[next++ % choices.size()] % n; };
  const auto sub = [&] { return random_expression(c, choices, next, depth - 1); };
  if (depth == 0) {
    switch (pick(4)) {
      case 0:
        return c.number(Rational(pick(41) - 20, 1 + pick(12)));
      case 1:
        return c.symbol(parameters[static_cast<std::size_t>(pick(4))], Role::Parameter);
      case 2:
        return pick(5) == 0 ? c.pi() : c.symbol(parameters[static_cast<std::size_t>(pick(4))], Role::Parameter);
      default:
        return c.symbol(coordinates[static_cast<std::size_t>(pick(3))], Role::Coordinate, pick(3));
    }
  }
  switch (pick(15)) {
    case 0:
    case 1:
      return sub() + sub();
    case 2:
      return sub() - sub();
    case 3:
    case 4:
      return sub() * sub();
    case 5:
      return sub() / (sub() + Rational(7, 3));
    case 6:
      return pow(sub(), Rational(1 + pick(3)));
    case 7:
      return pow(pow(sub(), Rational(2)) + Rational(1), Rational(pick(7) - 3, 2));
    case 8:
      return apply(pick(2) ? Kind::Sin : Kind::Cos, c.symbol("θ1", Role::Coordinate, pick(2)));
    case 9:
      return apply(pick(2) ? Kind::Tan : Kind::Exp, c.symbol("x", Role::Coordinate) * Rational(pick(5) - 2, 2));
    case 10:
      return c.power(apply(Kind::Abs, sub()) + Rational(1), sub());
    case 11:
      return c.power(c.number(Rational(3, 2)),
                     sub() / (c.symbol("k", Role::Parameter) * c.symbol("x", Role::Coordinate)));
    case 12:
      return c.power(c.symbol("a", Role::Parameter), -(sub() / c.symbol("b", Role::Parameter)));
    case 13:
      return c.function(Kind::Min, std::array{sub(), sub()}) *
             apply(pick(2) ? Kind::Step : Kind::Log, c.symbol("x", Role::Coordinate));
    default: {
      const std::array sides{c.symbol("a", Role::Parameter), c.symbol("x", Role::Coordinate)};
      const Expr less = c.function(Kind::Less, sides),
                 other = c.function(Kind::LessEqual, std::array{c.symbol("b", Role::Parameter), sides[1]});
      const Expr either = c.function(Kind::Or, std::array{less, other}),
                 both = c.function(Kind::And, std::array{less, either});
      const std::array branches{pick(2) ? less : pick(2) ? either : both, sub(), sub()};
      return c.function(Kind::Piecewise, branches);
    }
  }
}

}  // namespace

struct Case {
  Context c;
  ReadingOrder order;
  Expr e;

  Case() {
    for (const char* p : parameters) order.parameters.push_back(c.symbol(p, Role::Parameter));
    for (const char* q : coordinates) order.coordinates.push_back(c.symbol(q, Role::Coordinate));
    const auto choices = *rc::gen::container<std::vector<int>>(40, rc::gen::inRange(0, 5040));
    std::size_t next = 0;
    e = random_expression(c, choices, next, 3);
  }
};

bool same_value(double printed, double meant) {
  return !std::isfinite(meant) || std::abs(printed - meant) <= 1e-9 * std::max(1.0, std::abs(meant));
}

TEST_CASE("what is printed can be read back") {
  CHECK(rc::check([] {
    Case it;
    const std::string text = to_plain(it.e, it.order);
    const SourceText source(
        "test.lag",
        "system s\nparam a = 1, b = 1, m1 = 1, k = 1\ncoord x : length, θ1, θ2 : angle\nlet z = " + text + "\n");
    Diagnostics diagnostics;
    const syntax::SyntaxTree tree = syntax::parse(source, diagnostics);
    if (diagnostics.has_errors()) RC_FAIL(text + ": " + diagnostics.items().front().message);
    const auto* let = std::get_if<syntax::LetStatement>(&tree.statements.back().body);
    RC_ASSERT(let != nullptr);
    if (!same_value(evaluate(*let->items.front().value), evaluate(it.e))) RC_FAIL(text);
  }));
}

TEST_CASE("LaTeX and MathML say what is meant to one who reads them as they stand") {
  CHECK(rc::check([] {
    Case it;
    const double meant = evaluate(it.e);
    const std::string latex = to_latex(it.e, it.order), mathml = to_mathml(it.e, it.order);
    if (!same_value(typeset_reader::value_of_latex(latex, value_of_name), meant)) RC_FAIL(latex);
    if (!same_value(typeset_reader::value_of_mathml(mathml, value_of_name), meant)) RC_FAIL(mathml);
  }));
}

TEST_CASE("a line that was broken says the same in its pieces") {
  CHECK(rc::check([] {
    Case it;
    const Layout layout = lay_out(it.e, it.order);
    for (const double line : {3.0, 8.0, 20.0}) {
      std::string latex, mathml;
      for (const Layout& piece : broken_lines(layout, {}, line, line))
        latex += " " + to_latex(piece), mathml += to_mathml(piece);
      for (const char* size : {"\\bigl", "\\bigr", "\\Bigl", "\\Bigr", "{}"})
        for (auto at = latex.find(size); at != std::string::npos; at = latex.find(size))
          latex.erase(at, std::string(size).size());
      if (!same_value(typeset_reader::value_of_latex(latex, value_of_name), evaluate(it.e))) RC_FAIL(latex);
      if (!same_value(typeset_reader::value_of_mathml(mathml, value_of_name), evaluate(it.e))) RC_FAIL(mathml);
    }
  }));
}

TEST_CASE("every function of the table is a word of the language, and is printed as such") {
  Context c;
  ReadingOrder order;
  const Expr x = c.symbol("x", Role::Coordinate);
  std::apply(
      [&](const auto&... row) {
        const auto read_back = [&](Kind kind, std::string_view name) {
          const std::string text = to_plain(apply(kind, Rational(2) * x), order);
          CHECK(text == std::string(name).append("(2 x)"));
          const SourceText source("test.lag", "system s\ncoord x : number\nlet z = " + text + "\n");
          Diagnostics diagnostics;
          const syntax::SyntaxTree tree = syntax::parse(source, diagnostics);
          INFO(render(diagnostics, source));
          REQUIRE_FALSE(diagnostics.has_errors());
          const syntax::Expression& call =
              *std::get<syntax::LetStatement>(tree.statements.back().body).items.front().value;
          CHECK(call.kind == syntax::Expression::Kind::Call);
          CHECK(call.text == name);
        };
        (read_back(row.kind, row.name), ...);
      },
      functions::rows);
}

TEST_CASE("no notation writes a kind that it does not know") {
  Context c;
  const Expr strange = node_of_forgotten_kind(c.symbol("x", Role::Coordinate));
  CHECK_THROWS_AS(to_plain(strange, {}), std::logic_error);
  CHECK_THROWS_AS(to_latex(strange, {}), std::logic_error);
  CHECK_THROWS_AS(to_mathml(strange, {}), std::logic_error);
  CHECK_THROWS_AS(to_dag_text(std::array{strange}), std::logic_error);
}

#include <maupertuis/print.hpp>
#include <maupertuis/syntax_tree.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <array>
#include <cmath>
#include <map>
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
  switch (e.kind) {
    case K::Number: return std::stod(e.text);
    case K::Name: return e.text == "pi" ? std::acos(-1.0) : value_of_name(e.text, e.primes);
    case K::Unary: return -arg(0);
    case K::Binary:
      switch (e.op) {
        case O::Add: return arg(0) + arg(1);
        case O::Subtract: return arg(0) - arg(1);
        case O::Multiply: case O::Juxtapose: return arg(0) * arg(1);
        case O::Divide: return arg(0) / arg(1);
        case O::Power: return std::pow(arg(0), arg(1));
        case O::Less: return arg(0) < arg(1);
        case O::LessEqual: return arg(0) <= arg(1);
        default: return std::nan("");
      }
    case K::Call: {
      const std::map<std::string, double (*)(double)> functions{
          {"sin", std::sin}, {"cos", std::cos}, {"tan", std::tan}, {"exp", std::exp}, {"sqrt", std::sqrt}, {"abs", std::fabs}};
      const auto f = functions.find(e.text);
      return f == functions.end() ? std::nan("") : f->second(arg(0));
    }
    case K::Piecewise: return arg(0) != 0 ? arg(1) : arg(2);
    default: return std::nan("");
  }
}

double evaluate(Expr e) {
  const auto arg = [&](std::size_t i) { return evaluate(e[i]); };
  switch (e.kind()) {
    case Kind::Number: return e.number().to_double();
    case Kind::Pi: return std::acos(-1.0);
    case Kind::Symbol: return value_of_name(e.name(), e.order());
    case Kind::Sum: { double s = 0; for (std::size_t i = 0; i < e.size(); ++i) s += arg(i); return s; }
    case Kind::Product: { double p = 1; for (std::size_t i = 0; i < e.size(); ++i) p *= arg(i); return p; }
    case Kind::Power: return std::pow(arg(0), arg(1));
    case Kind::Sin: return std::sin(arg(0));
    case Kind::Cos: return std::cos(arg(0));
    case Kind::Tan: return std::tan(arg(0));
    case Kind::Exp: return std::exp(arg(0));
    case Kind::Abs: return std::fabs(arg(0));
    case Kind::Less: return arg(0) < arg(1);
    case Kind::Piecewise: return arg(0) != 0 ? arg(1) : arg(2);
    default: return std::nan("");
  }
}

Expr random_expression(Context& c, const std::vector<int>& choices, std::size_t& next, int depth) {
  const auto pick = [&](int n) { return choices[next++ % choices.size()] % n; };
  const auto sub = [&] { return random_expression(c, choices, next, depth - 1); };
  if (depth == 0) {
    switch (pick(4)) {
      case 0: return c.number(Rational(pick(41) - 20, 1 + pick(12)));
      case 1: return c.symbol(parameters[static_cast<std::size_t>(pick(4))], Role::Parameter);
      case 2: return pick(5) == 0 ? c.pi() : c.symbol(parameters[static_cast<std::size_t>(pick(4))], Role::Parameter);
      default: return c.symbol(coordinates[static_cast<std::size_t>(pick(3))], Role::Coordinate, pick(3));
    }
  }
  switch (pick(12)) {
    case 0: case 1: return sub() + sub();
    case 2: return sub() - sub();
    case 3: case 4: return sub() * sub();
    case 5: return sub() / (sub() + Rational(7, 3));
    case 6: return pow(sub(), Rational(1 + pick(3)));
    case 7: return pow(pow(sub(), Rational(2)) + Rational(1), Rational(pick(7) - 3, 2));
    case 8: return apply(pick(2) ? Kind::Sin : Kind::Cos, c.symbol("θ1", Role::Coordinate, pick(2)));
    case 9: return apply(pick(2) ? Kind::Tan : Kind::Exp, c.symbol("x", Role::Coordinate) * Rational(pick(5) - 2, 2));
    case 10: return c.power(apply(Kind::Abs, sub()) + Rational(1), sub());
    default: {
      const std::array sides{c.symbol("a", Role::Parameter), c.symbol("x", Role::Coordinate)};
      const std::array branches{c.function(Kind::Less, sides), sub(), sub()};
      return c.function(Kind::Piecewise, branches);
    }
  }
}

}  // namespace

TEST_CASE("what is printed can be read back") {
  CHECK(rc::check([] {
    const auto choices = *rc::gen::container<std::vector<int>>(40, rc::gen::inRange(0, 5040));
    Context c;
    ReadingOrder order;
    for (const char* p : parameters) order.parameters.push_back(c.symbol(p, Role::Parameter));
    for (const char* q : coordinates) order.coordinates.push_back(c.symbol(q, Role::Coordinate));
    std::size_t next = 0;
    const Expr e = random_expression(c, choices, next, 3);
    const std::string text = to_plain(e, order);
    const SourceText source("test.lag", "system s\nparam a = 1, b = 1, m1 = 1, k = 1\ncoord x : length, θ1, θ2 : angle\nlet z = " + text + "\n");
    Diagnostics diagnostics;
    const syntax::SyntaxTree tree = syntax::parse(source, diagnostics);
    if (diagnostics.has_errors()) RC_FAIL(text + ": " + diagnostics.items().front().message);
    const auto* let = std::get_if<syntax::LetStatement>(&tree.statements.back().body);
    RC_ASSERT(let != nullptr);
    const double printed = evaluate(*let->items.front().value), meant = evaluate(e);
    if (!std::isfinite(meant)) return;
    if (!(std::abs(printed - meant) <= 1e-9 * std::max(1.0, std::abs(meant)))) RC_FAIL(text);
  }));
}

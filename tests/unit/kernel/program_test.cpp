#include "kernel/program/program.hpp"

#include <doctest/doctest.h>
#include <maupertuis/kernel.hpp>
#include <maupertuis/transform.hpp>

#include <stdexcept>
#include <string>

namespace {

using namespace maupertuis;

std::size_t lines_with(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + word.size())) ++count;
  return count;
}

Kernel chain(Context& context, int links) {
  KernelSource source;
  const Expr l = context.symbol("l", Role::Parameter);
  source.parameters = {l};
  Expr x = context.number(0), y = x, lagrangian = x;
  for (int i = 0; i < links; ++i) {
    const Expr angle = context.symbol("a" + std::to_string(i), Role::Coordinate);
    source.coordinates.push_back(angle);
    x = x + l * sin(angle);
    y = y - l * cos(angle);
    lagrangian = lagrangian + pow(context.time_derivative(x), 2) + pow(context.time_derivative(y), 2) - y;
  }
  source.residual = variational_residual(lagrangian, source.coordinates);
  return build_kernel(source);
}

}  // namespace

TEST_CASE("a chain of pendulums costs one sincos and two products a link") {
  Context context;
  const std::string text = chain(context, 10).print();
  CHECK(lines_with(text, "sincos") == 10);
  CHECK(lines_with(text, "products") == 10);
  CHECK(lines_with(text, "square") == 0);
}

TEST_CASE("what turns about one point is accelerated across its radius by the angle's acceleration: no products") {
  struct Turning {
    int across, along;  // sizes of x − X and y
    bool moves;         // X is a coordinate
    std::size_t products;
  };
  for (const Turning& t :
       {Turning{1, -1, false, 0}, Turning{-3, 3, false, 0}, Turning{1, -1, true, 1}, Turning{1, -2, false, 1}}) {
    CAPTURE(t.across);
    Context context;
    const Expr angle = context.symbol("θ", Role::Coordinate), m = context.symbol("m", Role::Parameter),
               l = context.symbol("l", Role::Parameter);
    KernelSource source;
    source.coordinates = {angle};
    source.parameters = {m, l};
    Expr x = context.number(t.across) * l * sin(angle);
    const Expr y = context.number(t.along) * l * cos(angle);
    if (t.moves) source.coordinates.push_back(context.symbol("X", Role::Coordinate)), x = x + source.coordinates[1];
    const Expr lagrangian = m * (pow(context.time_derivative(x), 2) + pow(context.time_derivative(y), 2)) - y;
    source.residual = variational_residual(lagrangian, source.coordinates);
    const std::string text = build_kernel(source).print();
    CHECK(lines_with(text, "= products") == t.products);
  }
}

TEST_CASE("sinh and cosh do not turn, and unlike sizes are not collected") {
  Context context;
  const Expr u = context.symbol("u", Role::Coordinate), m = context.symbol("m", Role::Parameter);
  const auto second = [&](Expr e) { return context.time_derivative(context.time_derivative(e)); };
  const auto products = [&](Expr residual) {
    KernelSource source;
    source.coordinates = {u};
    source.parameters = {m};
    source.residual = {residual};
    return lines_with(build_kernel(source).print(), "= products");
  };
  const Expr sinh = apply(Kind::Sinh, u), cosh = apply(Kind::Cosh, u);
  CHECK(products(m * cos(u) * second(sin(u)) - m * sin(u) * second(cos(u))) == 0);
  CHECK(products(m * cos(u) * context.time_derivative(sin(u)) - m * sin(u) * context.time_derivative(cos(u)) +
                 second(u)) == 0);
  CHECK(products(cosh * second(sinh) - sinh * second(cosh)) == 1);
  CHECK(products(m * cos(u) * second(sin(u)) - sin(u) * second(cos(u))) == 1);
}

TEST_CASE("the residual of a chain is about linear in the number of links") {
  Context context;
  const auto size = [](const std::string& text) { return text.size(); };
  const auto ten = size(chain(context, 10).print()), eighty = size(chain(context, 80).print());
  CHECK(eighty < 10 * ten);
}

TEST_CASE("sums that share exponentially stay linear") {
  Context context;
  const Expr q = context.symbol("q", Role::Coordinate);
  Expr e = q;
  for (int i = 0; i < 200; ++i) e = sin(e) * e + e;
  KernelSource source;
  source.coordinates = {q};
  source.residual = {context.symbol("q", Role::Coordinate, 2) + e};
  const Kernel kernel = build_kernel(source);
  CHECK(kernel.print().size() < 100000);
}

TEST_CASE("what depends on parameters alone is a constant, and unused nodes are gone") {
  Context context;
  const Expr q = context.symbol("q", Role::Coordinate), k = context.symbol("k", Role::Parameter);
  KernelSource source;
  source.coordinates = {q};
  source.parameters = {k};
  source.residual = {context.symbol("q", Role::Coordinate, 2) + sin(k) * apply(Kind::Exp, k) * q};
  const std::string text = build_kernel(source).print();
  CHECK(lines_with(text, "sincos") == 0);
  CHECK(lines_with(text, "linear") == 1);
  CHECK(text.find("1 instructions") != std::string::npos);
}

TEST_CASE("equal switch functions are one switch, whatever their factor") {
  Context context;
  const Expr q = context.symbol("q", Role::Coordinate);
  KernelSource source;
  source.coordinates = {q};
  source.residual = {context.symbol("q", Role::Coordinate, 2) + apply(Kind::Sign, q) +
                     apply(Kind::Abs, Rational(-2) * q)};
  CHECK(build_kernel(source).switches().size() == 1);
}

TEST_CASE("a symbol that nobody listed, and a residual that is not linear in the acceleration, are internal errors") {
  Context context;
  const Expr q = context.symbol("q", Role::Coordinate), a = context.symbol("q", Role::Coordinate, 2);
  KernelSource source;
  source.coordinates = {q};
  source.residual = {a + context.symbol("k", Role::Parameter)};
  CHECK_THROWS_AS(build_kernel(source), std::logic_error);
  source.residual = {a * a};
  CHECK_THROWS_AS(build_kernel(source), std::logic_error);
  source.residual = {context.time_derivative(a)};
  CHECK_THROWS_AS(build_kernel(source), std::logic_error);
}

TEST_CASE("forces of q alone are found when q is known: they have no tangents, and nothing of them is corrected") {
  Context context;
  KernelSource source;
  Expr potential = context.number(0), kinetic = potential;
  for (int i = 0; i < 6; ++i) {
    const Expr q = context.symbol("q" + std::to_string(i), Role::Coordinate);
    source.coordinates.push_back(q);
    kinetic = kinetic + pow(context.time_derivative(q), 2) * Rational(i + 1, 2);
  }
  const auto& q = source.coordinates;
  for (int i = 0; i < 6; i += 2)
    for (int j = 0; j < i; j += 2)
      potential = potential - pow(pow(q[i] - q[j], 2) + pow(q[i + 1] - q[j + 1], 2), Rational(-1, 2));
  source.residual = variational_residual(kinetic - potential, q);
  source.observables = {kinetic + potential};
  const Kernel three_bodies = build_kernel(source);
  const Program& program = three_bodies.program();
  CHECK(program.stored_end[2] == program.unknowns);
  for (const Run& run : program.runs[Dynamics])
    for (std::uint32_t i = run.first; i < run.last; ++i) {
      const Instruction& x = program.instructions[i];
      CHECK(x.lag == 2);
      if (x.op == Op::Power) CHECK(program.tangent_lags[x.out] == Program::unmoved);
    }
  // What is watched has all its orders as early as before, and what moves with accelerations is at hand before them.
  source.events = {pow(q[0] - q[2], 2) + pow(q[1] - q[3], 2)};
  const Kernel watched = build_kernel(source);
  CHECK(watched.program().lags[watched.program().events[0]] == 0);
  source.events.clear();
  source.residual[0] = source.residual[0] + sin(q[0]) * context.time_derivative(context.time_derivative(q[1]));
  const Kernel coupled = build_kernel(source);
  for (const Instruction& x : coupled.program().instructions)
    if (x.op == Op::SinCos) CHECK(x.lag == 0);
}

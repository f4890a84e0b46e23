#include "support.hpp"

#include <cmath>

using namespace maupertuis;
using test::Elaborated;

namespace {

constexpr const char* kPendulum =
    "param m = 1 kg, l = 2 m, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at (x, y)\ngravity (0, -g)\n";

Expr symbol(const Elaborated& m, const char* name) { return m.system().find_parameter(name)->symbol; }

}  // namespace

TEST_CASE("a constraint is left minus right, a position constraint where no velocity stands in it") {
  const Elaborated m(std::string(kPendulum) + "constraint x^2 + y^2 = l^2 name rod\n");
  REQUIRE(m.system().constraints.size() == 1);
  const Constraint& c = m.system().constraints[0];
  CHECK(c.level == Constraint::Level::Position);
  CHECK(c.name == "rod");
  CHECK(c.multiplier.name() == "λ_rod");
  CHECK(c.multiplier.role() == Role::Multiplier);
  CHECK(c.reaction.name() == "reaction(rod)");
  CHECK(c.dimension == dimensions::length() * dimensions::length());
  CHECK(evaluate(c.value, m.at({3, 5}, {7, 11})) == doctest::Approx(9 + 25 - 4));
  CHECK(symbols_of(std::vector<Expr>{c.value}).size() == 3);
}

TEST_CASE("a velocity makes a velocity constraint; one that cancels does not") {
  const Elaborated v(std::string(kPendulum) + "constraint x' = l/1 [s] name a\n");
  CHECK(v.system().constraints[0].level == Constraint::Level::Velocity);
  CHECK(evaluate(v.system().constraints[0].value, v.at({0, 0}, {7, 0})) == doctest::Approx(7.0 - 2));
  const Elaborated p(std::string(kPendulum) + "constraint (x + y)' * 1 [s] + x = (x' + y') * 1 [s] + l\n");
  CHECK(p.system().constraints[0].level == Constraint::Level::Position);
}

TEST_CASE("multipliers are named after their constraints, or numbered") {
  const Elaborated one(std::string(kPendulum) + "constraint x^2 + y^2 = l^2\n");
  CHECK(one.system().constraints[0].multiplier.name() == "λ");
  const Elaborated two("param m = 1 kg\ncoord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\n"
                       "constraint x = y\nconstraint y = z name belt\n");
  CHECK(two.system().constraints[0].multiplier.name() == "λ1");
  CHECK(two.system().constraints[1].multiplier.name() == "λ_belt");
  const Elaborated taken("param m = 1 kg, λ = 1 m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nconstraint x = y + λ\n");
  CHECK(taken.system().constraints[0].multiplier.name() == "Λ");
}

TEST_CASE("an input in a constraint stands for its formula of t") {
  const Elaborated m("param m = 1 kg, a = 3 m, w = 2 rad/s\ncoord x : length\nT = 1/2 m x'^2\n"
                     "input u : [m] = a sin(w t)\nconstraint x' + 1 [1/s] x = u'\n");
  const Bindings b = m.at({5}, {7}, 0.4);
  CHECK(evaluate(m.system().constraints[0].value, b) == doctest::Approx(7 + 5 - 3 * 2 * std::cos(0.8)));
}

TEST_CASE("definitions of parameters stay in the system as written and are expanded in the other") {
  const Elaborated m(std::string(kPendulum) + "let d = 2 l\nconstraint x^2 + y^2 = d^2\n");
  REQUIRE(m.system().written);
  const Constraint& c = m.system().constraints[0];
  const Constraint& w = m.system().written->constraints[0];
  CHECK(c.multiplier == w.multiplier);
  CHECK(c.value != w.value);
  CHECK(substitute(w.value, m.system().definition_values()) == c.value);
  CHECK(evaluate(c.value, m.at({3, 5}, {0, 0})) == doctest::Approx(9 + 25 - 16));
  CHECK(symbol(m, "l").role() == Role::Parameter);
}

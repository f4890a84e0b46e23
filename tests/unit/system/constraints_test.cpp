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
  const Elaborated two(
      "param m = 1 kg\ncoord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\n"
      "constraint x = y\nconstraint y = z name belt\n");
  CHECK(two.system().constraints[0].multiplier.name() == "λ1");
  CHECK(two.system().constraints[1].multiplier.name() == "λ_belt");
  const Elaborated taken(
      "param m = 1 kg, λ = 1 m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nconstraint x = y + λ\n");
  CHECK(taken.system().constraints[0].multiplier.name() == "Λ");
}

TEST_CASE("an input in a constraint stands for its formula of t") {
  const Elaborated m(
      "param m = 1 kg, a = 3 m, w = 2 rad/s\ncoord x : length\nT = 1/2 m x'^2\n"
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

TEST_CASE("what is no constraint") {
  const auto codes = [](const std::string& line) {
    return Elaborated("param m = 1 kg, l = 2 m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = 1 [N/m] l x\n" +
                      line + "\n")
        .codes();
  };
  CHECK(codes("constraint l = 2 [m]") == "E0423");
  CHECK(codes("constraint 1 = 2") == "E0423");
  CHECK(codes("constraint l = 3 [m/s] t") == "E0423");
  CHECK(codes("constraint x = x") == "E0424");
  CHECK(codes("constraint x = x + l") == "E0423");
  CHECK(codes("constraint (x - y)^2 + 2 x y = x^2 + y^2") == "E0424");
  CHECK(codes("constraint x'' = y''") == "E0401");
  CHECK(codes("constraint x = y^2") == "E0304");
  CHECK(codes("constraint (x, y) = (y, x)") == "E0210");
  CHECK(codes("constraint x = y\nconstraint y = x") == "W0425");
  CHECK(codes("constraint x = y\nconstraint x = 2 y") == "");
  CHECK(codes("constraint x = abs(y)") == "E0426");
  CHECK(codes("constraint x = max(y, l)") == "E0426");
  CHECK(codes("input u : [m] = l step(t)\nconstraint x = u") == "E0426");
  CHECK(codes("input u : [m] = l sin(t/1 [s])\nconstraint x = u") == "");
  CHECK(codes("constraint x = y name m") == "E0202");
  CHECK(codes("constraint x = y name y") == "E0202");
  CHECK(codes("constraint x = y name a\nconstraint x = 2 y name a") == "E0202");
  CHECK(codes("reaction a = release l\nconstraint x = y name a") == "E0202");
  CHECK(codes("constraint x = y name a\nV += a") == "E0212");
  CHECK(codes("constraint x = y name L") == "E0202");
}

TEST_CASE("multipliers and reactions have their units, and their place") {
  const std::string head =
      "param m = 1 kg, l = 2 m\ncoord x, y : length, θ : angle\n"
      "T = 1/2 m (x'^2 + y'^2 + l^2 θ'^2)\nconstraint x^2 + y^2 = l^2 name rod\n"
      "constraint x' = l θ' name roll\nconstraint θ = 1 name stop\nreaction bar = release l\n";
  const auto codes = [&](const std::string& line) { return Elaborated(head + line + "\n").codes(); };
  CHECK(codes("expect multiplier(rod) at 1 s = 3 N/m ± 1") == "");
  CHECK(codes("expect multiplier(rod) at 1 s = 3 N ± 1") == "E0304");
  CHECK(codes("expect reaction rod at 1 s = 3 N ± 1") == "");
  CHECK(codes("expect reaction rod at 1 s = 3 N/m ± 1") == "E0304");
  CHECK(codes("expect reaction(roll) at 1 s = 3 N ± 1") == "");
  CHECK(codes("expect multiplier(stop) at 1 s = 3 N m ± 1") == "");
  CHECK(codes("expect reaction(stop) at 1 s = 3 N ± 1") == "E0304");
  CHECK(Elaborated("param L0 = 1 H\ncoord q, p : charge\nL = 1/2 L0 (q'^2 + p'^2)\nconstraint q' = p' name node\n"
                   "expect reaction(node) at 1 s = 3 V ± 1\n")
            .codes() == "");
  CHECK(codes("expect reaction(bar) at 1 s = 3 N ± 1") == "");
  CHECK(codes("expect multiplier(bar) at 1 s = 3 N ± 1") == "E0226");
  CHECK(codes("expect reaction(bra) at 1 s = 3 N ± 1") == "E0226");
  CHECK(codes("expect multiplier(x) at 1 s = 3 N ± 1") == "E0226");
  CHECK(codes("expect multiplier(2 x) at 1 s = 3 N ± 1") == "E0226");
  CHECK(codes("claim reaction(roll) = 0") == "");
  CHECK(codes("expect conserved reaction(roll)") == "E0225");
  CHECK(codes("expect (2 reaction(roll))' at 1 s = 3 N/s ± 1") == "E0225");
  CHECK(codes("V = l reaction(roll)") == "E0225");
  CHECK(codes("constraint reaction(roll) x = 0") == "E0225");
  CHECK(codes("force x = reaction(roll)") == "E0225");
  CHECK(codes("draw O - (x, y), reaction roll, reaction bar") == "");
  CHECK(codes("draw reaction rope") == "E0226");
  for (const char* word : {"holonomic", "nonholonomic", "scleronomic", "rheonomic", "integrable"})
    CHECK(codes(std::string("expect constraint roll is ") + word) == "");
  CHECK(codes("expect constraint roll is nonholomonic") == "E0227");
  CHECK(codes("expect constraint role is holonomic") == "E0226");
  CHECK(codes("expect constraint bar is holonomic") == "E0226");

  const Elaborated m(
      head + "draw reaction roll\nexpect constraint roll is nonholonomic\nexpect reaction roll at 1 s = 3 N ± 1\n");
  CHECK(m.experiment().drawing.at(0).names.at(0) == "roll");
  CHECK(m.expected<expectation::ConstraintClass>(0).constraint == "roll");
  CHECK(m.expected<expectation::ConstraintClass>(0).word == "nonholonomic");
  CHECK(m.expected<expectation::ValueAt>(1).subject == m.system().constraints[1].reaction);
}

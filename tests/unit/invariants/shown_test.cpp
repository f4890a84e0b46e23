// Which integrals a reader is shown, and that what holds between them is told in them alone.
#include "../model_text.hpp"

#include <maupertuis/invariants.hpp>

#include <algorithm>

using namespace maupertuis;

namespace {

Invariants found_in(const ModelText& m) {
  InvariantsOptions options;
  options.drift = options.completeness = false;
  Diagnostics diagnostics;
  auto found = find_invariants(m.model, m.equations, options, diagnostics);
  REQUIRE(found);
  return std::move(*found);
}

bool names_hidden_ones(Expr value, const Invariants& found) {
  const auto nodes = topological_order({&value, 1});
  return std::any_of(found.symbols.begin() + static_cast<std::ptrdiff_t>(found.shown), found.symbols.end(),
                     [&](const Expr& s) { return std::find(nodes.begin(), nodes.end(), s) != nodes.end(); });
}

/// Each bracket, computed anew from what the symbols stand for, has the value that is told.
void check_brackets(const ModelText& m, const Invariants& found) {
  ExprMap values;
  for (std::size_t i = 0; i < found.integrals.size(); ++i) values.emplace(found.symbols[i], found.integrals[i].value);
  const Expr mass = m.p("m");
  for (const PoissonBracket& b : found.brackets) {
    REQUIRE(b.first < b.second);
    if (b.second < found.shown && b.value.value) CHECK_FALSE(names_hidden_ones(b.value.value, found));
    if (!b.value.value) continue;
    // With p = m q': {F, G} = Σ (∂F/∂q ∂G/∂q' − ∂F/∂q' ∂G/∂q)/m
    Expr sum = m.system->context->number(0);
    for (const Coordinate& c : m.system->coordinates) {
      const auto slope = [&](std::size_t i, Expr s) { return differentiate(found.integrals[i].value, s); };
      sum = sum +
            (slope(b.first, c.q) * slope(b.second, c.velocity) - slope(b.first, c.velocity) * slope(b.second, c.q)) /
                mass;
    }
    CHECK(zero_test(sum - substitute(b.value.value, values)).verdict == Verdict::Zero);
  }
  for (const IntegralRelation& r : found.relations)
    CHECK(zero_test(substitute(r.value.value, values)).verdict == Verdict::Zero);
}

}  // namespace

TEST_CASE("a falling particle: charges without a name that are functions of others are hidden") {
  const ModelText m(
      "system fall\nparam m = 1 kg, g = 9.81 m/s^2\ncoord x, y, z : length\n"
      "point P mass m at (x, y, z)\ngravity (0, 0, -g)\n");
  const Invariants found = found_in(m);
  CHECK(found.integrals.size() == 14);
  CHECK(found.shown == 10);
  for (std::size_t i = 0; i < found.integrals.size(); ++i)
    CHECK((i < found.shown) == (found.integrals[i].independent || !found.integrals[i].name.empty()));
  CHECK_FALSE(names_hidden_ones(found.relations.front().value.value, found));
  check_brackets(m, found);
}

TEST_CASE("an oscillator in the plane: what brackets of shown ones lead to is shown") {
  const ModelText m(
      "system oscillator\nparam m = 1 kg, k = 2 N/m\ncoord x, y : length\n"
      "point P mass m at (x, y)\nV = 1/2 k (x^2 + y^2)\n");
  const Invariants found = found_in(m);
  CHECK(found.integrals.size() == 10);
  CHECK(found.shown == 8);  // energy, L, two Fradkin components, four of the phase
  for (std::size_t i = found.shown; i < found.integrals.size(); ++i) CHECK_FALSE(found.integrals[i].independent);
  check_brackets(m, found);
}

TEST_CASE("of a chain that is too long for every basis of functions the energy is found") {
  const int links = 12;
  std::string names, points;
  for (int i = 1; i <= links; ++i) {
    const std::string n = std::to_string(i), before = i > 1 ? "P" + std::to_string(i - 1) + " + " : "";
    names += (i > 1 ? ", θ" : "θ") + n;
    points += "point P" + n + " mass m at " + before + "l (sin θ" + n + ", -cos θ" + n + ")\n";
  }
  const ModelText m("system chain\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord " + names + " : angle\n" + points +
                    "gravity (0, -g)\n");
  const Invariants found = found_in(m);
  REQUIRE(found.integrals.size() == 1);
  CHECK(found.integrals[0].name == "energy");
  CHECK(found.integrals[0].certificate.verdict == Verdict::Zero);
}

TEST_CASE("of many coordinates the momenta of cyclic ones are found beside the energy") {
  std::string names, energy;
  for (int i = 1; i <= 40; ++i) {  // a ring of springs: its centre moves uniformly
    const std::string n = std::to_string(i), next = std::to_string(i % 40 + 1);
    names += (i > 1 ? ", x" : "x") + n;
    energy += (i > 1 ? " + " : "") + ("sin(x" + next + " - x" + n + ")^4");
  }
  const ModelText m("system ring\nparam m = 1 kg, k = 1 N/m, l = 1 m\ncoord " + names + " : angle\nT = 1/2 m l^2 (" +
                    [&] {
                      std::string sum;
                      for (int i = 1; i <= 40; ++i) sum += (i > 1 ? " + x" : "x") + std::to_string(i) + "'^2";
                      return sum;
                    }() +
                    ")\nV = k l^2 (" + energy + ")\n");
  const Invariants found = found_in(m);
  CHECK(found.rank >= 2);
}

#include "support.hpp"

#include <maupertuis/locus.hpp>
#include <maupertuis/symbolic_linearization.hpp>

#include <maupertuis/print.hpp>

using namespace maupertuis;

namespace locus_test {
namespace {

const char* const hoop = R"(system hoop
param m = 100 g, R = 30 cm, g = 9.81 m/s^2, Ω = 8 rad/s
coord θ : angle
let φ = Ω t
point bead mass m at R (sin θ cos φ, sin θ sin φ, -cos θ)
gravity (0, 0, -g)
)";

std::size_t index_of(const MechanicalSystem& system, const std::string& name) {
  return static_cast<std::size_t>(system.find_parameter(name) - system.parameters.data());
}

std::string entry(const ExprMatrix& m, const Linearized& l) { return to_plain(m.at(0, 0), l.equations.order); }

}  // namespace

TEST_CASE("The bead on the hoop: a pitchfork at Ω = √(g/R), by bisection to rounding") {
  Linearized m(hoop);
  const Locus locus = parameter_locus(m.at, m.start, index_of(*m.system, "Ω"), 0, 12, 25);
  REQUIRE(locus.changes.size() == 1);
  CHECK(near(locus.changes[0].parameter, std::sqrt(9.81 / 0.3), 1e-7));
  CHECK(locus.changes[0].before == Stability::Energetic);
  CHECK(locus.changes[0].after == Stability::Unstable);
  CHECK(locus.branches.size() == 4);  // bottom, top, and two tilted ones
  for (const LocusBranch& b : locus.branches)
    for (const LocusPoint& x : b.points) {
      const double θ = x.equilibrium.point.q[0], w = x.parameter;
      if (std::abs(std::sin(θ)) > 1e-9) CHECK(std::abs(std::cos(θ) * 0.3 * w * w - 9.81) < 1e-7);
    }
  for (std::size_t b = 2; b < 4; ++b)  // they grow out of the change
    CHECK(near(locus.branches[b].points.front().parameter, locus.changes[0].parameter, 1e-12));
  CHECK(m.at.parameter(index_of(*m.system, "Ω")) == 8);  // as before
}

TEST_CASE("A symmetry of one value of the parameter explains nothing at the others") {
  Linearized m(R"(dimensionless
param k = 0
coord x, y : number
T = 1/2 (x'^2 + y'^2)
V = -k x^4 + 1/2 y^2
start x = 0.1
)");
  const Locus locus = parameter_locus(m.at, m.start, index_of(*m.system, "k"), 0, 0.5, 3);
  CHECK(locus.translations.empty());
  for (const LocusBranch& b : locus.branches)
    for (const LocusPoint& x : b.points)
      if (x.parameter > 0) CHECK(x.stability.verdict != Stability::Energetic);
}

TEST_CASE("Formulas of the linearization") {
  Linearized m(hoop);
  const ModalStudy study = m.study();
  std::size_t tilted = 0;
  for (const ModalEntry& e : study.entries) {
    const auto s = symbolic_linearization(m.equations, e.linearization, study.translations);
    REQUIRE(s);
    CHECK(entry(s->mass, m) == "m R^2");
    if (s->equilibrium.empty()) continue;
    ++tilted;
    CHECK(to_plain(s->equilibrium[0].first, m.equations.order) == "cos θ");
    // ω² = Ω² − g²/(R² Ω²)
    const Expr w = m.p("Ω"), g = m.p("g"), R = m.p("R");
    CHECK(
        zero_test(s->square - (pow(w, Rational(2)) - pow(g, Rational(2)) / (pow(R, Rational(2)) * pow(w, Rational(2)))))
            .verdict == Verdict::Zero);
  }
  CHECK(tilted == 2);
}

TEST_CASE("A length that a spring takes is solved for") {
  Linearized m(R"(system spring
param m = 1 kg, k = 40 N/m, l0 = 1 m, g = 9.81 m/s^2
coord r : length, θ : angle
T = 1/2 m (r'^2 + r^2 θ'^2)
V = 1/2 k (r - l0)^2 - m g r cos θ
start r = 1.1 m
)");
  Diagnostics told;
  const std::vector<StartValue> at{{1, 0, m.number(0), {}, {}}};
  const auto study = modal_study_at(m.at, m.start, at, told);
  REQUIRE(study);
  const auto s = symbolic_linearization(m.equations, study->entries[0].linearization, study->translations);
  REQUIRE(s);
  REQUIRE(s->equilibrium.size() == 1);
  const Expr stretched = m.p("l0") + m.p("m") * m.p("g") / m.p("k");
  CHECK(zero_test(s->equilibrium[0].second.value - stretched).verdict == Verdict::Zero);
  CHECK(zero_test(s->stiffness.at(1, 1) - m.p("m") * m.p("g") * stretched).verdict == Verdict::Zero);
}

TEST_CASE("A part of π that it is only for these numbers is not taken for the formula") {
  Linearized m(
      "system twist\nparam J = 1 kg m^2, k = 1 N m, τ = 0.78539816339744830962 N m\ncoord θ : angle\nT = 1/2 J θ'^2\nV "
      "= 1/2 k θ^2 - τ θ\n");
  const ModalStudy study = m.study();
  const auto s = symbolic_linearization(m.equations, study.entries.at(0).linearization, study.translations);
  REQUIRE(s);
  REQUIRE(s->equilibrium.size() == 1);
  CHECK(zero_test(s->equilibrium[0].second.value - m.p("τ") / m.p("k")).verdict == Verdict::Zero);
}

}  // namespace locus_test

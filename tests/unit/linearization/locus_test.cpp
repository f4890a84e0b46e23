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

namespace {

Locus swept(Linearized& m, const std::string& name, double from, double to, std::size_t steps) {
  return parameter_locus(m.at, m.start, index_of(*m.system, name), from, to, steps);
}
const char* const crossing = "dimensionless\nparam r = 0\ncoord x : number\nL = 1/2 x'^2 + 1/2 r x^2 - 1/3 x^3\n";

}  // namespace

TEST_CASE("a subcritical branch far from the start is met, followed both ways, and its changes are no accidents") {
  // V' = x (a − u + u²), u = x²/100: at u = (1 ± √(1 − 4 a))/2, up to ten typical sizes away, for a < 1/4.
  const char* const subcritical =
      "dimensionless\nparam a = 1\ncoord x : number\nL = 1/2 x'^2 - 1/2 a x^2 + x^4/400 - x^6/60000\n";
  for (const auto& [from, to] : {std::pair(1.0, -0.5), std::pair(-0.5, 1.0)}) {
    CAPTURE(from);
    Linearized m(subcritical);
    const Locus locus = swept(m, "a", from, to, 16);
    REQUIRE(locus.branches.size() == 5);  // rest, two stable and two unstable ones
    std::size_t outer = 0;
    for (const LocusBranch& b : locus.branches)
      for (const LocusPoint& p : b.points) {
        const double x = p.equilibrium.point.q[0], u = x * x / 100;
        CHECK(std::abs(x * (p.parameter - u + u * u)) < 1e-9);
        outer += x * x > 60;
      }
    CHECK(outer == 16);  // a = −0.5, −0.4 … 0.2, on both sides
    for (const StabilityChange& c : locus.changes) CHECK(std::abs(c.parameter) < 1e-12);
  }
}

TEST_CASE("two branches that cross change their verdicts where they cross, on the grid or between its values") {
  for (const auto& [from, steps] : {std::pair(-1.03, 21), std::pair(-1.0, 21), std::pair(-0.77, 10)}) {
    CAPTURE(from);
    Linearized m(crossing);
    const Locus locus = swept(m, "r", from, 1, static_cast<std::size_t>(steps));
    CHECK(locus.branches.size() == 2);
    REQUIRE(locus.changes.size() == 2);
    for (const StabilityChange& c : locus.changes) {
      CHECK(std::abs(c.parameter) < 1e-6);
      CHECK((c.before == Stability::Energetic) == (c.after == Stability::Unstable));
    }
    for (const LocusBranch& b : locus.branches) CHECK(b.points.size() == static_cast<std::size_t>(steps));
  }
}

TEST_CASE("a branch that moves fast is one, however coarse the grid") {
  Linearized turned("dimensionless\nparam α = 0\ncoord θ : angle\nL = 1/2 θ'^2 + cos(θ - α)\n");
  const Locus two = swept(turned, "α", 0, 7, 15);
  CHECK(two.branches.size() == 2);
  CHECK(two.changes.empty());
  // Two rods under a load: each buckled shape is one branch from P = (3 - √5)/2 on.
  Linearized rods(
      "dimensionless\nparam P = 0.5\ncoord a, b : angle\nT = 1/2 (a'^2 + b'^2)\n"
      "V = 1/2 a^2 + 1/2 (b - a)^2 - P (2 - cos a - cos b)\n");
  const Locus buckled = swept(rods, "P", 0, 1, 11);
  CHECK(buckled.branches.size() == 3);
  REQUIRE(buckled.changes.size() == 1);
  CHECK(near(buckled.changes[0].parameter, (3 - std::sqrt(5)) / 2, 1e-7));
  // From the other end: they end on the straight one.
  const Locus back = swept(rods, "P", 1, 0, 11);
  CHECK(back.branches.size() == 3);
  REQUIRE(back.changes.size() == 1);
  CHECK(near(back.changes[0].parameter, (3 - std::sqrt(5)) / 2, 1e-7));
}

TEST_CASE("with an imperfection the branch that goes on stays stable, and the others begin at a fold") {
  Linearized m(
      "dimensionless\nparam Ω = 0.5\ncoord θ : angle\nL = 1/2 θ'^2 + 1/2 Ω^2 sin(θ)^2 + cos(θ) + 0.01 sin(θ)\n"
      "D = 0.05 θ'^2\n");
  const Locus locus = swept(m, "Ω", 0.5, 2, 16);
  CHECK(locus.changes.empty());
  const auto goes_on = std::find_if(locus.branches.begin(), locus.branches.end(), [](const LocusBranch& b) {
    return b.points.size() == 16 && std::abs(b.points.front().equilibrium.point.q[0]) < 0.1;
  });
  REQUIRE(goes_on != locus.branches.end());
  CHECK(goes_on->points.back().equilibrium.point.q[0] > 1.3);
  for (const LocusPoint& x : goes_on->points) CHECK(x.stability.verdict == Stability::Asymptotic);
}

namespace {

/// The folds of a sweep, forwards and back: each of two branches that end there.
std::vector<Fold> folds_of(const std::string& text, const std::string& name, double from, double to,
                           std::size_t steps) {
  std::vector<Fold> out;
  for (const bool back : {false, true}) {
    Linearized m(text);
    Locus locus = back ? swept(m, name, to, from, steps) : swept(m, name, from, to, steps);
    for (const Fold& f : locus.folds) {
      REQUIRE(f.branches.size() == 2);
      for (const std::size_t b : f.branches) {
        const auto& points = locus.branches[b].points;
        CHECK((points.front().parameter == f.parameter || points.back().parameter == f.parameter));
      }
    }
    if (!back) {
      out = locus.folds;
      continue;
    }
    REQUIRE(locus.folds.size() == out.size());
    for (std::size_t k = 0; k < out.size(); ++k) CHECK(near(out[k].parameter, locus.folds[k].parameter, 1e-12));
  }
  return out;
}

}  // namespace

TEST_CASE("a branch that ends between two values of the sweep ends in a fold") {
  // x'' = μ − x²
  const auto node =
      folds_of("dimensionless\nparam μ = 1\ncoord x : number\nL = 1/2 x'^2 + μ x - x^3/3\n", "μ", 1, -0.9, 9);
  REQUIRE(node.size() == 1);
  CHECK(std::abs(node[0].parameter) < 1e-13);
  CHECK(std::abs(node[0].equilibrium.point.q[0]) < 1e-9);

  // A tilted double well: f = ±2/√27 at x = ∓1/√3.
  const auto well =
      folds_of("dimensionless\nparam f = 0\ncoord x : number\nL = 1/2 x'^2 - 1/4 x^4 + 1/2 x^2 + f x\nD = 0.1 x'^2\n",
               "f", -1, 1, 12);
  REQUIRE(well.size() == 2);
  for (const int k : {0, 1}) {
    CHECK(near(well[static_cast<std::size_t>(k)].parameter, (2 * k - 1) * 2 / std::sqrt(27), 1e-13));
    CHECK(near(well[static_cast<std::size_t>(k)].equilibrium.point.q[0], (1 - 2 * k) / std::sqrt(3), 1e-9));
  }

  // A column with a hinge, bent by e to begin with: x − tan x = e, P cos x = 1.
  const double e = 0.05, x = -0.512039814;
  const auto column = folds_of(
      "dimensionless\nparam P = 1\ncoord x : angle\nT = 1/2 x'^2\nV = 1/2 (x - 0.05)^2 + P cos(x)\n", "P", 0.5, 2, 11);
  REQUIRE(column.size() == 1);
  const double at = column[0].equilibrium.point.q[0];
  CHECK(near(at, x, 1e-6));
  CHECK(near(at - std::tan(at), e, 1e-9));
  CHECK(near(column[0].parameter * std::cos(at), 1, 1e-12));

  // A bead on a turning hoop whose axis leans: (κ cos α)^(2/3) + (κ sin α)^(2/3) = 1 with κ = g/(R Ω²), in an angle and
  // on a constraint.
  const double α = 0.1, sum = std::pow(std::cos(α), 2.0 / 3) + std::pow(std::sin(α), 2.0 / 3);
  for (const char* text :
       {"dimensionless\nparam Ω = 1\ncoord θ : angle\nL = 1/2 θ'^2 + 1/2 Ω^2 sin(θ)^2 + cos(θ - 0.1)\n",
        "dimensionless\nparam Ω = 1\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) + 1/2 Ω^2 x^2 - y cos(0.1) + x "
        "sin(0.1)\nconstraint x^2 + y^2 = 1\nstart x = 0.1, y = -1\n"}) {
    CAPTURE(text);
    const auto hoop_folds = folds_of(text, "Ω", 0.7, 2, 8);
    REQUIRE(!hoop_folds.empty());
    CHECK(near(hoop_folds.front().parameter, std::pow(sum, 0.75), 1e-12));
  }
}

TEST_CASE("a branch that grows out of another one, and one that runs away, have no fold") {
  for (const char* text : {"dimensionless\nparam r = 0\ncoord x : number\nL = 1/2 x'^2 + 1/2 r x^2 - 1/4 x^4\n",
                           "dimensionless\nparam r = 0\ncoord x : number\nL = 1/2 x'^2 + 1/2 r x^2 + 1/4 x^4\n",
                           "dimensionless\nparam r = 0\ncoord x : number\nL = 1/2 x'^2 - 1/2 r x^2 + x\n"}) {
    CAPTURE(text);
    Linearized m(text);
    CHECK(swept(m, "r", -1.03, 1, 21).folds.empty());
  }
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

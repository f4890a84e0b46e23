// Slow motions beside fast ones, rests that are known to half of their digits, and many switches at one point.
#include "support.hpp"

#include <numbers>

using namespace maupertuis;

namespace {

Stability verdict_of(const std::string& text) {
  const ModalStudy study = Linearized(text).study();
  REQUIRE(study.entries.size() >= 1);
  return study.entries.front().analysis.stability.verdict;
}

}  // namespace

TEST_CASE("at a fold the sign of the second derivative is an accident, and decides nothing") {
  // V' = F (1 - cos(x/w - 0.3)) ≥ 0 touches 0 without a sign change: an inflection of V.
  CHECK(verdict_of("param m = 2 kg, w = 0.8 m, F = 1 N\ncoord x : length\nT = 1/2 m x'^2\n"
                   "V = F x - F w sin(x/w - 0.3)\nstart x = 0.9 m\n") == Stability::Undecided);
  // (x - 0.7)³, multiplied out.
  CHECK(verdict_of("dimensionless\nparam a = 0.7\ncoord x : number\nL = 1/2 x'^2 - (x^3 - 3 x^2 a + 3 x a^2)\n"
                   "start x = 0.9\n") == Stability::Undecided);
  // Beside another coordinate that is held.
  CHECK(verdict_of("dimensionless\nparam b = 0.3\ncoord x, y : number\n"
                   "L = 1/2 (x'^2 + y'^2) - (x - b - sin(x - b)) - 1/2 (y - x)^2\nstart x = 0.9, y = 0.9\n") ==
        Stability::Undecided);
  // With a constraint: the same inflection along a line.
  CHECK(verdict_of("dimensionless\nparam b = 0.3\ncoord x, y : number\n"
                   "L = 1/2 (x'^2 + y'^2) - (x - b - sin(x - b))\nconstraint y = 2 x\nstart x = 0.9, y = 1.8\n") ==
        Stability::Undecided);
}

TEST_CASE("what is soft and has a sign keeps it") {
  CHECK(verdict_of("dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 y^2 - 0.5e-9 (x - 0.3)^2\n"
                   "start x = 0.9, y = 0\n") == Stability::Energetic);
  CHECK(verdict_of("dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 y^2 + 0.5e-9 (x - 0.3)^2\n"
                   "start x = 0.9, y = 0\n") == Stability::Unstable);
}

TEST_CASE("a slow swing beside a stiff bar that does not touch it") {
  Linearized slow(
      "param m = 1 kg, k = 1e12 N/m, T0 = 200 s\ncoord x, y : length\n"
      "L = 1/2 m (x'^2 + y'^2) - 1/2 k x^2 - 1/2 m (2 pi/T0)^2 y^2\n");
  const auto found = frequencies(slow.study().entries.front().analysis);
  REQUIRE(found.size() == 2);
  CHECK(near(found[0], std::numbers::pi / 100, 1e-12));
  CHECK(near(found[1], 1e6, 1e-12));
}

TEST_CASE("negative damping of a slow coordinate is not rounding of a fast one") {
  Linearized fed(
      "param m = 1 kg, k = 1e16 N/m, k2 = 1 N/m, c = -1e-7 N s/m\ncoord x, y : length\n"
      "L = 1/2 m (x'^2 + y'^2) - 1/2 k x^2 - 1/2 k2 y^2\nD = 1/2 c y'^2\n");
  const ModalAnalysis analysis = fed.study().entries.front().analysis;
  CHECK(analysis.stability.verdict == Stability::Unstable);
  CHECK(near(analysis.modes.front().eigenvalue.real(), 0.5e-7, 1e-6));
}

TEST_CASE("sides of a point on which many formulas switch") {
  const auto springs = [](std::size_t count) {
    std::string names, kinetic, potential;
    for (std::size_t i = 1; i <= count; ++i) {
      const std::string x = "x" + std::to_string(i), k = std::to_string(i * i);
      names += (i > 1 ? ", " : "") + x;
      kinetic += (i > 1 ? " + " : "") + x + "'^2";
      potential += " - " + k + "/2 * (" + x + "^2 + 3 max(" + x + ", 0)^2)";
    }
    return "dimensionless\ncoord " + names + " : number\nL = 1/2 (" + kinetic + ")" + potential + "\n";
  };
  // Each coordinate has the frequency i on one side and 2 i on the other.
  const ModalStudy four = Linearized(springs(4)).study();
  CHECK(four.entries.size() == 16);
  std::size_t with_four = 0;
  for (const ModalEntry& e : four.entries) {
    const auto found = frequencies(e.analysis);
    with_four += std::count_if(found.begin(), found.end(), [](double w) { return near(w, 8, 1e-12); });
  }
  CHECK(with_four == 8);
  Linearized seven(springs(7));
  CHECK_FALSE(modal_study(seven.at, seven.start, seven.diagnostics));
  REQUIRE_FALSE(seven.diagnostics.items().empty());
  CHECK(seven.diagnostics.items().front().code == "E1307");
  CHECK(seven.diagnostics.items().front().reason.find("7 formulas switch there") == 0);
}

TEST_CASE("a family is one of equilibria to 100 digits: no flat place, and no neighbourhood of a multiple root") {
  const auto study = [](const std::string& text) { return Linearized("dimensionless\n" + text).study(); };
  const auto alone_at = [&](const std::string& text, double x) {
    const ModalStudy found = study(text);
    CAPTURE(text);
    REQUIRE(found.entries.size() == 1);
    CHECK(found.entries[0].equilibrium.family == 0);
    CHECK(std::abs(found.entries[0].equilibrium.point.q[0] - x) < 1e-12);
  };
  alone_at("param a = 0.3\ncoord x : number\nL = 1/2 x'^2 - (x^4 - 4 a x^3 + 6 a^2 x^2 - 4 a^3 x + a^4)\nstart x = 1\n",
           0.3);
  alone_at("coord x, y : number\nL = 1/2 (x'^2 + y'^2) - (cos x - 1 + x^2/2)^3 - y^2\nstart x = 1\n", 0);  // x¹²
  // Far from 1 the force is 10⁻⁴⁰ beside the stiffness along y.
  alone_at("coord x, y : number\nL = 1/2 (x'^2 + y'^2) - (1 - exp(-(x - 1)^2))^2 - y^2/2\nstart x = 1, y = 0.5\n", 1);
  alone_at("coord x, y : number\nL = 1/2 (x'^2 + y'^2) - exp(-50 x^2) - y^4\nstart x = 1, y = 1\n", 0);
  // exp(-1/x²) has no value at its only rest, and no other place is one.
  Linearized flat("dimensionless\ncoord x : number\nL = 1/2 x'^2 - exp(-1/x^2)\nstart x = 1\n");
  CHECK_FALSE(modal_study(flat.at, flat.start, flat.diagnostics));
}

TEST_CASE("at the edge of where equations have values nothing rests, and steep derivatives there make no rest") {
  const auto places = [](const std::string& potential) {
    Linearized m("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = " + potential + "\nstart x = 1\n");
    EquilibriumSearch search;
    search.start = m.start;
    std::vector<double> out;
    for (const Equilibrium& x : find_equilibria(m.at, search).found) out.push_back(x.point.q[0]);
    return out;
  };
  CHECK(places("x^1.5 + x").empty());             // the force at 0 is −1, beside a stiffness of 10¹² at 10⁻²⁶
  CHECK(places("x^1.5").empty());                 // it vanishes at 0 alone, beyond which there is none
  CHECK(places("x^2 log(x) - x^2").size() == 1);  // at √e, not at 0
  CHECK(places("-x - log(x)").empty());           // −1/x balances at −1, where the logarithm has no value
  // A rest next to the edge is one: 3/2 √x = a.
  for (const double a : {1.0, 1e-2, 1e-4, 1e-5}) {
    CAPTURE(a);
    const std::vector<double> found = places("x^1.5 - " + std::to_string(a) + " x");
    REQUIRE(found.size() == 1);
    CHECK(found[0] == doctest::Approx(4 * a * a / 9).epsilon(1e-9));
  }
  const std::vector<double> between = places("abs(x)^1.5");  // values on both sides
  REQUIRE(between.size() == 1);
  CHECK(std::abs(between[0]) < 1e-12);
}

TEST_CASE("a second term that is 10⁻¹⁸ of the first or less decides where rests are") {
  const auto places = [](const std::string& coordinates, const std::string& potential, const std::string& start) {
    Linearized m("dimensionless\ncoord " + coordinates + " : number\nT = 1/2 x'^2" +
                 (coordinates == "x" ? "" : " + 1/2 y'^2") + "\nV = " + potential + "\nstart " + start + "\n");
    EquilibriumSearch search;
    search.start = m.start;
    std::vector<std::vector<double>> out;
    for (const Equilibrium& x : find_equilibria(m.at, search).found) {
      CHECK(x.family == 0);
      out.push_back(x.point.q);
    }
    std::sort(out.begin(), out.end());
    return out;
  };
  using Places = std::vector<std::vector<double>>;
  for (const char* small : {"1e-18", "1e-22", "1e-25"}) {  // along the trough x = y²: at the middle and at both ends
    CAPTURE(small);
    const Places found = places("x, y", "(x - y^2)^2 + " + std::string(small) + " (y^2 - 1)^2", "x = 0.3");
    REQUIRE(found.size() == 3);
    CHECK(std::hypot(found[0][0], found[0][1]) < 1e-9);
    for (const std::size_t end : {1, 2}) CHECK(std::hypot(found[end][0] - 1, std::abs(found[end][1]) - 1) < 1e-9);
  }
  for (const char* small : {"1e-18", "1e-30"}) {  // on the ring: below and above
    CAPTURE(small);
    const Places found = places("x, y", "(x^2 + y^2 - 1)^2 + " + std::string(small) + " x", "x = 0");
    REQUIRE(found.size() == 3);
    for (const std::size_t k : {0, 2}) CHECK(std::hypot(std::abs(found[k][0]) - 1, found[k][1]) < 1e-9);
  }
  // (x − 1)² + c has no root, however small c.
  for (const char* small : {"1e-16", "1e-25", "1e-50"}) {
    CAPTURE(small);
    CHECK(places("x", "1/3 (x - 1)^3 + " + std::string(small) + " x", "x = 0.5").empty());
  }
  CHECK(places("x", "1/3 (x - 1)^3", "x = 0.5").size() == 1);
}

TEST_CASE("families that are some stay: rings, levers balanced by decimal numbers, flat pieces") {
  const auto family = [](const std::string& text) {
    const ModalStudy found = Linearized(text).study();
    CAPTURE(text);
    REQUIRE_FALSE(found.entries.empty());
    return found.entries[0].equilibrium.family;
  };
  CHECK(family("dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - (x^2 + y^2 - 1)^2\nstart x = 1\n") == 1);
  CHECK(family("dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - (x^2 + y^2 - 1)^4\nstart x = 1\n") == 1);
  CHECK(family("dimensionless\ncoord x : number\nL = 1/2 x'^2 - max(x, 0)^3\nstart x = -1\n") == 1);
  // 0.1 · 0.3 = 0.03 · 1 holds of the decimal numbers, not of their doubles; a spring in s makes θ no translation.
  CHECK(family("param m1 = 100 g, l1 = 30 cm, m2 = 30 g, l2 = 1 m, g = 9.81 m/s^2, k = 1 N/m\n"
               "coord θ : angle, s : length\npoint A mass m1 at l1 (cos θ, sin θ)\n"
               "point B mass m2 at -l2 (cos θ, sin θ)\npoint C mass m2 at (0, s)\n"
               "V = m1 g A.y + m2 g B.y + 1/2 k s^2 (2 + cos θ)\nstart θ = 0.3 rad\n") == 1);
}

namespace {

/// m1 on a stiff link beside m2 on a ground spring of 0.05 N/m, both under a constant pull a.
std::string on_a_soft_spring(const std::string& k, const std::string& a, const std::string& start = "x = 0 m") {
  return "param m1 = 1 kg, m2 = 3 kg, k = " + k + " N/m, kg = 0.05 N/m, a = " + a +
         " m/s^2\ncoord x, y : length\nL = 1/2 m1 x'^2 + 1/2 m2 y'^2 - m1 a x - m2 a y - 1/2 k (x - y)^2 - "
         "1/2 kg y^2\nstart " +
         start + "\n";
}

}  // namespace

TEST_CASE("a rest on a soft spring beside a stiff link is where the forces balance, however stiff the link") {
  for (const char* k : {"1e8", "1e10", "2e11", "1e14", "1e18"}) {
    CAPTURE(k);
    const ModalStudy study = Linearized(on_a_soft_spring(k, "9.81")).study();
    REQUIRE(study.entries.size() == 1);
    const std::vector<double>& q = study.entries.front().equilibrium.point.q;
    CHECK(near(q[0], -4 * 9.81 / 0.05 - 9.81 / std::stod(k), 1e-15));
    CHECK(near(q[1], -4 * 9.81 / 0.05, 1e-15));
  }
  // Where it hangs by 10 nm is no 0.
  const ModalStudy small = Linearized(on_a_soft_spring("2e11", "1.25e-10")).study();
  REQUIRE(small.entries.size() == 1);
  CHECK(near(small.entries.front().equilibrium.point.q[1], -1e-8, 1e-12));
}

TEST_CASE("39 N that nothing balances are no rest beside the stiffness of a link") {
  for (const char* given : {"x = 0 m, y = 0 m", "x = 0 m, y = -4.905e-11 m"}) {
    Linearized wrong(on_a_soft_spring("2e11", "9.81", given));
    std::vector<StartValue> values;
    for (const std::size_t i : {0, 1}) values.push_back({i, 0, wrong.number(wrong.start.q[i]), {}, {}});
    CHECK_FALSE(modal_study_at(wrong.at, wrong.start, values, wrong.diagnostics));
    values.pop_back();
    CHECK_FALSE(modal_study_at(wrong.at, wrong.start, values, wrong.diagnostics));
  }
  const ModalEntry right = Linearized(on_a_soft_spring("2e11", "9.81", "x = -784.8 m, y = -784.8 m")).here();
  CHECK(right.analysis.stability.verdict == Stability::Energetic);
}

TEST_CASE("a family along which a pendulum stands upright stays one") {
  const ModalStudy study = Linearized(
                               "dimensionless\ncoord x, y : number, θ : angle\nL = 1/2 (x'^2 + y'^2 + θ'^2) + cos(θ) - "
                               "1/4 (x^2 + y^2 - 1)^2\nstart x = 1, θ = 3\n")
                               .study();
  std::size_t upright = 0;
  for (const ModalEntry& e : study.entries) upright += e.equilibrium.family == 1 && e.equilibrium.point.q[2] > 3;
  CHECK(upright == 1);
}

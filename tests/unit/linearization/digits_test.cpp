// Eigenvalues that double does not tell from zero or from their neighbours, and what proves that friction takes energy.
#include "support.hpp"

using namespace maupertuis;

namespace {

ModalAnalysis first_of(const std::string& text) {
  const ModalStudy study = Linearized(text).study();
  REQUIRE(study.entries.size() >= 1);
  return study.entries.front().analysis;
}

std::string damper(const char* c, const char* k) {
  return std::string("dimensionless\nparam c = ") + c + ", k = " + k +
         "\ncoord x : number\nL = 1/2 x'^2 - 1/2 k x^2\nD = 1/2 c x'^2\nstart x = 1\n";
}

}  // namespace

TEST_CASE("a slow creep behind a strong damper is no zero") {
  for (const auto& [c, k, slow] : {std::tuple("1e6", "1e-6", -1e-12), std::tuple("1e3", "1e-14", -1e-17)}) {
    const ModalAnalysis creep = first_of(damper(c, k));
    REQUIRE(creep.modes.size() == 2);
    CHECK(near(creep.modes[0].eigenvalue.real(), slow, 1e-12));
    CHECK(creep.stability.verdict == Stability::Asymptotic);
  }
  CHECK(first_of(damper("1e6", "-1e-6")).stability.verdict == Stability::Unstable);
}

TEST_CASE("eigenvalues are told however small they are beside the largest") {
  const ModalAnalysis slow = first_of(
      "dimensionless\nparam m = 2e-12, c = 7e5, k = -7\ncoord x : number\nL = 1/2 m x'^2 - 1/2 k x^2\n"
      "D = 1/2 c x'^2\nstart x = 1\n");
  CHECK(slow.stability.verdict == Stability::Unstable);
  REQUIRE(slow.modes.size() == 2);
  CHECK(near(slow.modes[0].eigenvalue.real(), 1e-5, 1e-12));
  const ModalAnalysis beside = first_of(
      "dimensionless\nparam m = 1e-12, c = 1e6, k = 1e-6\ncoord x, y : number\n"
      "L = 1/2 m x'^2 + 1/2 y'^2 - 1/2 k x^2 - 1/2 y^2\nD = 1/2 c x'^2\nstart x = 1\n");
  REQUIRE(beside.modes.size() == 3);
  for (const Mode& mode : beside.modes) CHECK(mode.multiplicity == 1);
  REQUIRE(frequencies(beside).size() == 1);
  CHECK(near(frequencies(beside)[0], 1, 1e-15));
  const ModalAnalysis bound = first_of(  // to a strongly damped light mass, by a soft spring
      "dimensionless\nparam M = 1e-9, c = 1e9, K = 1e-9\ncoord x, z : number\n"
      "L = 1/2 x'^2 + 1/2 M z'^2 - 1/2 x^2 - 1/2 K (z - x)^2\nD = 1/2 c z'^2\nstart x = 1\n");
  REQUIRE(bound.modes.size() == 3);
  CHECK(bound.stability.verdict == Stability::Energetic);
  CHECK(near(bound.modes[0].eigenvalue.real(), -1e-18, 1e-8));
  CHECK(near(std::abs(bound.modes[2].eigenvalue.imag()), 1 + 0.5e-9, 1e-15));
  // Roots of the characteristic polynomial of fourth degree, computed in 60 digits elsewhere.
  const ModalAnalysis coupled = first_of(
      "dimensionless\nparam m1 = 2e-17, k1 = 6e7, m2 = 1e-3, C = 100, B = 80, k2 = 0.01\ncoord y, z : number\n"
      "L = 1/2 m1 y'^2 - 1/2 k1 y^2 + 1/2 m2 z'^2 - 1/2 k2 z^2 + B z y'\nD = 1/2 C (z' - y')^2\nstart y = 1\n");
  std::vector<double> decays;
  for (const Mode& mode : coupled.modes) decays.push_back(mode.eigenvalue.real());
  std::sort(decays.begin(), decays.end());
  REQUIRE(decays.size() == 4);
  CHECK(near(decays[1], -556107.1172471269, 1e-14));
  CHECK(near(decays[2], -107892.88265293596, 1e-14));
  CHECK(near(decays[3], -0.00010000000009400001, 1e-14));
}

TEST_CASE("two oscillators joined by a damper") {
  const ModalAnalysis joined = first_of(
      "dimensionless\nparam c = 1e6, k = 1e-6\ncoord x, y : number\nL = 1/2 x'^2 + 1/2 y'^2 - 1/2 k x^2 - 1/2 y^2\n"
      "D = 1/2 c (x' - y')^2\nstart x = 1\n");
  CHECK(joined.stability.verdict == Stability::Asymptotic);
  REQUIRE(frequencies(joined).size() == 1);
  // Both move as one of mass 2 on the sum of the springs, to second order in 1/c: no digit of that is in double.
  CHECK(near(frequencies(joined)[0], std::sqrt(1.000001 / 2), 1e-9));
  CHECK(near(joined.modes[0].eigenvalue.real(), -1e-12, 1e-5));
}

TEST_CASE("the drift of a light charge in a trap") {
  const ModalAnalysis drift = first_of(
      "dimensionless\nparam m = 1e-18\ncoord x, y : number\n"
      "L = 1/2 m (x'^2 + y'^2) + 1/2 (x y' - y x') - 1/2 (x^2 + y^2)\nstart x = 1\n");
  CHECK(drift.stability.verdict == Stability::Energetic);
  REQUIRE(frequencies(drift).size() == 2);
  CHECK(near(frequencies(drift)[0], 1, 1e-15));
  CHECK(near(frequencies(drift)[1], 1e18, 1e-15));
}

TEST_CASE("frequencies of a stiff link on a soft spring have all their digits") {
  const ModalAnalysis link = first_of(
      "param m1 = 1 kg, m2 = 3 kg, k = 2e11 N/m, kg = 0.05 N/m\ncoord x, y : length\n"
      "L = 1/2 m1 x'^2 + 1/2 m2 y'^2 - 1/2 k (x - y)^2 - 1/2 kg y^2\nstart x = 0 m\n");
  REQUIRE(frequencies(link).size() == 2);
  // λ² − (k/m1 + k/m2 + kg/m2) λ + k kg/(m1 m2) = 0: the small root is kg/(m1 + m2) to 13 digits.
  CHECK(near(frequencies(link)[0], std::sqrt(0.05 / 4), 1e-12));
  CHECK(link.modes.front().error <= 1e-15);
  CHECK(link.stability.verdict == Stability::Energetic);
}

TEST_CASE("a zero that no symmetry explains says how large it may be") {
  const ModalAnalysis flat =
      first_of("dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/4 x^4 - 1/2 y^2\nstart x = 0\n");
  REQUIRE(flat.modes.front().kind == Mode::Kind::Zero);
  CHECK(flat.modes.front().error > 0);
  CHECK(flat.modes.front().error < 1e-7);
  const ModalAnalysis free = first_of("dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 y^2\n");
  REQUIRE(free.modes.front().kind == Mode::Kind::Zero);
  CHECK(free.modes.front().error == 0);
}

TEST_CASE("two oscillations of one shape are a Jordan chain, and grow like t") {
  // z = x + i y = e^{−it} (a + b t).
  const std::string turning =
      "dimensionless\nparam k = -1\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) + (x y' - y x') - 1/2 k (x^2 + y^2)\n";
  const ModalAnalysis chain = first_of(turning);
  REQUIRE(chain.modes.size() == 1);
  CHECK(chain.modes[0].chain == 2);
  CHECK(chain.modes[0].multiplicity == 2);
  CHECK(near(chain.modes[0].frequency(), 1, 1e-15));
  CHECK(chain.eigenvalues.size() == 4);
  CHECK(chain.stability.verdict == Stability::Unstable);
  CHECK(chain.stability.reason.find("grow like t") != std::string::npos);
  // With terms of higher order they decide.
  CHECK(first_of(turning.substr(0, turning.size() - 1) + " - x^4\n").stability.verdict == Stability::Undecided);
  // Equal frequencies with two shapes are none.
  const ModalAnalysis two = first_of("dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 (x^2 + y^2)\n");
  REQUIRE(two.modes.size() == 2);
  CHECK(two.modes[0].chain == 1);
  CHECK(two.modes[0].multiplicity == 2);
  // At the limit of aperiodic motion the decay is one.
  const ModalAnalysis limit =
      first_of("dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\nD = x'^2\nstart x = 1\n");
  REQUIRE(limit.modes.size() == 1);
  CHECK(limit.modes[0].chain == 2);
  CHECK(limit.stability.verdict == Stability::Asymptotic);
}

TEST_CASE("of friction that is looked at in single states alone no proof is told") {
  const auto reason = [](const std::string& d) {
    const ModalAnalysis a = first_of(
        "dimensionless\nparam ε = 1e-8, c = 0.1\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 (x^2 + y^2)\nD = " +
        d + "\nstart x = 1\n");
    CHECK(a.stability.verdict == Stability::Energetic);
    return a.stability.reason;
  };
  const auto says = [](const std::string& text) { return text.find("as far as looked at") != std::string::npos; };
  CHECK(says(reason("1/2 ((y - x)^2 - ε (x^2 + y^2)) (x'^2 + y'^2)")));  // gives energy in a narrow wedge
  CHECK_FALSE(says(reason("1/2 (y - x)^2 (x'^2 + y'^2)")));
  CHECK_FALSE(says(reason("1/2 c (x' - y')^2")));
  CHECK_FALSE(says(reason("1/2 c (x'^2 - 2 x' y' + y'^2)")));
  CHECK_FALSE(says(reason("c abs(x')^3 + c abs(y')^3")));
}

TEST_CASE("friction that gives a little is not proved to take") {
  const auto told = [](const std::string& dissipation) {
    return first_of("dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 (x^2 + 2 y^2)\nD = " +
                    dissipation + "\nstart x = 1\n")
        .stability;
  };
  const std::string doubt = "as far as looked at";
  for (const char* gives : {"0.2 y'", "-1e-15 x'^2 + 0.1 y'^2", "1/2 ((x' + y')^2 - 1e-16 x'^2)"}) {
    CAPTURE(gives);
    const StabilityReport report = told(gives);
    const bool doubts = report.verdict != Stability::Energetic || report.reason.find(doubt) != std::string::npos;
    CHECK(doubts);
  }
  for (const char* takes : {"1/2 (x' + y')^2", "1/2 (x' - 3 y')^2 + 1e-15 x'^2"}) {
    CAPTURE(takes);
    CHECK(told(takes).reason.find(doubt) == std::string::npos);
  }
}

TEST_CASE("forces without a potential, or along velocities, may feed a motion, however small they are") {
  const auto is_stable = [](const std::string& c, const std::string& forces) {
    const Stability verdict =
        first_of("dimensionless\nparam c = " + c +
                 "\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) + 3 (x y' - y x') + 1/2 (x^2 + y^2)\n" + forces +
                 "start x = 1\n")
            .stability.verdict;
    return verdict == Stability::Energetic || verdict == Stability::Linear;
  };
  const std::string circulatory = "force x = c y\nforce y = -c x\n", driving = "force x = c x'\n";
  for (const char* c : {"1e-14", "1e-25", "1e-300"}) {
    CAPTURE(c);
    CHECK_FALSE(is_stable(c, circulatory));
    CHECK_FALSE(is_stable(c, driving));
  }
  CHECK(is_stable("0", circulatory));
  CHECK(is_stable("0.1", "force x = c y\nforce y = c x\n"));
}

namespace {

/// Three bodies in a row on stiff links, with a fourth that a constraint carries along.
std::string carried(const char* e, const char* constraint) {
  return std::string("dimensionless\nparam k = 1e12, e = ") + e +
         "\ncoord x, y, z, w : number\nL = 1/2 (x'^2 + y'^2 + z'^2 + w'^2) - 1/2 k (x - y)^2 - 1/2 k (y - z)^2 "
         "- 1/2 e x^2\nconstraint " +
         constraint + "\n";
}

}  // namespace

TEST_CASE("constraints leave frequencies all their digits") {
  for (const char* constraint : {"w = z", "w' = z'", "w = z + 1/2 z^2", "w = z\nconstraint 2 w = z + w"}) {
    CAPTURE(constraint);
    const ModalAnalysis soft = first_of(carried("1e-2", constraint));
    REQUIRE(frequencies(soft).size() == 3);
    CHECK(near(frequencies(soft)[0], 0.05, 1e-13));  // all four on one spring
    const ModalAnalysis pushed = first_of(carried("-1e-2", constraint));
    CHECK(pushed.stability.verdict == Stability::Unstable);
    CHECK(near(pushed.stability.growth_rate, 0.05, 1e-13));
  }
  CHECK(first_of(carried("1e-2", "w = z")).stability.verdict == Stability::Energetic);
}

TEST_CASE("a rod that pulls, and a stiff link at its end, have all their digits") {
  // About the bottom: m (x'' + g/l x) + k (x − X) = 0, n X'' + k (X − x) = 0.
  const double g_l = 9.81 / 0.7, k = 1e13, m = 2, n = 3;
  const ModalAnalysis rod = first_of(
      "dimensionless\nparam m = 2, n = 3, l = 0.7, g = 9.81, k = 1e13\ncoord x, y, X : number\n"
      "L = 1/2 m (x'^2 + y'^2) + 1/2 n X'^2 - m g y - 1/2 k (x - X)^2\nconstraint x^2 + y^2 = l^2\nstart y = -0.7\n");
  REQUIRE(frequencies(rod).size() == 2);
  const double sum = g_l + k / m + k / n, product = g_l * k / n;
  const double large = (sum + std::sqrt(sum * sum - 4 * product)) / 2;
  CHECK(near(frequencies(rod)[0], std::sqrt(product / large), 1e-13));
  CHECK(near(frequencies(rod)[1], std::sqrt(large), 1e-13));
}

TEST_CASE("matrices are shown in the digits that their formulas lose") {
  // K = ∂²V/∂b² = c (1 − cos b), of which double keeps half the digits or less.
  Linearized m("dimensionless\nparam c = 1e10\ncoord b : number\nL = 1/2 b'^2 - c (cos b - 1 + b^2/2)\n");
  for (const double b : {1e-3, 1e-5, 1e-7}) {
    CAPTURE(b);
    const Linearization there = linearize(m.at, {0, {b}, {0}, {0}, {}, {}}).linearization;
    const double stiffness = -2e10 * std::pow(std::sin(b / 2), 2);
    CHECK(near(there.stiffness.at(0, 0), -stiffness, 1e-15));
    CHECK(near(there.a.at(1, 0), stiffness, 1e-15));
  }
}

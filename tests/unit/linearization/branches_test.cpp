// Sweeps stay on the branches that they follow: beside others that pass nearby, and through folds.
#include "support.hpp"

#include "analysis/linearization/branch_follower.hpp"

#include <maupertuis/locus.hpp>

#include <numbers>

using namespace maupertuis;

namespace {

Locus sweep_of(const std::string& text, const std::string& name, double from, double to, std::size_t steps) {
  Linearized m(text);
  const auto parameter = static_cast<std::size_t>(m.system->find_parameter(name) - m.system->parameters.data());
  Locus out = parameter_locus(m.at, m.start, parameter, from, to, steps);
  for (const LocusBranch& b : out.branches) CHECK(b.points.size() > 1);
  for (const Fold& f : out.folds) {
    REQUIRE(f.branches.size() == 2);
    for (const std::size_t b : f.branches) {
      const auto& points = out.branches[b].points;
      CHECK((points.front().parameter == f.parameter || points.back().parameter == f.parameter));
    }
  }
  return out;
}

/// V(x) of a particle of mass 1, in a.
std::string particle(const std::string& potential) {
  return "dimensionless\nparam a = 1\ncoord x : number\nL = 1/2 x'^2 - (" + potential + ")\nstart x = 1\n";
}

/// Folds at these parameters and places, ascending; no verdict changes elsewhere.
void has_folds(const Locus& locus, const std::vector<std::pair<double, double>>& expected) {
  CHECK(locus.changes.empty());
  REQUIRE(locus.folds.size() == expected.size());
  for (const auto& [parameter, place] : expected) {
    CAPTURE(parameter);
    CAPTURE(place);
    CHECK(std::any_of(locus.folds.begin(), locus.folds.end(), [&, p = parameter, x = place](const Fold& f) {
      return std::abs(f.parameter - p) <= 1e-14 && std::abs(f.equilibrium.point.q[0] - x) <= 1e-14;
    }));
  }
}

}  // namespace

TEST_CASE("branches that pass each other closely do not cross") {
  for (const char* gap : {"1e-2", "1e-4", "1e-6", "1e-8"})
    for (const std::size_t steps : {20, 21, 7}) {
      CAPTURE(gap);
      CAPTURE(steps);
      const Locus apart = sweep_of(particle(std::string("x^3/3 - (a^2 + ") + gap + ") x"), "a", -1, 1, steps);
      CHECK(apart.branches.size() == 2);  // ± √(a² + gap)
      has_folds(apart, {});
      const double fold = std::sqrt(std::stod(gap));
      const Locus folded = sweep_of(particle(std::string("x^3/3 - (a^2 - ") + gap + ") x"), "a", -1, 1, steps);
      if (steps != 20 && fold < 1e-3) continue;  // a = 0 lies between, where nothing rests
      CHECK(folded.branches.size() == 4);
      has_folds(folded, {{-fold, 0}, {fold, 0}});
    }
}

TEST_CASE("a crossing with an imperfection is none, or has two folds") {
  for (const double e : {1e-3, 1e-6, 1e-9}) {  // V' = x² − a x − e, and with −e
    CAPTURE(e);
    const std::string text = std::to_string(e * 1e12) + "e-12";
    has_folds(sweep_of(particle("x^3/3 - a x^2/2 - " + text + " x"), "a", -1, 1, 20), {});
    const double fold = 2 * std::sqrt(e), place = std::sqrt(e);
    has_folds(sweep_of(particle("x^3/3 - a x^2/2 + " + text + " x"), "a", -1, 1, 20), {{-fold, -place}, {fold, place}});
  }
}

TEST_CASE("a pitchfork with an imperfection has a fold, however small it is") {
  for (const double e : {1e-2, 1e-4, 1e-6, 1e-8}) {  // V' = x³ − a x − e
    CAPTURE(e);
    const Locus fork = sweep_of(particle("x^4/4 - a x^2/2 - " + std::to_string(e * 1e12) + "e-12 x"), "a", -1, 1, 20);
    CHECK(fork.branches.size() == 3);
    has_folds(fork, {{3 * std::pow(e / 2, 2.0 / 3), -std::cbrt(e / 2)}});
  }
  // A bead on a turning hoop that is pushed aside: tan θ = −∛e, Ω² = (1 + e^(2/3))^(3/2).
  const Locus hoop =
      sweep_of("dimensionless\nparam Ω = 1\ncoord θ : angle\nL = 1/2 θ'^2 + 1/2 Ω^2 sin(θ)^2 + cos θ + 1e-5 sin θ\n",
               "Ω", 0.5, 1.5, 21);
  has_folds(hoop, {{std::pow(1 + std::pow(1e-5, 2.0 / 3), 0.75), -std::atan(std::cbrt(1e-5))}});
}

TEST_CASE("folds at values of the sweep end two branches") {
  for (const std::size_t steps :
       {2, 3, 5, 9, 17, 18}) {  // a = ±2 is among the values of all but the first and the last
    CAPTURE(steps);
    for (const double side : {1.0, -1.0}) {
      const Locus cubic = sweep_of(particle("x^4/4 - 3 x^2/2 + a x"), "a", -4 * side, 4 * side, steps);
      CHECK(cubic.branches.size() == 3);
      has_folds(cubic, {{-2, -1}, {2, 1}});
    }
  }
}

TEST_CASE("a pitchfork at a value of the sweep is where its branches begin") {
  for (const std::size_t steps : {20, 21, 11}) {
    const Locus fork = sweep_of(particle("x^4/4 - a x^2/2"), "a", -1, 1, steps);
    CHECK(fork.folds.empty());
    REQUIRE(fork.branches.size() == 3);
    for (const std::size_t b : {1, 2}) CHECK(std::abs(fork.branches[b].points.front().parameter) <= 1e-15);
  }
}

TEST_CASE("a point is judged at its own parameter, wherever the branch was followed to before") {
  Linearized m(particle("x^4/4 - a x^2/2"));
  const NeighboursAt none;
  BranchFollower follow(m.at, m.start, 0, 0.5, none);
  follow.set_parameter(0);
  EquilibriumSearch search;
  search.start = m.start;
  const auto rests = find_equilibria(m.at, search).found;
  REQUIRE(rests.size() == 1);
  const LocusPoint fork = follow.judged(0, rests[0]);
  CHECK(fork.stability.verdict == Stability::Undecided);
  const auto beyond = follow.continued({fork}, 0.5);  // looks back to 0, whether it is a fold
  REQUIRE(beyond);
  for (const double a : {0.5, -0.25, 0.5}) {
    const std::complex<double> z = follow.judged(a, *beyond).eigenvalues.back();
    CHECK(std::abs(z * z - a) < 1e-14);
  }
}

TEST_CASE("a value at which nothing is decided is not where the verdict changes beside it") {
  // At a = 3 the stiffness in x vanishes, of y² it does at 3.57 and changes its sign.
  const std::string text =
      "dimensionless\nparam a = 1\ncoord x, y : number\n"
      "L = 1/2 (x'^2 + y'^2) - (1/2 (a - 3)^2 x^2 + x^4/4 + 1/2 (3.57 - a) y^2 + y^4/4)\nstart x = 0.1, y = 0.2\n";
  for (const std::size_t steps : {6, 7, 12, 60})
    for (const bool up : {true, false}) {
      CAPTURE(steps);
      CAPTURE(up);
      const Locus locus = sweep_of(text, "a", up ? 0 : 6, up ? 6 : 0, steps);
      CHECK(locus.branches.size() == 3);
      std::vector<StabilityChange> of_middle;
      for (const StabilityChange& change : locus.changes)
        if (change.branch == 0) of_middle.push_back(change);
      REQUIRE(of_middle.size() == 1);
      CHECK(std::abs(of_middle[0].parameter - 3.57) < 1e-10);
      CHECK(of_middle[0].before == (up ? Stability::Energetic : Stability::Unstable));
    }
}

TEST_CASE("folds beside a stiff link have all their digits") {
  for (const std::size_t steps : {17, 18}) {
    const Locus link = sweep_of(
        "dimensionless\nparam a = 0\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - x^4/4 + 3 x^2/2 - a x "
        "- 1/2 * 1e10 (x - y)^2\nstart x = 1, y = 1\n",
        "a", -4, 4, steps);
    CHECK(link.branches.size() == 3);
    has_folds(link, {{-2, -1}, {2, 1}});
  }
}

TEST_CASE("several folds in one step of a sweep") {
  // V' = T₅(x) − a: folds where T₅ is ±1.
  const auto turn = [](double k) { return std::cos(k * std::numbers::pi / 5); };
  for (const std::size_t steps : {2, 3, 5, 12}) {
    CAPTURE(steps);
    const Locus chebyshev = sweep_of(particle("16 x^6/6 - 20 x^4/4 + 5 x^2/2 - a x"), "a", -2, 2, steps);
    CHECK(chebyshev.branches.size() == 5);
    has_folds(chebyshev, {{-1, turn(1)}, {-1, turn(3)}, {1, turn(2)}, {1, turn(4)}});
  }
  for (const double b : {1e-3, 1e-5}) {  // V' = x³ − b x − a
    CAPTURE(b);
    const Locus cusp = sweep_of(particle("x^4/4 - " + std::to_string(b * 1e9) + "e-9 x^2/2 - a x"), "a", -1, 1, 20);
    CHECK(cusp.branches.size() == 3);
    const double place = std::sqrt(b / 3), fold = 2 * b / 3 * place;
    has_folds(cusp, {{-fold, place}, {fold, -place}});
  }
  has_folds(sweep_of(particle("x^4/4 - a x"), "a", -1, 1, 20), {});
  has_folds(sweep_of(particle("x^4/4 + 1e-5 x^2/2 - a x"), "a", -1, 1, 20), {});
}

TEST_CASE("the arm beyond a fold is followed where no search begins") {
  const Locus far = sweep_of(particle("x^2/2 - x^3/120 - a x"), "a", 0, 11, 12);  // x = 20 (1 ± √(1 − a/10))
  REQUIRE(far.branches.size() == 2);
  CHECK(near(far.branches[1].points.front().equilibrium.point.q[0], 40, 1e-14));
  REQUIRE(far.folds.size() == 1);
  CHECK(near(far.folds[0].parameter, 10, 1e-15));
  CHECK(near(far.folds[0].equilibrium.point.q[0], 20, 1e-15));
}

TEST_CASE("a truss that snaps through, with constraints") {
  // A spring of the length l₀ between (0, 0) and (1, y): dP/dy = 0 where its length is ∛l₀.
  const double l0 = std::sqrt(1.25), y = std::sqrt(std::pow(l0, 2.0 / 3) - 1), load = y * (1 - std::pow(l0, 2.0 / 3));
  const Locus truss = sweep_of(
      "dimensionless\nparam P = 0\ncoord x, y, s : number\nL = 1/2 (x'^2 + y'^2 + s'^2) - 1/2 (s - sqrt(1.25))^2 + P "
      "y\n"
      "constraint x = 1\nconstraint s^2 = x^2 + y^2\nstart x = 1, y = 0.5, s = 1.1\n",
      "P", -0.2, 0.2, 6);
  CHECK(truss.changes.empty());
  for (const double side : {1.0, -1.0})
    CHECK(std::any_of(truss.folds.begin(), truss.folds.end(), [&](const Fold& f) {
      const std::vector<double>& q = f.equilibrium.point.q;
      return near(f.parameter, side * load, 1e-13) && near(q[1], side * y, 1e-13) && q[2] > 0;
    }));
}

TEST_CASE("a verdict that holds between two values of the sweep alone") {
  // Unstable at x = 0 for |a| < 0.01: within a step, and beside the ends of the sweep.
  for (const auto& [from, to] : {std::pair(-1.0, 1.0), std::pair(-1.02, 1.0), std::pair(-0.02, 1.0),
                                 std::pair(-1.0, 0.014), std::pair(1.0, -1.0)}) {
    CAPTURE(from);
    const Locus window = sweep_of(particle("x^2/2 (a^2 - 1e-4 + x^2/2)"), "a", from, to, 20);
    REQUIRE(window.changes.size() == 2);
    CHECK(near(window.changes[0].parameter, -0.01, 1e-9));
    CHECK(near(window.changes[1].parameter, 0.01, 1e-9));
  }
}

TEST_CASE("constraints hide no change of a verdict") {
  const Locus carried = sweep_of(
      "dimensionless\nparam k = 1e12, e = 1e-2\ncoord x, y, z, w : number\nL = 1/2 (x'^2 + y'^2 + z'^2 + w'^2) "
      "- 1/2 k (x - y)^2 - 1/2 k (y - z)^2 - 1/2 e x^2\nconstraint w = z\n",
      "e", -1, 1, 20);
  REQUIRE(carried.changes.size() == 1);
  CHECK(carried.changes[0].before == Stability::Unstable);
  CHECK(carried.changes[0].after == Stability::Energetic);
  CHECK(std::abs(carried.changes[0].parameter) <= 1e-12);
}

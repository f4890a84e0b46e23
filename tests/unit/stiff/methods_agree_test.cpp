// One constrained motion by two methods that share nothing but the equations, and in independent coordinates.
#include "../model_text.hpp"
#include "simulation/methods.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/kernel.hpp>

#include <cmath>

namespace {

using namespace maupertuis;
using Vector = std::vector<double>;

/// Two rods in Cartesian coordinates, the upper one rheonomic: its hinge moves.
constexpr const char* kRods =
    "system rods\ndimensionless\nparam m1 = 1, m2 = 1.5, g = 9.81\ncoord x1, y1, x2, y2 : number\n"
    "T = 1/2 m1 (x1'^2 + y1'^2) + 1/2 m2 (x2'^2 + y2'^2)\nV = g (m1 y1 + m2 y2)\nD = 0.05 (x2'^2 + y2'^2)\n"
    "constraint (x1 - sin(3 t)/10)^2 + y1^2 = 1 name upper\nconstraint (x2 - x1)^2 + (y2 - y1)^2 = 0.64 name lower\n";

constexpr const char* kAngles =
    "system rods\ndimensionless\nparam m1 = 1, m2 = 1.5, g = 9.81\ncoord a, b : angle\n"
    "let X1 = sin(3 t)/10 + sin a\nlet Y1 = -cos a\nlet X2 = X1 + 0.8 sin b\nlet Y2 = Y1 - 0.8 cos b\n"
    "T = 1/2 m1 (X1'^2 + Y1'^2) + 1/2 m2 (X2'^2 + Y2'^2)\nV = g (m1 Y1 + m2 Y2)\nD = 0.05 (X2'^2 + Y2'^2)\n";

Vector run(Method& method, const Vector& q, const Vector& v, double end) {
  method.start(0, q, v);
  while (method.time() != end) {
    const Step step = method.step(end);
    INFO(step.reason);
    REQUIRE(step.ending == StepEnding::None);
  }
  Vector out = method.sample(end).q;
  const Sample sample = method.sample(end);
  out.insert(out.end(), sample.multipliers.begin(), sample.multipliers.end());
  return out;
}

}  // namespace

TEST_CASE("variational, stiff and independent coordinates give one motion, and one λ") {
  const ModelText rods(kRods), angles(kAngles);
  Diagnostics diagnostics;
  VariationalOptions fine;
  fine.step = 0.01, fine.order = 8;
  StiffOptions tight;
  tight.tolerance = 1e-12;
  const auto variational = variational_method(rods.equations, {}, fine, diagnostics);
  const auto stiff = stiff_method(rods.equations, {}, tight, diagnostics);
  const auto independent = variational_method(angles.equations, {}, fine, diagnostics);
  const double a = 0.5, b = -0.4, end = 2;
  const Vector q{std::sin(a), -std::cos(a), std::sin(a) + 0.8 * std::sin(b), -std::cos(a) - 0.8 * std::cos(b)};
  const Vector v{0.3, 0, 0.3, 0};  // the hinge starts with 3/10; both angles at rest
  const Vector one = run(*variational, q, v, end), two = run(*stiff, q, v, end),
               three = run(*independent, {a, b}, {0, 0}, end);
  REQUIRE(one.size() == 6);
  for (std::size_t i = 0; i < 6; ++i) CHECK(two[i] == doctest::Approx(one[i]).epsilon(1e-7));
  const double x1 = std::sin(6.0) / 10 + std::sin(three[0]);
  CHECK(one[0] == doctest::Approx(x1).epsilon(1e-11));
  CHECK(one[2] == doctest::Approx(x1 + 0.8 * std::sin(three[1])).epsilon(1e-11));
  CHECK(variational->constraint_residual() < 1e-15);
  CHECK(stiff->constraint_residual() < 1e-15);
}

TEST_CASE(
    "the slider crank of the SUNDIALS examples, recomputed to 24 digits: both methods, with the work of the damper") {
  const ModelText m(
      "system crank\ndimensionless\nparam a = 0.5, J1 = 1, m2 = 1, J2 = 2, l0 = 1, k = 1, c = 1, F = 1\n"
      "coord q : angle, x : number, p : angle\nlet l = sqrt(x^2 - x (cos p + a cos q) + (1 + a^2)/4 + a cos(p - q)/2)\n"
      "T = J1 q'^2/2 + m2 x'^2/2 + J2 p'^2/2\nV = k (l - l0)^2/2\nD = c l'^2/2\nforce x = F\nforce p = -F sin p\n"
      "constraint x = cos p + a cos q name along\nconstraint 0 = sin p + a sin q name across\n");
  const Vector reference{-1.429996967647227372640421,  0.9390306135782662263334509,  0.5178947564898862480481259,
                         0.05499161053776447944428012, 0.02942223164778110036987099, -0.004440989758956746845820136};
  Diagnostics diagnostics;
  VariationalOptions fine;
  fine.step = 0.02, fine.order = 8;
  StiffOptions tight;
  tight.tolerance = 1e-12;
  const WantedFunctions wanted{{m.equations.energy_function}, {}, {m.equations.power}};
  const auto check = [&](std::unique_ptr<Method> method, double tolerance) {
    run(*method, {std::acos(0.0), std::sqrt(0.75), -std::acos(0.0) / 3}, {0, 0, 0}, 5);
    const Sample s = method->sample(5);
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(std::abs(s.q[i] - reference[i]) < tolerance);
      CHECK(std::abs(s.v[i] - reference[3 + i]) < tolerance);
    }
    method->start(0, Vector{std::acos(0.0), std::sqrt(0.75), -std::acos(0.0) / 3}, Vector{0, 0, 0});
    CHECK(std::abs(s.observables[0] - method->sample(0).observables[0] - s.integrals[0]) < tolerance);
  };
  check(variational_method(m.equations, wanted, fine, diagnostics), 1e-12);
  check(stiff_method(m.equations, wanted, tight, diagnostics), 1e-11);
}

TEST_CASE("what the stiff method refuses") {
  const ModelText rods(kRods);
  Diagnostics diagnostics;
  StiffOptions options;
  options.tolerance = -1;
  CHECK(stiff_method(rods.equations, {}, options, diagnostics) == nullptr);
  REQUIRE(diagnostics.items().size() == 1);
  CHECK(diagnostics.items()[0].code == "E0724");
}

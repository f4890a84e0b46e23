#include "../model_text.hpp"
#include "simulation/methods.hpp"

#include <cmath>

namespace {

using namespace maupertuis;

std::vector<std::string> codes(const std::string& text, const VariationalOptions& options) {
  const ModelText m(text);
  Diagnostics diagnostics;
  CHECK(variational_method(m.equations, {}, options, diagnostics) == nullptr);
  std::vector<std::string> found;
  for (const auto& d : diagnostics.items()) found.push_back(d.code);
  return found;
}

}  // namespace

TEST_CASE("what the variational method refuses, each with its code") {
  const std::string skate =
      "system skate\ndimensionless\ncoord x, y : number, φ : angle\nT = 1/2 (x'^2 + y'^2 + φ'^2)\nconstraint x' sin φ "
      "= y' cos φ\n";
  const std::string free = "system free\ndimensionless\ncoord x : number\nL = 1/2 x'^2\n";
  VariationalOptions options;
  options.step = 0.1;
  CHECK(codes(skate, options) == std::vector<std::string>{"E0720"});
  for (const int order : {3, 14}) {
    options.order = order;
    CHECK(codes(free, options) == std::vector<std::string>{"E0722"});
  }
  options.order = 4, options.step = 0;
  CHECK(codes(free, options) == std::vector<std::string>{"E0721"});
}

TEST_CASE(
    "a free body turned by a quaternion: spatial angular momentum and the norm to rounding, energy to the order") {
  // M is singular in these coordinates, and the norm is a constraint.
  const std::string body =
      "param J1 = 1 kg m^2, J2 = 2 kg m^2, J3 = 2.5 kg m^2\nbody sat inertia diag(J1, J2, J3) rotation ";
  const ModelText quaternion("system tumbling\n" + body + "quaternion\n");
  REQUIRE(quaternion.system->coordinates.size() == 4);
  std::vector<Expr> omega = quaternion.system->bodies[0].angular_velocity_world;
  std::vector<Expr> body_rate = quaternion.system->bodies[0].angular_velocity;
  const ExprMatrix& r = quaternion.system->bodies[0].rotation;
  // Spatial angular momentum R I ω.
  std::vector<Expr> momentum;
  const std::vector<Expr> inertia{quaternion.p("J1"), quaternion.p("J2"), quaternion.p("J3")};
  for (std::size_t i = 0; i < 3; ++i)
    momentum.push_back(r.at(i, 0) * inertia[0] * body_rate[0] + r.at(i, 1) * inertia[1] * body_rate[1] +
                       r.at(i, 2) * inertia[2] * body_rate[2]);
  momentum.push_back(quaternion.equations.energy_function);
  Diagnostics diagnostics;
  for (const int order : {2, 4, 6}) {
    VariationalOptions options;
    options.step = 0.05, options.order = order;
    const auto method = variational_method(quaternion.equations, {momentum, {}, {}}, options, diagnostics);
    REQUIRE(method);
    // q̇ = ½ q ω at q = 1: ω = (0.3, 2, -0.1).
    method->start(0, std::vector<double>{1, 0, 0, 0}, std::vector<double>{0, 0.15, 1, -0.05});
    const std::vector<double> first = method->sample(0).observables;
    CHECK(first[1] == doctest::Approx(4));
    double worst = 0, worst_energy = 0, worst_norm = 0;
    for (int i = 0; i < 4000; ++i) {
      const Step step = method->step(1e9);
      INFO(step.reason);
      REQUIRE(step.ending == StepEnding::None);
      const Sample s = method->sample(method->time());
      for (std::size_t k = 0; k < 3; ++k) worst = std::max(worst, std::abs(s.observables[k] - first[k]));
      worst_energy = std::max(worst_energy, std::abs(s.observables[3] - first[3]));
      worst_norm =
          std::max(worst_norm, std::abs(s.q[0] * s.q[0] + s.q[1] * s.q[1] + s.q[2] * s.q[2] + s.q[3] * s.q[3] - 1));
    }
    CAPTURE(order);
    CHECK(worst < 1e-12);
    CHECK(worst_norm < 1e-14);
    CHECK(worst_energy < 10 * std::pow(0.1, order));
    CHECK(method->constraint_residual() < 1e-14);
  }
}

// Random Lagrangians: the derivation against the action principle, symmetry of M, covariance.
#include <doctest/doctest.h>
#include <maupertuis/certificate.hpp>

#include "generators.hpp"

using namespace maupertuis;
using namespace maupertuis::property;

namespace {

/// A system of two freedoms whose Lagrangian is given whole.
struct RandomSystem {
  std::shared_ptr<Context> context = std::make_shared<Context>();
  std::shared_ptr<MechanicalSystem> system = std::make_shared<MechanicalSystem>();
  std::vector<Expr> leaves;

  RandomSystem() {
    system->context = context;
    for (const char* name : {"x", "y"}) {
      Coordinate c;
      c.name = name;
      c.q = context->symbol(name, Role::Coordinate);
      c.velocity = context->symbol(name, Role::Coordinate, 1);
      c.acceleration = context->symbol(name, Role::Coordinate, 2);
      system->coordinates.push_back(c);
    }
    for (const Coordinate& c : system->coordinates) leaves.push_back(c.q);
    leaves.push_back(context->symbol("m", Role::Parameter));
    leaves.push_back(context->time());
    for (const Coordinate& c : system->coordinates) leaves.push_back(c.velocity);
  }

  EquationsOfMotion derive(Expr lagrangian) {
    system->lagrangian_given = EnergyTerm{lagrangian, "L", {}};
    Diagnostics diagnostics;
    auto equations = euler_lagrange(system, diagnostics);
    RC_ASSERT(static_cast<bool>(equations));
    return *equations;
  }
};

}  // namespace

TEST_CASE("the residual of a random Lagrangian passes its certificate") {
  rc::holds("certify", [](const Recipe& recipe) {
    RandomSystem s;
    const Expr e = build(recipe, s.leaves, Functions::WithSwitches);
    // The rate of something as a factor exercises d/dt inside L.
    const Expr lagrangian = e + s.context->time_derivative(s.leaves[0] * s.leaves[1] * s.leaves[3]) * sin(s.leaves[4]);
    const Certificate certificate = certify(s.derive(lagrangian), nullptr);
    for (const CertificateCheck& check : certificate.checks) RC_ASSERT(check.verdict != Verdict::Nonzero);
  });
}

TEST_CASE("a random Lagrangian and a residual with one term too many") {
  rc::holds("certify rejects", [](const Recipe& recipe) {
    RandomSystem s;
    EquationsOfMotion equations = s.derive(build(recipe, s.leaves, Functions::Smooth));
    equations.residual[1] = equations.residual[1] + s.leaves[0] * s.leaves[4];
    const Certificate certificate = certify(equations, nullptr);
    RC_ASSERT(!certificate.passed());
  });
}

TEST_CASE("M is symmetric") {
  rc::holds("M symmetric", [](const Recipe& recipe) {
    RandomSystem s;
    const ExprMatrix m = mass_matrix(s.derive(build(recipe, s.leaves, Functions::Smooth)));
    RC_ASSERT(zero_test(m.at(0, 1) - m.at(1, 0)).verdict == Verdict::Zero);
  });
}

TEST_CASE("Lagrange's equations keep their form under point transformations") {
  rc::holds("covariance", [](const Recipe& recipe, const Recipe& first, const Recipe& second) {
    RandomSystem s;
    Context& c = *s.context;
    const Expr lagrangian = build(recipe, s.leaves, Functions::Polynomial);
    // q = F(q, t), the new coordinates called by the old names.
    const std::vector<Expr> positions(s.leaves.begin(), s.leaves.begin() + 4);
    const std::vector<Expr> f{build(first, positions, Functions::Polynomial),
                              build(second, positions, Functions::Polynomial)};
    ExprMap moved;
    for (std::size_t i = 0; i < 2; ++i) {
      const Coordinate& q = s.system->coordinates[i];
      const Expr rate = total_time_derivative(f[i]);
      moved.emplace(q.q, f[i]);
      moved.emplace(q.velocity, rate);
      moved.emplace(q.acceleration, total_time_derivative(rate));
    }
    const auto old_residual = substitute(expand_time_derivatives(s.derive(lagrangian).residual), moved);
    const auto new_residual = s.derive(substitute(lagrangian, moved)).residual;
    for (std::size_t j = 0; j < 2; ++j) {
      std::vector<Expr> terms;
      for (std::size_t i = 0; i < 2; ++i) terms.push_back(differentiate(f[i], s.leaves[j]) * old_residual[i]);
      RC_ASSERT(zero_test(c.sum(terms) - new_residual[j]).verdict == Verdict::Zero);
    }
  });
}

#include "analysis/hamiltonian/proofs.hpp"

#include <fmt/format.h>

#include <utility>

namespace maupertuis::phase_space {

/// At p = ∂L/∂q̇ for velocities that are small against those of the parameters: roots stay real.
ZeroTest Proofs::at_points(const std::vector<Expr>& differences) const {
  const MechanicalSystem& system = *hamiltonian_.system;
  ExprMap momenta;
  const ExprVector values = with_definitions(system, hamiltonian_.momentum_values);
  for (std::size_t i = 0; i < values.size(); ++i) momenta.emplace(hamiltonian_.momenta[i], values[i]);
  std::vector<Expr> plain = expand_time_derivatives(in_terms_of_motion(system, substitute(differences, momenta)));
  Bindings center = parameter_bindings(system);
  std::vector<Expr> unknowns;
  int next = 1;
  for (const Coordinate& c : system.coordinates) {
    center.insert({{c.q, 0.7 + 0.1 * next}, {c.velocity, 0.05 * next}, {c.acceleration, 0.3 * next}});
    unknowns.insert(unknowns.end(), {c.q, c.velocity, c.acceleration});
    ++next;
  }
  for (const Constraint& c : system.constraints) center.emplace(c.multiplier, 0.4);
  return zero_test_where(plain, {}, unknowns, center);
}

void Proofs::add(std::string name, std::string statement, std::vector<Expr> differences) {
  CertificateCheck check;
  check.name = std::move(name);
  check.statement = std::move(statement);
  const std::vector<Expr> plain = expand_time_derivatives(with_definitions(*hamiltonian_.system, differences));
  ZeroTest test = zero_test(plain);
  if (test.verdict == Verdict::Undecided) {
    const std::string open = test.reason;
    test = at_points(plain);
    if (test.verdict == Verdict::Undecided)
      test.reason = open;
    else
      check.statement += fmt::format(", to 60 digits at {} points, not proved", test.points);
  }
  check.verdict = test.verdict;
  check.points = test.points;
  check.error_bound = test.error_bound;
  check.reason =
      test.verdict == Verdict::Nonzero && test.reason.empty() ? "the two sides differ at a random point" : test.reason;
  certificate_.checks.push_back(std::move(check));
}

}  // namespace maupertuis::phase_space

#pragma once
#include <maupertuis/hamiltonian.hpp>

namespace maupertuis::phase_space {

/// Zero tests that become a certificate. Definitions are put in first. Differences with roots of velocities in them,
/// which the prime fields may leave open, are evaluated at points near the values of the model's parameters to 60
/// digits.
class Proofs {
 public:
  Proofs(const Hamiltonian& hamiltonian, const EquationsOfMotion& equations)
      : hamiltonian_(hamiltonian), equations_(equations) {}
  /// That all `differences` vanish identically.
  void add(std::string name, std::string statement, std::vector<Expr> differences);
  Certificate take() { return std::move(certificate_); }

 private:
  ZeroTest at_points(const std::vector<Expr>& differences) const;

  const Hamiltonian& hamiltonian_;
  const EquationsOfMotion& equations_;
  Certificate certificate_;
};

}  // namespace maupertuis::phase_space

#pragma once
#include <maupertuis/fields.hpp>

#include <optional>
#include <vector>

namespace maupertuis {

/// The symmetric (Belinfante) stress-energy tensor of a density that is Lorentz-invariant with some speed c.
///
/// Both indices up, metric ds² = c² dt² − dx²; indices are space variables, then t, as those of fluxes and densities:
///
///     Θ^{μν} = T^{μν} + ∂_λ B^{λμν},  T^μ_ν = Π_a^μ ∂_ν φ_a − δ^μ_ν ℒ,  Π_a^μ = ∂ℒ/∂(∂_μ φ_a),
///     B^{λμν} = ½ (S^{λμν} − S^{μλν} − S^{νλμ}),  S^{λμν} = Π_a^λ (Σ^{μν})_ab φ_b,  δφ = ½ ω_{μν} Σ^{μν} φ
///
/// with Σ of the boosts and rotations that were found. Θ is reduced by the field equations.
struct StressEnergy {
  std::size_t dimensions = 0;  // of space
  Expr c_squared;
  std::vector<Expr> symmetric, canonical;  // [(dimensions + 1)²]
  std::vector<Expr> spin_part;             // B^{λμν} [(dimensions + 1)³]; all 0: the canonical tensor is symmetric
  // By the zero test, on solutions of the field equations:
  bool is_symmetric = false;           // Θ^{μν} = Θ^{νμ}
  bool is_conserved = false;           // ∂_μ Θ^{μν} = 0
  bool differs_by_divergence = false;  // Θ^{μν} − T^{μν} = ∂_λ B^{λμν}, B^{λμν} = −B^{μλν}
  bool certified() const { return is_symmetric && is_conserved && differs_by_divergence; }
  bool has_spin() const;

  Expr energy_density() const;            // c² Θ^{tt}
  Expr energy_flux(std::size_t i) const;  // c² Θ^{it}, which is c² times the density of momentum
  Expr stress(std::size_t i, std::size_t j) const { return symmetric[i * (dimensions + 1) + j]; }
  Expr spin(std::size_t l, std::size_t m, std::size_t n) const {
    return spin_part[(l * (dimensions + 1) + m) * (dimensions + 1) + n];
  }
};

/// Nothing where the boosts along all space variables and the rotations are not among `found`, where the density holds
/// higher derivatives, where friction or forces act, or where the certificate fails.
std::optional<StressEnergy> stress_energy(const FieldEquations& equations, const FieldCurrents& found);

}  // namespace maupertuis

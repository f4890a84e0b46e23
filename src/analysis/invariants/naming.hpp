#pragma once
#include "analysis/invariants/ansatz.hpp"

#include <optional>
#include <string>

namespace maupertuis::invariants {

/// What an integral is called, by how its symmetry moves the points of the model.
struct Naming {
  std::string name, symmetry;   // empty: no name fits
  Expr scaled;                  // the integral in its usual normalisation and sign
  int rank = 9;                 // place in a list: energy first, then momenta, angular momenta, boosts, others
};

/// Fits the symmetry δq = M⁻¹ ∂I/∂q' at random points: the points of the model are moved by
///     δr = a + ω × r + b t + (s₀ + s₁ t) r − (ξ₀ + ξ₁ t + ξ₂ t²) ṙ
/// or the coordinates by constants. Precondition: no constraints.
class Namer {
 public:
  Namer(const EquationsOfMotion& equations, const MotionRows& rows, const Ansatz& ansatz, std::uint64_t seed);
  Naming name(Expr integral) const;
  /// By its value alone, for systems with constraints or forces: a multiple of h_E, of a momentum, of an angular momentum.
  Naming name_by_value(Expr integral) const;

 private:
  struct Fit;
  std::optional<Fit> fit_points(Expr integral) const;
  std::optional<Fit> fit_coordinates(Expr integral) const;
  std::optional<Fit> fit_leading_part(Expr integral) const;
  bool name_relative_rotation(Expr integral, Naming& naming) const;
  bool is_square_of_angular_momentum(Expr integral) const;
  void describe(const Fit& fit, Naming& naming) const;

  const EquationsOfMotion& equations_;
  const MotionRows& rows_;
  const Ansatz& ansatz_;
  std::uint64_t seed_;
  bool energy_is_t_plus_v_;
};

}  // namespace maupertuis::invariants

#pragma once
#include "analysis/invariants/symmetry_fit.hpp"

#include <optional>
#include <string>

namespace maupertuis::invariants {

/// What an integral is called, by how its symmetry moves the points of the model.
struct Naming {
  std::string name, symmetry;  // empty: no name fits
  Expr scaled;                 // the integral in its usual normalisation and sign
  int rank = 9;                // place in a list: energy first, then momenta, angular momenta, boosts, others
};

class Namer {
 public:
  Namer(const EquationsOfMotion& equations, const MotionRows& rows, const Ansatz& ansatz, std::uint64_t seed);
  /// By its symmetry. Precondition: no constraints.
  Naming name(Expr integral) const;
  /// By its value alone, for systems with constraints or forces: a multiple of h_E, of a momentum, of an angular
  /// momentum.
  Naming name_by_value(Expr integral) const;

 private:
  using Fit = SymmetryFit;
  Naming of_fit(const Fit& fit, Expr integral) const;
  std::optional<Naming> as_energy(Expr integral) const;
  std::optional<Naming> of_time(const Fit& fit, Expr integral) const;
  std::optional<Naming> of_scaling(const Fit& fit, Expr integral) const;
  std::optional<Naming> of_rotation(const Fit& fit, Expr integral) const;
  std::optional<Naming> of_translation(const Fit& fit, Expr integral) const;
  std::optional<Naming> of_boost(const Fit& fit, Expr integral) const;
  std::optional<Naming> of_coordinates(const Fit& fit, Expr integral) const;
  std::optional<Naming> of_leading_part(const Fit& fit, Expr integral) const;
  std::optional<Naming> of_relative_rotation(Expr integral) const;
  bool is_square_of_angular_momentum(Expr integral) const;

  std::string axis(std::size_t i) const { return std::string(1, ansatz_.world.axes[i]); }
  std::string axis_of_rotation(const Fit::Term& rotation) const;
  std::string total() const;
  bool has_gauge(Expr integral) const;

  const EquationsOfMotion& equations_;
  const MotionRows& rows_;
  const Ansatz& ansatz_;
  std::uint64_t seed_;
  bool energy_is_t_plus_v_;
};

}  // namespace maupertuis::invariants

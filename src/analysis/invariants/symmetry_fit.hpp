#pragma once
#include "analysis/invariants/ansatz.hpp"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <vector>

namespace maupertuis::invariants {

/// The constants by which a symmetry is described:
///     δr = a + ω × r + b t + (s₀ + s₁ t) r − (ξ₀ + ξ₁ t + ξ₂ t²) ṙ
/// of the points of a model (with ξ linear in r for one relativistic particle), constants added to coordinates, or the
/// leading part of a quadratic integral.
enum class Constant {
  TimeShift,
  Rotation,
  Translation,
  Boost,
  TimeScale,
  Scale,
  TimeSquare,
  TimeTimesScale,
  LorentzBoost,
  Coordinate,
  RungeLenz,
  Fradkin,
};

/// The constants that are not 0.
struct SymmetryFit {
  struct Term {
    Constant constant;
    std::size_t axis = 0, second = 0;  // of World::axes; of a rotation its plane; of Coordinate its number
    Expr value;                        // in the parameters
  };
  std::vector<Term> terms;

  const Term* find(Constant c) const {
    for (const Term& t : terms)
      if (t.constant == c) return &t;
    return nullptr;
  }
  std::size_t count(Constant c) const {
    return static_cast<std::size_t>(
        std::count_if(terms.begin(), terms.end(), [c](const Term& t) { return t.constant == c; }));
  }
  bool only(std::initializer_list<Constant> allowed) const {
    return std::all_of(terms.begin(), terms.end(),
                       [&](const Term& t) { return std::count(allowed.begin(), allowed.end(), t.constant) > 0; });
  }
};

/// How the symmetry δq = M⁻¹ ∂I/∂q' moves the points. No terms where it is none of the above.
SymmetryFit fit_points(Expr integral, const MotionRows& rows, const Ansatz& ansatz, std::uint64_t seed);
/// δq_i = k_i − ξ₀ q̇_i.
SymmetryFit fit_coordinates(Expr integral, const MotionRows& rows, std::uint64_t seed);
/// The part quadratic in the velocities of an integral of one particle, or of a relative motion: v × (r × v) of the
/// Laplace-Runge-Lenz vector, v_i v_j of Fradkin's tensor.
SymmetryFit fit_leading_part(Expr integral, const MotionRows& rows, const Ansatz& ansatz, std::uint64_t seed);

}  // namespace maupertuis::invariants

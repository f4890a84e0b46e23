#pragma once
#include <maupertuis/linearization.hpp>

#include <optional>
#include <utility>
#include <vector>

namespace maupertuis {

/// The linearization as formulas, in the parameters of the model.
struct SymbolicLinearization {
  /// cos θ or a coordinate, and what it is at the equilibrium: "r = l0 + g m/k", "cos θ = g/(R Ω²)".
  std::vector<std::pair<Expr, ReadableForm>> equilibrium;
  ExprMatrix mass, damping, stiffness;               // M, C + G, K + N [n × n]; readable entries
  ExprMatrix input, input_rate, input_acceleration;  // B, B₁, B₂ [n × k]
  Expr square;                                       // K/M of one coordinate without C: ω²; else empty
};

/// For unconstrained systems of at most four coordinates at rest. Coordinates are found as 0 or a part of π; by solving
/// equations that are linear in the others; or by cos θ where sin θ is a common factor. Proved: the forces vanish there
/// (zero test). The matrices are compared with those of numbers. Nothing where the equilibrium has no such formula.
std::optional<SymbolicLinearization> symbolic_linearization(const EquationsOfMotion& equations,
                                                            const Linearization& numbers,
                                                            const std::vector<Translation>& translations);

}  // namespace maupertuis

#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/evaluate.hpp>

#include <optional>
#include <random>
#include <vector>

namespace maupertuis {

/// Looks at expressions at random states of a system, parameters at random as well: what holds there by numbers is then
/// proved by the zero test.
class RandomStates {
 public:
  explicit RandomStates(const EquationsOfMotion& equations) : system_(*equations.system) {}

  /// The expression in q, q', q'', λ, t and parameters: lets, inputs and derivatives put in.
  Expr settled(Expr e) const;
  /// Whether it is zero as a function.
  bool vanishes(Expr e);
  /// The numbers b with Σ b_k terms_k = sum as functions, simple fractions each; nothing where there are none.
  std::optional<std::vector<Rational>> combination(Expr sum, const std::vector<Expr>& terms);

 private:
  std::vector<std::vector<double>> values(const std::vector<Expr>& roots, std::size_t rows);

  const MechanicalSystem& system_;
  std::mt19937_64 random_{20 * 7 * 1788};  // Mécanique analytique; any other would do
};

}  // namespace maupertuis

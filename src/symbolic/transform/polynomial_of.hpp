#pragma once
#include "symbolic/transform/term_algebra.hpp"

#include <unordered_map>

namespace maupertuis::terms {

enum class Trigonometry { ToSums, Opaque };

/// Reads expressions into the term algebra, memoized by node: shared sub-expressions are expanded once.
/// Functions that are no polynomials become atoms with expanded arguments.
/// Throws TooManyTerms beyond the budget of the algebra. Precondition: no TimeDerivative nodes.
class PolynomialReader {
 public:
  PolynomialReader(TermAlgebra& algebra, Trigonometry trigonometry) : algebra_(&algebra), trigonometry_(trigonometry) {}

  const Polynomial& read(Expr e);

  /// The coarsest angle of which every sine and cosine read so far holds whole multiples: θ after sin θ and cos 3θ.
  /// Powers of sines and cosines are printed in it.
  const std::unordered_map<NodeId, Fraction>& angle_units() const { return units_; }

 private:
  Polynomial read_node(Expr e);
  Polynomial read_sum(Expr e);
  Polynomial read_product(Expr e);
  Polynomial read_power(Expr e);
  Polynomial read_symbolic_power(Expr base, const Polynomial& exponent);
  Polynomial read_circular(Expr e);
  Polynomial read_exponential(Expr e);
  Polynomial read_function(Expr e);
  std::vector<Frequency> angles(const Polynomial& argument);

  TermAlgebra* algebra_;
  Trigonometry trigonometry_;
  std::unordered_map<NodeId, Polynomial> known_;
  std::unordered_map<NodeId, Fraction> units_;
};

}  // namespace maupertuis::terms

#pragma once
#include "symbolic/transform/term_algebra.hpp"

/// Factors of a polynomial with several variables, as far as a reader wants them: m (l + x)^2, (m1 + m2) l1^2,
/// k (r - l0), (φ' cos θ + ψ')^2.
///
/// Common factors of every variable's coefficients are taken out, quadratics split where their discriminant is a
/// square, repeated factors are found by the derivative. Nothing else is tried: an irreducible answer may still have
/// factors, an answer with factors is always right.
namespace maupertuis::terms {

struct Factored {
  Rational coefficient = 1;
  MonomialId monomial = 0;
  struct Part {
    Polynomial sum;  // at least two terms, coprime integer coefficients
    int multiplicity = 1;
  };
  std::vector<Part> parts;  // empty: the polynomial is a single term
  bool split = false;       // something came apart beyond the common monomial
};

/// Harmonics are taken as one more variable each. Precondition: p is not empty.
Factored factor(TermAlgebra& algebra, const Polynomial& p);

/// p / divisor if it divides without rest, else nothing (empty). Precondition: divisor is not empty.
Polynomial exact_quotient(TermAlgebra& algebra, const Polynomial& p, const Polynomial& divisor);

/// p with every square of the root that stands in it as r² again: for the atom r = B^(1/2),
///
///     k (x² + a²) + k l² − 2 k l r  =  k r² − 2 k l r + k l²,     which factors to k (r − l)²
///
/// `root` is the atom that stands for r in the result (squares of a Base atom itself would be multiplied out again).
/// Empty where the radicand is not found in p.
Polynomial with_square_of_root(TermAlgebra& algebra, const Polynomial& p, AtomId base, AtomId root);

/// The atoms' smallest exponents over all terms, where every term has the atom with the same sign.
MonomialId common_monomial(TermAlgebra& algebra, const Polynomial& p);

/// The smallest exponent of every atom over all terms, 0 counted where a term has none: dividing by it leaves no
/// negative powers.
MonomialId lowest_powers(TermAlgebra& algebra, const Polynomial& p);

}  // namespace maupertuis::terms

#pragma once
#include <maupertuis/transform.hpp>

namespace maupertuis {

/// ∫ e dz with the other symbols held, term by term: powers of linear functions, sine, cosine, hyperbolic functions and
/// exponentials of linear arguments, these times polynomials, u^n u'. An empty handle where a term is none of these.
/// The caller verifies: ∂/∂z of the result is e.
Expr antiderivative(Expr e, Expr z);

/// True if `symbol` stands in e.
bool depends_on(Expr e, Expr symbol);

/// The factors of a product; e itself where it is none.
std::vector<Expr> factors_of(Expr e);

}  // namespace maupertuis

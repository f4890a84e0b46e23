#include <maupertuis/transform.hpp>

#include "symbolic/transform/polynomial_of.hpp"

namespace maupertuis {

Expr expand(Expr e, std::size_t term_budget) {
  terms::TermAlgebra algebra(e.context(), term_budget);
  terms::PolynomialReader reader(algebra, terms::Trigonometry::Opaque);
  try {
    return algebra.expression(reader.read(expand_time_derivatives(e)));
  } catch (const terms::TooManyTerms&) {
    return {};
  }
}

}  // namespace maupertuis

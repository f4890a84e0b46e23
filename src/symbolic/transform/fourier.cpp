#include <maupertuis/transform.hpp>

#include "symbolic/transform/polynomial_of.hpp"

namespace maupertuis {

Expr fourier_form(Expr e, std::size_t term_budget) {
  terms::TermAlgebra algebra(e.context(), term_budget);
  terms::PolynomialReader reader(algebra, terms::Trigonometry::ToSums);
  try {
    return algebra.expression(reader.read(expand_time_derivatives(e)));
  } catch (const terms::TooManyTerms&) {
    return {};
  }
}

}  // namespace maupertuis

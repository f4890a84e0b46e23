#pragma once
#include <maupertuis/constraint_analysis.hpp>

namespace maupertuis {

/// Σ form_k d(variables_k), with variables q and t.
struct OneForm {
  ExprVector components;  // [n + 1]
};

/// F with dF = f · form for a simple integrating factor f, proved; empty where none was found.
FirstIntegral first_integral(const OneForm& form, const ExprVector& variables, const ReadingOrder& order);

}  // namespace maupertuis

#pragma once
#include <maupertuis/field_run.hpp>

#include <string>
#include <vector>

namespace maupertuis {

/// What is asked of fields at rest.
struct RestAnswers {
  std::string trouble;                        // why there is no rest; empty: there is one
  std::vector<FieldRunResult::Value> values;  // to the questions, in their order; no number: no such derivative
  std::string stability;                      // stable, unstable, undecided
};

/// Of the rest that the model has: FieldQuestion::time is of no account.
RestAnswers answers_at_rest(const FieldEquations& equations, const std::vector<FieldQuestion>& questions);

}  // namespace maupertuis

#pragma once
#include <maupertuis/evaluate.hpp>
#include <maupertuis/field_run.hpp>
#include <maupertuis/study.hpp>

#include <vector>

/// What the lines `expect EXPR at TIME = …` of a model ask for, in their order.
inline std::vector<maupertuis::FieldQuestion> questions_of(maupertuis::Study& study) {
  std::vector<maupertuis::FieldQuestion> out;
  for (const maupertuis::Expectation& e : study.model()->experiment.expectations) {
    const auto& at = std::get<maupertuis::expectation::ValueAt>(e.kind);
    out.push_back({at.subject, false, maupertuis::evaluate(at.time, {})});
  }
  return out;
}

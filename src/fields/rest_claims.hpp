#pragma once
#include <maupertuis/field_run.hpp>
#include <maupertuis/verification.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace maupertuis {

/// What a value should be, in SI.
struct GivenValue {
  double value = 0, tolerance = 0;
  expectation::DisplayUnit unit;
};

/// Whether `actual` is it. `source`: what its error is that of, in words.
void judge_field_value(ExpectationResult& result, const GivenValue& given, const FieldRunResult::Value& actual,
                       const std::string& source);

/// A line about the equilibrium of fields.
struct AskedRest {
  struct Named {
    std::string name;  // u(l/2); empty: it needs none
    GivenValue value;
  };
  std::size_t line = 0;  // in Verification::results
  std::vector<FieldQuestion> questions;
  std::vector<Named> expected;  // [questions]
  std::string word;             // stable, unstable, undecided, or none
};

/// Carries them out; the equilibrium is looked for once.
void judge_rests(const FieldEquations& equations, const std::vector<AskedRest>& asked, Verification& out);

}  // namespace maupertuis

#pragma once
#include <maupertuis/extended_simulation.hpp>
#include <maupertuis/verification.hpp>

#include <vector>

namespace maupertuis {

/// Expectations of a model with `precision quad` or `precision 100` that all digits can decide: coordinates and
/// velocities at times.
class ExtendedClaims {
 public:
  struct Line {
    const expectation::ValueAt* expectation;
    std::size_t index;  // of its result
  };

  ExtendedClaims(const Model& model, const EquationsOfMotion& equations, const StopFlag* interrupt)
      : model_(model), equations_(equations), interrupt_(interrupt) {}
  /// Whether the model asks for more digits than double has, and the subject is a coordinate or a velocity.
  bool takes(const expectation::ValueAt& expectation) const;
  /// The results of these lines; their times all lie after the start, or all before it. One run for all.
  void decide(const std::vector<Line>& lines, std::vector<ExpectationResult>& results, Diagnostics& diagnostics) const;

 private:
  void judge(const expectation::ValueAt& expectation, const ExtendedState& state, const std::string& reason,
             ExpectationResult& result) const;
  const AgreedNumber& value_in(const ExtendedState& state, Expr subject) const;
  Rational exact(Expr e) const;

  const Model& model_;
  const EquationsOfMotion& equations_;
  const StopFlag* interrupt_;
};

}  // namespace maupertuis

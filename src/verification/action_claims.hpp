#pragma once
#include <maupertuis/action.hpp>
#include <maupertuis/verification.hpp>

namespace maupertuis {

/// `expect action`, `expect action of (…)`, `expect index` and `expect path … at`: about the stationary path with the
/// smallest action between the ends of the model, about number 2 by the action, or about a path that is given. The
/// search is done at first use, for all lines of a model.
class ActionClaims {
 public:
  ActionClaims(const Model& model, const EquationsOfMotion& equations, const StopFlag* interrupt)
      : model_(model), equations_(equations) {
    options_.variations = false;
    options_.interrupt = interrupt;
  }
  void decide(const expectation::Action& expectation, ExpectationResult& result);
  void decide(const expectation::ActionAlong& expectation, ExpectationResult& result);
  void decide(const expectation::MorseIndex& expectation, ExpectationResult& result);
  void decide(const expectation::PathAt& expectation, ExpectationResult& result);

 private:
  /// Path `number` by the action, from 1, or 0 for the first; null, and why, where there is none.
  const StationaryPath* path(int number, ExpectationResult& result);
  /// "; of 3 paths, number 2 by the action"
  std::string among_others(int number) const;
  void judge(const expectation::Number& expected, double actual, double error, const std::string& ground,
             ExpectationResult& result) const;

  const Model& model_;
  const EquationsOfMotion& equations_;
  ActionOptions options_;
  bool searched_ = false;
  std::optional<PathSearch> found_;
  std::string trouble_;
};

}  // namespace maupertuis

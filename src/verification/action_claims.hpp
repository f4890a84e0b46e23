#pragma once
#include <maupertuis/action.hpp>
#include <maupertuis/verification.hpp>

namespace maupertuis {

/// `expect action`, `expect action of (…)`, `expect index` and `expect path … at`: about the stationary path with the smallest action
/// between the ends of the model, about number 2 by the action, or about a path that is given. The search is done at first use, for all lines of a model.
class ActionClaims {
 public:
  ActionClaims(const Model& model, const EquationsOfMotion& equations, const std::atomic<bool>* interrupt)
      : model_(model), equations_(equations) {
    options_.variations = false;
    options_.interrupt = interrupt;
  }
  void decide(const Expectation& expectation, ExpectationResult& result);

 private:
  const StationaryPath* path(const Expectation& expectation, ExpectationResult& result);
  void decide_given(const Expectation& expectation, ExpectationResult& result);
  void decide_index(const Expectation& expectation, const StationaryPath& path, ExpectationResult& result) const;
  void judge(const Expectation& expectation, double actual, const std::string& ground, ExpectationResult& result) const;

  const Model& model_;
  const EquationsOfMotion& equations_;
  ActionOptions options_;
  bool searched_ = false;
  std::optional<PathSearch> found_;
  std::string trouble_;
};

}  // namespace maupertuis

#pragma once
#include <maupertuis/modes.hpp>
#include <maupertuis/verification.hpp>

#include <functional>

namespace maupertuis {

/// Frequencies, eigenvalues and matrices at a point, equilibria and their stability, critical parameters: what the
/// linearization about the point says. Made at first use, shared by the lines of a model.
class ModeClaims {
 public:
  ModeClaims(const Model& model, const EquationsOfMotion& equations);
  void decide(const expectation::Frequencies& expectation, ExpectationResult& result);
  void decide(const expectation::Eigenvalues& expectation, ExpectationResult& result);
  void decide(const expectation::Matrix& expectation, ExpectationResult& result);
  void decide(const expectation::Equilibrium& expectation, ExpectationResult& result);
  void decide(const expectation::Stable& expectation, ExpectationResult& result);

 private:
  using Judge = std::function<void(const ModalEntry&, ExpectationResult&)>;
  /// Judges what was found at the point on every side of a kink. `what`: what is there if the search fails.
  void decide_at(const MotionState& begin, const std::vector<StartValue>& at, const char* what, const Judge& judge,
                 ExpectationResult& result);
  /// The same for what a linearization with constant coefficients has.
  void decide_linear(const std::vector<StartValue>& at, const char* what, const Judge& judge,
                     ExpectationResult& result);
  void judge_frequencies(const expectation::Frequencies& expectation, const ModalAnalysis& analysis,
                         ExpectationResult& result) const;
  void judge_stability(const expectation::Equilibrium& expectation, const ModalEntry& entry,
                       ExpectationResult& result) const;
  bool judge_place(const expectation::Equilibrium& expectation, const ModalEntry& entry,
                   ExpectationResult& result) const;

  const Model& model_;
  const EquationsOfMotion& derived_;
  PointEquations equations_;
  MechanicalSystem plain_;  // without reactions in normal forces
  MotionState start_;
};

}  // namespace maupertuis

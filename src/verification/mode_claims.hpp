#pragma once
#include <maupertuis/modes.hpp>
#include <maupertuis/verification.hpp>

namespace maupertuis {

/// `expect frequencies [squared] at …` and `expect equilibrium at … is …`: what the linearization about the point says. Made at first
/// use, shared by the lines of a model.
class ModeClaims {
 public:
  ModeClaims(const Model& model, const EquationsOfMotion& equations);
  void decide(const Expectation& expectation, ExpectationResult& result) const;

 private:
  void decide_frequencies(const Expectation& expectation, const ModalAnalysis& analysis, ExpectationResult& result) const;
  void decide_stability(const Expectation& expectation, const ModalEntry& entry, ExpectationResult& result) const;

  const Model& model_;
  PointEquations equations_;
  MotionState start_;
};

}  // namespace maupertuis

#pragma once
#include <maupertuis/modes.hpp>
#include <maupertuis/verification.hpp>

namespace maupertuis {

/// Frequencies, eigenvalues and matrices at a point, equilibria and their stability, critical parameters: what the linearization about
/// the point says. Made at first use, shared by the lines of a model.
class ModeClaims {
 public:
  ModeClaims(const Model& model, const EquationsOfMotion& equations);
  void decide(const Expectation& expectation, ExpectationResult& result);

 private:
  void decide_frequencies(const Expectation& expectation, const ModalAnalysis& analysis, ExpectationResult& result) const;
  void decide_of(const Expectation& expectation, const ModalEntry& entry, ExpectationResult& result) const;
  void decide_stability(const Expectation& expectation, const ModalEntry& entry, ExpectationResult& result) const;
  bool decide_place(const Expectation& expectation, const ModalEntry& entry, ExpectationResult& result) const;
  std::optional<ModalStudy> study_at(const Expectation& expectation, Diagnostics& told) const;

  const Model& model_;
  const EquationsOfMotion& derived_;
  PointEquations equations_;
  MotionState start_;
};

}  // namespace maupertuis

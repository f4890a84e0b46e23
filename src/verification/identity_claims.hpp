#pragma once
#include "verification/distances.hpp"

#include <maupertuis/along_motion.hpp>
#include <maupertuis/integrals_through_modes.hpp>
#include <maupertuis/invariants.hpp>
#include <maupertuis/verification.hpp>

#include <map>
#include <optional>
#include <string>

namespace maupertuis {

/// expect equation, claim, expect conserved, expect … not conserved, expect integral: identities along the motion, by
/// the zero test, and by the search for integrals, which is done once for each degree.
class IdentityClaims {
 public:
  IdentityClaims(const Model& model, const EquationsOfMotion& equations, Diagnostics& diagnostics)
      : model_(model), equations_(equations), diagnostics_(diagnostics) {}
  void decide(const expectation::Equation& expectation, ExpectationResult& result);
  void decide(const expectation::Conserved& expectation, ExpectationResult& result);
  void decide(const expectation::NotConserved& expectation, ExpectationResult& result);
  void decide(const expectation::Integral& expectation, ExpectationResult& result);

 private:
  /// What should vanish along the motion, with the accelerations put in, and what messages call it.
  struct Identity {
    const char* name;  // "Its time derivative along the motion"
    Expr value;
  };
  const AlongMotion& along();
  bool needs_solvable(ExpectationResult& result);
  std::optional<SignedDistances> distances_with_signs() const;
  Expr in_solved_motion(Expr difference);
  static void explain_false(Expr difference, const EquationsOfMotion& equations, ExpectationResult& result);
  std::string ground(const ZeroTest& test) const;
  std::string failure(const ZeroTest& test, const Identity& identity) const;
  std::string state_text(const Bindings& sample) const;
  void judge_sides(const ZeroTest& test, const AcrossSwitches& sides, ExpectationResult& result) const;
  void judge_through_modes(Expr subject, ExpectationResult& result);
  std::string not_throughout() const;
  IntegralThroughModes through_modes(Expr subject) const;
  void decide_on_level(const expectation::Conserved& expectation, ExpectationResult& result);
  const std::optional<Invariants>& invariants(int degree);

  const Model& model_;
  const EquationsOfMotion& equations_;
  Diagnostics& diagnostics_;
  std::optional<AlongMotion> along_;
  std::map<int, std::optional<Invariants>> invariants_;  // by degree in the velocities
};

}  // namespace maupertuis

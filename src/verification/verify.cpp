#include <maupertuis/verification.hpp>

#include "verification/action_claims.hpp"
#include "verification/constraint_claims.hpp"
#include "verification/degenerate_claims.hpp"
#include "verification/identity_claims.hpp"
#include "verification/judge.hpp"
#include "verification/mode_claims.hpp"
#include "verification/orbit_claims.hpp"
#include "verification/phase_space_claims.hpp"
#include "verification/run_claims.hpp"

#include <maupertuis/degenerate.hpp>

#include <algorithm>

namespace maupertuis {
namespace {

/// Hands each line to what decides its kind. What several lines share is made at first use.
class Verifier {
 public:
  Verifier(const Model& model, const EquationsOfMotion& equations, const SimulationOptions& options,
           Diagnostics& diagnostics)
      : model_(model),
        equations_(equations),
        interrupt_(options.interrupt),
        identities_(model, equations, diagnostics),
        runs_(model, equations, options, diagnostics) {}

  Verification carry_out(const SourceText& source, const std::string& with) {
    Verification verification;
    for (const Expectation& e : model_.experiment.expectations) {
      if (e.with != with) continue;
      ExpectationResult result;
      result.line = source.locate(e.span.begin).line;
      result.text = e.text;
      result.claim = e.claim;
      line_ = verification.results.size();
      std::visit([&](const auto& kind) { decide(kind, result); }, e.kind);
      verification.results.push_back(std::move(result));
    }
    runs_.carry_out(verification.results);
    return verification;
  }

 private:
  // By the motion: the runs are made when all lines are known.
  void decide(const expectation::ValueAt& e, ExpectationResult& result) {
    if (has_value(e.subject, result)) runs_.ask(e, line_);
  }
  void decide(const expectation::ValueAtUntil& e, ExpectationResult& result) {
    if (has_value(e.subject, result)) runs_.ask(e, line_);
  }
  void decide(const expectation::UntilAt& e, ExpectationResult&) { runs_.ask(e, line_); }
  void decide(const expectation::EnergyConserved& e, ExpectationResult&) { runs_.ask(e, line_); }
  void decide(const expectation::ConservedAlongRun& e, ExpectationResult& result) {
    if (has_value(e.subject, result)) runs_.ask(e, line_);
  }

  void decide(const expectation::Event& e, ExpectationResult&) { runs_.ask(e, line_); }
  void decide(const expectation::EventCount& e, ExpectationResult&) { runs_.ask(e, line_); }

  void decide(const expectation::Conserved& e, ExpectationResult& result) { identities_.decide(e, result); }
  void decide(const expectation::NotConserved& e, ExpectationResult& result) { identities_.decide(e, result); }
  void decide(const expectation::Integral& e, ExpectationResult& result) { identities_.decide(e, result); }
  void decide(const expectation::Equation& e, ExpectationResult& result) { identities_.decide(e, result); }

  void decide(const expectation::Hamiltonian& e, ExpectationResult& result) {
    decide_phase_space(e, equations_, result);
  }
  void decide(const expectation::Routhian& e, ExpectationResult& result) { decide_phase_space(e, equations_, result); }
  void decide(const expectation::Bracket& e, ExpectationResult& result) {
    if (e.dirac)
      decide_degenerate(e, model_, equations_, result);
    else
      decide_phase_space(e, equations_, result);
  }

  void decide(const expectation::PhaseConstraints& e, ExpectationResult& result) {
    decide_degenerate(e, model_, equations_, result);
  }
  void decide(const expectation::ClassCount& e, ExpectationResult& result) {
    decide_degenerate(e, model_, equations_, result);
  }
  void decide(const expectation::Freedoms& e, ExpectationResult& result) {
    decide_freedoms(number_of(model_.system, e.number), constraints(), result);
  }
  void decide(const expectation::ConstraintClass& e, ExpectationResult& result) {
    decide_class(e, model_.system, constraints(), result);
  }

  template <typename Claim>
  requires requires(ModeClaims& claims, const Claim& e, ExpectationResult& result) { claims.decide(e, result); }
  void decide(const Claim& e, ExpectationResult& result) {
    if (is_one_motion(result)) modes().decide(e, result);
  }

  template <typename Claim>
  requires requires(OrbitClaims& claims, const Claim& e, ExpectationResult& result) { claims.decide(e, result); }
  void decide(const Claim& e, ExpectationResult& result) {
    if (is_one_motion(result)) orbits().decide(e, result);
  }

  void decide(const expectation::Action& e, ExpectationResult& result) { paths().decide(e, result); }
  void decide(const expectation::ActionAlong& e, ExpectationResult& result) { paths().decide(e, result); }
  void decide(const expectation::MorseIndex& e, ExpectationResult& result) { paths().decide(e, result); }
  void decide(const expectation::PathAt& e, ExpectationResult& result) { paths().decide(e, result); }

  void decide(const expectation::Error& e, ExpectationResult& result) {
    result.expected = "error " + e.code;
    result.actual = "no error";
    result.message = "The model has no mistake that gives this error.";
  }

  /// Near the start, if there is one; why there is none is for the run to say.
  const ConstraintAnalysis& constraints() {
    if (!constraints_) {
      Diagnostics unheard;
      const auto start = consistent_start(model_, equations_, unheard);
      constraints_ = analyse_constraints(equations_, start ? &start->state : nullptr);
    }
    return *constraints_;
  }
  /// False, and said, where it depends on functions that a degenerate Lagrangian leaves free.
  bool has_value(Expr subject, ExpectationResult& result) const {
    if (!equations_.degenerate || equations_.degenerate->is_determined(subject)) return true;
    return leave_open(result);
  }

  /// False, and said, where functions stay free: modes and periods are those of one choice.
  bool is_one_motion(ExpectationResult& result) const { return !has_free_functions(equations_) || leave_open(result); }

  static bool leave_open(ExpectationResult& result) {
    result.actual = "any value";
    result.message = "It depends on functions of time that the Lagrangian leaves free: choose them with `gauge`.";
    return false;
  }

  /// Where L is degenerate, what determines all accelerations.
  const EquationsOfMotion& solvable() const { return solvable_equations(equations_); }
  const Model& solvable_model() {
    if (!equations_.determined) return model_;
    if (!solvable_model_) solvable_model_ = with_determined_system(model_, equations_);
    return *solvable_model_;
  }
  ModeClaims& modes() {
    if (!modes_) modes_.emplace(solvable_model(), solvable());
    return *modes_;
  }
  OrbitClaims& orbits() {
    if (!orbits_) orbits_.emplace(solvable_model(), solvable(), interrupt_);
    return *orbits_;
  }
  ActionClaims& paths() {
    if (!paths_) paths_.emplace(model_, equations_, interrupt_);
    return *paths_;
  }

  const Model& model_;
  const EquationsOfMotion& equations_;
  const StopFlag* interrupt_;
  std::size_t line_ = 0;  // of the expectation that is looked at
  IdentityClaims identities_;
  RunClaims runs_;
  std::optional<ConstraintAnalysis> constraints_;
  std::optional<Model> solvable_model_;
  std::optional<ModeClaims> modes_;
  std::optional<OrbitClaims> orbits_;
  std::optional<ActionClaims> paths_;
};

}  // namespace

std::size_t Verification::passed() const {
  return static_cast<std::size_t>(
      std::count_if(results.begin(), results.end(), [](const auto& r) { return r.passed; }));
}

Verification verify(const Model& model, const EquationsOfMotion& equations, const SourceText& source,
                    const SimulationOptions& options, Diagnostics& diagnostics, const std::string& with) {
  return Verifier(model, equations, options, diagnostics).carry_out(source, with);
}

}  // namespace maupertuis

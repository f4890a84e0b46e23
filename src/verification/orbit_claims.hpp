#pragma once
#include <maupertuis/orbits.hpp>
#include <maupertuis/verification.hpp>

#include <map>

namespace maupertuis {

/// expect multipliers, expect trace, expect period: of the periodic motion next to the model's start, as `maup orbits
/// --floquet` finds it; `over` gives a period, or nearly one, which is looked for otherwise. One search for each such
/// time.
class OrbitClaims {
 public:
  OrbitClaims(const Model& model, const EquationsOfMotion& equations, const StopFlag* interrupt)
      : model_(model), equations_(equations), interrupt_(interrupt) {}
  void decide(const expectation::Multipliers& expectation, ExpectationResult& result);
  void decide(const expectation::Trace& expectation, ExpectationResult& result);
  void decide(const expectation::Period& expectation, ExpectationResult& result);

 private:
  struct Answer {
    std::optional<FloquetResult> found;
    std::string trouble;
  };
  const Answer& answer(Expr over);
  /// The motion of that period; null, and why, where there is none.
  const FloquetResult* motion(Expr over, ExpectationResult& result);

  const Model& model_;
  const EquationsOfMotion& equations_;
  const StopFlag* interrupt_;
  std::map<double, Answer> answers_;  // by the period that was given; 0: none
};

}  // namespace maupertuis

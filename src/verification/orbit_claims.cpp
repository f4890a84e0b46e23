#include "verification/orbit_claims.hpp"

#include "verification/judge.hpp"

#include <fmt/format.h>

namespace maupertuis {

const OrbitClaims::Answer& OrbitClaims::answer(const Expectation& e) {
  const double given = number_of(model_.system, e.time);
  const auto [at, is_new] = answers_.try_emplace(given);
  if (!is_new) return at->second;
  FloquetOptions options;
  options.interrupt = interrupt_;
  if (e.time) options.period = given;
  Diagnostics told;
  at->second.found = floquet(model_, equations_, options, told);
  for (const Diagnostic& d : told.items())
    if (d.severity == Severity::Error && at->second.trouble.empty()) at->second.trouble = d.message + ". " + d.reason;
  return at->second;
}

void OrbitClaims::decide(const Expectation& e, ExpectationResult& result) {
  const Answer& a = answer(e);
  if (!a.found) {
    result.actual = "no periodic motion";
    result.message = a.trouble;
    return;
  }
  const FloquetResult& f = *a.found;
  using Asked = syntax::ExpectStatement::Kind;
  if (e.kind == Asked::Multipliers) {
    // Those that are 1 by themselves may be written or left out.
    auto values = f.multipliers;
    if (spectrum_size(e, model_.system) != values.size()) values.resize(values.size() - f.trivial);
    judge_spectrum(e, model_.system, values, result);
  } else {
    judge_number(e, model_.system, e.kind == Asked::Trace ? f.trace : f.motion.period, result);
  }
  result.message += fmt::format("; periodic motion of {:.9g} s, closed to {:.1e}", f.motion.period, f.motion.closure);
}

}  // namespace maupertuis

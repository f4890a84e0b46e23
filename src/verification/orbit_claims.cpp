#include "verification/orbit_claims.hpp"

#include "verification/judge.hpp"

#include <fmt/format.h>

namespace maupertuis {

const OrbitClaims::Answer& OrbitClaims::answer(Expr over) {
  const double given = number_of(model_.system, over);
  const auto [at, is_new] = answers_.try_emplace(given);
  if (!is_new) return at->second;
  FloquetOptions options;
  options.interrupt = interrupt_;
  if (over) options.period = given;
  Diagnostics told;
  at->second.found = floquet(model_, equations_, options, told);
  for (const Diagnostic& d : told.items())
    if (d.severity == Severity::Error && at->second.trouble.empty()) at->second.trouble = d.message + ". " + d.reason;
  return at->second;
}

const FloquetResult* OrbitClaims::motion(Expr over, ExpectationResult& result) {
  const Answer& a = answer(over);
  if (a.found) return &*a.found;
  result.actual = "no periodic motion";
  result.message = a.trouble;
  return nullptr;
}

namespace {

void add_ground(const FloquetResult& f, ExpectationResult& result) {
  result.message += fmt::format("; periodic motion of {:.9g} s, closed to {:.1e}", f.motion.period, f.motion.closure);
}

}  // namespace

void OrbitClaims::decide(const expectation::Multipliers& e, ExpectationResult& result) {
  const FloquetResult* f = motion(e.over, result);
  if (!f) return;
  // Those that are 1 by themselves may be written or left out.
  auto values = f->multipliers;
  if (spectrum_size(e.expected, model_.system) != values.size()) values.resize(values.size() - f->trivial);
  judge_spectrum(e.expected, model_.system, values, result);
  add_ground(*f, result);
}

void OrbitClaims::decide(const expectation::Trace& e, ExpectationResult& result) {
  const FloquetResult* f = motion(e.over, result);
  if (!f) return;
  judge_number(e.expected, model_.system, f->trace, result);
  add_ground(*f, result);
}

void OrbitClaims::decide(const expectation::Period& e, ExpectationResult& result) {
  const FloquetResult* f = motion(e.over, result);
  if (!f) return;
  judge_number(e.expected, model_.system, f->motion.period, result);
  add_ground(*f, result);
}

}  // namespace maupertuis

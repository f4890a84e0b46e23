#include "verification/claims.hpp"

#include <maupertuis/along_motion.hpp>
#include "verification/pitfalls.hpp"

#include <algorithm>

namespace maupertuis {
namespace {

bool has_acceleration(Expr e) {
  for (const Expr& s : symbols_of({&e, 1}))
    if (s.role() == Role::Coordinate && s.order() == 2) return true;
  return false;
}

/// True if a = c·b with c constant in q, q̇ and t: equations without accelerations say the same then.
bool proportional(Expr a, Expr b) {
  if (a.is_zero() || b.is_zero()) return false;
  const Expr ratio = a / b;
  for (const Expr& s : symbols_of({&ratio, 1})) {
    if (s.role() != Role::Coordinate && s.role() != Role::Time) continue;
    if (zero_test(differentiate(ratio, s)).verdict != Verdict::Zero) return false;
  }
  return true;
}

bool follows_from(Expr difference, const EquationsOfMotion& equations, const ExprVector& residual) {
  if (has_acceleration(difference)) {
    ExprVector balance = residual;
    for (std::size_t i = 0; i < equations.constraint_forces.size(); ++i)
      balance[i] = balance[i] - equations.constraint_forces[i];
    const AlongMotion mistaken(equations, balance);
    return mistaken.solvable() && mistaken.vanishes(difference).verdict == Verdict::Zero;
  }
  for (const Expr& row : residual) {
    const Expr plain = expand_time_derivatives(row);
    if (!has_acceleration(plain) && proportional(difference, plain)) return true;
  }
  return false;
}

bool is_about(const Pitfall& pitfall, const Resemblance* resemblance) {
  if (!resemblance || resemblance->origins.empty() || pitfall.about.empty()) return true;
  return std::all_of(resemblance->origins.begin(), resemblance->origins.end(), [&](TermOrigin origin) {
    return std::find(pitfall.about.begin(), pitfall.about.end(), origin) != pitfall.about.end();
  });
}

}  // namespace

std::string diagnose_claim(Expr difference, const EquationsOfMotion& equations, const Resemblance* resemblance) {
  const Expr plain = expand_time_derivatives(difference);
  for (const Pitfall& pitfall : pitfalls(equations))
    if (is_about(pitfall, resemblance) && follows_from(plain, equations, pitfall.residual)) return pitfall.sentence;
  return resemblance ? resemblance->sentence : "";
}

}  // namespace maupertuis

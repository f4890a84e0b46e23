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

/// Whether several accelerations of the claim are 0 by the mistaken equations, each for itself: then any sum of them
/// is.
bool follows_idly(Expr difference, const AlongMotion& mistaken, const EquationsOfMotion& equations) {
  std::size_t count = 0;
  for (const Coordinate& c : equations.system->coordinates) {
    if (differentiate(difference, c.acceleration).is_zero()) continue;
    if (mistaken.vanishes(c.acceleration).verdict != Verdict::Zero) return false;
    ++count;
  }
  return count > 1;
}

bool follows_from(Expr difference, const EquationsOfMotion& equations, const ExprVector& residual) {
  if (has_acceleration(difference)) {
    ExprVector balance = residual;
    for (std::size_t i = 0; i < equations.constraint_forces.size(); ++i)
      balance[i] = balance[i] - equations.constraint_forces[i];
    const AlongMotion mistaken(equations, balance);
    return mistaken.solvable() && mistaken.vanishes(difference).verdict == Verdict::Zero &&
           !follows_idly(difference, mistaken, equations);
  }
  for (const Expr& row : residual) {
    const Expr plain = expand_time_derivatives(row);
    if (!has_acceleration(plain) && proportional(difference, plain)) return true;
  }
  return false;
}

/// A first integral that is claimed to be 0, as a momentum or the energy.
bool is_conserved(Expr difference, const EquationsOfMotion& equations) {
  if (has_acceleration(difference)) return false;
  const AlongMotion along(equations);
  return along.solvable() && along.vanishes(total_time_derivative(difference)).verdict == Verdict::Zero;
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
  const bool explained = resemblance && !resemblance->sentence.empty();
  for (const Pitfall& pitfall : pitfalls(equations)) {
    if ((explained && pitfall.throughout) || !is_about(pitfall, resemblance)) continue;
    if (!follows_from(plain, equations, pitfall.residual)) continue;
    const bool perhaps_a_slip =
        resemblance && resemblance->signs_alone && pitfall.sentence.find("sign") == std::string::npos;
    return pitfall.sentence + (perhaps_a_slip ? ", or its sign is a slip" : "");
  }
  if (explained) return resemblance->sentence;
  return is_conserved(plain, equations)
             ? "its value stays along every motion, and is 0 along some of them alone: what holds along all of them is "
               "that its rate of change is 0"
             : "";
}

}  // namespace maupertuis

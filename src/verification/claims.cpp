#include "verification/claims.hpp"

#include <maupertuis/along_motion.hpp>
#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/simulation.hpp>

#include "verification/pitfalls.hpp"

#include <algorithm>

namespace maupertuis {
namespace {

bool has_acceleration(Expr e) {
  for (const Expr& s : symbols_of({&e, 1}))
    if (s.role() == Role::Coordinate && s.order() == 2) return true;
  return false;
}

bool holds_multiplier(Expr e) {
  for (const Expr& s : symbols_of({&e, 1}))
    if (s.role() == Role::Multiplier) return true;
  return false;
}

/// True if a = c·b with c constant in q, q̇, t and λ: equations without accelerations say the same then.
bool proportional(Expr a, Expr b) {
  if (a.is_zero() || b.is_zero()) return false;
  const Expr ratio = a / b;
  for (const Expr& s : symbols_of({&ratio, 1})) {
    if (s.role() != Role::Coordinate && s.role() != Role::Time && s.role() != Role::Multiplier) continue;
    if (zero_test(differentiate(ratio, s)).verdict != Verdict::Zero) return false;
  }
  return true;
}

/// Whether several accelerations and multipliers of the claim are 0 by the mistaken equations, each for itself: then
/// any sum of them is.
bool follows_idly(Expr difference, const AlongMotion& mistaken, const EquationsOfMotion& equations) {
  ExprVector unknowns = equations.multipliers;
  for (const Coordinate& c : equations.system->coordinates) unknowns.push_back(c.acceleration);
  std::size_t count = 0;
  for (const Expr& unknown : unknowns) {
    if (differentiate(difference, unknown).is_zero()) continue;
    if (mistaken.vanishes(unknown).verdict != Verdict::Zero) return false;
    ++count;
  }
  return count > 1;
}

bool solve(const EquationsOfMotion& equations, const ExprVector& balance) {
  const MechanicalSystem& system = *equations.system;
  return accelerations_and_multipliers(in_terms_of_motion(system, balance),
                                       in_terms_of_motion(system, equations.constraint_accelerations), system)
      .has_value();
}

/// Whether the mistaken equations have one q̈ and one λ: from others nothing follows, or everything does. Where the
/// right ones do not say λ either, as with constraints that repeat each other, q̈ alone is asked for.
bool determine_motion(Expr difference, const EquationsOfMotion& equations, const ExprVector& balance,
                      const AlongMotion& mistaken) {
  if (!equations.system->constrained()) return mistaken.solvable();
  return solve(equations, balance) || (!holds_multiplier(difference) && !solve(equations, equations.balance()));
}

bool follows_from(Expr difference, const EquationsOfMotion& equations, const ExprVector& residual) {
  ExprVector balance = residual;
  for (std::size_t i = 0; i < equations.constraint_forces.size(); ++i)
    balance[i] = balance[i] - equations.constraint_forces[i];
  if (has_acceleration(difference) || holds_multiplier(difference)) {
    const AlongMotion mistaken(equations, balance);
    return determine_motion(difference, equations, balance, mistaken) &&
           mistaken.vanishes(difference).verdict == Verdict::Zero && !follows_idly(difference, mistaken, equations);
  }
  for (const Expr& row : balance) {
    const Expr plain = expand_time_derivatives(row);
    if (!has_acceleration(plain) && proportional(difference, plain)) return true;
  }
  return false;
}

/// A first integral that is claimed to be 0, as a momentum or the energy.
bool is_conserved(Expr difference, const EquationsOfMotion& equations) {
  if (has_acceleration(difference) || holds_multiplier(difference)) return false;
  const AlongMotion along(equations);
  return along.solvable() && along.vanishes(total_time_derivative(difference)).verdict == Verdict::Zero;
}

/// A claim that has λ in it errs in nothing but the force of a constraint: no energy is to blame for that.
bool errs_in_multipliers(Expr difference, const Resemblance* resemblance) {
  return resemblance && !resemblance->origins.empty() && holds_multiplier(difference) &&
         std::all_of(resemblance->origins.begin(), resemblance->origins.end(),
                     [](TermOrigin origin) { return origin == TermOrigin::Constraint; });
}

bool is_about(const Pitfall& pitfall, const Resemblance* resemblance) {
  if (!resemblance || resemblance->origins.empty() || pitfall.about.empty()) return true;
  return std::all_of(resemblance->origins.begin(), resemblance->origins.end(), [&](TermOrigin origin) {
    return std::find(pitfall.about.begin(), pitfall.about.end(), origin) != pitfall.about.end();
  });
}

}  // namespace

std::string diagnose_claim(Expr difference, const EquationsOfMotion& equations, const Resemblance* resemblance) {
  const Expr plain = expand_time_derivatives(with_reactions(equations, {&difference, 1}).front());
  const bool explained = resemblance && resemblance->explained();
  if (explained && errs_in_multipliers(plain, resemblance)) return resemblance->sentence;
  for (const Pitfall& pitfall : pitfalls(equations, resemblance && resemblance->in_several_ways)) {
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

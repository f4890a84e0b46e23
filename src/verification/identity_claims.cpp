#include "verification/identity_claims.hpp"

#include "verification/claims.hpp"
#include "verification/one_fraction.hpp"
#include "verification/phase_space_claims.hpp"
#include "verification/rate_resemblance.hpp"
#include "verification/row_terms.hpp"
#include "verification/solved_resemblance.hpp"

#include <maupertuis/print.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

std::string jump_text(const JumpAcross& jump) {
  return fmt::format(
      "It is constant on each side of a switch and jumps by {:.6g} (SI units){}: it is not conserved across.",
      std::abs(jump.jump), jump.place.empty() ? "" : " where " + jump.place);
}

/// "It is not conserved in the mode "floor sliding +", and impacts on floor change it."
std::string where_it_changes(const IntegralThroughModes& through) {
  using Holds = IntegralThroughModes::Holds;
  const auto mode =
      std::find_if(through.modes.begin(), through.modes.end(), [](const auto& m) { return m.holds != Holds::Yes; });
  const auto impact =
      std::find_if(through.impacts.begin(), through.impacts.end(), [](const auto& i) { return i.kept != Holds::Yes; });
  std::string text;
  if (mode != through.modes.end())
    text = fmt::format("In the mode \"{}\" {}.", mode->mode,
                       mode->holds == Holds::No ? "it is not conserved" : "it is not known to be conserved");
  if (impact != through.impacts.end())
    text += fmt::format("{}Impacts on {} {}.", text.empty() ? "" : " ", impact->contact,
                        impact->kept == Holds::No ? "change it" : "could not be looked at");
  const auto event =
      std::find_if(through.events.begin(), through.events.end(), [](const auto& e) { return e.kept != Holds::Yes; });
  if (event != through.events.end())
    text += fmt::format("{}The event `{}` {}.", text.empty() ? "" : " ", event->event,
                        event->kept == Holds::No ? "changes it" : "could not be looked at");
  return text.empty() ? fmt::format("{} modes are too many to look at.", through.left_out) : text;
}

}  // namespace

const AlongMotion& IdentityClaims::along() {
  if (along_) return *along_;
  along_.emplace(equations_);
  Diagnostics told_by_the_run;
  if (const auto start = consistent_start(model_, equations_, told_by_the_run)) along_->set_start(start->state);
  return *along_;
}

std::string IdentityClaims::ground(const ZeroTest& test) const {
  return ground_of(test, equations_.system->constrained());
}

bool IdentityClaims::needs_solvable(ExpectationResult& result) {
  if (along().solvable()) return true;
  result.message = "The mass matrix is singular: the equations do not determine the accelerations.";
  return false;
}

void IdentityClaims::decide(const expectation::Conserved& e, ExpectationResult& result) {
  if (!needs_solvable(result)) return;
  if (!e.where.empty()) return decide_on_level(e, result);
  const Expr rate = along().rate(with_momenta(e.subject, equations_));
  const ZeroTest test = along().vanishes(rate);
  result.expected = "d/dt = 0 along the motion";
  if (test.verdict == Verdict::Zero)
    if (const AcrossSwitches sides = along().across(with_momenta(e.subject, equations_));
        sides.switches > 0 || sides.jump) {
      judge_sides(test, sides, result);
      return judge_through_modes(e.subject, result);
    }
  result.passed = test.verdict == Verdict::Zero;
  result.actual = result.passed ? result.expected : "d/dt is not 0";
  result.message = result.passed ? ground(test) : failure(test, {"Its time derivative along the motion", rate});
  judge_through_modes(e.subject, result);
}

/// What holds while contacts are open has to hold in all modes, and impacts and events have to keep it.
void IdentityClaims::judge_through_modes(Expr subject, ExpectationResult& result) {
  if (!result.passed || !is_in_parts(model_)) return;
  const IntegralThroughModes through = through_modes(subject);
  result.passed = through.everywhere();
  if (!result.passed) {
    result.actual = not_throughout();
    result.message = where_it_changes(through);
  } else if (model_.system.has_modes()) {
    result.message += fmt::format("; so in {} modes, and impacts keep it", through.modes.size());
  }
}

std::string IdentityClaims::not_throughout() const {
  return model_.system.has_modes() ? "conserved while all contacts are open, but not throughout"
                                   : "conserved between events, but not throughout";
}

IntegralThroughModes IdentityClaims::through_modes(Expr subject) const {
  return integrals_through_modes(model_, equations_, {with_momenta(subject, equations_)}).front();
}

/// A constant on each side of a switch is one constant only if it goes on there.
void IdentityClaims::judge_sides(const ZeroTest& test, const AcrossSwitches& sides, ExpectationResult& result) const {
  result.passed = !sides.jump;
  result.actual = result.passed ? result.expected : "d/dt = 0 on each side of a switch alone";
  result.message = result.passed ? fmt::format("{} on each side of its switches; at {} points of them it does not jump",
                                               ground(test), sides.points)
                                 : jump_text(*sides.jump);
}

constexpr const char* no_state_found =
    "No state of the level was found to 60 digits. Where the level is an edge of what the motion can have, as the "
    "energy "
    "of a circular orbit, there is none that Newton's method reaches.";

/// dF/dt = 0 at all states on the level; and the motion stays there, else nothing would follow for it.
void IdentityClaims::decide_on_level(const expectation::Conserved& e, ExpectationResult& result) {
  result.expected = "d/dt = 0 along the motions on the level";
  std::vector<Expr> level;
  for (const Expr& x : e.where) level.push_back(with_momenta(x, equations_));
  for (const Expr& x : level) {
    const ZeroTest stays = along().vanishes_on(along().rate(x), level);
    if (stays.verdict == Verdict::Zero) continue;
    result.actual = stays.verdict == Verdict::Nonzero ? "the motion leaves the level" : "undecided";
    result.message = stays.verdict == Verdict::Nonzero
                         ? "A quantity that is given for the level changes along the motion."
                         : no_state_found;
    return;
  }
  const ZeroTest test = along().vanishes_on(along().rate(with_momenta(e.subject, equations_)), level);
  result.passed = test.verdict == Verdict::Zero;
  result.actual = result.passed                      ? result.expected
                  : test.verdict == Verdict::Nonzero ? "d/dt is not 0 on the level"
                                                     : "undecided";
  result.message = result.passed ? fmt::format("vanishes to 60 digits at {} points of the level", test.points)
                   : test.verdict == Verdict::Nonzero
                       ? fmt::format("At a state on the level its time derivative is {:.6g}.", test.witness_value)
                       : no_state_found;
  if (!result.passed) return;
  const AcrossSwitches sides = along().across(with_momenta(e.subject, equations_));
  if (!sides.jump) return;
  result.passed = false;
  result.actual = "d/dt = 0 on each side of a switch alone";
  result.message = jump_text(*sides.jump);
}

void IdentityClaims::decide(const expectation::NotConserved& e, ExpectationResult& result) {
  if (!needs_solvable(result)) return;
  const ZeroTest test = along().vanishes(along().rate(with_momenta(e.subject, equations_)));
  result.expected = "d/dt is not 0 along the motion";
  result.passed = test.verdict == Verdict::Nonzero;
  if (test.verdict == Verdict::Zero)
    if (const AcrossSwitches sides = along().across(with_momenta(e.subject, equations_)); sides.jump) {
      result.passed = true;
      result.actual = "it jumps at a switch";
      result.message = jump_text(*sides.jump);
      return;
    }
  if (test.verdict == Verdict::Zero && is_in_parts(model_)) {
    const IntegralThroughModes through = through_modes(e.subject);
    const auto differs = [](const auto& x) {
      if constexpr (requires { x.kept; })
        return x.kept == IntegralThroughModes::Holds::No;
      else
        return x.holds == IntegralThroughModes::Holds::No;
    };
    if (std::any_of(through.modes.begin(), through.modes.end(), differs) ||
        std::any_of(through.impacts.begin(), through.impacts.end(), differs) ||
        std::any_of(through.events.begin(), through.events.end(), differs)) {
      result.passed = true;
      result.actual = not_throughout();
      result.message = where_it_changes(through);
      return;
    }
  }
  result.actual = result.passed                   ? result.expected
                  : test.verdict == Verdict::Zero ? "d/dt = 0: it is conserved"
                                                  : "undecided";
  result.message = result.passed                   ? "a state was found at which it changes"
                   : test.verdict == Verdict::Zero ? ground(test)
                                                   : test.reason;
}

/// The search of `maup invariants`, of the degree that the expectation has in the velocities; one for each degree.
const std::optional<Invariants>& IdentityClaims::invariants(int degree) {
  const auto [it, is_new] = invariants_.try_emplace(degree);
  if (is_new) {
    InvariantsOptions options;
    options.velocity_degree = degree;
    options.drift = options.relations = options.completeness = false;
    it->second = find_invariants(model_, equations_, options, diagnostics_);
  }
  return it->second;
}

void IdentityClaims::decide(const expectation::Integral& e, ExpectationResult& result) {
  result.expected = "found by maup invariants, up to functions of the others";
  const Expr integral = along().put_in(e.subject);
  const int degree = std::clamp(velocity_degree(integral, *equations_.system).value_or(2), 2, 4);
  const auto& found = invariants(degree);
  if (!found) {
    const std::string why = diagnostics_.empty() ? "" : diagnostics_.items().back().message;
    result.message = fmt::format("The search did not run{}{}.", why.empty() ? "" : ": ", why);
    return;
  }
  result.passed = is_function_of(integral, *found, equations_);
  result.actual = result.passed ? result.expected : "not found";
  if (const AcrossSwitches sides = along().across(integral); sides.jump) {
    result.passed = false;
    result.actual = "constant on each side of a switch alone";
    result.message = jump_text(*sides.jump);
    return;
  }
  result.message =
      result.passed
          ? fmt::format("a function of the {} integrals of degree up to {} in the velocities, by the rank of gradients",
                        found->integrals.size(), degree)
          : fmt::format("It is no function of the {} integrals of degree up to {} in the velocities that were found.",
                        found->integrals.size(), degree);
  judge_through_modes(e.subject, result);
}

void IdentityClaims::decide(const expectation::Equation& e, ExpectationResult& result) {
  if (!needs_solvable(result)) return;
  const Expr difference = with_momenta(e.left - e.right, equations_);
  const ZeroTest test = along().vanishes(difference);
  result.expected = "follows from the derived equations";
  result.passed = test.verdict == Verdict::Zero;
  if (result.passed) {
    result.actual = result.expected;
    result.message = ground(test);
    return;
  }
  result.actual = test.verdict == Verdict::Undecided ? "undecided" : "does not follow";
  result.message = failure(test, {"Along the motion, left side − right side", in_solved_motion(difference)});
  if (test.verdict != Verdict::Nonzero) return;
  if (!equations_.system->higher.empty()) return;  // its rows are not those that a reader writes
  if (const auto sides = distances_with_signs()) {
    const Expr on_side = sides->with_signs(difference);
    if (AlongMotion(sides->equations).vanishes(on_side).verdict == Verdict::Zero) {
      result.passed = true;
      result.actual = result.expected;
      result.where = sides->where;
      result.message = fmt::format("follows where {}", sides->where);
      return;
    }
    return explain_false(on_side, sides->equations, result);
  }
  explain_false(difference, equations_, result);
}

/// With q̈ and λ put in, over one denominator: what is left can be read. As it is where the equations are not solved.
Expr IdentityClaims::in_solved_motion(Expr difference) {
  const Expr with_forces = with_reactions(equations_, {&difference, 1}).front();
  const Expr plain = expand_time_derivatives(in_terms_of_motion(*equations_.system, {&with_forces, 1}).front());
  const Expr solved = expand_time_derivatives(substitute(plain, solved_motion(equations_)));
  return is_short_enough(solved) ? as_one_fraction(solved, equations_.order).value() : along().put_in(difference);
}

/// Where the motion starts; nothing where no distance of the energies is |r| in a coordinate.
std::optional<SignedDistances> IdentityClaims::distances_with_signs() const {
  Diagnostics told_by_the_run;
  const auto start = consistent_start(model_, equations_, told_by_the_run);
  return start ? signed_distances(equations_, start->state) : std::nullopt;
}

void IdentityClaims::explain_false(Expr difference, const EquationsOfMotion& equations, ExpectationResult& result) {
  auto resemblance = resembled_equation_in_rates(difference, equations);
  if (!resemblance) resemblance = resembled_equation(difference, equations);
  if (!resemblance || !resemblance->explained())
    if (auto solved = resembled_solution(difference, equations)) resemblance = std::move(solved);
  if (resemblance) result.message = resemblance->text;
  result.pitfall = diagnose_claim(difference, equations, resemblance ? &*resemblance : nullptr);
  if (result.pitfall.empty() && (resemblance || result.claim))
    result.message += " No known mistake has this signature.";
}

/// Names the difference where it is short enough to be read.
std::string IdentityClaims::failure(const ZeroTest& test, const Identity& identity) const {
  if (test.verdict == Verdict::Undecided) return "Undecided: " + test.reason;
  if (is_short_enough(identity.value)) {
    const ReadableForm form = readable(identity.value, equations_.order);
    const std::string text = to_plain(form.value, equations_.order);
    constexpr std::size_t longest = 300;
    if (form.intermediates.empty() && text.size() <= longest)
      return fmt::format("{} is {}, not 0.", identity.name, text);
  }
  return fmt::format("{} is not 0: at {} it is {:.6g}.", identity.name, state_text(test.witness), test.witness_value);
}

/// "x = 0.3, x' = -1.2 (SI)" of a sample.
std::string IdentityClaims::state_text(const Bindings& sample) const {
  std::string out;
  for (const Coordinate& c : equations_.system->coordinates)
    for (const Expr& symbol : {c.q, c.velocity})
      if (const auto found = sample.find(symbol); found != sample.end())
        out += fmt::format("{}{}{} = {:.6g}", out.empty() ? "" : ", ", c.name, symbol == c.q ? "" : "'", found->second);
  return out.empty() ? "a sample state" : out + " (SI)";
}

}  // namespace maupertuis

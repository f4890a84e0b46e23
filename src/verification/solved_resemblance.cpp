#include "verification/solved_resemblance.hpp"

#include "verification/combination.hpp"
#include "verification/one_fraction.hpp"
#include "verification/phrases.hpp"
#include "verification/term_variants.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/simulation.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {
namespace {

/// What is written in the place of what should stand there: term by term, over one denominator.
struct Replaced {
  Expr below;                        // both times this
  ExprVector terms;                  // of what should stand there, as a sum
  std::vector<Rational> numbers;     // before them in what is written
  std::vector<std::size_t> changed;  // those with numbers other than 1
  bool all_alike() const {
    return changed.size() == numbers.size() &&
           std::all_of(numbers.begin(), numbers.end(), [&](const Rational& b) { return b == numbers.front(); });
  }
  /// Where all of it is missing, or nothing, there is no resemblance.
  bool is_one_mistake() const {
    return all_alike() ? !numbers.front().is_zero() && !numbers.front().is_one() : changed.size() == 1;
  }
};

class SolutionResembler {
 public:
  SolutionResembler(Expr difference, const EquationsOfMotion& equations)
      : equations_(equations),
        states_(equations),
        claim_(states_.settled(with_reactions(equations, {&difference, 1}).front())) {}

  std::optional<Resemblance> find() {
    if (!reads_unknowns()) return std::nullopt;
    const ExprMap solution = solved_motion(equations_);
    if (solution.empty()) return std::nullopt;
    const Expr beside = states_.settled(-substitute(leading_, solution)), written = claim_ - leading_;
    if (!is_short_enough(beside) || !is_short_enough(written)) return std::nullopt;
    velocities_alone_ = states_.vanishes(at_rest(beside));
    const auto in_terms = replaced(written, beside);
    const bool sums_inertia = differentiate(leading_, unknowns_.front()).is(Kind::Sum);
    if (in_terms && (in_terms->all_alike() || !sums_inertia)) return told_beside(*in_terms);
    if (const auto found = other_inertia(written, solution)) return found;
    if (in_terms) return told_beside(*in_terms);
    return other_function(written, beside);
  }

 private:
  /// Which q̈ and λ stand in the claim, and the part that they make: linear in them.
  bool reads_unknowns() {
    ExprVector all = equations_.multipliers, leading;
    for (const Coordinate& c : equations_.system->coordinates) all.push_back(c.acceleration);
    const ExprVector slopes = gradient(claim_, all);
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (states_.vanishes(slopes[k])) continue;
      const std::vector<Expr> symbols = symbols_of({&slopes[k], 1});
      for (const Expr& s : symbols)
        if (std::find(all.begin(), all.end(), s) != all.end()) return false;
      unknowns_.push_back(all[k]);
      holds_multiplier_ = holds_multiplier_ || all[k].role() == Role::Multiplier;
      leading.push_back(slopes[k] * all[k]);
    }
    leading_ = equations_.system->context->sum(leading);
    return !unknowns_.empty();
  }

  Expr at_rest(Expr e) const {
    ExprMap map;
    for (const Coordinate& c : equations_.system->coordinates)
      map.emplace(c.velocity, equations_.system->context->number(0));
    return substitute(e, map);
  }

  /// Of a claim c q̈ = f with f ≠ 0 that has its terms right: c should be f over the acceleration.
  std::optional<Resemblance> other_inertia(Expr written, const ExprMap& solution) {
    if (unknowns_.size() != 1 || holds_multiplier_ || states_.vanishes(written)) return std::nullopt;
    const Expr value = states_.settled(solution.at(unknowns_.front()));
    if (!is_short_enough(value) || states_.vanishes(value)) return std::nullopt;
    const Expr right = as_one_fraction(-written / value, equations_.order).value();
    for (const Expr& s : symbols_of({&right, 1}))
      if (s.role() == Role::Coordinate || s.role() == Role::Time) return std::nullopt;  // no inertia: something else
    const auto found = replaced(differentiate(leading_, unknowns_.front()), right);
    return found ? std::optional(told_before(*found)) : std::nullopt;
  }

  /// cos β for sin β where one term stands beside.
  std::optional<Resemblance> other_function(Expr written, Expr beside) {
    const Expr right = as_one_fraction(beside, equations_.order).value();
    if (right.is(Kind::Sum) || right.is_zero()) return std::nullopt;
    for (const TermVariant& variant : term_variants(right, equations_))
      if (states_.vanishes(written - variant.value))
        return Resemblance{fmt::format("It resembles what the equations give for {}; {} stands in the place of {}.",
                                       names(), text(variant.value), text(right)),
                           variant.sentence,
                           {},
                           false};
    return std::nullopt;
  }

  std::optional<Replaced> replaced(Expr written, Expr right) {
    if (!is_short_enough(right)) return std::nullopt;
    const OneFraction fraction = as_one_fraction(right, equations_.order);
    const Expr sum = expand(fraction.above);
    if (!sum || sum.is_zero()) return std::nullopt;
    Replaced out{fraction.below, {}, {}, {}};
    for (std::size_t k = 0; k < (sum.is(Kind::Sum) ? sum.size() : 1); ++k)
      out.terms.push_back(sum.is(Kind::Sum) ? sum[k] : sum);
    const auto numbers = states_.combination(written * out.below, out.terms);
    if (!numbers) return std::nullopt;
    out.numbers = *numbers;
    for (std::size_t k = 0; k < out.numbers.size(); ++k)
      if (!out.numbers[k].is_one()) out.changed.push_back(k);
    return out.is_one_mistake() ? std::optional(out) : std::nullopt;
  }

  std::string text(Expr e) const { return to_plain(written_out(e, equations_.order), equations_.order); }

  std::string names() const {
    std::string out;
    for (const Expr& u : unknowns_)
      out += (out.empty() ? "" : unknowns_.back() == u ? " and " : ", ") + to_plain(u, equations_.order);
    return out;
  }

  /// "It resembles what the equations give for s''; 5/7 g sin β stands in the place of 2/3 g sin β."
  std::string difference(const Replaced& found, Expr times) const {
    ExprVector terms;
    for (const std::size_t k : found.changed) terms.push_back(found.terms[k]);
    const Expr sum = equations_.system->context->sum(terms) * times;
    const Rational number = found.numbers[found.changed.front()];
    // Over its denominator where that is all that differs; else term by term, as where the denominator is taken out.
    const bool whole = found.all_alike();
    const std::string by = whole || found.below.is_one() ? "" : fmt::format(", times {}", text(found.below));
    const Expr shown = whole ? sum / found.below : sum;
    const std::string what = number.is_zero() ? "missing: " + text(shown)
                             : number == Rational(-1)
                                 ? "wrong sign: " + text(shown)
                                 : fmt::format("{} stands in the place of {}", text(number * shown), text(shown));
    return fmt::format("It resembles what the equations give for {}{}; {}.", names(), by, what);
  }

  Resemblance told_beside(const Replaced& found) const {
    const Rational number = found.numbers[found.changed.front()];
    Resemblance out{difference(found, equations_.system->context->number(1)), "", {}, number == Rational(-1)};
    const bool of_force = unknowns_.size() == 1 && holds_multiplier_;
    if (of_force && found.all_alike() && number == Rational(-1)) {
      out.origins = {TermOrigin::Constraint};
      out.sentence = "λ has the wrong sign: +Aᵀλ belongs to the right side, with A the derivatives of left − right";
    } else if (!found.all_alike() || velocities_alone_) {
      out.sentence = "one of its terms " + phrases::of_factor(number);
    } else if (!holds_multiplier_ && number == Rational(-1)) {
      out.sentence = "what stands beside the accelerations has the wrong sign, all of it, or these have";
    } else if (!holds_multiplier_ && number.sign() > 0) {
      out.sentence = phrases::of_ratio_to_inertia(number);
    }
    return out;
  }

  Resemblance told_before(const Replaced& found) const {
    const Rational number = found.numbers[found.changed.front()];
    return {difference(found, unknowns_.front()), "a part of the inertia " + phrases::of_factor(number), {}, false};
  }

  const EquationsOfMotion& equations_;
  RandomStates states_;
  Expr claim_, leading_;  // leading: Σ slope u over q̈ and λ
  ExprVector unknowns_;   // that stand in the claim
  bool holds_multiplier_ = false, velocities_alone_ = false;
};

}  // namespace

ExprMap solved_motion(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  constexpr std::size_t most = 8;
  if (system.coordinates.size() + equations.multipliers.size() > most || equations.degenerate) return {};
  ExprMap out;
  const ExprVector balance = in_terms_of_motion(system, equations.balance());
  if (!system.constrained()) {
    const auto solved = accelerations(balance, system);
    for (std::size_t i = 0; solved && i < solved->size(); ++i)
      out.emplace(system.coordinates[i].acceleration, (*solved)[i]);
    return out;
  }
  const auto solved =
      accelerations_and_multipliers(balance, in_terms_of_motion(system, equations.constraint_accelerations), system);
  if (!solved) return {};
  for (std::size_t i = 0; i < solved->accelerations.size(); ++i)
    out.emplace(system.coordinates[i].acceleration, solved->accelerations[i]);
  for (std::size_t k = 0; k < solved->multipliers.size(); ++k)
    out.emplace(equations.multipliers[k], solved->multipliers[k]);
  return out;
}

std::optional<Resemblance> resembled_solution(Expr difference, const EquationsOfMotion& equations) {
  return SolutionResembler(difference, equations).find();
}

}  // namespace maupertuis

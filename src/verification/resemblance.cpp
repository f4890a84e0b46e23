#include "verification/resemblance.hpp"

#include "verification/combination.hpp"
#include "verification/phrases.hpp"
#include "verification/term_variants.hpp"

#include <maupertuis/print.hpp>
#include <maupertuis/simulation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>

/// A claim F = 0 resembles row i of R − Aᵀλ = 0 if F is c times its terms, each with a number of its own before it that
/// should be 1: 0 is a missing term, −1 a wrong sign. Where no such numbers exist, one term may have been replaced. The
/// factor c, which may be any expression, is what the accelerations of F have over those of the row, or what its terms
/// at rest have.
namespace maupertuis {
namespace {

/// A factor of a row that the claim may be.
struct RowFactor {
  std::size_t row;
  Expr factor;
};

/// How a claim differs from its row.
struct Finding {
  RowFactor of;
  std::string difference, sentence;
  std::vector<TermOrigin> origins;
  bool signs_alone = false, in_several_ways = false;
  std::size_t cost = 0;  // terms that differ, with a little for a factor that is no number: the smaller one is believed
};

class Resembler {
 public:
  Resembler(Expr difference, const EquationsOfMotion& equations)
      : equations_(equations),
        system_(*equations.system),
        states_(equations),
        claim_(expand_time_derivatives(with_reactions(equations, {&difference, 1}).front())) {}

  std::optional<Resemblance> find() {
    constexpr std::size_t most_coordinates = 10;  // beyond, no row is read term by term
    if (system_.coordinates.size() > most_coordinates || !linear_in_accelerations()) return std::nullopt;
    mass_ = mass_matrix(equations_);
    std::optional<Finding> best;
    for (std::size_t row = 0; row < system_.coordinates.size(); ++row) {
      if (!worth_a_look(row)) continue;
      const std::vector<RowTerm>& terms = terms_of(row);
      if (terms.empty()) continue;
      for (const Expr& factor : factors(row))
        if (auto found = explain({row, factor}, terms); found && (!best || found->cost < best->cost))
          best = std::move(found);
    }
    if (!best) best = unexplained();
    return best ? std::optional(told(*best)) : std::nullopt;
  }

 private:
  Expr zero() const { return system_.context->number(Rational(0)); }
  Expr one() const { return system_.context->number(Rational(1)); }
  bool vanishes(Expr e) { return states_.vanishes(e); }

  // ------------------------------------------------------------------------------------------ which row, which factor

  bool linear_in_accelerations() {
    ExprVector accelerations;
    for (const Coordinate& c : system_.coordinates) accelerations.push_back(c.acceleration);
    slopes_ = gradient(claim_, accelerations);
    for (const Expr& slope : slopes_)
      for (const Expr& s : symbols_of({&slope, 1}))
        if (s.role() == Role::Coordinate && s.order() == 2) return false;
    for (Expr& slope : slopes_)
      if (vanishes(slope)) slope = zero();
    return true;
  }

  bool no_accelerations() const {
    return std::all_of(slopes_.begin(), slopes_.end(), [](const Expr& e) { return e.is_zero(); });
  }

  /// A row whose accelerations do not meet those of the claim is not what it resembles; without any, small systems have
  /// few rows.
  bool worth_a_look(std::size_t row) const {
    constexpr std::size_t few = 6;
    if (no_accelerations()) return system_.coordinates.size() <= few;
    for (std::size_t j = 0; j < slopes_.size(); ++j)
      if (!slopes_[j].is_zero() && !mass_.at(row, j).is_zero()) return true;
    return false;
  }

  const std::vector<RowTerm>& terms_of(std::size_t row) {
    const auto [at, is_new] = terms_.try_emplace(row);
    if (is_new) at->second = row_terms(equations_, mass_, row);
    return at->second;
  }

  Expr at_rest(Expr e) const {
    ExprMap map;
    for (const Coordinate& c : system_.coordinates)
      for (const Expr& s : {c.velocity, c.acceleration}) map.emplace(s, zero());
    for (const Expr& multiplier : equations_.multipliers) map.emplace(multiplier, zero());
    return substitute(e, map);
  }

  static bool constant_in_motion(Expr e) {
    for (const Expr& s : symbols_of({&e, 1}))
      if (s.role() == Role::Coordinate || s.role() == Role::Time || s.role() == Role::Input ||
          s.role() == Role::Multiplier)
        return false;
    return true;
  }

  /// In its readable form, unless that is a search for minutes.
  Expr tidied(Expr e) const { return is_short_enough(e) ? readable(e, equations_.order).value : e; }

  /// A ratio without its coordinates, where they cancel as functions.
  std::optional<Expr> constant_ratio(Expr a, Expr b) {
    const Expr ratio = tidied(a / b);
    if (constant_in_motion(ratio)) return ratio;
    const Expr plain = states_.settled(a / b);
    for (const Expr& s : symbols_of({&plain, 1}))
      if ((s.role() == Role::Coordinate || s.role() == Role::Time || s.role() == Role::Multiplier) &&
          !vanishes(differentiate(plain, s)))
        return std::nullopt;
    ExprMap somewhere;  // it is the same everywhere: where sines and cosines are known numbers
    for (const Expr& s : symbols_of({&plain, 1}))
      if (s.role() == Role::Coordinate || s.role() == Role::Time || s.role() == Role::Multiplier)
        somewhere.emplace(s, one());
    return tidied(substitute(plain, somewhere));
  }

  ExprVector factors(std::size_t row) {
    ExprVector out{one()};
    const auto add = [&](Expr factor) {
      if (factor.is_zero() || vanishes(factor)) return;
      for (const Expr& other : out)
        if (vanishes(factor - other)) return;
      out.push_back(factor);
    };
    for (std::size_t j = 0; j < slopes_.size(); ++j)
      if (!slopes_[j].is_zero() && !mass_.at(row, j).is_zero()) add(tidied(slopes_[j] / mass_.at(row, j)));
    Expr resting = zero();
    for (const RowTerm& t : terms_of(row))
      if (t.origin == TermOrigin::Potential) resting = resting + t.value;
    if (!resting.is_zero())
      if (const auto ratio = constant_ratio(at_rest(claim_), at_rest(resting)); ratio && !ratio->is_zero()) add(*ratio);
    return out;
  }

  // ---------------------------------------------------------------------------------------------------- what differs

  std::optional<Finding> explain(const RowFactor& of, const std::vector<RowTerm>& terms) {
    const Expr claim = claim_ / of.factor;
    if (auto found = by_numbers(of, claim, terms)) return found;
    return by_one_term(of, claim, terms);
  }

  std::size_t factor_cost(Expr factor) const { return factor.is_number() ? 0 : constant_in_motion(factor) ? 1 : 4; }

  std::optional<Finding> by_numbers(RowFactor of, Expr claim, const std::vector<RowTerm>& terms) {
    std::vector<Expr> values;
    for (const RowTerm& t : terms) values.push_back(t.value);
    auto numbers = states_.combination(claim, values);
    if (!numbers) return std::nullopt;
    const Rational usual = most_common(*numbers, terms);
    if (usual.is_zero()) return std::nullopt;
    of.factor = usual * of.factor;
    std::vector<std::pair<RowTerm, Rational>> changed;
    for (std::size_t k = 0; k < terms.size(); ++k)
      if (const Rational b = (*numbers)[k] / usual; !b.is_one()) changed.push_back({terms[k], b});
    const bool inertia_stands = std::none_of(changed.begin(), changed.end(), [](const auto& c) {
      return c.first.origin == TermOrigin::Inertia || c.first.origin == TermOrigin::Coupling;
    });
    if (changed.empty() || (!inertia_stands && 2 * changed.size() > terms.size() + 1)) return std::nullopt;
    if (is_solved_for_forces(changed)) return std::nullopt;
    Finding out{of, "", "", {}, false, false, 10 * changed.size() + factor_cost(of.factor)};
    tell(out, changed, terms);
    return out;
  }

  /// A claim without λ whose other terms differ too, as in s'' = 5/7 g sin β of what rolls, has the force of the
  /// constraint put in; one without q̈ has the acceleration put in. Neither errs in this equation.
  bool is_solved_for_forces(const std::vector<std::pair<RowTerm, Rational>>& changed) const {
    const auto among = [&](TermOrigin origin) {
      return std::count_if(changed.begin(), changed.end(), [&](const auto& c) { return c.first.origin == origin; });
    };
    const auto of_constraints = among(TermOrigin::Constraint), of_inertia = among(TermOrigin::Inertia);
    const auto all = static_cast<std::ptrdiff_t>(changed.size());
    return (of_constraints > 0 && of_constraints < all) || (no_accelerations() && of_inertia > 0 && of_inertia < all);
  }

  /// Where all terms but those with accelerations, or only these, have one number before them, the claim says nothing
  /// of which of the two is wrong.
  static std::optional<Rational> ratio_to_inertia(const std::vector<std::pair<RowTerm, Rational>>& changed,
                                                  const std::vector<RowTerm>& terms) {
    const auto accelerates = [](const RowTerm& t) {
      return t.origin == TermOrigin::Inertia || t.origin == TermOrigin::Coupling;
    };
    const Rational number = changed.front().second;
    if (std::all_of(changed.begin(), changed.end(),
                    [](const auto& c) { return c.first.origin == TermOrigin::Velocity; }))
      return std::nullopt;
    const bool inertia = accelerates(changed.front().first);
    for (const auto& [term, factor] : changed)
      if (factor != number || accelerates(term) != inertia) return std::nullopt;
    const auto alike =
        std::count_if(terms.begin(), terms.end(), [&](const RowTerm& t) { return accelerates(t) == inertia; });
    if (number.is_zero() || (number == Rational(-1) && !inertia) || static_cast<std::size_t>(alike) != changed.size())
      return std::nullopt;
    return inertia ? Rational(1) / number : number;
  }

  /// The number before most terms; among equals that before the own acceleration.
  static Rational most_common(const std::vector<Rational>& numbers, const std::vector<RowTerm>& terms) {
    Rational best(0);
    std::size_t most = 0;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      if (numbers[k].is_zero()) continue;
      std::size_t votes = 0;
      bool own = false;
      for (std::size_t j = 0; j < numbers.size(); ++j)
        if (numbers[j] == numbers[k]) {
          votes += 2;
          own = own || terms[j].origin == TermOrigin::Inertia;
        }
      votes += own;
      if (votes > most) most = votes, best = numbers[k];
    }
    return best;
  }

  /// A term, or all terms of one origin, that stands there otherwise.
  std::optional<Finding> by_one_term(const RowFactor& of, Expr claim, const std::vector<RowTerm>& terms) {
    Expr all = zero();
    for (const RowTerm& t : terms) all = all + t.value;
    const Expr more = claim - all;
    for (const RowTerm& t : candidates(terms)) {
      const Expr written = more + t.value;
      Finding out{of, "", "", {t.origin}, false, false, 12 + factor_cost(of.factor)};
      if (stands_as_variant(out, written, t)) return out;
      if (const auto ratio = constant_ratio(written, t.value); ratio && constant_in_motion(*ratio)) {
        const Expr shown = *ratio * t.value;
        if (!vanishes(shown - written) || ratio->is_zero() || terms_in(shown) > terms_in(t.value)) continue;
        if (fraction_of(*ratio).below.is(Kind::Sum)) continue;  // M cos α for M + m is no slip of a factor
        tell_ratio(out, *ratio, t, terms);
        return out;
      }
    }
    return std::nullopt;
  }

  bool stands_as_variant(Finding& out, Expr written, const RowTerm& t) {
    for (const TermVariant& variant : term_variants(t.value, equations_))
      for (const bool minus : {false, true}) {
        const Expr value = minus ? -variant.value : variant.value;
        if (!vanishes(written - value)) continue;
        out.difference = stands_for(value, t.value, out.of.row);
        out.sentence = variant.sentence + (minus ? ", and the sign is wrong" : "");
        out.cost += minus ? 5 : 0;
        return true;
      }
    return false;
  }

  /// A ratio of what is written to a term, in symbols: powers above and below, and its number.
  struct Fraction {
    Rational number{1};
    Expr above, below;
    bool quantities = false;  // a number with a unit stands in it
  };
  Fraction fraction_of(Expr ratio) const {
    Fraction out{1, one(), one()};
    for (std::size_t k = 0; k < (ratio.is(Kind::Product) ? ratio.size() : 1); ++k) {
      const Expr factor = ratio.is(Kind::Product) ? ratio[k] : ratio;
      for (const Expr& s : symbols_of({&factor, 1})) out.quantities = out.quantities || s.role() == Role::Constant;
      const Rational* exponent = factor.is(Kind::Power) ? factor[1].number_or_null() : nullptr;
      if (const Rational* number = factor.number_or_null())
        out.number *= *number;
      else if (exponent && exponent->sign() < 0)
        out.below = out.below / factor;
      else
        out.above = out.above * factor;
    }
    return out;
  }

  /// 200/k with k = 200: right with the values that the model gives its parameters.
  bool is_value_of_symbols(Expr ratio, const Fraction& parts) const {
    constexpr double digits = 1e-12;
    const bool numbers = parts.quantities || !(parts.number.is_one() || (-parts.number).is_one());
    return numbers && !parts.below.is_one() && std::abs(number_of(system_, ratio) - 1) <= digits;
  }

  void tell_ratio(Finding& out, Expr ratio, const RowTerm& t, const std::vector<RowTerm>& terms) const {
    const std::size_t row = out.of.row;
    if (const Rational* number = ratio.number_or_null()) {
      std::vector<std::pair<RowTerm, Rational>> changed;
      for (const RowTerm& one : terms)
        if (one.origin == t.origin && one.of == t.of && (one.value == t.value || !stands_among(terms, t)))
          changed.push_back({one, *number});
      return tell(out, changed, terms);
    }
    out.difference = stands_for(ratio * t.value, t.value, row);
    const Fraction parts = fraction_of(ratio);
    if (is_value_of_symbols(ratio, parts)) {
      out.sentence =
          "numbers stand in the place of symbols: equations hold for all values of the parameters, so that a claim "
          "names them";
      return;
    }
    const Expr above = parts.number * parts.above;
    const std::string what = parts.below.is_one() ? text(above, row) + " is too many"
                             : above.is_one()     ? text(parts.below, row) + " is missing"
                                                  : stands_for(above, parts.below, row);
    out.sentence = fmt::format("a factor of {} is wrong: {}", name_of(t), what);
  }

  /// Whether a candidate is a term itself, not a sum of several.
  static bool stands_among(const std::vector<RowTerm>& terms, const RowTerm& t) {
    return std::any_of(terms.begin(), terms.end(), [&](const RowTerm& one) { return one.value == t.value; });
  }

  std::string stands_for(Expr written, Expr right, std::size_t row) const {
    return fmt::format("{} stands in the place of {}", text(written, row), text(right, row));
  }

  /// A factor leaves the number of terms as it is; F + k in the place of F has a term more.
  static std::size_t terms_in(Expr e) {
    const Expr expanded = expand(e);
    return expanded && expanded.is(Kind::Sum) ? expanded.size() : 1;
  }

  /// The terms, and their sums by origin.
  std::vector<RowTerm> candidates(const std::vector<RowTerm>& terms) const {
    std::vector<RowTerm> out = terms;
    std::map<std::pair<TermOrigin, std::size_t>, std::vector<Expr>> groups;
    for (const RowTerm& t : terms) groups[{t.origin, t.of}].push_back(t.value);
    for (const auto& [key, values] : groups)
      if (values.size() > 1) out.push_back({key.first, system_.context->sum(values), key.second});
    return out;
  }

  /// No known slip: what the claim has more, where its accelerations are those of a row.
  std::optional<Finding> unexplained() {
    if (no_accelerations()) return std::nullopt;
    for (std::size_t row = 0; row < system_.coordinates.size(); ++row) {
      if (!worth_a_look(row) || terms_of(row).empty()) continue;
      for (const Expr& factor : factors(row)) {
        if (!same_accelerations(row, factor)) continue;
        Expr all = zero();
        for (const RowTerm& t : terms_of(row)) all = all + t.value;
        if (no_multipliers() && !states_.vanishes(forces_of_constraints(row))) return std::nullopt;
        const std::string more = text(claim_ / factor - all, row);
        constexpr std::size_t longest = 200;
        if (more.size() > longest) return std::nullopt;
        return Finding{{row, factor}, fmt::format("on its left side stands more: {}", more), "", {}, false, false, 100};
      }
    }
    return std::nullopt;
  }

  /// A claim that has the forces of constraints put in lacks them in no equation.
  bool no_multipliers() const {
    const std::vector<Expr> symbols = symbols_of({&claim_, 1});
    return std::none_of(symbols.begin(), symbols.end(), [](const Expr& s) { return s.role() == Role::Multiplier; });
  }
  Expr forces_of_constraints(std::size_t row) {
    Expr sum = zero();
    for (const RowTerm& t : terms_of(row))
      if (t.origin == TermOrigin::Constraint) sum = sum + t.value;
    return sum;
  }

  bool same_accelerations(std::size_t row, Expr factor) {
    for (std::size_t j = 0; j < slopes_.size(); ++j)
      if (!vanishes(slopes_[j] - factor * mass_.at(row, j))) return false;
    return true;
  }

  // ---------------------------------------------------------------------------------------------------------- in words

  std::string text(Expr e, std::size_t row) const {
    if (!is_short_enough(e)) return to_plain(e, equations_.order);
    ReadableForm form = readable(e, equations_.order);
    ExprMap written_out;
    for (const Intermediate& i : form.intermediates) written_out.emplace(i.symbol, substitute(i.value, written_out));
    ReadingOrder order = equations_.order;
    order.own = system_.coordinates[row].q;
    return to_plain(substitute(form.value, written_out), order);
  }

  std::string name_of(const RowTerm& t) const {
    switch (t.origin) {
      case TermOrigin::Inertia:
        return "the inertia";
      case TermOrigin::Coupling:
        return fmt::format("the coupling with {}", system_.coordinates[t.of].name);
      case TermOrigin::Velocity:
        return "a term with velocities";
      case TermOrigin::PrescribedMotion:
      case TermOrigin::PrescribedAcceleration:
        return "the term from the prescribed motion";
      case TermOrigin::Potential:
        return "a force of the potential";
      case TermOrigin::Dissipation:
        return "the dissipation";
      case TermOrigin::Force:
        return "a generalized force";
      case TermOrigin::Constraint:
        return fmt::format("the force of the constraint {}", system_.constraint_label(t.of));
    }
    return "";
  }

  std::string where_from(const RowTerm& t, std::size_t row) const {
    const std::string& q = system_.coordinates[row].name;
    switch (t.origin) {
      case TermOrigin::Inertia:
        return fmt::format("M has it before {}''", q);
      case TermOrigin::Coupling:
        return "M is not diagonal";
      case TermOrigin::Velocity:
        return fmt::format("d/dt ∂L/∂{0}' − ∂L/∂{0} gives it", q);
      case TermOrigin::PrescribedMotion:
        return fmt::format("T has a part without velocities, and ∂T/∂{} holds it", q);
      case TermOrigin::PrescribedAcceleration:
        return fmt::format("∂L/∂{}' holds t, and d/dt acts through it too", q);
      case TermOrigin::Potential:
        return fmt::format("it is in ∂V/∂{}", q);
      case TermOrigin::Dissipation:
        return fmt::format("+∂D/∂{}' belongs to the left side", q);
      case TermOrigin::Force:
        return "Q belongs to the right side";
      case TermOrigin::Constraint:
        return "+Aᵀλ belongs to the right side";
    }
    return "";
  }

  /// A part of the inertia where another part of it stands as it should.
  std::string name_in(const std::vector<RowTerm>& terms, const std::vector<std::pair<RowTerm, Rational>>& changed,
                      const RowTerm& t) const {
    if (t.origin != TermOrigin::Inertia && t.origin != TermOrigin::Coupling && t.origin != TermOrigin::Dissipation)
      return name_of(t);
    const auto same = [&](const RowTerm& one) { return one.origin == t.origin && one.of == t.of; };
    const auto all = std::count_if(terms.begin(), terms.end(), same);
    const auto wrong = std::count_if(changed.begin(), changed.end(), [&](const auto& c) { return same(c.first); });
    return wrong < all ? "a part of " + name_of(t) : name_of(t);
  }

  void tell(Finding& out, const std::vector<std::pair<RowTerm, Rational>>& changed,
            const std::vector<RowTerm>& terms) const {
    out.origins.clear();
    out.signs_alone =
        std::all_of(changed.begin(), changed.end(), [](const auto& c) { return c.second == Rational(-1); });
    std::map<std::string, std::vector<std::pair<RowTerm, Rational>>>
        by_kind;  // in the order: missing, wrong factor, wrong sign
    for (const auto& c : changed)
      by_kind[c.second.is_zero()         ? "missing"
              : c.second == Rational(-1) ? "wrong sign"
                                         : "wrong factor " + c.second.to_string()]
          .push_back(c);
    out.in_several_ways = by_kind.size() > 1;
    for (const auto& [kind, list] : by_kind) {
      std::vector<Expr> values;
      for (const auto& [term, number] : list) values.push_back(term.value);
      const Expr sum = system_.context->sum(values);
      const std::string shown = text(sum, out.of.row);
      out.difference +=
          (out.difference.empty() ? "" : "; ") + (kind.find("factor") == std::string::npos
                                                      ? fmt::format("{}: {}", kind, shown)
                                                      : stands_for(list.front().second * sum, sum, out.of.row));
      for (const auto& [term, number] : list) {
        if (std::find(out.origins.begin(), out.origins.end(), term.origin) != out.origins.end()) continue;
        out.origins.push_back(term.origin);
        const std::string name = name_in(terms, changed, term);
        out.sentence += fmt::format("{}{} {}: {}", out.sentence.empty() ? "" : "; ", name, phrases::of_factor(number),
                                    where_from(term, out.of.row));
      }
    }
    if (const auto ratio = ratio_to_inertia(changed, terms)) {
      out.origins.clear();
      if (*ratio == Rational(-1)) {
        out.sentence = "what stands beside the inertia has the wrong sign, all of it, or the inertia has";
        return;
      }
      out.sentence = phrases::of_ratio_to_inertia(*ratio);
    }
  }

  Resemblance told(const Finding& found) const {
    constexpr std::size_t longest = 60;
    const Coordinate& c = system_.coordinates[found.of.row];
    const std::string factor = text(found.of.factor, found.of.row);
    const bool plain = found.of.factor.is_one() || (-found.of.factor).is_one();
    const std::string times = plain                     ? ""
                              : factor.size() > longest ? ", times a factor"
                                                        : fmt::format(", times {}", factor);
    return {fmt::format("It resembles the equation for {}{}; {}.", c.name, times, found.difference), found.sentence,
            found.origins, found.signs_alone, found.in_several_ways};
  }

  const EquationsOfMotion& equations_;
  const MechanicalSystem& system_;
  RandomStates states_;
  Expr claim_;
  ExprMatrix mass_;
  std::vector<Expr> slopes_;  // ∂F/∂q̈
  std::map<std::size_t, std::vector<RowTerm>> terms_;
};

}  // namespace

std::optional<Resemblance> resembled_equation(Expr difference, const EquationsOfMotion& equations) {
  return Resembler(difference, equations).find();
}

}  // namespace maupertuis

#include "verification/rate_resemblance.hpp"

#include "verification/combination.hpp"

#include <maupertuis/jacobian.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/rates.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace maupertuis {
namespace {

/// Terms of a row that hold the same rates and coordinates, as they are printed and in q, q̇, q̈.
struct Group {
  Expr printed, plain;
  bool accelerates = false;  // holds σ'
};

class RateResembler {
 public:
  RateResembler(Expr difference, const EquationsOfMotion& equations, const EquationsInRates& in_rates)
      : in_rates_(in_rates),
        context_(*equations.system->context),
        states_(equations),
        claim_(expand_time_derivatives(difference)) {
    for (const Coordinate& c : equations.system->coordinates) accelerations_.push_back(c.acceleration);
    for (std::size_t k = 0; k < in_rates.rates.size(); ++k) {
      const Expr sigma = in_rates.rates[k];
      changes_.push_back(total_time_derivative(sigma));
      written_out_.emplace(sigma, in_rates.definitions[k]);
      written_out_.emplace(changes_.back(), total_time_derivative(in_rates.definitions[k]));
    }
  }

  std::optional<Resemblance> find() {
    if (!holds_acceleration(claim_)) return std::nullopt;
    for (const EquationsInRates::Row& row : in_rates_.rows) {
      const std::vector<Group> groups = groups_of(row.form);
      for (const Expr& factor : factors(groups))
        if (auto found = explain(row.rate, factor, groups)) return found;
    }
    return std::nullopt;
  }

 private:
  bool holds_acceleration(Expr e) const {
    for (const Expr& slope : gradient(e, accelerations_))
      if (!slope.is_zero()) return true;
    return false;
  }

  std::vector<Group> groups_of(const ReadableForm& form) const {
    ExprMap by_name;
    for (const Intermediate& i : form.intermediates) by_name.emplace(i.symbol, substitute(i.value, by_name));
    const Expr whole = substitute(form.value, by_name), flat = expand(whole);
    const Expr sum = flat ? flat : whole;
    std::map<std::set<NodeId>, ExprVector> alike;
    for (std::size_t k = 0; k < (sum.is(Kind::Sum) ? sum.size() : 1); ++k) {
      const Expr term = sum.is(Kind::Sum) ? sum[k] : sum;
      std::set<NodeId> names;
      for (const Expr& s : symbols_of({&term, 1}))
        if (s.role() == Role::Coordinate || written_out_.count(s)) names.insert(s.id());
      alike[names].push_back(term);
    }
    std::vector<Group> out;
    for (const auto& [names, terms] : alike) {
      out.push_back(group_of(context_.sum(terms)));
    }
    return out;
  }

  Group group_of(Expr printed) const {
    Group out{printed, expand_time_derivatives(substitute(printed, written_out_)), false};
    for (const Expr& s : symbols_of({&printed, 1}))
      out.accelerates = out.accelerates || std::find(changes_.begin(), changes_.end(), s) != changes_.end();
    return out;
  }

  /// (A + B) ω1 ω2 for (A − B) ω1 ω2 errs in one term of a group.
  std::vector<Group> with_single_terms(std::vector<Group> groups) const {
    const std::size_t count = groups.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Expr sum = groups[i].printed;
      for (std::size_t k = 0; sum.is(Kind::Sum) && k < sum.size(); ++k) groups.push_back(group_of(sum[k]));
    }
    return groups;
  }

  /// Of the whole row: 1, or the reciprocal of what stands before a σ', and their negatives.
  std::vector<Expr> factors(const std::vector<Group>& groups) const {
    std::vector<Expr> out{context_.number(1), context_.number(-1)};
    for (const Group& group : groups)
      for (const Expr& change : changes_)
        if (const Expr before = differentiate(group.printed, change); group.accelerates && !before.is_zero())
          for (const int sign : {1, -1}) out.push_back(context_.number(sign) / before);
    return out;
  }

  std::optional<Resemblance> explain(const std::string& rate, Expr factor, const std::vector<Group>& groups) {
    Expr more = claim_;
    for (const Group& group : groups) more = more - factor * group.plain;
    for (const Expr& slope : gradient(more, accelerations_))
      if (!states_.vanishes(slope)) return std::nullopt;  // other accelerations
    const auto told = [&](const std::string& difference, const std::string& sentence) {
      const bool plain = factor.is_one() || (-factor).is_one();
      const std::string times = plain ? "" : ", times " + to_plain(factor, in_rates_.order);
      return Resemblance{fmt::format("It resembles the equation for {}{}; {}.", rate, times, difference), sentence, {}};
    };
    for (const Group& group : with_single_terms(groups)) {
      if (group.accelerates) continue;
      const std::string text = to_plain(readable(group.printed, in_rates_.order).value, in_rates_.order);
      const Expr own = factor * group.plain;
      if (states_.vanishes(more + own)) return told("missing: " + text, "a term of the equation in rates is missing");
      if (states_.vanishes(more + Rational(2) * own))
        return told("wrong sign: " + text, "a term of the equation in rates has the wrong sign");
      for (const auto& [times, name] : {std::pair(Rational(1), "2"), std::pair(Rational(-1, 2), "1/2")})
        if (states_.vanishes(more - times * own))
          return told(fmt::format("{} times {} stands in its place", name, text),
                      fmt::format("a term of the equation in rates has a factor {} too many", name));
    }
    return std::nullopt;
  }

  const EquationsInRates& in_rates_;
  Context& context_;
  RandomStates states_;
  Expr claim_;
  ExprVector accelerations_, changes_;  // q̈ [n], σ' [r]
  ExprMap written_out_;                 // σ and σ' in q, q̇, q̈
};

}  // namespace

std::optional<Resemblance> resembled_equation_in_rates(Expr difference, const EquationsOfMotion& equations) {
  if (equations.shown().system->rates.empty()) return std::nullopt;
  const RatesResult result = equations_in_rates(equations);
  if (!result.equations) return std::nullopt;
  return RateResembler(difference, equations, *result.equations).find();
}

}  // namespace maupertuis

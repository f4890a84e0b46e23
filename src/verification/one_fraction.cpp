#include "verification/one_fraction.hpp"

#include <algorithm>
#include <map>

namespace maupertuis {
namespace {

/// The factors of a product, or the one that it is.
ExprVector factors_of(Expr e) {
  if (!e.is(Kind::Product)) return {e};
  ExprVector out;
  for (std::size_t i = 0; i < e.size(); ++i) out.push_back(e[i]);
  return out;
}

/// What stands above and below the bar of a product; numbers stand above.
OneFraction split_at_bar(Expr product) {
  const Expr one = product.context().number(1);
  OneFraction out{one, one};
  for (const Expr& factor : factors_of(product)) {
    if (split_power(factor).exponent.sign() < 0)
      out.below = out.below / factor;
    else
      out.above = out.above * factor;
  }
  return out;
}

/// a b + a c as a (b + c), by the powers that all terms of a sum hold.
Expr with_common_factors_out(Expr sum) {
  if (!sum.is(Kind::Sum)) return sum;
  std::map<NodeId, PowerOf> common;
  for (const Expr& factor : factors_of(sum[0]))
    if (!factor.is_number()) common.emplace(split_power(factor).base.id(), split_power(factor));
  for (std::size_t k = 1; k < sum.size(); ++k) {
    std::map<NodeId, Rational> here;
    for (const Expr& factor : factors_of(sum[k]))
      here.emplace(split_power(factor).base.id(), split_power(factor).exponent);
    std::erase_if(common, [&](const auto& entry) { return !here.count(entry.first); });
    for (auto& [id, power] : common) power.exponent = std::min(power.exponent, here.at(id));
  }
  Expr outside = sum.context().number(1);
  for (const auto& [id, power] : common) outside = outside * pow(power.base, power.exponent);
  ExprVector inside;
  for (std::size_t k = 0; k < sum.size(); ++k) inside.push_back(sum[k] / outside);
  return outside * sum.context().sum(inside);
}

/// sin² + cos² put together, then the factors of all terms in front.
Expr tidy(Expr e, const ReadingOrder& order) {
  const Expr read = written_out(e, order), flat = expand(read);
  return read.is(Kind::Sum) && flat ? with_common_factors_out(flat) : read;
}

class Fractions {
 public:
  explicit Fractions(const ReadingOrder& order) : order_(order) {}

  OneFraction of(Expr e) const {
    if (e.is(Kind::Sum)) return of_sum(e);
    Expr product = e.context().number(1);
    for (const Expr& factor : factors_of(e)) {
      const PowerOf power = split_power(factor);
      if (!power.exponent.is_integer() || !power.base.is(Kind::Sum)) {
        product = product * factor;
        continue;
      }
      const OneFraction base = of_sum(power.base);
      product = product * pow(base.above, power.exponent) / pow(base.below, power.exponent);
    }
    return split_at_bar(product);
  }

 private:
  OneFraction of_sum(Expr sum) const {
    std::vector<OneFraction> parts;
    for (std::size_t i = 0; i < sum.size(); ++i) parts.push_back(of(sum[i]));
    const Expr below = common_denominator(parts, sum.context());
    ExprVector terms;
    for (const OneFraction& part : parts) terms.push_back(part.above * (below / part.below));
    const Expr whole = sum.context().sum(terms), expanded = expand(whole);
    return split_at_bar(tidy(expanded ? expanded : whole, order_) / below);
  }

  /// Each factor with the largest power that it has in one of the denominators.
  static Expr common_denominator(const std::vector<OneFraction>& parts, Context& context) {
    std::map<NodeId, PowerOf> largest;
    for (const OneFraction& part : parts)
      for (const Expr& factor : factors_of(part.below)) {
        const PowerOf power = split_power(factor);
        const auto [at, is_new] = largest.try_emplace(power.base.id(), power);
        if (!is_new && at->second.exponent < power.exponent) at->second = power;
      }
    Expr out = context.number(1);
    for (const auto& [id, power] : largest) out = out * pow(power.base, power.exponent);
    return out;
  }

  const ReadingOrder& order_;
};

}  // namespace

OneFraction as_one_fraction(Expr e, const ReadingOrder& order) {
  const OneFraction found = Fractions(order).of(e);
  const Expr expanded = expand(found.above);
  return expanded ? split_at_bar(tidy(expanded, order) / found.below) : found;
}

Expr written_out(Expr e, const ReadingOrder& order) {
  const ReadableForm form = readable(e, order);
  ExprMap values;
  for (const Intermediate& i : form.intermediates) values.emplace(i.symbol, substitute(i.value, values));
  return substitute(form.value, values);
}

}  // namespace maupertuis

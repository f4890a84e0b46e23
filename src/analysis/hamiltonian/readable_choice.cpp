#include "analysis/hamiltonian/readable_choice.hpp"

#include <maupertuis/print.hpp>
#include <maupertuis/tree_size.hpp>

#include <algorithm>

namespace maupertuis::phase_space {
namespace {

constexpr std::size_t longest_printed = 3000;  // nodes of the tree

/// UTF-8 letters.
std::size_t letters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::vector<Expr> arguments_of(Expr e, Kind kind) {
  if (!e.is(kind)) return {e};
  std::vector<Expr> arguments;
  for (std::size_t i = 0; i < e.size(); ++i) arguments.push_back(e[i]);
  return arguments;
}
std::vector<Expr> terms_of(Expr e) { return arguments_of(e, Kind::Sum); }
std::vector<Expr> factors_of(Expr e) { return arguments_of(e, Kind::Product); }

/// Fraction bars inside brackets make the eye go up and down: (p_1 - l1 p_2/l2)^2. Numbers, 1/2, do not count.
std::size_t inner_fractions(const std::string& text) {
  std::size_t count = 0;
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
    const bool of_numbers = i > 0 && text[i - 1] >= '0' && text[i - 1] <= '9' && i + 1 < text.size() &&
                            text[i + 1] >= '0' && text[i + 1] <= '9';
    if (text[i] == '/' && depth > 0 && !of_numbers) ++count;
  }
  return count;
}

bool is_below_the_bar(Expr factor) {
  return factor.is(Kind::Power) && factor[1].is_number() && factor[1].number().sign() < 0;
}

}  // namespace

std::size_t length_of(Expr e, const ReadingOrder& order) {
  constexpr std::size_t weight_of_inner_fraction = 8;
  if (tree_size(e, longest_printed + 1) > longest_printed) return unreadable;
  const std::string text = to_plain(e, order);
  return letters(text) + weight_of_inner_fraction * inner_fractions(text);
}

Expr shortest(std::span<const Expr> candidates, const ReadingOrder& order) {
  Expr best;
  std::size_t least = unreadable;
  for (const Expr& candidate : candidates) {
    if (!candidate) continue;
    const std::size_t length = length_of(candidate, order);
    if (best && length >= least) continue;
    best = candidate;
    least = length;
  }
  return best;
}

bool is_long(Expr e) { return tree_size(e, longest_printed + 1) > longest_printed; }

Expr tidy(Expr e, const ReadingOrder& order) {
  const ReadableForm form = readable(e, order);
  if (!form.intermediates.empty()) return e;
  const Expr candidates[] = {form.value, e};
  return shortest(candidates, order);
}

Expr flat_sum(std::span<const Expr> parts, Context& context) {
  std::vector<Expr> terms;
  for (const Expr& part : parts) {
    if (!part.is(Kind::Sum))
      terms.push_back(part);
    else
      for (std::size_t i = 0; i < part.size(); ++i) terms.push_back(part[i]);
  }
  return context.sum(terms);
}

Expr over(Expr numerator, Expr denominator) {
  if (!denominator.is(Kind::Product)) return numerator / denominator;
  for (std::size_t i = 0; i < denominator.size(); ++i) numerator = numerator / denominator[i];
  return numerator;
}

Expr negative(Expr e) {
  if (!e.is(Kind::Sum)) return -e;
  std::vector<Expr> terms;
  for (std::size_t i = 0; i < e.size(); ++i) terms.push_back(-e[i]);
  return e.context().sum(terms);
}

Expr difference(Expr a, Expr b) {
  const Expr parts[] = {a, negative(b)};
  return flat_sum(parts, a.context());
}

Cleared cleared(Expr e, const ReadingOrder& order) {
  Context& context = e.context();
  const Expr form = tidy(e, order);
  const std::vector<Expr> terms = terms_of(form);
  std::vector<std::pair<Expr, Rational>> bars;  // the least common multiple of what stands below the terms
  for (const Expr& term : terms)
    for (const Expr& factor : factors_of(term)) {
      if (!is_below_the_bar(factor)) continue;
      const Rational power = -factor[1].number();
      const auto known =
          std::find_if(bars.begin(), bars.end(), [&](const auto& bar) { return bar.first == factor[0]; });
      if (known == bars.end())
        bars.emplace_back(factor[0], power);
      else
        known->second = std::max(known->second, power);
    }
  Expr denominator = context.number(1);
  for (const auto& [bar, power] : bars) denominator = denominator * pow(bar, power);
  if (bars.empty()) return {form, denominator};
  std::vector<Expr> raised;
  for (Expr term : terms) {
    for (const auto& [bar, power] : bars) term = term * pow(bar, power);
    raised.push_back(term);
  }
  return {tidy(context.sum(raised), order), denominator};
}

Expr slope(Expr e, Expr symbol, const ReadingOrder& order) {
  std::vector<Expr> parts;
  for (const Expr& term : terms_of(e)) {
    Expr square;
    for (const Expr& factor : factors_of(term))
      if (factor.is(Kind::Power) && factor[0].is(Kind::Sum) && factor[1].is_number() &&
          factor[1].number() == Rational(2))
        square = factor;
    if (!square) {
      parts.push_back(tidy(differentiate(term, symbol), order));
      continue;
    }
    const Expr s = square[0], c = term / square;
    parts.push_back(s * tidy(2 * c * differentiate(s, symbol) + s * differentiate(c, symbol), order));
  }
  return flat_sum(parts, e.context());
}

}  // namespace maupertuis::phase_space

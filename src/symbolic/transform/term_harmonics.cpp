#include "symbolic/transform/term_algebra.hpp"

#include <algorithm>

/// The trigonometric part of the term algebra: normal form of a sine or cosine, and products to sums.
namespace maupertuis::terms {
namespace {

std::vector<Frequency> combined(const std::vector<Frequency>& a, const std::vector<Frequency>& b, int sign) {
  std::vector<Frequency> result;
  result.reserve(a.size() + b.size());
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    if (j == b.size() || (i < a.size() && a[i].angle < b[j].angle)) {
      result.push_back(a[i++]);
    } else if (i == a.size() || b[j].angle < a[i].angle) {
      result.push_back({b[j].angle, Fraction{sign * b[j].multiple.num, b[j].multiple.den}});
      ++j;
    } else {
      const Fraction total = a[i].multiple + Fraction{sign * b[j].multiple.num, b[j].multiple.den};
      if (!total.is_zero()) result.push_back({a[i].angle, total});
      ++i, ++j;
    }
  }
  return result;
}

/// Takes the multiple of π out of an argument: what is left of it lies in [0, 1/2), the quarter turns are returned.
int take_quarter_turns(std::vector<Frequency>& argument, NodeId pi) {
  const auto place = std::find_if(argument.begin(), argument.end(), [&](const Frequency& f) { return f.angle == pi; });
  if (place == argument.end()) return 0;
  const std::int64_t twice = 2 * std::int64_t{place->multiple.num}, den = place->multiple.den;
  const std::int64_t quarters = twice >= 0 ? twice / den : -((-twice + den - 1) / den);
  const Fraction rest = fraction(twice - quarters * den, 2 * den);
  if (rest.is_zero())
    argument.erase(place);
  else
    place->multiple = rest;
  return static_cast<int>(((quarters % 4) + 4) % 4);
}

}  // namespace

HarmonicId TermAlgebra::intern(const Harmonic& harmonic) {
  const auto [place, fresh] = harmonic_ids_.try_emplace(harmonic, static_cast<HarmonicId>(harmonics_.size()));
  if (fresh) harmonics_.push_back(harmonic);
  return place->second;
}

Term TermAlgebra::harmonic_term(bool sine, std::vector<Frequency> argument, Rational coefficient) {
  const NodeId pi = context_->pi().id();
  // The sign is decided by the first angle that is not π, so that cos(π/3 − θ) and cos(θ − π/3) are one.
  const auto first = std::find_if(argument.begin(), argument.end(), [&](const Frequency& f) { return f.angle != pi; });
  const bool flip =
      (first == argument.end() ? !argument.empty() && argument.front().multiple.num < 0 : first->multiple.num < 0);
  if (flip) {
    for (Frequency& f : argument) f.multiple.num = -f.multiple.num;
    if (sine) coefficient = -coefficient;
  }
  // cos(x + π/2) = −sin x, sin(x + π/2) = cos x.
  for (int quarter = take_quarter_turns(argument, pi); quarter > 0; --quarter) {
    if (!sine) coefficient = -coefficient;
    sine = !sine;
  }
  if (argument.empty()) return sine ? Term{0, 0, 0} : Term{0, 0, coefficient};
  if (argument.size() == 1 && argument.front().angle == pi) {
    const Fraction part = argument.front().multiple;
    if (!sine && part == Fraction{1, 3}) return {0, 0, coefficient * Rational(1, 2)};
    if (sine && part == Fraction{1, 6}) return {0, 0, coefficient * Rational(1, 2)};
  }
  return {0, intern(Harmonic{sine, std::move(argument)}), std::move(coefficient)};
}

const TermAlgebra::HarmonicProduct& TermAlgebra::harmonic_product(HarmonicId a, HarmonicId b) {
  if (a > b) std::swap(a, b);
  std::uint32_t& place = harmonic_product_places_[pair_key(a, b)];
  if (place != KeyTable::none) return harmonic_products_[place];
  const bool first_sine = harmonics_[a].sine, second_sine = harmonics_[b].sine;
  std::vector<Frequency> difference = combined(harmonics_[a].argument, harmonics_[b].argument, -1);
  std::vector<Frequency> total = combined(harmonics_[a].argument, harmonics_[b].argument, 1);
  const Rational half(1, 2), minus_half(-1, 2);
  HarmonicProduct result;
  if (first_sine == second_sine) {
    // cos a cos b = ½cos(a−b) + ½cos(a+b),  sin a sin b = ½cos(a−b) − ½cos(a+b)
    result[0] = harmonic_term(false, std::move(difference), half);
    result[1] = harmonic_term(false, std::move(total), first_sine ? minus_half : half);
  } else {
    // sin a cos b = ½sin(a+b) + ½sin(a−b);  cos a sin b = ½sin(a+b) − ½sin(a−b)
    result[0] = harmonic_term(true, std::move(total), half);
    result[1] = harmonic_term(true, std::move(difference), first_sine ? half : minus_half);
  }
  place = static_cast<std::uint32_t>(harmonic_products_.size());
  harmonic_products_.push_back(std::move(result));
  return harmonic_products_.back();
}

}  // namespace maupertuis::terms

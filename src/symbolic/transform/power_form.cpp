#include "symbolic/transform/power_form.hpp"

#include <algorithm>
#include <numeric>

namespace maupertuis::terms {
namespace {

constexpr int largest_multiple = 12;

void append(const Polynomial& more, std::vector<Term>& terms) { terms.insert(terms.end(), more.begin(), more.end()); }

/// sin α and cos α as indeterminates, and the polynomials of their multiples.
class Circle {
 public:
  Circle(TermAlgebra& algebra, const std::vector<Frequency>& angle, Eliminate eliminate) : algebra_(algebra) {
    const Expr alpha = algebra.angle_expression(angle);
    // The angle may come out turned by the constructor's sign rule; the caller passes it with a positive first part.
    sine_ = algebra.atom(sin(alpha), AtomKind::Harmonic);
    cosine_ = algebra.atom(cos(alpha), AtomKind::Harmonic);
    removed_ = eliminate == Eliminate::SineSquared ? sine_ : cosine_;
    kept_ = eliminate == Eliminate::SineSquared ? cosine_ : sine_;
    cosines_.push_back(algebra.constant(1));
    sines_.push_back({});
  }

  const Polynomial& cosine(int k) { return extend(k), cosines_[static_cast<std::size_t>(k)]; }
  const Polynomial& sine(int k) { return extend(k), sines_[static_cast<std::size_t>(k)]; }

  /// Applies Pythagoras to every whole even power of the removed one.
  Polynomial reduced(const Polynomial& p) {
    std::vector<Term> raw;
    for (const Term& t : p) {
      const Monomial& m = algebra_.monomial(t.monomial);
      const auto place = std::find_if(m.begin(), m.end(), [&](const Factor& f) { return f.atom == removed_; });
      if (place == m.end() || !place->exponent.is_integer() || place->exponent.num < 2) {
        raw.push_back(t);
        continue;
      }
      const int squares = place->exponent.num / 2;
      Monomial rest = m;
      rest[static_cast<std::size_t>(place - m.begin())].exponent = Fraction{place->exponent.num % 2, 1};
      if (place->exponent.num % 2 == 0) rest.erase(rest.begin() + (place - m.begin()));
      const Polynomial one_minus_square =
          algebra_.add(algebra_.constant(1), algebra_.scale(algebra_.of_atom(kept_, Fraction{2, 1}), -1));
      const Polynomial power = algebra_.power(one_minus_square, Fraction{squares, 1});
      const MonomialId monomial = algebra_.intern(rest);
      append(algebra_.multiply(power, Polynomial{Term{monomial, t.harmonic, t.coefficient}}), raw);
    }
    return algebra_.normalized(std::move(raw));
  }

 private:
  void extend(int k) {
    while (static_cast<int>(cosines_.size()) <= k) {
      const Polynomial c = cosines_.back(), s = sines_.back();
      const Polynomial c1 = algebra_.of_atom(cosine_), s1 = algebra_.of_atom(sine_);
      cosines_.push_back(reduced(algebra_.add(algebra_.multiply(c, c1), algebra_.scale(algebra_.multiply(s, s1), -1))));
      sines_.push_back(reduced(algebra_.add(algebra_.multiply(s, c1), algebra_.multiply(c, s1))));
    }
  }

  TermAlgebra& algebra_;
  AtomId sine_ = 0, cosine_ = 0, removed_ = 0, kept_ = 0;
  std::vector<Polynomial> cosines_, sines_;
};

/// How many times the angle stands in an argument, and what is left; nothing if that is no whole number.
bool split_argument(const std::vector<Frequency>& argument, const std::vector<Frequency>& angle, int& multiple,
                    std::vector<Frequency>& rest) {
  const Frequency& pivot = angle.front();
  const auto place =
      std::find_if(argument.begin(), argument.end(), [&](const Frequency& f) { return f.angle == pivot.angle; });
  if (place == argument.end()) return false;
  const Fraction k = place->multiple / pivot.multiple;
  if (!k.is_integer() || std::abs(k.num) > largest_multiple) return false;
  multiple = k.num;
  rest.clear();
  std::vector<Frequency> taken = angle;
  for (Frequency& f : taken) f.multiple = f.multiple * k;
  for (const Frequency& f : argument) {
    const auto same = std::find_if(taken.begin(), taken.end(), [&](const Frequency& g) { return g.angle == f.angle; });
    const Fraction left = same == taken.end() ? f.multiple : f.multiple - same->multiple;
    if (!left.is_zero()) rest.push_back({f.angle, left});
  }
  for (const Frequency& f : taken)
    if (std::none_of(argument.begin(), argument.end(), [&](const Frequency& g) { return g.angle == f.angle; }))
      rest.push_back({f.angle, Fraction{-f.multiple.num, f.multiple.den}});
  std::sort(rest.begin(), rest.end(), [](const Frequency& a, const Frequency& b) { return a.angle < b.angle; });
  return true;
}

}  // namespace

Polynomial power_form(TermAlgebra& algebra, const Polynomial& p, const std::vector<Frequency>& angle,
                      Eliminate eliminate) {
  Circle circle(algebra, angle, eliminate);
  std::vector<Term> raw;
  std::vector<Frequency> rest;
  for (const Term& t : p) {
    int k = 0;
    const Harmonic h = algebra.harmonic(t.harmonic);
    if (t.harmonic == 0 || !split_argument(h.argument, angle, k, rest)) {
      raw.push_back(t);
      continue;
    }
    const int sign = k < 0 ? -1 : 1;
    const Polynomial cos_k = circle.cosine(std::abs(k)), sin_k = algebra.scale(circle.sine(std::abs(k)), sign);
    const auto rest_term = [&](bool sine) -> Polynomial {
      Term term = algebra.harmonic_term(sine, rest, t.coefficient);
      if (term.coefficient.is_zero()) return {};
      term.monomial = t.monomial;
      return {term};
    };
    // cos(kα + β) = cos kα cos β − sin kα sin β;  sin(kα + β) = sin kα cos β + cos kα sin β
    append(algebra.multiply(h.sine ? sin_k : cos_k, rest_term(false)), raw);
    append(algebra.scale(algebra.multiply(h.sine ? cos_k : sin_k, rest_term(true)), h.sine ? 1 : -1), raw);
  }
  return circle.reduced(algebra.normalized(std::move(raw)));
}

std::vector<std::vector<Frequency>> candidate_angles(const TermAlgebra& algebra, const Polynomial& p,
                                                     const std::unordered_map<NodeId, Fraction>& units) {
  std::vector<std::vector<Frequency>> result;
  const auto offer = [&](std::vector<Frequency> angle) {
    if (std::find(result.begin(), result.end(), angle) == result.end()) result.push_back(std::move(angle));
  };
  std::vector<std::vector<Frequency>> combinations;
  for (const Term& t : p) {
    const Harmonic& h = algebra.harmonic(t.harmonic);
    Fraction whole{0, 1};  // the argument is this many times a primitive combination of units
    for (const Frequency& f : h.argument) {
      const auto unit = units.find(f.angle);
      const Fraction size = unit == units.end() ? f.multiple : unit->second;
      offer({{f.angle, size}});
      whole = gcd(whole, f.multiple / size);
    }
    if (h.argument.size() < 2 || whole.num < 2) continue;  // a product of two sines of it would leave its double
    std::vector<Frequency> combination = h.argument;
    for (Frequency& f : combination) f.multiple = f.multiple / whole;
    combinations.push_back(std::move(combination));
  }
  for (auto& combination : combinations) offer(std::move(combination));
  return result;
}

bool has_multiple_angle(const TermAlgebra& algebra, const Polynomial& p,
                        const std::unordered_map<NodeId, Fraction>& units) {
  for (const Term& t : p)
    for (const Frequency& f : algebra.harmonic(t.harmonic).argument) {
      const auto unit = units.find(f.angle);
      if (unit != units.end() && unit->second < gcd({0, 1}, f.multiple)) return true;
    }
  return false;
}

}  // namespace maupertuis::terms

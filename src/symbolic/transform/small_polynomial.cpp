#include "symbolic/transform/small_polynomial.hpp"

#include <algorithm>

namespace maupertuis::terms {
namespace {

constexpr std::size_t largest_size = 400;  // terms of an intermediate result

void accumulate(SmallPolynomial& into, const Exponents& exponents, const Rational& value) {
  if (value.is_zero()) return;
  const auto [place, fresh] = into.try_emplace(exponents, value);
  if (fresh) {
    if (into.size() > largest_size) throw NotWorthIt{};
    return;
  }
  place->second += value;
  if (place->second.is_zero()) into.erase(place);
}

Exponents sum(const Exponents& a, const Exponents& b) {
  Exponents result = a;
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = static_cast<std::int16_t>(result[i] + b[i]);
  return result;
}

std::optional<Exponents> difference(const Exponents& a, const Exponents& b) {
  Exponents result = a;
  for (std::size_t i = 0; i < a.size(); ++i) {
    result[i] = static_cast<std::int16_t>(result[i] - b[i]);
    if (result[i] < 0) return std::nullopt;
  }
  return result;
}

SmallPolynomial times_term(const SmallPolynomial& a, const Exponents& exponents, const Rational& value) {
  SmallPolynomial result;
  for (const auto& [e, c] : a) result.emplace(sum(e, exponents), c * value);
  return result;
}

Rational gcd_of(Rational a, Rational b) {
  while (!b.is_zero()) {
    const auto q = (a / b).small();
    if (!q) throw NotWorthIt{};
    Rational rest = a + b * Rational(-(q->numerator / q->denominator));
    a = std::move(b);
    b = std::move(rest);
  }
  return abs(a);
}

SmallPolynomial times_power(const SmallPolynomial& a, std::size_t variable, int exponent) {
  Exponents e(a.begin()->first.size(), 0);
  e[variable] = static_cast<std::int16_t>(exponent);
  return times_term(a, e, 1);
}

/// The gcd of several polynomials.
SmallPolynomial gcd_of_all(const std::vector<SmallPolynomial>& all) {
  SmallPolynomial result;
  for (const SmallPolynomial& p : all) {
    if (p.empty()) continue;
    result = result.empty() ? p : gcd(result, p);
    if (is_constant(result)) break;
  }
  return result;
}

/// The pseudo-remainder of a by b in one variable: lc(b)^k a = q b + r.
SmallPolynomial pseudo_remainder(SmallPolynomial a, const SmallPolynomial& b, std::size_t variable) {
  const int db = degree(b, variable);
  const SmallPolynomial lead = coefficients(b, variable).back();
  while (!a.empty() && degree(a, variable) >= db) {
    const int da = degree(a, variable);
    const SmallPolynomial top = coefficients(a, variable).back();
    a = lead * a - times_power(top * b, variable, da - db);
  }
  return a;
}

}  // namespace

SmallPolynomial operator+(const SmallPolynomial& a, const SmallPolynomial& b) {
  SmallPolynomial result = a;
  for (const auto& [e, c] : b) accumulate(result, e, c);
  return result;
}

SmallPolynomial operator-(const SmallPolynomial& a, const SmallPolynomial& b) {
  SmallPolynomial result = a;
  for (const auto& [e, c] : b) accumulate(result, e, -c);
  return result;
}

SmallPolynomial operator*(const SmallPolynomial& a, const SmallPolynomial& b) {
  if (a.size() * b.size() > 64 * largest_size) throw NotWorthIt{};
  SmallPolynomial result;
  for (const auto& [ea, ca] : a)
    for (const auto& [eb, cb] : b) accumulate(result, sum(ea, eb), ca * cb);
  return result;
}

SmallPolynomial scaled(const SmallPolynomial& a, const Rational& factor) {
  SmallPolynomial result = a;
  for (auto& [e, c] : result) c *= factor;
  return result;
}

SmallPolynomial constant_polynomial(const Rational& value, std::size_t variables) {
  SmallPolynomial result;
  if (!value.is_zero()) result.emplace(Exponents(variables, 0), value);
  return result;
}

std::optional<SmallPolynomial> quotient(const SmallPolynomial& a, const SmallPolynomial& b) {
  SmallPolynomial rest = a, result;
  const auto& [lead, lead_coefficient] = *b.rbegin();
  while (!rest.empty()) {
    const auto exponents = difference(rest.rbegin()->first, lead);
    if (!exponents) return std::nullopt;
    const Rational c = rest.rbegin()->second / lead_coefficient;
    result.emplace(*exponents, c);
    rest = rest - times_term(b, *exponents, c);
  }
  return result;
}

Division divide(const SmallPolynomial& a, const SmallPolynomial& b) {
  Division result;
  SmallPolynomial left = a;
  const auto& [lead, lead_coefficient] = *b.rbegin();
  while (!left.empty()) {
    const auto [exponents, value] = *left.rbegin();
    if (const auto factor = difference(exponents, lead)) {
      const Rational c = value / lead_coefficient;
      result.quotient.emplace(*factor, c);
      left = left - times_term(b, *factor, c);
    } else {
      result.rest.emplace(exponents, value);
      left.erase(exponents);
    }
  }
  return result;
}

std::optional<SmallPolynomial> square_root(const SmallPolynomial& a) {
  if (a.empty()) return a;
  const auto& [top, top_coefficient] = *a.rbegin();
  const auto root = top_coefficient.sign() > 0 ? exact_root(top_coefficient, 2) : std::nullopt;
  if (!root || std::any_of(top.begin(), top.end(), [](std::int16_t e) { return e % 2 != 0; })) return std::nullopt;
  Exponents half = top;
  for (auto& e : half) e = static_cast<std::int16_t>(e / 2);
  SmallPolynomial result{{half, *root}};
  SmallPolynomial rest = a - result * result;
  while (!rest.empty()) {
    const auto exponents = difference(rest.rbegin()->first, half);
    if (!exponents || !(*exponents < result.begin()->first)) return std::nullopt;
    const SmallPolynomial next{{*exponents, rest.rbegin()->second / (Rational(2) * *root)}};
    rest = rest - scaled(result * next, 2) - next * next;
    result.insert(*next.begin());
  }
  return result;
}

SmallPolynomial primitive(const SmallPolynomial& a, Rational& content) {
  content = 0;
  for (const auto& [e, c] : a) content = gcd_of(abs(c), content);
  if (content.is_zero()) content = 1;
  if (!a.empty() && a.rbegin()->second.sign() < 0) content = -content;
  return scaled(a, Rational(1) / content);
}

int degree(const SmallPolynomial& a, std::size_t variable) {
  int result = 0;
  for (const auto& [e, c] : a) result = std::max<int>(result, e[variable]);
  return result;
}

bool is_constant(const SmallPolynomial& a) {
  if (a.size() != 1) return a.empty();
  const Exponents& e = a.begin()->first;
  return std::all_of(e.begin(), e.end(), [](std::int16_t x) { return x == 0; });
}

std::vector<SmallPolynomial> coefficients(const SmallPolynomial& a, std::size_t variable) {
  std::vector<SmallPolynomial> result(static_cast<std::size_t>(degree(a, variable)) + 1);
  for (const auto& [e, c] : a) {
    Exponents rest = e;
    rest[variable] = 0;
    result[static_cast<std::size_t>(e[variable])].emplace(std::move(rest), c);
  }
  return result;
}

SmallPolynomial derivative(const SmallPolynomial& a, std::size_t variable) {
  SmallPolynomial result;
  for (const auto& [e, c] : a) {
    if (e[variable] == 0) continue;
    Exponents lower = e;
    --lower[variable];
    result.emplace(std::move(lower), c * Rational(e[variable]));
  }
  return result;
}

/// Euclid's algorithm in one variable over polynomials in the others, contents taken out at every step.
SmallPolynomial gcd(const SmallPolynomial& a, const SmallPolynomial& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  Rational unused;
  const std::size_t variables = a.begin()->first.size();
  // The main variable: one that both have. A variable of only one of them can be in no common divisor.
  std::size_t main = variables;
  for (std::size_t v = 0; v < variables; ++v) {
    const bool in_a = degree(a, v) > 0, in_b = degree(b, v) > 0;
    if (in_a && in_b && main == variables) main = v;
    if (in_a && !in_b) return gcd(gcd_of_all(coefficients(a, v)), b);
    if (in_b && !in_a) return gcd(a, gcd_of_all(coefficients(b, v)));
  }
  if (main == variables) return constant_polynomial(1, variables);
  const SmallPolynomial content_a = gcd_of_all(coefficients(a, main)), content_b = gcd_of_all(coefficients(b, main));
  SmallPolynomial p = *quotient(a, content_a), q = *quotient(b, content_b);
  while (!q.empty()) {
    if (degree(p, main) < degree(q, main)) std::swap(p, q);
    if (degree(q, main) == 0) {
      p = constant_polynomial(1, variables);
      break;
    }
    SmallPolynomial rest = pseudo_remainder(p, q, main);
    if (!rest.empty()) rest = primitive(*quotient(rest, gcd_of_all(coefficients(rest, main))), unused);
    p = std::move(q);
    q = std::move(rest);
  }
  return primitive(p * gcd(content_a, content_b), unused);
}

namespace {

void append(std::vector<SmallFactor>& all, const std::vector<SmallFactor>& more, int multiplicity = 1) {
  for (const SmallFactor& f : more) {
    const auto same = std::find_if(all.begin(), all.end(), [&](const SmallFactor& g) { return g.value == f.value; });
    if (same != all.end())
      same->multiplicity += f.multiplicity * multiplicity;
    else
      all.push_back({f.value, f.multiplicity * multiplicity});
  }
}

std::vector<SmallFactor> product_of_factors(const SmallPolynomial& a, const SmallPolynomial& b) {
  Rational unused;
  std::vector<SmallFactor> result;
  append(result, factors(primitive(a, unused)));
  append(result, factors(primitive(b, unused)));
  return result;
}

/// a x² + b x + c with a square discriminant: 4a (…) = (2a x + b − s)(2a x + b + s).
std::optional<SmallPolynomial> quadratic_factor(const SmallPolynomial& p, std::size_t variable) {
  const auto c = coefficients(p, variable);
  const auto root = square_root(c[1] * c[1] - scaled(c[2] * c[0], 4));
  if (!root) return std::nullopt;
  const SmallPolynomial linear = times_power(scaled(c[2], 2), variable, 1) + c[1] - *root;
  Rational unused;
  return primitive(*quotient(linear, gcd_of_all(coefficients(linear, variable))), unused);
}

}  // namespace

std::vector<SmallFactor> factors(const SmallPolynomial& a) {
  if (is_constant(a)) return {};
  const std::size_t variables = a.begin()->first.size();
  std::size_t main = variables;
  for (std::size_t v = 0; v < variables; ++v) {
    const int d = degree(a, v);
    if (d > 0 && (main == variables || d < degree(a, main))) main = v;
  }
  const SmallPolynomial content = gcd_of_all(coefficients(a, main));
  if (!is_constant(content)) return product_of_factors(content, *quotient(a, content));
  const int d = degree(a, main);
  if (d == 1) return {{a, 1}};
  if (d == 2) {
    const auto part = quadratic_factor(a, main);
    if (!part) return {{a, 1}};
    const auto other = quotient(a, *part);
    return other ? product_of_factors(*part, *other) : std::vector<SmallFactor>{{a, 1}};
  }
  const SmallPolynomial repeated = gcd(a, derivative(a, main));
  if (is_constant(repeated)) return {{a, 1}};
  return product_of_factors(repeated, *quotient(a, repeated));
}

}  // namespace maupertuis::terms

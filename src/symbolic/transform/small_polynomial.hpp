#pragma once
#include <maupertuis/rational.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

/// A small polynomial in numbered variables with whole exponents: what factoring works on.
namespace maupertuis::terms {

using Exponents = std::vector<std::int16_t>;            // by variable
using SmallPolynomial = std::map<Exponents, Rational>;  // lexicographic; no zero coefficients

/// Thrown when the work would exceed what a factor is worth; the caller keeps the unfactored form.
struct NotWorthIt {};

SmallPolynomial operator+(const SmallPolynomial& a, const SmallPolynomial& b);
SmallPolynomial operator-(const SmallPolynomial& a, const SmallPolynomial& b);
SmallPolynomial operator*(const SmallPolynomial& a, const SmallPolynomial& b);
SmallPolynomial scaled(const SmallPolynomial& a, const Rational& factor);
SmallPolynomial constant_polynomial(const Rational& value, std::size_t variables);

/// a/b where b divides a, else nothing.
std::optional<SmallPolynomial> quotient(const SmallPolynomial& a, const SmallPolynomial& b);
/// a = quotient · b + rest; the rest has no term that the last term of b divides.
struct Division {
  SmallPolynomial quotient, rest;
};
Division divide(const SmallPolynomial& a, const SmallPolynomial& b);
/// The square root where the polynomial is a square.
std::optional<SmallPolynomial> square_root(const SmallPolynomial& a);
/// Coprime integer coefficients, the lexicographically last one positive; `content` is what was divided out.
SmallPolynomial primitive(const SmallPolynomial& a, Rational& content);
/// A greatest common divisor, primitive.
SmallPolynomial gcd(const SmallPolynomial& a, const SmallPolynomial& b);

int degree(const SmallPolynomial& a, std::size_t variable);
bool is_constant(const SmallPolynomial& a);
/// Coefficients by powers of one variable.
std::vector<SmallPolynomial> coefficients(const SmallPolynomial& a, std::size_t variable);
SmallPolynomial derivative(const SmallPolynomial& a, std::size_t variable);

struct SmallFactor {
  SmallPolynomial value;
  int multiplicity;
};
/// Factors of a primitive polynomial without monomial factors.
std::vector<SmallFactor> factors(const SmallPolynomial& a);

}  // namespace maupertuis::terms

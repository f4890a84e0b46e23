#include "analysis/invariants/parameter_fit.hpp"

#include <algorithm>

namespace maupertuis::invariants {
namespace {

constexpr std::size_t most_of_a_fraction = 140;  // of one fraction
constexpr int most_degree = 5;
constexpr std::size_t checks = 2;  // random points at which a fit has to agree

/// All exponents of total degree ≤ `degree` of `count` variables, ascending by degree.
std::vector<std::vector<int>> powers_up_to(std::size_t count, int degree) {
  std::vector<std::vector<int>> out{std::vector<int>(count, 0)};
  std::size_t first = 0;
  for (int d = 1; d <= degree; ++d) {
    const std::size_t end = out.size();
    for (std::size_t i = first; i < end; ++i) {
      std::size_t last = count;  // multiply by variables from the last used one on, so that each comes once
      while (last > 0 && out[i][last - 1] == 0) --last;
      for (std::size_t k = last > 0 ? last - 1 : 0; k < count; ++k) {
        out.push_back(out[i]);
        ++out.back()[k];
      }
    }
    first = end;
  }
  return out;
}

}  // namespace

Expr expression(const Coefficient& c, const std::vector<Expr>& parameters, Context& context) {
  std::vector<Expr> factors{context.number(c.number)};
  if (c.root) factors.push_back(c.root);
  for (std::size_t i = 0; i < c.exponents.size(); ++i)
    if (!c.exponents[i].is_zero()) factors.push_back(pow(parameters[i], c.exponents[i]));
  if (c.numerator) factors.push_back(c.numerator);
  if (c.denominator) factors.push_back(pow(c.denominator, Rational(-1)));
  return context.product(factors);
}

std::optional<ParameterFit::Point> ParameterFit::point_at(ParameterRoots roots) {
  auto values = solver_(roots);
  if (!values) return std::nullopt;
  return Point{std::move(roots), std::move(*values)};
}

bool ParameterFit::prepare() {
  const auto roots = sampler_.usable_parameters();
  base_ = roots ? point_at(*roots) : std::nullopt;
  if (!base_) return false;
  for (std::size_t i = 0; i < sampler_.parameters().size(); ++i)
    if (!scale_parameter(i)) return false;
  return true;
}

/// By 2, 3, 5, …: products of 2, 3, 5, 7 are squares modulo p, so that the root of a parameter stays one.
bool ParameterFit::scale_parameter(std::size_t i) {
  for (const int factor : {2, 3, 5, 7, 6, 10, 14, 15, 21, 30, 35, 42}) {
    ParameterRoots roots = base_->roots;
    roots[i] = sampler_.field().multiply(roots[i], sampler_.field().from(factor));
    if (auto point = point_at(std::move(roots))) {
      scaled_.push_back(std::move(*point));
      factors_.push_back(factor);
      return true;
    }
  }
  return false;
}

const ParameterFit::Point* ParameterFit::random_point(std::size_t index) {
  while (random_.size() <= index) {
    const auto roots = sampler_.usable_parameters();
    auto point = roots ? point_at(*roots) : std::nullopt;
    if (!point) return nullptr;
    random_.push_back(std::move(*point));
  }
  return &random_[index];
}

std::optional<int> ParameterFit::power_of(int base, Value ratio) const {
  const PrimeField& field = sampler_.field();
  const Value factor = field.from(base);
  Value up = field.one(), down = field.multiply(ratio, field.one());
  for (int e = 0; e <= 24; ++e) {
    if (up == ratio) return e;
    if (down == field.one()) return -e;
    up = field.multiply(up, factor);
    down = field.multiply(down, factor);
  }
  return std::nullopt;
}

Value ParameterFit::monomial(const std::vector<int>& exponents, const ParameterRoots& roots) const {
  const PrimeField& field = sampler_.field();
  Value product = field.one();
  for (std::size_t i = 0; i < exponents.size(); ++i) {
    const Value base = exponents[i] < 0 ? field.inverse(roots[i]) : roots[i];
    product = field.multiply(product, field.power(base, static_cast<std::uint64_t>(std::abs(exponents[i]))));
  }
  return product;
}

Coefficient ParameterFit::with_powers(const std::vector<int>& exponents) const {
  Coefficient c;
  for (const int e : exponents) c.exponents.push_back(Rational(e, 2));
  return c;
}

std::optional<Coefficient> ParameterFit::find(std::size_t vector, std::size_t entry) {
  const PrimeField& field = sampler_.field();
  const Value at_base = base_->values[vector][entry];
  std::vector<int> exponents(scaled_.size(), 0);
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < scaled_.size(); ++i) {
    const auto e = power_of(factors_[i], field.multiply(scaled_[i].values[vector][entry], field.inverse(at_base)));
    if (e)
      exponents[i] = *e;
    else
      others.push_back(i);
  }
  if (others.empty()) return fit_monomial(exponents, vector, entry);
  for (int degree = 1; degree <= most_degree; ++degree)
    if (auto c = fit_fraction(exponents, others, degree, vector, entry)) return c;
  return std::nullopt;
}

std::optional<Coefficient> ParameterFit::fit_monomial(const std::vector<int>& exponents, std::size_t vector,
                                                      std::size_t entry) {
  const PrimeField& field = sampler_.field();
  const Value number = field.multiply(base_->values[vector][entry], field.inverse(monomial(exponents, base_->roots)));
  for (std::size_t k = 0; k < checks; ++k) {
    const Point* point = random_point(k);
    if (!point || field.multiply(number, monomial(exponents, point->roots)) != point->values[vector][entry])
      return std::nullopt;
  }
  Coefficient c = with_powers(exponents);
  if (const auto rational = rational_of(number, field)) {
    c.number = *rational;
    return c;
  }
  for (const NumberRoot& r : roots_)
    if (const auto rational = rational_of(field.multiply(number, field.inverse(r.image)), field)) {
      c.number = *rational;
      c.root = r.root;
      return c;
    }
  return std::nullopt;
}

/// c·D − N = 0 at random points, N and D with unknown coefficients.
std::optional<Coefficient> ParameterFit::fit_fraction(const std::vector<int>& exponents,
                                                      const std::vector<std::size_t>& others, int degree,
                                                      std::size_t vector, std::size_t entry) {
  const PrimeField& field = sampler_.field();
  const auto powers = powers_up_to(others.size(), degree);
  const std::size_t count = powers.size();
  if (2 * count > most_of_a_fraction) return std::nullopt;
  FieldMatrix rows(2 * count + checks + 2, 2 * count);
  for (std::size_t r = 0; r < rows.rows; ++r) {
    const Point* point = random_point(r);
    if (!point) return std::nullopt;
    const Value c = field.multiply(point->values[vector][entry], field.inverse(monomial(exponents, point->roots)));
    for (std::size_t k = 0; k < count; ++k) {
      Value m = field.one();
      for (std::size_t i = 0; i < others.size(); ++i)
        m = field.multiply(m, field.power(point->roots[others[i]], 2 * static_cast<std::uint64_t>(powers[k][i])));
      rows.at(r, k) = field.negate(m);
      rows.at(r, count + k) = field.multiply(c, m);
    }
  }
  const auto solutions = null_vectors(std::move(rows), field);
  if (solutions.empty()) return std::nullopt;
  std::vector<Value> upper(count, 0), lower(count, 0);
  for (std::size_t k = 0; k < solutions[0].columns.size(); ++k) {
    const std::size_t column = solutions[0].columns[k];
    (column < count ? upper[column] : lower[column - count]) = solutions[0].entries[k];
  }
  const auto numerator = polynomial(powers, upper, others), denominator = polynomial(powers, lower, others);
  if (!numerator || !denominator || denominator->is_zero()) return std::nullopt;
  Coefficient c = with_powers(exponents);
  c.numerator = *numerator;
  c.denominator = *denominator;
  return c;
}

std::optional<Expr> ParameterFit::polynomial(const std::vector<std::vector<int>>& powers,
                                             const std::vector<Value>& coefficients,
                                             const std::vector<std::size_t>& others) const {
  Context& context = sampler_.parameters().front().context();
  std::vector<Expr> terms;
  for (std::size_t k = 0; k < powers.size(); ++k) {
    if (coefficients[k] == 0) continue;
    const auto number = rational_of(coefficients[k], sampler_.field());
    if (!number) return std::nullopt;
    std::vector<Expr> factors{context.number(*number)};
    for (std::size_t i = 0; i < others.size(); ++i)
      if (powers[k][i] > 0) factors.push_back(pow(sampler_.parameters()[others[i]], Rational(powers[k][i])));
    terms.push_back(context.product(factors));
  }
  return context.sum(terms);
}

}  // namespace maupertuis::invariants

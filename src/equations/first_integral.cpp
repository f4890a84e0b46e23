#include "equations/first_integral.hpp"

#include "equations/antiderivative.hpp"
#include "equations/simplified.hpp"

#include <algorithm>
#include <numeric>

/// A form is tried with factors f until f · form is closed and its antiderivative is elementary.
namespace maupertuis {
namespace {

constexpr std::size_t most_nodes = 400;  // of a form: what is larger has no integral that anyone would read

bool closed(const ExprVector& form, const ExprVector& variables) {
  for (std::size_t i = 0; i < form.size(); ++i)
    for (std::size_t j = i + 1; j < form.size(); ++j)
      if (!vanishes_identically(differentiate(form[i], variables[j]) - differentiate(form[j], variables[i])))
        return false;
  return true;
}

/// F of a closed form: variable by variable what is still missing.
Expr potential(const ExprVector& form, const ExprVector& variables, const ReadingOrder& order) {
  Context& context = variables[0].context();
  Expr out = context.number(Rational(0));
  for (std::size_t i = 0; i < form.size(); ++i) {
    const Expr missing = form[i] - differentiate(out, variables[i]);
    if (vanishes_identically(missing)) continue;
    Expr part = antiderivative(missing, variables[i]);
    if (!part) part = antiderivative(simplified(missing, order), variables[i]);
    if (!part) return {};
    out = out + part;
  }
  for (std::size_t i = 0; i < form.size(); ++i)
    if (!vanishes_identically(differentiate(out, variables[i]) - form[i])) return {};
  return out;
}

/// The product of the factors of e that are functions of other variables than z: what separation divides by.
Expr foreign_factors(Expr e, const ExprVector& variables, Expr z) {
  Expr out = e.context().number(Rational(1));
  for (const Expr& factor : factors_of(e)) {
    const bool moves = std::any_of(variables.begin(), variables.end(), [&](Expr v) { return depends_on(factor, v); });
    if (moves && !depends_on(factor, z)) out = out * factor;
  }
  return out;
}

/// 1; 1/a_i; what separates two variables, 1/(p q) for p(y) … dx + q(x) … dy; 1/(a_i a_j).
ExprVector candidate_factors(const ExprVector& form, const ExprVector& variables) {
  ExprVector out{variables[0].context().number(Rational(1))};
  const auto add = [&out](Expr divisor) {
    const Expr factor = pow(divisor, Rational(-1));
    if (std::find(out.begin(), out.end(), factor) == out.end()) out.push_back(factor);
  };
  std::vector<std::size_t> present;
  for (std::size_t i = 0; i < form.size(); ++i)
    if (!form[i].is_zero()) present.push_back(i);
  for (const std::size_t i : present) add(form[i]);
  for (const std::size_t i : present)
    for (const std::size_t j : present)
      if (i < j)
        add(foreign_factors(form[i], variables, variables[i]) * foreign_factors(form[j], variables, variables[j]));
  for (const std::size_t i : present)
    for (const std::size_t j : present)
      if (i < j) add(form[i] * form[j]);
  return out;
}

/// What makes the coefficients of the terms whole numbers without a common divisor.
Rational common_scale(Expr sum) {
  std::int64_t multiple = 1, divisor = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const auto part = split_coefficient(sum[i]).coefficient.small();
    if (!part || part->denominator > 1000 || multiple > 1000000) return Rational(1);
    multiple = std::lcm(multiple, part->denominator);
    divisor = std::gcd(divisor, part->numerator);
  }
  return divisor == 0 ? Rational(1) : Rational(multiple, divisor);
}

/// exp F where F has logarithms of the motion: a log x - log y + c z becomes x^a exp(c z)/y. The logarithm of a length
/// is nothing that a model could say. F itself where the factor of one is a function.
Expr without_logarithms(Expr sum, const ExprVector& variables) {
  Context& context = sum.context();
  const auto moves = [&](Expr e) {
    return std::any_of(variables.begin(), variables.end(), [&](Expr v) { return depends_on(e, v); });
  };
  Expr rest = context.number(Rational(0)), first;
  std::vector<std::pair<Expr, Expr>> powers;
  for (std::size_t i = 0; i < (sum.is(Kind::Sum) ? sum.size() : 1); ++i) {
    const Expr term = sum.is(Kind::Sum) ? sum[i] : sum;
    const std::vector<Expr> factors = factors_of(term);
    const auto log = std::find_if(factors.begin(), factors.end(), [&](Expr f) { return f.is(Kind::Log) && moves(f); });
    if (log == factors.end()) {
      rest = rest + term;
      continue;
    }
    const Expr coefficient = term / *log;
    if (moves(coefficient)) return sum;
    if (!first) first = coefficient;
    powers.emplace_back((*log)[0], coefficient / first);
  }
  if (!first) return sum;
  Expr out = rest.is_zero() ? context.number(Rational(1)) : apply(Kind::Exp, rest / first);
  for (const auto& [base, exponent] : powers) out = out * context.power(base, exponent);
  return out;
}

/// The first term with the first variable that stands in the sum has a minus sign.
bool leads_negative(Expr sum, const ExprVector& variables) {
  for (const Expr& v : variables)
    for (std::size_t i = 0; i < (sum.is(Kind::Sum) ? sum.size() : 1); ++i) {
      const Expr term = sum.is(Kind::Sum) ? sum[i] : sum;
      if (depends_on(term, v)) return split_coefficient(term).coefficient.sign() < 0;
    }
  return false;
}

/// Readable, in whole numbers where that is possible; its sign follows from the order of the coordinates.
Expr presentable(Expr e, const ExprVector& variables, const ReadingOrder& order) {
  const Expr plain = without_logarithms(simplified(e, order), variables);
  Rational scale = plain.is(Kind::Sum) ? common_scale(plain) : Rational(1) / split_coefficient(plain).coefficient;
  const auto scaled = [&] { return expand(plain * scale, 200); };
  if (!scaled()) return plain;
  if (leads_negative(scaled(), variables)) scale = -scale;
  return scale == Rational(1) ? plain : simplified(scaled(), order);
}

}  // namespace

FirstIntegral first_integral(const OneForm& form, const ExprVector& all, const ReadingOrder& order) {
  if (topological_order(form.components).size() > most_nodes) return {};
  // Variables that the form neither moves nor reads have no part in it.
  const std::vector<Expr> read = symbols_of(form.components);
  ExprVector plain, variables;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Expr a = form.components[i];
    if (a.is_zero() && std::find(read.begin(), read.end(), all[i]) == read.end()) continue;
    variables.push_back(all[i]);
    plain.push_back(vanishes_identically(a) ? a.context().number(Rational(0)) : simplified(a, order));
  }
  if (variables.empty()) return {};
  for (const Expr& factor : candidate_factors(plain, variables)) {
    ExprVector trial;
    for (const Expr& a : plain) trial.push_back(a * factor);
    if (!closed(trial, variables)) continue;
    if (const Expr value = potential(trial, variables, order)) return {presentable(value, variables, order)};
  }
  return {};
}

}  // namespace maupertuis

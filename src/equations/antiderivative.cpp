#include "equations/antiderivative.hpp"

#include <maupertuis/evaluate.hpp>

#include <algorithm>

namespace maupertuis {
namespace {

/// a z + b → a, an empty handle if u is not linear in z.
Expr slope(Expr u, Expr z) {
  const Expr a = differentiate(u, z);
  return depends_on(a, z) ? Expr() : a;
}

Expr whole(Context& context, std::int64_t n) { return context.number(Rational(n)); }

/// u^n with u linear.
Expr of_power(Expr base, const Rational& n, Expr z) {
  const Expr a = slope(base, z);
  if (!a || a.is_zero()) return {};
  if (n == Rational(-1)) return apply(Kind::Log, base) / a;
  return pow(base, n + Rational(1)) / (n + Rational(1)) / a;
}

/// ∫ f(u) for u linear, by the table; empty if f is not in it.
Expr of_function(Expr f, Expr z) {
  if (f.size() != 1) return {};
  const Expr u = f[0], a = slope(u, z);
  if (!a || a.is_zero()) return {};
  if (f.is(Kind::Sin)) return -cos(u) / a;
  if (f.is(Kind::Cos)) return sin(u) / a;
  if (f.is(Kind::Exp)) return f / a;
  if (f.is(Kind::Sinh)) return apply(Kind::Cosh, u) / a;
  if (f.is(Kind::Cosh)) return apply(Kind::Sinh, u) / a;
  if (f.is(Kind::Tan)) return -apply(Kind::Log, cos(u)) / a;
  return {};
}

/// ∫ p f with p = z^n and f of the table: by parts, n times.
Expr by_parts(Expr power, Expr f, Expr z) {
  const auto [base, n] = split_power(power);
  if (!(base == z) || !n.is_integer() || n.sign() <= 0 || Rational(12) < n) return {};
  const Expr inner = of_function(f, z);
  if (!inner) return {};
  const Expr rest = antiderivative(expand(differentiate(power, z) * inner), z);
  return rest ? power * inner - rest : Expr();
}

/// u^n u' or f(u) u' up to a factor that is free of z, for a factor u^n or f(u) of the term.
Expr by_substitution(Expr term, const std::vector<Expr>& factors, Expr z) {
  Context& context = term.context();
  for (const Expr& factor : factors) {
    const bool function = !factor.is(Kind::Power) && factor.size() == 1;
    const auto [base, n] = function ? PowerOf{factor[0], Rational(1)} : split_power(factor);
    const Expr rate = differentiate(base, z);
    if (rate.is_zero() || (base == z)) continue;
    const Expr rest = term / factor / rate;
    if (zero_test(differentiate(rest, z)).verdict != Verdict::Zero) continue;
    // rest is free of z: its value at any z will do; take one where nothing vanishes.
    const Expr constant = substitute(rest, {{z, whole(context, 1) / whole(context, 3)}});
    const Expr dummy = context.symbol("antiderivative variable", Role::Auxiliary);
    const Expr outer = function ? of_function(apply(factor.kind(), dummy), dummy) : of_power(dummy, n, dummy);
    if (outer) return constant * substitute(outer, {{dummy, base}});
  }
  return {};
}

Expr of_term(Expr term, Expr z) {
  Context& context = term.context();
  if (!depends_on(term, z)) return term * z;
  Expr constant = whole(context, 1), rest = constant;
  std::vector<Expr> moving;
  for (const Expr& factor : factors_of(term)) {
    if (depends_on(factor, z))
      moving.push_back(factor), rest = rest * factor;
    else
      constant = constant * factor;
  }
  Expr integral;
  if (moving.size() == 1) {
    const auto [base, n] = split_power(moving[0]);
    integral = of_power(base, n, z);
    if (!integral) integral = of_function(moving[0], z);
  } else if (moving.size() == 2) {
    integral = by_parts(moving[0], moving[1], z);
    if (!integral) integral = by_parts(moving[1], moving[0], z);
  }
  if (!integral) integral = by_substitution(rest, moving, z);
  if (!integral) {  // products of sines and cosines to sums
    const Expr sums = fourier_form(rest, 200);
    if (sums && sums.is(Kind::Sum)) integral = antiderivative(sums, z);
  }
  return integral ? constant * integral : Expr();
}

}  // namespace

bool depends_on(Expr e, Expr symbol) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::find(symbols.begin(), symbols.end(), symbol) != symbols.end();
}

std::vector<Expr> factors_of(Expr e) {
  if (!e.is(Kind::Product)) return {e};
  std::vector<Expr> factors;
  for (std::size_t i = 0; i < e.size(); ++i) factors.push_back(e[i]);
  return factors;
}

Expr antiderivative(Expr e, Expr z) {
  const Expr expanded = expand(e, 500);
  if (!expanded) return {};
  Context& context = e.context();
  std::vector<Expr> terms;
  const std::size_t count = expanded.is(Kind::Sum) ? expanded.size() : 1;
  for (std::size_t i = 0; i < count; ++i) {
    terms.push_back(of_term(expanded.is(Kind::Sum) ? expanded[i] : expanded, z));
    if (!terms.back()) return {};
  }
  return sum_of(terms, context);
}

}  // namespace maupertuis

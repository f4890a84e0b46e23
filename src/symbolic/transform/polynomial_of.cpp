#include "symbolic/transform/polynomial_of.hpp"

#include <maupertuis/require.hpp>

#include <algorithm>

namespace maupertuis::terms {

const Polynomial& PolynomialReader::read(Expr e) {
  if (const auto known = known_.find(e.id()); known != known_.end()) return known->second;
  for (const Expr& node : topological_order({&e, 1}))
    if (!known_.count(node.id())) {
      Polynomial value = read_node(node);
      known_.emplace(node.id(), std::move(value));
    }
  return known_.at(e.id());
}

Polynomial PolynomialReader::read_node(Expr e) {
  MAUP_REQUIRE(!e.is(Kind::TimeDerivative));
  if (e.is_number()) return algebra_->constant(e.number());
  if (e.is(Kind::Pi) || e.is_symbol()) return algebra_->of_atom(algebra_->atom(e, AtomKind::Symbol));
  if (e.is(Kind::Sum)) return read_sum(e);
  if (e.is(Kind::Product)) return read_product(e);
  if (e.is(Kind::Power)) return read_power(e);
  if (e.is(Kind::Sin) || e.is(Kind::Cos)) return read_circular(e);
  if (e.is(Kind::Exp)) return read_exponential(e);
  return read_function(e);  // an atom, whatever it is
}

Polynomial PolynomialReader::read_sum(Expr e) {
  std::vector<Term> raw;
  for (std::size_t i = 0; i < e.size(); ++i) {
    const Polynomial& part = known_.at(e[i].id());
    raw.insert(raw.end(), part.begin(), part.end());
  }
  return algebra_->normalized(std::move(raw));
}

Polynomial PolynomialReader::read_product(Expr e) {
  std::vector<const Polynomial*> factors;
  for (std::size_t i = 0; i < e.size(); ++i) factors.push_back(&known_.at(e[i].id()));
  std::stable_sort(factors.begin(), factors.end(), [](auto* a, auto* b) { return a->size() < b->size(); });
  Polynomial result = *factors.front();
  for (std::size_t i = 1; i < factors.size(); ++i) result = algebra_->multiply(result, *factors[i]);
  return result;
}

Polynomial PolynomialReader::read_power(Expr e) {
  const Polynomial base = known_.at(e[0].id());
  if (const Rational* exponent = e[1].number_or_null()) {
    if (exponent->is_integer() && exponent->sign() > 0 && base.size() > 1 && algebra_->budget() < 512 * base.size() &&
        Rational(64) < *exponent)
      throw TooManyTerms{};
    return algebra_->power(base, to_fraction(*exponent));
  }
  return read_symbolic_power(e[0], known_.at(e[1].id()));
}

/// x^(s − 1) = x^s · x^-1: the number leaves the exponent, so that x · x^(s−1) = x^s.
Polynomial PolynomialReader::read_symbolic_power(Expr base, const Polynomial& exponent) {
  Polynomial symbolic = exponent;
  Polynomial number;
  if (!symbolic.empty() && symbolic.front().monomial == 0 && symbolic.front().harmonic == 0 &&
      fits_fraction(symbolic.front().coefficient)) {
    number = {symbolic.front()};
    symbolic.erase(symbolic.begin());
  }
  const Polynomial argument = known_.at(base.id());
  const Expr canonical = algebra_->context().power(algebra_->expression(argument), algebra_->expression(symbolic));
  if (canonical.is_number()) return algebra_->power(argument, to_fraction(number.front().coefficient));
  Polynomial result = algebra_->of_atom(algebra_->atom(canonical, AtomKind::Function, {argument, symbolic}));
  if (number.empty()) return result;
  return algebra_->multiply(result, algebra_->power(argument, to_fraction(number.front().coefficient)));
}

/// An argument as a rational combination of one-term expressions.
std::vector<Frequency> PolynomialReader::angles(const Polynomial& argument) {
  std::vector<Frequency> result;
  for (const Term& term : argument) {
    const Expr angle = algebra_->expression({Term{term.monomial, term.harmonic, 1}});
    result.push_back({angle.id(), to_fraction(term.coefficient)});
  }
  std::sort(result.begin(), result.end(), [](const Frequency& a, const Frequency& b) { return a.angle < b.angle; });
  return result;
}

Polynomial PolynomialReader::read_circular(Expr e) {
  const Polynomial& argument = known_.at(e[0].id());
  const bool readable =
      std::all_of(argument.begin(), argument.end(), [](const Term& t) { return fits_fraction(t.coefficient); });
  if (trigonometry_ == Trigonometry::Opaque || !readable) return read_function(e);
  std::vector<Frequency> angle = angles(argument);
  for (const Frequency& f : angle) {
    const auto place = units_.try_emplace(f.angle, gcd({0, 1}, f.multiple)).first;
    place->second = gcd(place->second, f.multiple);
  }
  Term term = algebra_->harmonic_term(e.is(Kind::Sin), std::move(angle), 1);
  if (term.coefficient.is_zero()) return {};
  return {std::move(term)};
}

/// exp(a + 2b) = exp(a) · exp(b)^2.
Polynomial PolynomialReader::read_exponential(Expr e) {
  const Polynomial argument = known_.at(e[0].id());
  Polynomial result = algebra_->constant(1);
  for (const Term& term : argument) {
    const Polynomial exponent{Term{term.monomial, term.harmonic, 1}};
    if (!fits_fraction(term.coefficient)) return read_function(e);
    const Expr canonical = apply(Kind::Exp, algebra_->expression(exponent));
    const AtomId atom = algebra_->atom(canonical, AtomKind::Exponential, {exponent});
    result = algebra_->multiply(result, algebra_->of_atom(atom, to_fraction(term.coefficient)));
  }
  return result;
}

Polynomial PolynomialReader::read_function(Expr e) {
  std::vector<Expr> canonical;
  std::vector<Polynomial> arguments;
  for (std::size_t i = 0; i < e.size(); ++i) {
    arguments.push_back(known_.at(e[i].id()));
    canonical.push_back(algebra_->expression(arguments.back()));
  }
  const Expr value = algebra_->context().function(e.kind(), canonical);
  // The constructor may move a sign out, or know the value: then the result is no bare function of the arguments.
  const ScaledTerm scaled = split_coefficient(value);
  if (scaled.rest.is_one()) return algebra_->constant(scaled.coefficient);
  if (scaled.rest.kind() != e.kind()) return algebra_->of_atom(algebra_->atom(value, AtomKind::Symbol));
  if (!scaled.coefficient.is_one())
    for (Polynomial& argument : arguments) argument = algebra_->scale(argument, -1);
  const AtomId atom = algebra_->atom(scaled.rest, AtomKind::Function, std::move(arguments));
  return algebra_->scale(algebra_->of_atom(atom), scaled.coefficient);
}

}  // namespace maupertuis::terms

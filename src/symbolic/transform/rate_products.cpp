#include <maupertuis/rate_products.hpp>
#include <maupertuis/transform.hpp>

#include "symbolic/transform/polynomial_of.hpp"

#include <algorithm>
#include <optional>

namespace maupertuis {
namespace {

using terms::Fraction;
using terms::Harmonic;
using terms::Polynomial;
using terms::Term;

constexpr std::size_t most_terms = 60;

/// q̇_i q̇_j c, without the harmonic.
struct Pair {
  Expr first, second, factor;
};

class RateProducts {
 public:
  RateProducts(Context& context, std::span<const Expr> coordinates)
      : context_(context), algebra_(context, most_terms), reader_(algebra_, terms::Trigonometry::ToSums) {
    for (const Expr& q : coordinates) coordinate_of_.emplace(context.time_derivative(q), q);
  }

  /// Sum by sum, so that what is left alone keeps its form.
  Expr in(Expr e) {
    if (!e.is(Kind::Sum)) return of_term(e);
    std::vector<Expr> out;
    for (std::size_t i = 0; i < e.size(); ++i) out.push_back(in(e[i]));
    return context_.sum(out);
  }

 private:
  /// Whether a sine or cosine and two velocities stand in it: to look costs less than to expand.
  bool may_gain(Expr e) const {
    std::size_t velocities = 0;
    bool has_angle = false;
    for (const Expr& node : topological_order({&e, 1})) {
      velocities += coordinate_of_.count(node);
      has_angle = has_angle || node.is(Kind::Sin) || node.is(Kind::Cos);
    }
    return velocities > 1 && has_angle;
  }

  Expr of_term(Expr e) {
    if (context_.has_time_derivative(e.id()) || !may_gain(e)) return e;
    try {
      const Polynomial polynomial = reader_.read(e);
      Polynomial others;
      std::vector<Expr> out;
      for (const Term& term : polynomial)
        if (const std::optional<Expr> product = product_of_rates(term))
          out.push_back(*product);
        else
          others.push_back(term);
      if (out.empty()) return e;
      out.push_back(algebra_.expression(others));
      const Expr result = context_.sum(out);
      return is_same(reader_.read(expand_time_derivatives(result)), polynomial) ? result : e;
    } catch (const terms::TooManyTerms&) {
      return e;
    }
  }

  static bool is_same(const Polynomial& a, const Polynomial& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Term& x, const Term& y) {
      return x.monomial == y.monomial && x.harmonic == y.harmonic && x.coefficient == y.coefficient;
    });
  }

  std::optional<Pair> pair_of(const Term& term) {
    Pair out;
    terms::Monomial others;
    for (const terms::Factor& factor : algebra_.monomial(term.monomial)) {
      const auto found = coordinate_of_.find(algebra_.info(factor.atom).expr);
      if (found == coordinate_of_.end()) {
        others.push_back(factor);
        continue;
      }
      Expr& place = out.first ? out.second : out.first;
      if (factor.exponent != Fraction{1, 1} || place) return std::nullopt;
      place = found->second;
    }
    if (!out.second) return std::nullopt;
    out.factor = context_.number(term.coefficient) * algebra_.expression(algebra_.intern(others));
    return out;
  }

  /// c q̇_i q̇_j cos(a q_i + b q_j), or with a sine.
  std::optional<Expr> product_of_rates(const Term& term) {
    const Harmonic harmonic = algebra_.harmonic(term.harmonic);
    if (harmonic.argument.empty()) return std::nullopt;
    const std::optional<Pair> pair = pair_of(term);
    if (!pair) return std::nullopt;
    Fraction a, b;
    for (const terms::Frequency& f : harmonic.argument) {
      if (f.angle != pair->first.id() && f.angle != pair->second.id()) return std::nullopt;
      (f.angle == pair->first.id() ? a : b) = f.multiple;
    }
    const Expr cosine_i = velocity_times(false, pair->first, a), sine_i = velocity_times(true, pair->first, a),
               cosine_j = velocity_times(false, pair->second, b), sine_j = velocity_times(true, pair->second, b);
    return pair->factor *
           (harmonic.sine ? sine_i * cosine_j + cosine_i * sine_j : cosine_i * cosine_j - sine_i * sine_j);
  }

  /// q̇ cos aq = d/dt (sin aq)/a, or q̇ sin aq = −d/dt (cos aq)/a.
  Expr velocity_times(bool sine, Expr q, Fraction a) {
    if (a.is_zero()) return sine ? context_.number(0) : context_.time_derivative(q);
    const Rational multiple = terms::to_rational(a);
    const Expr angle = context_.number(multiple) * q;
    return context_.time_derivative(sine ? -cos(angle) : sin(angle)) / multiple;
  }

  Context& context_;
  terms::TermAlgebra algebra_;
  terms::PolynomialReader reader_;
  std::unordered_map<Expr, Expr, ExprHash> coordinate_of_;  // of a velocity
};

}  // namespace

Expr with_rate_products(Expr lagrangian, std::span<const Expr> coordinates) {
  return RateProducts(lagrangian.context(), coordinates).in(lagrangian);
}

}  // namespace maupertuis

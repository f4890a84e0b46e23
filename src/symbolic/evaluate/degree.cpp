#include "symbolic/evaluate/degree.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace maupertuis::evaluation {
namespace {

struct Fraction {
  double up = 0, down = 0;  // degrees
  double height = 0;
};

Fraction product(const Fraction& a, const Fraction& b) { return {a.up + b.up, a.down + b.down, a.height + b.height}; }

/// Over the product of the denominators.
Fraction sum(const std::vector<Fraction>& terms) {
  Fraction total;
  double down = 0, height = 0;
  for (const Fraction& f : terms) {
    down += f.down;
    if (f.down > 0) height += f.height;
  }
  for (const Fraction& f : terms) {
    total.up = std::max(total.up, f.up + down - f.down);
    total.height = std::max(total.height, f.height);
  }
  total.down = down;
  total.height += height + std::log2(static_cast<double>(terms.size()) + 1);
  return total;
}

Fraction power(Fraction base, double exponent) {
  if (exponent < 0) std::swap(base.up, base.down);
  const double n = std::abs(exponent);
  return {base.up * n, base.down * n, base.height * n};
}

Fraction derivative(const Fraction& f) { return {f.up + f.down, 2 * f.down, 2 * f.height + 8}; }

double bits(const Rational& value) {
  const auto parts = value.small();
  if (!parts) return 4.0 * static_cast<double>(value.numerator_string().size() + value.denominator_string().size());
  return std::log2(1.0 + std::abs(static_cast<double>(parts->numerator))) +
         std::log2(static_cast<double>(parts->denominator));
}

/// e^(i·argument) as a monomial of the basis: the sum of the absolute values of its coefficients over a common
/// denominator.
double angle_degree(const Tape& tape, Position argument) {
  double degree = 0, denominator = 1;
  const auto add = [&](Position at) {
    const auto c = term_view(tape, at).coefficient.small();
    if (!c) {
      degree = 1e30;
      return;
    }
    degree += std::abs(static_cast<double>(c->numerator)) / static_cast<double>(c->denominator);
    denominator = std::max(denominator, static_cast<double>(c->denominator));
  };
  if (tape.kind(argument) == Kind::Sum) {
    for (const Position term : tape.arguments(argument)) add(term);
  } else {
    add(argument);
  }
  return degree * denominator;
}

constexpr int largest_number_of_points = 4096;
constexpr double largest_degree = 1099511627776.0;  // 2^40
constexpr double log2_of_primes = 33;               // random_prime_triple draws from more than 2^33

}  // namespace

int points_needed(const Complexity& c, int wanted) {
  if (c.switches == 0) return wanted;
  const double combinations = std::pow(2.0, std::min(c.switches, 12));
  return static_cast<int>(std::min<double>(largest_number_of_points, std::max<double>(wanted, 12 * combinations)));
}

double error_bound(const Complexity& c, int points, double smallest_group) {
  if (!c.claimable || !(c.degree <= largest_degree) || !(c.height <= largest_degree)) return 1;
  const double sheets = std::pow(4.0, c.radicals);
  const double hit = std::min(1.0, (2 * c.degree + 1) * sheets / smallest_group);
  double at_points = std::pow(hit, points);
  if (c.switches > 0) {  // the sign combination that differs, with probability 2^-switches a point, must be drawn too
    const double seen = std::pow(0.5, std::min(c.switches, 60));
    at_points = std::pow(1 - seen * (1 - hit), points);
  }
  const double bad_prime = std::min(1.0, (c.height + c.degree + 61) / 61 / std::pow(2.0, log2_of_primes));
  const double one_prime = std::min(1.0, at_points + bad_prime);
  return std::max(one_prime * one_prime, 1e-300);
}

Complexity complexity(const Tape& tape, bool free_roots) {
  Complexity result;
  std::vector<Fraction> f(tape.size()), terms;
  std::unordered_set<Position> bases_of_symbolic_powers, bases_of_roots;
  for (Position at = 0; at < tape.size(); ++at) {
    const auto arguments = tape.arguments(at);
    switch (tape.kind(at)) {
      case Kind::Number:
        f[at].height = bits(tape.expression(at).number());
        break;
      case Kind::Sum:
      case Kind::Min:
      case Kind::Max:
      case Kind::Piecewise:
        terms.clear();
        for (const Position a : arguments) terms.push_back(f[a]);
        f[at] = sum(terms);
        if (tape.kind(at) == Kind::Min || tape.kind(at) == Kind::Max) ++result.switches;
        break;
      case Kind::Product:
        f[at] = f[arguments[0]];
        for (std::size_t i = 1; i < arguments.size(); ++i) f[at] = product(f[at], f[arguments[i]]);
        break;
      case Kind::Power: {
        const Expr exponent = tape.expression(arguments[1]);
        if (!exponent.is_number()) {
          f[at] = {1, 1, 0};
          bases_of_symbolic_powers.insert(arguments[0]);
          result.claimable &= bases_of_symbolic_powers.size() == 1;
          break;
        }
        if (free_roots && !exponent.number().is_integer()) {
          f[at] = product(power(f[arguments[0]], std::floor(exponent.number().to_double())), {1, 0, 1});
          break;
        }
        f[at] = power(f[arguments[0]], exponent.number().to_double());
        if (!exponent.number().is_integer() && bases_of_roots.insert(arguments[0]).second) ++result.radicals;
        break;
      }
      case Kind::Sin:
      case Kind::Cos:
      case Kind::Tan:
      case Kind::Sinh:
      case Kind::Cosh:
      case Kind::Tanh:
      case Kind::Exp: {
        // A Laurent monomial of the group elements: `error_bound` counts exponents of both signs.
        const bool quotient = tape.kind(at) == Kind::Tan || tape.kind(at) == Kind::Tanh;
        const double d = angle_degree(tape, arguments[0]);
        f[at] = {d, quotient ? d : 0, 1};
        break;
      }
      case Kind::Asin:
      case Kind::Acos:
      case Kind::Atan:
      case Kind::Atan2:
      case Kind::Acosh:
        ++result.radicals;
        f[at] = {1, 0, 0};
        break;
      // A random number of its own.
      case Kind::Pi:
      case Kind::Symbol:
      case Kind::Log:
      case Kind::Asinh:
      case Kind::Atanh:
      case Kind::Erf:
      case Kind::LambertW:
        f[at] = {1, 0, 0};
        break;
      case Kind::TimeDerivative:
        f[at] = derivative(f[arguments[0]]);
        break;
      case Kind::Abs:
        ++result.switches;
        f[at] = f[arguments[0]];
        break;
      case Kind::Sign:
      case Kind::Step:
        ++result.switches;
        break;
      case Kind::Less:
      case Kind::LessEqual:
        ++result.switches;
        break;
      case Kind::And:
      case Kind::Or:
        break;  // their comparisons count
    }
  }
  for (const Position root : tape.roots()) {
    result.degree = std::max(result.degree, std::max(f[root].up, f[root].down));
    result.height = std::max(result.height, f[root].height);
  }
  return result;
}

}  // namespace maupertuis::evaluation

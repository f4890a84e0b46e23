#include "symbolic/evaluate/degree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_set>
#include <vector>

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

/// What a tape's nodes are as quotients of polynomials, one after the other.
class DegreeCount {
 public:
  DegreeCount(const Tape& tape, bool free_roots) : tape_(tape), free_roots_(free_roots), nodes_(tape.size()) {
    for (Position at = 0; at < tape.size(); ++at) nodes_[at] = node(at);
    for (const Position root : tape.roots()) {
      result_.degree = std::max({result_.degree, nodes_[root].up, nodes_[root].down});
      result_.height = std::max(result_.height, nodes_[root].height);
    }
  }
  const Complexity& result() const { return result_; }

 private:
  Fraction node(Position at);
  Fraction of_power(Position at);

  /// A function with two pieces.
  Fraction switched(Fraction f) {
    ++result_.switches;
    return f;
  }
  std::vector<Fraction> arguments(Position at) const {
    std::vector<Fraction> out;
    for (const Position a : tape_.arguments(at)) out.push_back(nodes_[a]);
    return out;
  }

  const Tape& tape_;
  bool free_roots_;
  std::vector<Fraction> nodes_;
  std::unordered_set<Position> bases_of_symbolic_powers_, bases_of_roots_;
  Complexity result_;
};

Fraction DegreeCount::of_power(Position at) {
  const Position base = tape_.arguments(at)[0];
  const Expr exponent = tape_.expression(tape_.arguments(at)[1]);
  if (!exponent.is_number()) {
    bases_of_symbolic_powers_.insert(base);
    result_.claimable &= bases_of_symbolic_powers_.size() == 1;
    return {1, 1, 0};
  }
  const bool is_root = !exponent.number().is_integer();
  const double n = exponent.number().to_double();
  if (is_root && free_roots_) return product(power(nodes_[base], std::floor(n)), {1, 0, 1});
  if (is_root && bases_of_roots_.insert(base).second) ++result_.radicals;
  return power(nodes_[base], n);
}

Fraction DegreeCount::node(Position at) {
  constexpr Fraction random_number{1, 0, 0};
  switch (tape_.kind(at)) {
    case Kind::Number:
      return {0, 0, bits(tape_.expression(at).number())};
    case Kind::Sum:
    case Kind::Piecewise:
      return sum(arguments(at));
    case Kind::Min:
    case Kind::Max:
      return switched(sum(arguments(at)));
    case Kind::Product: {
      const std::vector<Fraction> factors = arguments(at);
      return std::accumulate(factors.begin() + 1, factors.end(), factors.front(), product);
    }
    case Kind::Power:
      return of_power(at);
    // A Laurent monomial of the group elements: `error_bound` counts exponents of both signs.
    case Kind::Sin:
    case Kind::Cos:
    case Kind::Sinh:
    case Kind::Cosh:
    case Kind::Exp:
      return {angle_degree(tape_, tape_.arguments(at)[0]), 0, 1};
    case Kind::Tan:
    case Kind::Tanh: {
      const double d = angle_degree(tape_, tape_.arguments(at)[0]);
      return {d, d, 1};
    }
    case Kind::Asin:
    case Kind::Acos:
    case Kind::Atan:
    case Kind::Atan2:
    case Kind::Acosh:
      ++result_.radicals;
      return random_number;
    case Kind::Pi:
    case Kind::Symbol:
    case Kind::Log:
    case Kind::Asinh:
    case Kind::Atanh:
    case Kind::Erf:
    case Kind::LambertW:
      return random_number;
    case Kind::TimeDerivative:
      return derivative(arguments(at)[0]);
    case Kind::Abs:
      return switched(arguments(at)[0]);
    case Kind::Sign:
    case Kind::Step:
    case Kind::Less:
    case Kind::LessEqual:
      return switched({});
    case Kind::And:
    case Kind::Or:
      return {};  // their comparisons count
  }
  return {};
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

Complexity complexity(const Tape& tape, bool free_roots) { return DegreeCount(tape, free_roots).result(); }

}  // namespace maupertuis::evaluation

#include "certificate/compare.hpp"

#include <maupertuis/interrupt_scope.hpp>

#include "symbolic/evaluate/prime_field.hpp"
#include "symbolic/evaluate/real100.hpp"
#include "symbolic/evaluate/real_numbers.hpp"

namespace maupertuis::certification {
namespace {

using evaluation::mix;
using evaluation::Position;
using evaluation::Real100;
using evaluation::Tape;
using Reals = evaluation::RealNumbers<Real100>;

/// Real numbers of 100 digits in the role that a prime field has in the other route.
class HundredDigits : public Reals {
 public:
  struct Angle {
    Real100 cosine, sine;
  };

  explicit HundredDigits(std::uint64_t seed, const Bindings* given = nullptr)
      : Reals([this](Expr e) { return draw(e); }), seed_(seed), given_(given) {}

  Real100 random(std::uint64_t key, std::uint64_t second) const {
    const std::uint64_t bits = mix(mix(seed_ ^ mix(key)) ^ second);
    const Real100 size = Real100(0.25) + Real100(static_cast<double>(bits >> 11) * 0x1p-53);
    return bits & 1 ? Real100(-size) : size;
  }
  bool is_zero(const Real100& a) const { return a == 0; }
  int sign(Position, const Real100& value) const { return value < 0 ? -1 : 1; }
  Real100 square_root(const Real100& a) const { return sqrt(a); }
  Angle cos_sin(const Tape&, Position argument, const std::vector<Real100>& v) const {
    return {cos(v[argument]), sin(v[argument])};
  }
  Real100 exponential(const Tape&, Position argument, const std::vector<Real100>& v) const { return exp(v[argument]); }
  Real100 logarithm(const Tape&, Position argument, const std::vector<Real100>& v) const { return log(v[argument]); }
  bool holds(const Tape& tape, Position at, const std::vector<Real100>& v) const {
    return Reals::holds(tape, at, v).value_or(false);
  }

 private:
  Real100 draw(Expr e) const {
    if (given_)
      if (const auto known = given_->find(e); known != given_->end()) return Real100(known->second);
    const Real100 value = random(0x73796d, e.id());
    const bool positive = e.role() == Role::Parameter || e.role() == Role::Constant || e.role() == Role::Time;
    return positive ? Real100(abs(value)) : value;
  }
  std::uint64_t seed_;
  const Bindings* given_;
};

std::vector<Real100> some_direction(const HundredDigits& numbers, std::size_t n) {
  std::vector<Real100> direction;
  for (std::size_t i = 0; i < n; ++i) direction.push_back(numbers.random(0x646972, i));
  return direction;
}

/// The size of what may cancel: rounding errors stay below this times 1e-90.
Real100 largest(const std::vector<Jet<Real100>>& values) {
  Real100 most = 1;
  for (const auto& jet : values)
    for (const auto& part : jet.c)
      for (const Real100& x : part)
        if (abs(x) > most) most = abs(x);
  return most;
}

/// Adds what one point tells. False: not everything is defined there.
bool compare_at(HundredDigits& numbers, const Questions& questions, const Tape& tape, RoutesResult& result) {
  std::vector<Jet<Real100>> values;
  const auto direction = some_direction(numbers, questions.system.coordinates.size());
  const auto all = differences(questions, tape, numbers, orders_needed(tape), direction, values, every_position);
  const Real100 scale = largest(values), tolerance = scale * Real100(1e-60);
  const auto undefined = [](const Real100& x) { return !isfinite(x); };
  const bool any_undefined = std::any_of(all.begin(), all.end(), [&](const std::vector<Real100>& route) {
    return std::any_of(route.begin(), route.end(), undefined);
  });
  if (!isfinite(scale) || any_undefined) return false;
  for (std::size_t route = 0; route < RouteCount; ++route) {
    RouteResult& r = result.routes[route];
    for (const Real100& x : all[route]) {
      if (!(abs(x) > tolerance)) continue;
      r.fails = true;
      r.difference = static_cast<double>(x);
    }
    if (!r.fails) ++r.points;
  }
  return true;
}

}  // namespace

RoutesResult compare_over_reals(const Questions& questions, std::uint64_t seed, int points) {
  RoutesResult result;
  const Tape tape = Tape::with_gaussians(questions.roots);
  result.complete = orders_needed(tape) <= Jet<Real100>::max_orders;
  int found = 0;
  for (int attempt = 0; result.complete && found < points && attempt < 20 * points; ++attempt) {
    interrupt_of(*questions.system.context).throw_if_asked();
    HundredDigits numbers(mix(seed + static_cast<std::uint64_t>(attempt)));
    found += compare_at(numbers, questions, tape, result);
  }
  result.complete &= found >= points;
  return result;
}

RoutesResult compare_at_real_point(const Questions& questions, const Bindings& point, std::uint64_t seed) {
  RoutesResult result;
  const Tape tape = Tape::with_gaussians(questions.roots);
  HundredDigits numbers(mix(seed), &point);
  result.complete = orders_needed(tape) <= Jet<Real100>::max_orders && compare_at(numbers, questions, tape, result);
  return result;
}

}  // namespace maupertuis::certification

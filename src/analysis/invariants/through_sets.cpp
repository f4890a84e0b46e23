#include "analysis/invariants/through_sets.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace maupertuis::invariants {
namespace {

using Holds = IntegralThroughModes::Holds;

constexpr double rounding = 1e-9;  // of the size of an integral

}  // namespace

double relative_change(Expr f, const Bindings& before, const Bindings& after) {
  const std::size_t terms = f.is(Kind::Sum) ? f.size() : 1;
  double size = 0;
  for (std::size_t i = 0; i < terms; ++i) {
    const Expr term = terms == 1 ? f : f[i];
    size += std::abs(evaluate(term, before)) + std::abs(evaluate(term, after));
  }
  const double difference = std::abs(evaluate(f, after) - evaluate(f, before));
  return difference == 0 ? 0 : difference / size;
}

struct AtSets::Impl {
  Impl(const Model& model, const EquationsOfMotion& equations, const MotionState& from)
      : system(model.system), start(from), constraints(equations), constrained(equations.system->constrained()) {
    for (const Coordinate& c : system.coordinates) positions.push_back(c.q), velocities.push_back(c.velocity);
  }

  Expr plain(Expr e) const { return with_constants_as_numbers(system, in_terms_of_motion(system, {&e, 1})).front(); }
  Bindings bindings(const MotionState& s) const {
    Bindings out = parameter_bindings(system);
    for (std::size_t i = 0; i < s.q.size(); ++i) out[positions[i]] = s.q[i], out[velocities[i]] = s.v[i];
    out[system.context->time()] = s.t;
    return out;
  }
  bool is_of_the_state(Expr e) const {
    const std::vector<Expr> symbols = symbols_of({&e, 1});
    return std::all_of(symbols.begin(), symbols.end(), [](const Expr& s) {
      return s.role() == Role::Parameter || s.role() == Role::Time || (s.role() == Role::Coordinate && s.order() < 2);
    });
  }
  double draw() { return std::uniform_real_distribution<double>(-1, 1)(random); }
  std::optional<MotionState> state_on(Expr function);
  std::optional<double> largest_change(Expr function, const ExprMap& sets, Expr integral);

  const MechanicalSystem& system;
  MotionState start;
  ConstraintManifold constraints;
  bool constrained;
  ExprVector positions, velocities;
  std::mt19937_64 random{0x736574};
};

/// By Newton's method along the gradient, and back to the constraints each time. A function of t alone is met in time.
std::optional<MotionState> AtSets::Impl::state_on(Expr function) {
  constexpr int most = 60;
  constexpr double met = 1e-13;
  MotionState s = start;
  s.t += draw();
  for (double& q : s.q) q += 0.3 * (1 + std::abs(q)) * draw();
  for (double& v : s.v) v += (1 + std::abs(v)) * draw();
  const ExprVector by_q = gradient(function, positions), by_v = gradient(function, velocities);
  const Expr by_t = differentiate(function, system.context->time());
  const std::vector<bool> free(s.q.size(), false);
  double first = 0;
  for (int round = 0; round < most; ++round) {
    if (constrained && !(constraints.move_positions(s, free) && constraints.move_velocities(s, free)))
      return std::nullopt;
    const Bindings here = bindings(s);
    const double value = evaluate(function, here);
    if (!std::isfinite(value)) return std::nullopt;
    first = std::max(first, std::abs(value));
    if (std::abs(value) <= met * first) return s;
    std::vector<double> slopes;
    for (const ExprVector* list : {&by_q, &by_v})
      for (const Expr& e : *list) slopes.push_back(evaluate(e, here));
    double square = 0;
    for (const double x : slopes) square += x * x;
    const double in_time = square == 0 ? evaluate(by_t, here) : 0;
    if (!std::isfinite(square) || (square == 0 && in_time == 0)) return std::nullopt;
    if (square == 0) s.t -= value / in_time;
    for (std::size_t i = 0; square > 0 && i < s.q.size(); ++i) {
      s.q[i] -= value * slopes[i] / square;
      s.v[i] -= value * slopes[s.q.size() + i] / square;
    }
  }
  return std::nullopt;
}

/// Nothing where no such state was found.
std::optional<double> AtSets::Impl::largest_change(Expr function, const ExprMap& sets, Expr integral) {
  std::optional<double> out;
  int seen = 0;
  for (int attempt = 0; attempt < 10 * impact_samples && seen < impact_samples; ++attempt) {
    const auto s = state_on(function);
    if (!s) continue;
    const Bindings before = bindings(*s);
    Bindings after = before;
    for (const auto& [symbol, value] : sets) after[symbol] = evaluate(value, before);
    const double change = relative_change(integral, before, after);
    if (!std::isfinite(change)) continue;
    ++seen;
    out = std::max(out.value_or(0), change);
  }
  return out;
}

AtSets::AtSets(const Model& model, const EquationsOfMotion& equations, const MotionState& start)
    : impl_(std::make_unique<Impl>(model, equations, start)) {}
AtSets::~AtSets() = default;

IntegralThroughModes::AtEvent AtSets::at(const ModelEvent& event, Expr integral) {
  IntegralThroughModes::AtEvent out{event.name, Holds::Undecided, 0};
  const Expr f = impl_->plain(integral), function = impl_->plain(event.function);
  ExprMap sets;
  for (const ModelEvent::Assignment& a : event.sets) {
    const Coordinate& c = impl_->system.coordinates[a.coordinate];
    sets[a.order == 0 ? c.q : c.velocity] = impl_->plain(a.value);
  }
  if (vanishes_identically(substitute(f, sets) - f)) {
    out.kept = Holds::Yes;
    return out;
  }
  if (!impl_->is_of_the_state(function) || !impl_->is_of_the_state(f)) return out;
  const auto change = impl_->largest_change(function, sets, f);
  if (!change) return out;
  out.change = *change;
  out.kept = *change <= rounding ? Holds::Yes : Holds::No;
  return out;
}

}  // namespace maupertuis::invariants

#include "analysis/orbits/drive.hpp"

#include <maupertuis/transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace maupertuis::orbits {
namespace {

constexpr double same_acceleration = 1e-9;  // of the largest one
constexpr int largest_ratio = 60;           // of frequencies whose common period is looked for

ExprVector of_motion(const EquationsOfMotion& equations) {
  const KernelSource source = motion_source(equations);
  ExprVector out = source.residual;
  for (const KernelConstraint& c : source.constraints) out.push_back(c.value);
  return expand_time_derivatives(out);
}

/// The rates ∂(argument)/∂t of sines and cosines; nothing where one is not constant.
std::optional<std::vector<double>> frequencies(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  const Bindings values = parameter_bindings(system);
  std::vector<double> out;
  for (const Expr& node : topological_order(of_motion(equations))) {
    if (!node.is(Kind::Sin) && !node.is(Kind::Cos)) continue;
    const Expr rate = differentiate(node[0], system.context->time());
    if (rate.is_zero()) continue;
    if (system.context->depends_on_time(rate.id())) return std::nullopt;
    out.push_back(std::abs(evaluate(rate, values)));
  }
  return out;
}

/// The state, and one beside it: on the motion itself the force may vanish at all times, as it does at an equilibrium.
std::array<MotionState, 2> places_at(const MotionState& state, const std::vector<double>& sizes) {
  MotionState beside = state;
  for (std::size_t i = 0; i < state.q.size(); ++i)
    beside.q[i] += 0.1 * sizes[i], beside.v[i] += 0.1 * sizes[state.q.size() + i];
  return {state, beside};
}

bool repeats(const MotionKernel& motion, const Survey& seen, const std::function<void(MotionState&)>& move) {
  KernelWorkspace work(motion.kernel, 1);
  work.set_parameters(motion.parameters);
  const auto accelerations = [&](const MotionState& s) {
    std::vector<double> a;
    if (work.evaluate(s.t, s.q, s.v) != KernelStatus::Ok) return a;
    for (std::size_t i = 0; i < s.q.size(); ++i) a.push_back(work.acceleration(i));
    return a;
  };
  const std::size_t n = motion.kernel.freedoms(), stride = std::max<std::size_t>(1, seen.states.size() / 32);
  std::vector<double> largest(n, 0.0), difference(n, 0.0);
  for (std::size_t k = 0; k < seen.states.size(); k += stride)
    for (const MotionState& here : places_at(seen.states[k], seen.sizes)) {
      MotionState moved = here;
      move(moved);
      const auto a = accelerations(here), b = accelerations(moved);
      if (a.empty() != b.empty()) return false;
      if (a.empty()) continue;
      for (std::size_t i = 0; i < n; ++i) {
        largest[i] = std::max(largest[i], std::abs(a[i]));
        difference[i] = std::max(difference[i], std::abs(a[i] - b[i]));
      }
    }
  for (std::size_t i = 0; i < n; ++i)
    if (!(difference[i] <= same_acceleration * largest[i])) return false;
  return true;
}

}  // namespace

bool depends_on_time(const EquationsOfMotion& equations) {
  const auto symbols = symbols_of(of_motion(equations));
  return std::any_of(symbols.begin(), symbols.end(), [](const Expr& e) { return e.role() == Role::Time; });
}

std::optional<double> period_of_drive(const EquationsOfMotion& equations) {
  const auto rates = frequencies(equations);
  if (!rates || rates->empty()) return std::nullopt;
  const double slowest = *std::min_element(rates->begin(), rates->end());
  if (!(slowest > 0)) return std::nullopt;
  for (int k = 1; k <= largest_ratio; ++k) {
    const bool fits = std::all_of(rates->begin(), rates->end(), [&](double w) {
      const double turns = k * w / slowest;
      return std::abs(turns - std::round(turns)) < 1e-9 * turns;
    });
    if (fits) return k * 2 * std::numbers::pi / slowest;
  }
  return std::nullopt;
}

bool repeats_in_time(const MotionKernel& motion, const Survey& seen, double period) {
  return repeats(motion, seen, [period](MotionState& s) { s.t += period; });
}

bool repeats_in_angle(const MotionKernel& motion, const Survey& seen, std::size_t coordinate) {
  return repeats(motion, seen, [coordinate](MotionState& s) { s.q[coordinate] += 2 * std::numbers::pi; });
}

}  // namespace maupertuis::orbits

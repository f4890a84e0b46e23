#include "analysis/orbits/drive.hpp"

#include "analysis/linearization/free_of_time.hpp"
#include "analysis/tangent/point_functions.hpp"

#include <maupertuis/transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <unordered_set>

namespace maupertuis::orbits {
namespace {

constexpr double same_acceleration = 1e-9;  // of the largest one
constexpr int largest_ratio = 60;           // of frequencies whose common period is looked for

/// Gaps, slip velocities and coefficients of friction.
ExprVector of_contacts(const MechanicalSystem& system) {
  ExprVector out;
  const auto add = [&](const Friction& f) {
    if (!f.present()) return;
    out.insert(out.end(), f.slip.begin(), f.slip.end());
    for (const Expr& e : {f.kinetic, f.static_, f.normal})
      if (e) out.push_back(e);
  };
  for (const Contact& c : system.contacts) {
    out.push_back(c.gap);
    out.push_back(c.restitution);
    add(c.friction);
  }
  for (const Friction& f : system.frictions) add(f);
  return in_terms_of_motion(system, out);
}

ExprVector of_motion(const EquationsOfMotion& equations) {
  const KernelSource source = motion_source(equations);
  ExprVector out = source.residual;
  for (const KernelConstraint& c : source.constraints) out.push_back(c.value);
  const ExprVector contacts = of_contacts(*equations.system);
  out.insert(out.end(), contacts.begin(), contacts.end());
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

/// Whether gaps and slip velocities are the same there: values and rates of those along the motion and beside it.
bool contacts_repeat(const MechanicalSystem& system, const Survey& seen,
                     const std::function<void(MotionState&)>& move) {
  if (!system.has_modes()) return true;
  ExprVector functions;
  for (const Contact& c : system.contacts) {
    functions.push_back(c.gap);
    functions.insert(functions.end(), c.friction.slip.begin(), c.friction.slip.end());
  }
  for (const Friction& f : system.frictions) functions.insert(functions.end(), f.slip.begin(), f.slip.end());
  const tangent::PointFunctions at(system, functions);
  const std::size_t stride = std::max<std::size_t>(1, seen.states.size() / 32);
  std::vector<double> largest(functions.size(), 0.0), difference(functions.size(), 0.0);
  for (std::size_t k = 0; k < seen.states.size(); k += stride)
    for (const MotionState& here : places_at(seen.states[k], seen.sizes)) {
      MotionState moved = here;
      move(moved);
      const auto a = at.values(here), b = at.values(moved);
      for (std::size_t i = 0; i < a.size(); ++i) {
        largest[i] = std::max(largest[i], std::abs(a[i]));
        difference[i] = std::max(difference[i], std::abs(a[i] - b[i]));
      }
    }
  for (std::size_t i = 0; i < largest.size(); ++i)
    if (!(difference[i] <= same_acceleration * largest[i])) return false;
  return true;
}

/// Accelerations on the side of each switch on which a state is. None: an acceleration has no value. `undecided`: a
/// switch is so near that rounding, or a little time, decides.
struct AccelerationsAt {
  std::vector<double> values;
  bool undecided = false;
};
AccelerationsAt accelerations_at(KernelWorkspace& work, const Kernel& kernel, const MotionState& s, double duration) {
  const std::size_t count = kernel.switches().size();
  std::vector<std::int8_t> sides(count, 1), before;
  KernelStatus status = KernelStatus::NonFinite;
  for (std::size_t pass = 0; pass <= count && (pass == 0 || sides != before); ++pass) {  // those within others first
    before = sides;
    work.set_branches(sides);
    status = work.evaluate(s.t, s.q, s.v);
    for (std::size_t i = 0; i < count; ++i) sides[i] = work.switch_function(i, 0) < 0 ? -1 : 1;
  }
  AccelerationsAt out;
  for (std::size_t i = 0; i < count; ++i) {
    const double reach = work.switch_scale(i) + std::abs(work.switch_function(i, 1) * duration);
    out.undecided = out.undecided || !(std::abs(work.switch_function(i, 0)) > same_acceleration * reach);
  }
  for (std::size_t i = 0; status == KernelStatus::Ok && i < s.q.size(); ++i) out.values.push_back(work.acceleration(i));
  return out;
}

/// `signs` [n]: what the accelerations at the moved state are multiplied by before they are compared.
bool repeats(const MechanicalSystem& system, const MotionKernel& motion, const Survey& seen,
             const std::function<void(MotionState&)>& move, const std::vector<double>& signs) {
  KernelWorkspace work(motion.kernel, 1);
  work.set_parameters(motion.parameters);
  const double duration = seen.states.back().t - seen.states.front().t;
  const std::size_t n = motion.kernel.freedoms(), stride = std::max<std::size_t>(1, seen.states.size() / 32);
  std::vector<double> largest(n, 0.0), difference(n, 0.0);
  for (std::size_t k = 0; k < seen.states.size(); k += stride)
    for (const MotionState& here : places_at(seen.states[k], seen.sizes)) {
      MotionState moved = here;
      move(moved);
      const auto [a, undecided] = accelerations_at(work, motion.kernel, here, duration);
      const auto [b, then_undecided] = accelerations_at(work, motion.kernel, moved, duration);
      if (undecided || then_undecided) continue;
      if (a.empty() != b.empty()) return false;
      if (a.empty()) continue;
      for (std::size_t i = 0; i < n; ++i) {
        largest[i] = std::max(largest[i], std::abs(a[i]));
        difference[i] = std::max(difference[i], std::abs(a[i] - signs[i] * b[i]));
      }
    }
  for (std::size_t i = 0; i < n; ++i)
    if (!(difference[i] <= same_acceleration * largest[i])) return false;
  return contacts_repeat(system, seen, move);
}

}  // namespace

bool depends_on_time(const EquationsOfMotion& equations) {
  return !free_of_time(of_motion(equations), *equations.system);
}

bool keeps_energy(const Model& model, const EquationsOfMotion& equations) {
  const MechanicalSystem& system = model.system;
  if (!conserved_quantities(equations).energy_conserved || !system.frictions.empty()) return false;
  const auto& events = model.experiment.events;
  if (std::any_of(events.begin(), events.end(),
                  [](const ModelEvent& e) { return e.action == ModelEvent::Action::Set; }))
    return false;
  const Bindings values = parameter_bindings(system);
  return std::all_of(system.contacts.begin(), system.contacts.end(), [&](const Contact& c) {
    const Expr gap = expand_time_derivatives(in_terms_of_motion(system, {&c.gap, 1})).front();
    const Expr restitution = in_terms_of_motion(system, {&c.restitution, 1}).front();
    return !c.friction.present() && differentiate(gap, system.context->time()).is_zero() &&
           evaluate(restitution, values) == 1;
  });
}

bool bounces_end(const MechanicalSystem& system) {
  const Bindings values = parameter_bindings(system);
  return std::all_of(system.contacts.begin(), system.contacts.end(), [&](const Contact& c) {
    return evaluate(in_terms_of_motion(system, {&c.restitution, 1}).front(), values) < 1;
  });
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

bool stands_in_waves_alone(const EquationsOfMotion& equations) {
  const Expr time = equations.system->context->time();
  std::unordered_set<NodeId> outside;  // what holds t beside sines and cosines
  const ExprVector roots = of_motion(equations);
  for (const Expr& node : topological_order(roots)) {
    bool holds = node == time;
    for (std::size_t i = 0; i < node.size() && !node.is(Kind::Sin) && !node.is(Kind::Cos); ++i)
      holds = holds || outside.count(node[i].id()) != 0;
    if (holds) outside.insert(node.id());
  }
  return std::none_of(roots.begin(), roots.end(), [&](const Expr& e) { return outside.count(e.id()) != 0; });
}

bool repeats_in_time(const MechanicalSystem& system, const MotionKernel& motion, const Survey& seen, double period,
                     int periods) {
  const std::vector<double> same(system.coordinates.size(), 1.0);
  for (int k = 1; k <= periods; ++k)
    if (!repeats(
            system, motion, seen, [period, k](MotionState& s) { s.t += k * period; }, same))
      return false;
  return true;
}

bool repeats_in_angle(const MechanicalSystem& system, const MotionKernel& motion, const Survey& seen,
                      std::size_t coordinate) {
  return repeats(
      system, motion, seen, [coordinate](MotionState& s) { s.q[coordinate] += 2 * std::numbers::pi; },
      std::vector<double>(system.coordinates.size(), 1.0));
}

bool repeats_with_other_sign(const MechanicalSystem& system, const MotionKernel& motion, const Survey& seen,
                             const std::array<std::size_t, 4>& quaternion) {
  std::vector<double> signs(system.coordinates.size(), 1.0);
  for (const std::size_t i : quaternion) signs[i] = -1;
  const auto turn = [&quaternion](MotionState& s) {
    for (const std::size_t i : quaternion) s.q[i] = -s.q[i], s.v[i] = -s.v[i];
  };
  return repeats(system, motion, seen, turn, signs);
}

}  // namespace maupertuis::orbits

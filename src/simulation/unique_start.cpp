#include "simulation/unique_start.hpp"

#include "simulation/run_plan.hpp"

#include <maupertuis/contact_mode.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/size_of_terms.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis {
namespace {

bool is_root(Expr e) {
  if (!e.is(Kind::Power) || !e[1].is(Kind::Number)) return false;
  const double exponent = e[1].number().to_double();
  return exponent > 0 && exponent < 1;
}

class StartOnRoots {
 public:
  StartOnRoots(const EquationsOfMotion& equations, const RunPlan& plan)
      : system_(*equations.system), plan_(plan), motion_(free_motion_kernel(equations)), work_(motion_.kernel, 2) {
    work_.set_parameters(motion_.parameters);
    at_ = parameter_bindings(system_);
    at_[system_.context->time()] = plan.begin;
    for (std::size_t i = 0; i < plan.q.size(); ++i) {
      at_[system_.coordinates[i].q] = plan.q[i];
      at_[system_.coordinates[i].velocity] = plan.v[i];
      at_[system_.coordinates[i].acceleration] = 0;
    }
  }

  /// Of the coordinates of a root that vanishes at the start one that may leave by itself.
  std::optional<std::size_t> leaves(Expr root) {
    const std::vector<Expr> symbols = symbols_of({&root, 1});
    if (std::any_of(symbols.begin(), symbols.end(), [&](Expr s) { return at_.count(s) == 0; })) return std::nullopt;
    constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();
    const Expr base = root[0];
    if (!(std::abs(evaluate(base, at_)) <= rounding * evaluate(size_of_terms(base), at_))) return std::nullopt;
    for (std::size_t i = 0; i < plan_.q.size(); ++i)
      if (std::find(symbols.begin(), symbols.end(), system_.coordinates[i].q) != symbols.end())
        if (stays(i) && (is_driven_away(i, 1) || is_driven_away(i, -1))) return i;
    return std::nullopt;
  }

 private:
  /// NaN where there is none.
  double acceleration(std::size_t i, double t, const std::vector<double>& q, const std::vector<double>& v) {
    const bool has_values = work_.choose_branches(t, q, v) && work_.evaluate(t, q, v) == KernelStatus::Ok;
    return has_values ? work_.acceleration(i) : std::numeric_limits<double>::quiet_NaN();
  }

  /// It rests, and goes on to while the others move as they do.
  bool stays(std::size_t i) {
    if (plan_.v[i] != 0) return false;
    std::vector<double> rates(plan_.q.size());
    for (std::size_t k = 0; k < rates.size(); ++k) rates[k] = acceleration(k, plan_.begin, plan_.q, plan_.v);
    constexpr double none = 1e-12;
    for (const double later : {0.0, 1e-3, 1e-2}) {
      std::vector<double> q = plan_.q, v = plan_.v;
      for (std::size_t k = 0; k < q.size(); ++k)
        if (k != i) q[k] += later * (v[k] + later / 2 * rates[k]), v[k] += later * rates[k];
      if (!(std::abs(acceleration(i, plan_.begin + later, q, v)) <= none)) return false;
    }
    return true;
  }

  /// Acceleration and displacement have one sign, and their quotient grows without end as both go to 0.
  bool is_driven_away(std::size_t i, double side) {
    constexpr double grows = 1.2;  // from one displacement to the next, a thousandth of it: as a power of 0.97
    double before = 0;
    for (double away = 1e-3; away > 1e-13; away *= 1e-3) {
      std::vector<double> q = plan_.q;
      q[i] += side * away;
      const double quotient = side * acceleration(i, plan_.begin, q, plan_.v) / away;
      if (!(quotient > 0 && quotient > grows * before)) return false;
      before = quotient;
    }
    return true;
  }

  const MechanicalSystem& system_;
  const RunPlan& plan_;
  MotionKernel motion_;
  KernelWorkspace work_;
  Bindings at_;
};

}  // namespace

bool start_has_one_motion(const Model& model, const EquationsOfMotion& equations, const RunPlan& plan,
                          Diagnostics& diagnostics) {
  if (model.system.has_modes()) return true;
  const ExprVector rows = expand_time_derivatives(equations.balance());
  std::vector<Expr> roots = topological_order(rows);
  std::erase_if(roots, [](Expr e) { return !is_root(e); });
  if (roots.empty()) return true;
  StartOnRoots start(equations, plan);
  for (const Expr& root : roots) {
    const auto i = start.leaves(root);
    if (!i) continue;
    const Coordinate& c = model.system.coordinates[*i];
    diagnostics.error(
        "E0735", c.span,
        fmt::format("the motion from this start is not the only one: {} may leave at any time", c.name),
        fmt::format("{} rests, and beside {} = {:g} the force away from there grows as a power below 1 of the "
                    "displacement, which has no finite derivative. Rest for ever obeys the equations, and so does a "
                    "motion that begins by itself after any time.",
                    c.name, c.name, plan.q[*i]),
        "Start beside that place or with a velocity, or round the power: (s^2 + a^2)^(1/4) for sqrt(s).");
    return false;
  }
  return true;
}

}  // namespace maupertuis

#include "kernel/workspace/workspace.hpp"

#include "kernel/program/point_orders.hpp"

#include <maupertuis/require.hpp>

#include <algorithm>
#include <array>
#include <limits>

/// The structured Taylor step (docs/design/kernel_program.md). Stage k finds q_{k+2}: with it set to 0 the residual is
/// evaluated at order k, M₀ q̈_k = −R_k gives the acceleration, and every coefficient that later orders read is
/// corrected by its derivative in the direction of q̈_k, which is that of order 0 up to a factor.
namespace maupertuis {

using workspace::StageSolver;

KernelWorkspace::Impl::Impl(const Kernel& kernel, int order)
    : expansion(kernel, order),
      solver(expansion, in_code),
      along(expansion.program),
      at_point(expansion.program),
      corrects_points(outputs_follow_accelerations()),
      points_are_unrolled(are_points_unrolled(expansion.program)),
      tiers(expansion.packed) {}

/// Whether an output at a point, or what it is computed from after the solve, is corrected in row 0.
bool KernelWorkspace::Impl::outputs_follow_accelerations() const {
  const Program& program = expansion.program;
  const auto follows = [&](Slot slot) {
    return slot != no_slot && slot >= program.unknowns && program.tangent_lags[slot] == 2;
  };
  for (const auto* slots : {&program.switch_slots, &program.events, &program.observables, &program.integrands,
                            &program.constraint_values, &program.constraint_rates})
    if (std::any_of(slots->begin(), slots->end(), follows)) return true;
  return !program.runs[Along].empty() || at_point.follows_acceleration();
}

KernelStatus KernelWorkspace::Impl::run(double t, std::span<const double> q, std::span<const double> v, int stages) {
  workspace::Expansion& x = expansion;
  MAUP_REQUIRE(q.size() == x.program.freedoms && v.size() == x.program.freedoms);
  if (x.compute_constants()) solver.constants_changed();
  x.last_stage = stages - 1;
  along.begin(stages == 1);
  solver.begin(stages == 1 && !corrects_points);
  observed = at_point.empty();
  if (x.program.time != no_slot) x.memory.row(0)[x.program.time] = t;
  double *const position = x.memory.row(0), *const velocity = x.memory.row(1);
  for (std::size_t i = 0; i < q.size(); ++i) position[i] = q[i], velocity[i] = v[i];
  if (run_unrolled(q, v, stages)) return KernelStatus::Ok;
  run_first_stages(0);
  if (const auto status = solver.factor(stages); status != KernelStatus::Ok) return without_solution(status);
  for (int stage = 0; stage < stages; ++stage) {
    if (stage > 0 && runs_on()) return run_later_stages(stages) ? KernelStatus::Ok : KernelStatus::NonFinite;
    if (stage == 0 || !solver.solve_directly(stage, [&] { run_stage(stage); }))
      if (const auto status = run_step_by_step(stage); status != KernelStatus::Ok)
        return stage > 0 ? status : without_solution(status);
    if (!in_code.code.later || !runs_on()) renew_blocks(stage, stages);
    run_along(stage);
  }
  const bool has_looked = solver.later() == StageSolver::LaterStages::StepByStep;
  return has_looked || solver.are_coefficients_finite(stages) ? KernelStatus::Ok : KernelStatus::NonFinite;
}

/// Unrolled code. False: there is none for this, or its results are not to be trusted.
bool KernelWorkspace::Impl::run_unrolled(std::span<const double> q, std::span<const double> v, int stages) {
  workspace::Expansion& x = expansion;
  if (!in_code.code.expand || stages != x.order) return false;
  if (auto better = tiers.next()) adopt(std::move(*better));
  std::array<double, 8> scratch;
  in_code.code.expand(x.memory.rows.data(), q.data(), v.data(), x.lane_coefficients.data(), x.memory.constants.data(),
                      scratch.data());
  if (!straight::sound(scratch.data())) return false;
  const bool is_over = along.ends_at_first();
  observed = observed || points_are_unrolled;
  if (along.empty()) return true;
  for (int stage = x.program.first_stage; stage < (is_over ? 1 : stages); ++stage) run_along(stage);
  return true;
}

/// Up to 0, with these unknowns in the place of its solution.
void KernelWorkspace::Impl::run_first_stages(double unknowns) {
  workspace::Expansion& x = expansion;
  std::fill_n(x.memory.row(2), x.padded_unknowns(), unknowns);
  const auto first = in_code.code.first;
  if (first) first(&in_code.arguments);
  for (int stage = x.program.first_stage; stage <= 0; ++stage) {
    if (!first) {
      x.engine.run_stage(x.tables, stage);
      if (stage < 0) x.engine.renew_blocks(x.tables, stage);
    }
    if (stage < 0) run_along(stage);
  }
}

/// Switch functions have values where forces have none, and tell the sides on which these have: log|x| on the wrong
/// side of 0.
KernelStatus KernelWorkspace::Impl::without_solution(KernelStatus status) {
  along.run(expansion.memory, 0);
  return status;
}

/// With a look at the solution before it is used.
KernelStatus KernelWorkspace::Impl::run_step_by_step(int stage) {
  in_code.arguments.has_copies = 0;
  if (stage > 0) run_stage(stage);
  return solver.solve_and_look(stage);
}

/// Whether all stages from 1 on run in one go.
bool KernelWorkspace::Impl::runs_on() const {
  return solver.later() == StageSolver::LaterStages::ByInverse &&
         (!in_code.code.stage || (in_code.code.later && along.ends_at_first()));
}

/// False: a q̈ is not finite.
bool KernelWorkspace::Impl::run_later_stages(int stages) {
  if (in_code.code.later) return in_code.code.later(&in_code.arguments, stages) == 1;
  const workspace::Expansion& x = expansion;
  const packed::InverseSolution solution = solver.inverse_for_engine();
  if (along.ends_at_first()) return x.engine.run_stages_by_inverse(x.tables, solution, 1, stages, false);
  bool finite = true;
  for (int stage = 1; stage < stages; ++stage) {
    finite &= x.engine.run_stages_by_inverse(x.tables, solution, stage, stage + 1, stage + 1 < stages);
    run_along(stage);
  }
  return finite;
}

/// From 1 on, with q_{k+2} = 0.
void KernelWorkspace::Impl::run_stage(int stage) {
  if (in_code.code.stage) return in_code.code.stage(&in_code.arguments, stage);
  expansion.engine.run_stage(expansion.tables, stage);
}

/// What no stage follows needs no copies.
void KernelWorkspace::Impl::renew_blocks(int stage, int stages) {
  if (stage + 1 >= stages) return;
  if (in_code.code.stage)
    in_code.code.ahead(&in_code.arguments, stage);
  else
    expansion.engine.renew_blocks(expansion.tables, stage);
}

/// Increments of the code before may still be asked for.
void KernelWorkspace::Impl::adopt(workspace::ExpansionCode code) {
  tiers.retire(in_code.code.memory);
  in_code.adopt(std::move(code), expansion);
  solver.adopt_code();
}

/// What follows the solution of a stage.
void KernelWorkspace::Impl::run_along(int stage) { along.run(expansion.memory, stage); }

/// Observables, once they are asked for: not each step of a run is looked at.
void KernelWorkspace::Impl::observe() {
  if (std::exchange(observed, true)) return;
  for (int stage = expansion.program.first_stage; stage <= 0; ++stage) at_point.run(expansion.memory, stage);
}

// ------------------------------------------------------------------------------------------------------- the workspace

KernelWorkspace::KernelWorkspace(const Kernel& kernel, int order) : impl_(std::make_unique<Impl>(kernel, order)) {
  MAUP_REQUIRE(order >= 1);
}

KernelWorkspace::~KernelWorkspace() = default;
KernelWorkspace::KernelWorkspace(KernelWorkspace&&) noexcept = default;

CompileReport KernelWorkspace::compile(const CompileOptions& options) {
  Impl& s = *impl_;
  if (s.expansion.unknowns == 0) return {.trouble = "there are no coordinates, and so no equations to compile"};
  s.solver.compile(options);
  constexpr std::size_t most_in_tiers = 8;  // beyond, quickly compiled code is as slow as that of a stage
  CompileOptions wanted = options;
  wanted.in_tiers = options.in_tiers && options.long_run && s.expansion.unknowns <= most_in_tiers;
  auto [code, report] = s.tiers.first(s.expansion.order, s.expansion.memory.stride, wanted);
  if (code.memory) s.adopt(std::move(code));
  return report;
}

void KernelWorkspace::set_parameters(std::span<const double> values) {
  workspace::Expansion& x = impl_->expansion;
  MAUP_REQUIRE(values.size() == x.parameters.size());
  x.parameters.assign(values.begin(), values.end());
  x.known_constants.clear();
  x.stale = true;
}

void KernelWorkspace::set_usual_accelerations(std::span<const double> accelerations) {
  impl_->solver.set_usual_accelerations(accelerations);
}

void KernelWorkspace::set_branches(std::span<const std::int8_t> sides) {
  workspace::Expansion& x = impl_->expansion;
  MAUP_REQUIRE(sides.size() == x.sides.size());
  x.stale = x.stale || !std::equal(sides.begin(), sides.end(), x.sides.begin());
  x.sides.assign(sides.begin(), sides.end());
}

/// Functions within others come to their sides first.
bool KernelWorkspace::choose_branches(double t, std::span<const double> q, std::span<const double> v) {
  std::vector<std::int8_t> sides = impl_->expansion.sides;
  bool changed = !sides.empty(), defined = true;
  for (std::size_t pass = 0; changed && pass <= sides.size(); ++pass) {
    static_cast<void>(evaluate(t, q, v));
    changed = false, defined = true;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const double value = switch_function(i, 0);
      const auto side = static_cast<std::int8_t>((value > 0) - (value < 0));
      changed = changed || side != sides[i];
      defined = defined && !std::isnan(value);
      sides[i] = side;
    }
    set_branches(sides);
  }
  return defined;
}

std::span<const std::int8_t> KernelWorkspace::branches() const { return impl_->expansion.sides; }

KernelStatus KernelWorkspace::expand(double t, std::span<const double> q, std::span<const double> v) {
  return impl_->run(t, q, v, impl_->expansion.order);
}

KernelStatus KernelWorkspace::evaluate(double t, std::span<const double> q, std::span<const double> v) {
  return impl_->run(t, q, v, 1);
}

void KernelWorkspace::observe_without_solution() {
  impl_->run_first_stages(std::numeric_limits<double>::quiet_NaN());
  impl_->at_point.run(impl_->expansion.memory, 0);
  impl_->observed = true;
}

}  // namespace maupertuis

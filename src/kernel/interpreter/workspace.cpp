#include "kernel/interpreter/workspace.hpp"

#include "kernel/packed/convolutions.hpp"

#include <maupertuis/require.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

/// The structured Taylor step (docs/design/kernel_program.md). Stage k finds q_{k+2}: with it set to 0 the residual is
/// evaluated at order k, M₀ q̈_k = −R_k gives the acceleration, and every coefficient that later orders read is
/// corrected by its derivative in the direction of q̈_k, which is that of order 0 up to a factor.
namespace maupertuis {

/// The engine's view of this workspace.
void KernelWorkspace::Impl::bind() {
  tables.packs = packed.packs.data();
  tables.pack_count = packed.packs.size();
  tables.blocks = packed.blocks.data();
  tables.columns = packed.columns.data();
  tables.products = packed.products.data();
  tables.functions = packed.functions.data();
  tables.runs = packed.runs.data();
  tangents = {tangent.data(), memory.stride, unknowns, static_cast<Slot>(padded_unknowns()), {}};
  std::copy_n(program.stored_end.begin(), tangents.end.size(), tangents.end.begin());
  tables.rows = memory.rows.data();
  tables.stride = memory.stride;
  tables.unknowns = unknowns;
  of_orders = packed::orders_of(memory.rows.data(), memory.stride, orders);
  const int before_all = -2 - program.first_stage;  // so that stages without an order of lag 0 find their place
  of_orders.insert(of_orders.begin(), static_cast<std::size_t>(before_all), {});
  tables.orders = of_orders.data() + before_all;
  tables.scalar.context = this;
  tables.scalar.value = [](void* self, std::uint32_t instruction, int at) {
    interpreter::run_instruction(static_cast<Impl*>(self)->memory, instruction, at);
  };
  tables.scalar.tangent = [](void* self, std::uint32_t instruction, double* values) {
    interpreter::tangents<1>(static_cast<Impl*>(self)->memory, values, {&instruction, 1});
  };
  lane_coefficients.resize(packed.coefficients.size());
  tables.coefficients = lane_coefficients.data();
  if (adds_up_ahead()) sums.assign(packed::count_convolutions(packed) * packed::rolled_group * packed::lanes, 0.0);
  tables.has_sums = !sums.empty();
  ready.emplace(packed, packed::Numbers{memory.rows.data(), memory.stride, lane_coefficients.data(), tables.has_sums ? sums.data() : nullptr});
  tables.ready = ready->packs.data();
  tables.copies = ready->copies.data();
  tables.copy_count = ready->copies.size();
  tables.convolution_runs = ready->convolution_runs.data();
  tables.convolution_run_count = ready->convolution_runs.size();
}

void KernelWorkspace::Impl::compute_constants() {
  if (!stale) return;
  interpreter::compute_constants(memory, parameters, sides);
  for (std::size_t i = 0; i < lane_coefficients.size(); ++i) lane_coefficients[i] = memory.constants[packed.coefficients[i]];
  if (lifted) lifted->set_constants(memory);
  has_probe = false;
  stale = false;
}

void KernelWorkspace::Impl::find_tangents(std::size_t directions) {
  if (!compiled.tangents) return engine.tangents(tables, tangent.data(), memory.stride, directions);
  for (std::size_t d = 0; d < directions; ++d) compiled.tangents(&arguments, tangent.data() + d * memory.stride);
}

/// Whether an output at a point, or what it is computed from after the solve, is corrected in row 0.
bool KernelWorkspace::Impl::outputs_follow_accelerations() const {
  const auto follows = [this](Slot slot) { return slot != no_slot && slot >= unknowns && program.tangent_lags[slot] == 2; };
  for (const auto* slots : {&program.switch_slots, &program.events, &program.observables, &program.integrands,
                            &program.constraint_values, &program.constraint_rates})
    if (std::any_of(slots->begin(), slots->end(), follows)) return true;
  return !program.runs[Along].empty() || at_point.follows_acceleration();
}

KernelStatus KernelWorkspace::Impl::run(double t, std::span<const double> q, std::span<const double> v, int stages) {
  MAUP_REQUIRE(q.size() == program.freedoms && v.size() == program.freedoms);
  compute_constants();
  last_stage = stages - 1;
  alone = stages == 1 && !corrects_points;
  if (program.time != no_slot) memory.row(0)[program.time] = t;
  double *const position = memory.row(0), *const velocity = memory.row(1);
  for (std::size_t i = 0; i < q.size(); ++i) position[i] = q[i], velocity[i] = v[i];
  arguments.q = q.data(), arguments.v = v.data();
  if (run_compiled(stages)) return KernelStatus::Ok;
  run_first_stages();
  if (const auto status = factor(stages); status != KernelStatus::Ok) return without_solution(status);
  for (int stage = 0; stage < stages; ++stage) {
    if (stage > 0 && runs_on()) return run_later_stages(stages) ? KernelStatus::Ok : KernelStatus::NonFinite;
    if (stage == 0 || !run_directly(stage))
      if (const auto status = run_step_by_step(stage); status != KernelStatus::Ok) return stage > 0 ? status : without_solution(status);
    if (!compiled.later || !runs_on()) renew_blocks(stage, stages);
    run_along(stage);
  }
  return later != LaterStages::StepByStep && !are_coefficients_finite(stages) ? KernelStatus::NonFinite : KernelStatus::Ok;
}

/// Up to 0, but for its solution.
void KernelWorkspace::Impl::run_first_stages() {
  std::fill_n(memory.row(2), padded_unknowns(), 0.0);
  if (compiled.first) compiled.first(&arguments);
  for (int stage = program.first_stage; stage <= 0; ++stage) {
    if (!compiled.first) {
      engine.run_stage(tables, stage);
      if (stage < 0) engine.renew_blocks(tables, stage);
    }
    if (stage < 0) run_along(stage);
  }
}

/// Switch functions have values where forces have none, and tell the sides on which these have: log|x| on the wrong side of 0.
KernelStatus KernelWorkspace::Impl::without_solution(KernelStatus status) {
  if (!program.runs[Along].empty()) interpreter::run_section(memory, Along, 0);
  return status;
}

/// With a look at the solution before it is used.
KernelStatus KernelWorkspace::Impl::run_step_by_step(int stage) {
  arguments.has_copies = 0;
  if (stage > 0) run_stage(stage);
  if (const auto status = solve(stage); status != KernelStatus::Ok) return status;
  if (stage == 0 && !constraints_agree()) return KernelStatus::Contradiction;
  set_accelerations(stage, solution.data(), 1);
  if (!alone) correct(stage);
  return KernelStatus::Ok;
}

/// False: nothing is done, the stage has to be run step by step.
bool KernelWorkspace::Impl::run_directly(int stage) {
  if (later == LaterStages::StepByStep || (later == LaterStages::ByLifting && !(by_lifting && lifted->is_direct(stage)))) return false;
  run_stage(stage);
  if (later == LaterStages::ByInverse) {
    arguments.has_copies = 0;
    compiled.solve(&arguments, stage);
    return true;
  }
  arguments.tangents = lifted->solve_row(memory.row(stage));
  if (compiled.correct) {
    arguments.has_copies = lifted->solves_for_copies();
    compiled.correct(&arguments, stage);
  } else {
    set_accelerations(stage, arguments.tangents, -1);
    correct(stage, arguments.tangents, -1);
  }
  return true;
}

/// Whether all stages from 1 on run in one go.
bool KernelWorkspace::Impl::runs_on() const {
  return later == LaterStages::ByInverse && (!compiled.stage || (compiled.later && program.runs[Along].empty()));
}

/// False: a q̈ is not finite.
bool KernelWorkspace::Impl::run_later_stages(int stages) {
  if (compiled.later) return compiled.later(&arguments, stages) == 1;
  const packed::InverseSolution solution{inverse.data(), program.residual.data(), residual_side_by_side, tangents, own.data(), answers.data()};
  if (program.runs[Along].empty()) return engine.run_stages_by_inverse(tables, solution, 1, stages, false);
  bool finite = true;
  for (int stage = 1; stage < stages; ++stage) {
    finite &= engine.run_stages_by_inverse(tables, solution, stage, stage + 1, stage + 1 < stages);
    run_along(stage);
  }
  return finite;
}

/// From 1 on, with q_{k+2} = 0.
void KernelWorkspace::Impl::run_stage(int stage) {
  if (compiled.stage) return compiled.stage(&arguments, stage);
  engine.run_stage(tables, stage);
}

/// What no stage follows needs no copies, and no sums.
void KernelWorkspace::Impl::renew_blocks(int stage, int stages) {
  if (stage + 1 >= stages) return;
  if (compiled.stage) compiled.ahead(&arguments, stage);
  else engine.renew_blocks(tables, stage);
  if (!compiled.stage && tables.has_sums) engine.add_up_ahead(tables, stage);
}

/// What follows the solution of a stage.
void KernelWorkspace::Impl::run_along(int stage) {
  if (!program.runs[Along].empty()) interpreter::run_section(memory, Along, stage);
  if (stage <= 0) at_point.run(memory, stage);
}

/// False: there is no code for this, or its results are not to be trusted.
bool KernelWorkspace::Impl::run_compiled(int stages) {
  if (!compiled.expand || stages != order || compiled.expand(&arguments) != 0) return false;
  has_full = false;
  if (program.runs[Along].empty() && at_point.empty()) return true;
  const int last = program.runs[Along].empty() ? 1 : stages;
  for (int stage = program.first_stage; stage < last; ++stage) run_along(stage);
  return true;
}

double KernelWorkspace::Impl::coefficient(Slot slot, int k) const {
  return k <= last_stage + 2 - program.lags[slot] && k < orders ? memory.row(k)[slot] : 0.0;
}

KernelWorkspace::KernelWorkspace(const Kernel& kernel, int order) : impl_(std::make_unique<Impl>(kernel, order)) {
  MAUP_REQUIRE(order >= 1);
}

KernelWorkspace::~KernelWorkspace() = default;
KernelWorkspace::KernelWorkspace(KernelWorkspace&&) noexcept = default;

int KernelWorkspace::order() const { return impl_->order; }

double KernelWorkspace::radius(double h) const {
  const Impl& s = *impl_;
  if (s.compiled.radius) return s.compiled.radius(s.memory.rows.data(), h);
  return s.engine.radius(s.memory.row(0), s.memory.stride, s.program.freedoms, s.order, h);
}

void polynomial_increments(const double* first, std::size_t stride, std::size_t columns, int degree, double tau, double* dq, double* dv) {
  packed::engine().increments(first, stride, columns, degree, tau, dq, dv);
}
void polynomial_accelerations(const double* first, std::size_t stride, std::size_t columns, int degree, double tau, double* a) {
  packed::engine().accelerations(first, stride, columns, degree, tau, a);
}
void polynomial_sizes(const double* first, std::size_t stride, std::size_t columns, int degree, const double* weights, double* sizes) {
  packed::engine().sizes(first, stride, columns, degree, weights, sizes);
}
void add_increments(std::size_t count, double tau, const double* dq, const double* dv, const double* q, const double* v, double* q_out, double* v_out) {
  packed::engine().add_increments(count, tau, dq, dv, q, v, q_out, v_out);
}
PolynomialIncrements* KernelWorkspace::increments() const {
  return impl_->compiled.increments ? impl_->compiled.increments : polynomial_increments;
}
std::size_t KernelWorkspace::row_stride() const { return impl_->memory.stride; }
const Program& KernelWorkspace::program() const { return impl_->program; }
const double* KernelWorkspace::constants() const { return impl_->memory.constants.data(); }

/// What compiled code is given.
void KernelWorkspace::Impl::adopt(interpreter::CompiledCode code) {
  compiled = std::move(code);
  if (compiled.stage) {
    sums.assign(packed::count_convolutions(packed) * packed::rolled_group * packed::lanes, 0.0);
    tangent_row.assign(memory.stride, 0.0);
    passing_row.assign(memory.stride, 0.0);
    probe.assign(memory.stride, 0.0);
    largest_rest.assign(memory.stride, std::numeric_limits<double>::infinity());
    arguments = {.rows = memory.rows.data(), .coefficients = lane_coefficients.data(), .sums = sums.data(), .inverse = inverse.data(),
                 .tangent_row = tangent_row.data(), .passing_row = passing_row.data(), .value = tables.scalar.value,
                 .tangent = tables.scalar.tangent, .context = tables.scalar.context};
    return;
  }
  arguments = {.rows = memory.rows.data(), .coefficients = lane_coefficients.data(),
               .term_coefficients = memory.coefficients.data(), .constants = memory.constants.data(),
               .sincos = engine.sine_cosine, .elementary = [](std::uint8_t kind, double x, double y) {
                 return static_cast<Kind>(kind) == Kind::Power ? std::pow(x, y) : interpreter::elementary(static_cast<Kind>(kind), x, y);
               }};
}

CompileReport KernelWorkspace::compile(const CompileOptions& options) {
  Impl& s = *impl_;
  if (s.unknowns == 0) return {.trouble = "there are no coordinates, and so no equations to compile"};
  if (s.lifted) s.lifted->compile(options);
  auto [code, report] = interpreter::compile(s.packed, s.order, s.memory.stride, options);
  if (code.memory) s.adopt(std::move(code));
  return report;
}

void KernelWorkspace::set_parameters(std::span<const double> values) {
  MAUP_REQUIRE(values.size() == impl_->parameters.size());
  impl_->parameters.assign(values.begin(), values.end());
  impl_->stale = true;
}

void KernelWorkspace::set_branches(std::span<const std::int8_t> sides) {
  MAUP_REQUIRE(sides.size() == impl_->sides.size());
  impl_->stale = impl_->stale || !std::equal(sides.begin(), sides.end(), impl_->sides.begin());
  impl_->sides.assign(sides.begin(), sides.end());
}

KernelStatus KernelWorkspace::expand(double t, std::span<const double> q, std::span<const double> v) {
  return impl_->run(t, q, v, impl_->order);
}

KernelStatus KernelWorkspace::evaluate(double t, std::span<const double> q, std::span<const double> v) {
  return impl_->run(t, q, v, 1);
}

}  // namespace maupertuis

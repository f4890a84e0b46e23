#include "kernel/interpreter/compiled.hpp"
#include "kernel/interpreter/elementary.hpp"
#include "kernel/interpreter/interpreter.hpp"
#include "kernel/interpreter/lifted_solve.hpp"
#include "kernel/interpreter/point_section.hpp"
#include "kernel/jet/bordered_solver.hpp"
#include "kernel/packed/convolutions.hpp"
#include "kernel/packed/engine.hpp"

#include <maupertuis/require.hpp>

#include <algorithm>
#include <cmath>

/// The structured Taylor step (docs/design/kernel_program.md). Stage k finds q_{k+2}: with it set to 0 the residual is
/// evaluated at order k, M₀ q̈_k = −R_k gives the acceleration, and every coefficient that later orders read is
/// corrected by its derivative in the direction of q̈_k, which is that of order 0 up to a factor.
namespace maupertuis {

using interpreter::Memory;

namespace {

/// Up to here the correction of a stage is a product with a small matrix, and so is the solution where M is positive definite.
constexpr std::size_t most_by_matrix = 16;
/// A point alone (an output between steps) needs M₀ but no corrections: beyond this the instructions that M₀ goes through are fewer.
constexpr std::size_t most_swept_at_point = 8;

/// What a rough solution may be wrong by. Beyond, the error bounds of LiftedSolve decide, since M₀ may be badly conditioned.
constexpr double largest_correction = 1e-9;

/// Infinity and NaN times 0 are NaN. Eight sums, since additions of one wait for each other for longer than the rest of a stage takes.
bool are_finite(std::span<const double> values) {
  constexpr std::size_t width = 8;
  double sums[width] = {};
  std::size_t i = 0;
  for (; i + width <= values.size(); i += width)
    for (std::size_t j = 0; j < width; ++j) sums[j] += values[i + j] * 0;
  for (; i < values.size(); ++i) sums[0] += values[i] * 0;
  for (std::size_t j = 1; j < width; ++j) sums[0] += sums[j];
  return sums[0] == 0;
}

}  // namespace

struct KernelWorkspace::Impl {
  Impl(const Kernel& k, int p)
      : kernel(k), packed(packed::pack(k.program())), program(packed.program), order(p),
        orders(p + 2 + (-2 - program.first_stage)), memory(program, orders, packed.cells), parameters(program.parameters, 0.0),
        sides(program.switches.size(), 1), unknowns(program.unknowns),
        by_matrix(unknowns <= most_by_matrix), producer(program.slots, nullptr), at_point(program) {
    solution.assign(padded_unknowns(), 0.0);
    unknown = {solution.data(), unknowns};
    tangent.assign(by_matrix ? unknowns * memory.stride : memory.stride, 0.0);
    if (!by_matrix && unknowns == program.freedoms) lifted.emplace(kernel.program(), packed, memory.stride);
    if (by_matrix) inverse.assign(unknowns * padded_unknowns(), 0.0);
    for (const Instruction& i : program.instructions) producer[i.out] = &i;
    interpreter::set_leaves(memory, 0.0, orders);
    corrects_points = outputs_follow_accelerations();
    bind();
  }

  std::size_t padded_unknowns() const { return (unknowns + packed::lanes - 1) / packed::lanes * packed::lanes; }
  void bind();
  void compute_constants();
  KernelStatus run(double t, std::span<const double> q, std::span<const double> v, int stages);
  void run_stage(int stage);
  void renew_blocks(int stage, int stages);
  void run_along(int stage);
  bool outputs_follow_accelerations() const;
  bool run_compiled(int stages);
  void adopt(interpreter::CompiledCode code);
  void find_tangents(std::size_t directions);
  void find_direction();
  void sweep_all();
  void sweep_block(std::size_t first);
  KernelStatus factor();
  KernelStatus factor_full();
  void need_full();
  KernelStatus solve(int stage);
  void solve_factored();
  void fetch_residual(int stage);
  bool solve_twice(int stage);
  void correct(int stage);
  bool constraints_agree();
  bool keeps(std::size_t constraint) const { return by_lifting || !solver || solver->keeps(constraint); }
  double coefficient(Slot slot, int k) const;

  Kernel kernel;
  packed::PackedProgram packed;
  const Program& program;            // of `packed`
  int order, orders;
  interpreter::Memory memory;
  packed::Tables tables;
  packed::TangentMatrix tangents;    // by_matrix: the engine's view of `tangent`
  const packed::Engine& engine = packed::engine();
  std::optional<packed::ReadyProgram> ready;
  std::vector<packed::Reciprocal> reciprocals;  // [orders]
  std::vector<double> lane_coefficients;  // [packed.coefficients]
  std::vector<double> parameters;
  std::vector<std::int8_t> sides;
  bool stale = true;                 // constants to be computed
  std::size_t unknowns;              // n + m
  std::optional<jet::BorderedSolver> solver;
  std::vector<double> bordered;      // [(n + m) × (n + m)] ∂R/∂(q̈, λ) at order 0; empty until it is asked for
  bool has_full = false;             // bordered is that of this point
  std::optional<interpreter::LiftedSolve> lifted;
  interpreter::Doubles solution;     // q̈_k and λ_k, padded
  std::span<double> unknown;         // [n + m] of it: −R_k, then q̈_k and λ_k
  std::vector<double> rough;         // [n + m] a solution that is being corrected
  bool by_matrix, by_inverse = false, by_lifting = false;
  interpreter::Doubles inverse;      // by_inverse: −M⁻¹, rows padded
  interpreter::Doubles tangent;      // by_matrix: ∂slot/∂q^(lag) for each direction [n + m × stride], else for one
  std::vector<double> block_tangent; // [slots × 8]
  std::vector<std::uint32_t> of_mass;  // instructions that M₀ goes through
  std::vector<const Instruction*> producer;  // [slots]
  interpreter::PointSection at_point;
  bool alone = false;                // a point whose coefficients are not corrected
  bool corrects_points = true;       // something that is read at a point alone depends on q̈
  std::size_t singular = 0, contradicting = 0;
  int last_stage = 0;
  interpreter::CompiledCode compiled;
  interpreter::Doubles sums;         // of rolled code: [convolutions × rolled_group × 8]
  packed::CompiledArguments arguments;
};

/// The engine's view of this workspace.
void KernelWorkspace::Impl::bind() {
  tables.packs = packed.packs.data();
  tables.pack_count = packed.packs.size();
  tables.blocks = packed.blocks.data();
  tables.columns = packed.columns.data();
  tables.products = packed.products.data();
  tables.functions = packed.functions.data();
  tables.runs = packed.runs.data();
  reciprocals.resize(1);
  for (double k = 1; k < orders; ++k) reciprocals.push_back({1 / k, std::fma(-k, 1 / k, 1.0) / k});
  tables.reciprocals = reciprocals.data();
  tangents = {tangent.data(), memory.stride, unknowns, static_cast<Slot>(padded_unknowns()), {}};
  std::copy_n(program.stored_end.begin(), tangents.end.size(), tangents.end.begin());
  tables.rows = memory.rows.data();
  tables.stride = memory.stride;
  tables.scalar.context = this;
  tables.scalar.value = [](void* self, std::uint32_t instruction, int at) {
    interpreter::run_instruction(static_cast<Impl*>(self)->memory, instruction, at);
  };
  tables.scalar.tangent = [](void* self, std::uint32_t instruction, double* values) {
    interpreter::tangents<1>(static_cast<Impl*>(self)->memory, values, {&instruction, 1});
  };
  lane_coefficients.resize(packed.coefficients.size());
  tables.coefficients = lane_coefficients.data();
  ready.emplace(packed, memory.rows.data(), memory.stride, lane_coefficients.data());
  tables.ready = ready->packs.data();
  tables.brought = ready->brought.data();
  tables.copies = ready->copies.data();
  tables.copy_count = ready->copies.size();
  tables.ready_runs = ready->runs.data();
  tables.ready_products = ready->products.data();
}

void KernelWorkspace::Impl::compute_constants() {
  if (!stale) return;
  interpreter::compute_constants(memory, parameters, sides);
  for (std::size_t i = 0; i < lane_coefficients.size(); ++i) lane_coefficients[i] = memory.constants[packed.coefficients[i]];
  if (lifted) lifted->set_constants(memory);
  stale = false;
}

void KernelWorkspace::Impl::find_tangents(std::size_t directions) {
  if (!compiled.tangents) return engine.tangents(tables, tangent.data(), memory.stride, directions);
  for (std::size_t d = 0; d < directions; ++d) compiled.tangents(&arguments, tangent.data() + d * memory.stride);
}

/// The tangents of all slots in the direction of each unknown.
void KernelWorkspace::Impl::sweep_all() {
  for (std::size_t d = 0; d < unknowns; ++d) {
    double* const row = tangent.data() + d * memory.stride;
    std::fill_n(row, padded_unknowns(), 0.0);
    row[d] = 1;
  }
  find_tangents(unknowns);
}

/// Those of the residual in 8 directions.
void KernelWorkspace::Impl::sweep_block(std::size_t first) {
  std::fill_n(block_tangent.begin(), unknowns * 8, 0.0);
  for (std::size_t d = 0; d < 8 && first + d < unknowns; ++d) block_tangent[(first + d) * 8 + d] = 1;
  interpreter::tangents<8>(memory, block_tangent.data(), of_mass);
}

/// M₀ = ∂R/∂q̈ at order 0, bordered by the constraints, column by column.
void KernelWorkspace::Impl::need_full() {
  if (has_full) return;
  has_full = true;
  const std::size_t n = unknowns;
  bordered.resize(n * n);
  const bool by_sweep = by_matrix && (!alone || n <= most_swept_at_point);
  if (!by_sweep && of_mass.empty()) {
    block_tangent.assign(program.slots * 8, 0.0);
    of_mass = interpreter::instructions_of_mass(program);
  }
  if (by_sweep) sweep_all();
  for (std::size_t d = 0; d < n; ++d) {
    if (!by_sweep && d % 8 == 0) sweep_block(d);
    for (std::size_t i = 0; i < n; ++i) {
      const Slot slot = program.residual[i];
      bordered[i * n + d] = program.tangent_lags[slot] != 2 ? 0.0
                            : by_sweep ? tangent[d * memory.stride + slot] : block_tangent[slot * 8 + d % 8];
    }
  }
}

/// Its factors.
KernelStatus KernelWorkspace::Impl::factor_full() {
  const std::size_t n = unknowns;
  need_full();
  if (!are_finite(bordered)) return KernelStatus::NonFinite;
  by_inverse = by_matrix && n == program.freedoms && engine.negative_inverse(bordered.data(), n, inverse.data(), padded_unknowns());
  if (by_inverse) return KernelStatus::Ok;
  if (!solver) solver.emplace(program.freedoms, n - program.freedoms);
  std::copy(bordered.begin(), bordered.end(), solver->matrix().begin());
  if (const auto undetermined = solver->factor()) {
    singular = *undetermined;
    return KernelStatus::SingularMass;
  }
  return KernelStatus::Ok;
}

KernelStatus KernelWorkspace::Impl::factor() {
  has_full = by_inverse = false;
  by_lifting = lifted && lifted->factor(memory);
  return by_lifting ? KernelStatus::Ok : factor_full();
}

/// unknown → its solution.
void KernelWorkspace::Impl::solve_factored() {
  if (by_lifting) lifted->solve(unknown);
  else solver->solve(unknown);
}

/// unknown = q̈_k.
KernelStatus KernelWorkspace::Impl::solve(int stage) {
  const double* const row = memory.row(stage);
  if (by_inverse) {
    const bool finite = engine.solve_by_inverse(inverse.data(), padded_unknowns(), row, program.residual.data(), unknowns, solution.data());
    return finite ? KernelStatus::Ok : KernelStatus::NonFinite;
  }
  const auto finite = [this] { return are_finite(unknown) ? KernelStatus::Ok : KernelStatus::NonFinite; };
  if (by_lifting && lifted->is_rough(stage) && (solve_twice(stage) || stage > 0)) return finite();
  fetch_residual(stage);
  if (stage > 0 || !by_lifting) {
    solve_factored();
  } else if (!lifted->solve_first(unknown)) {
    by_lifting = false;
    if (const KernelStatus status = factor_full(); status != KernelStatus::Ok) return status;
    solve_factored();
  }
  return finite();
}

/// unknown = −R_k
void KernelWorkspace::Impl::fetch_residual(int stage) {
  const double* const row = memory.row(stage);
  for (std::size_t i = 0; i < unknowns; ++i) unknown[i] = -row[program.residual[i]];
}

/// A rough solution, and one for what it leaves of −R_k, which the tangents tell. False: the second is not small beside the first, as it
/// is where the first holds.
bool KernelWorkspace::Impl::solve_twice(int stage) {
  fetch_residual(stage);
  lifted->solve(unknown);
  find_direction();
  rough.assign(unknown.begin(), unknown.end());
  fetch_residual(stage);
  for (std::size_t i = 0; i < unknowns; ++i) unknown[i] -= tangent[program.residual[i]];
  lifted->solve(unknown);
  double largest = 0, correction = 0;
  for (std::size_t i = 0; i < unknowns; ++i) {
    largest = std::max(largest, std::abs(rough[i])), correction = std::max(correction, std::abs(unknown[i]));
    unknown[i] += rough[i];
  }
  return correction <= largest_correction * largest;
}

/// All tangents in the direction of `unknown`.
void KernelWorkspace::Impl::find_direction() {
  std::copy(unknown.begin(), unknown.end(), tangent.begin());
  find_tangents(1);
}

/// Whether the rows of A that were dropped as dependent hold for the accelerations of the others.
bool KernelWorkspace::Impl::constraints_agree() {
  const std::size_t n = program.freedoms;
  for (std::size_t j = 0; n + j < unknowns; ++j) {
    if (keeps(j)) continue;
    const Slot slot = program.residual[n + j];
    double rest = memory.row(0)[slot], size = interpreter::term_size(memory, producer[slot], slot);
    for (std::size_t i = 0; i < n; ++i) {
      const double term = bordered[(n + j) * unknowns + i] * unknown[i];
      rest += term;
      size += std::abs(term);
    }
    if (std::abs(rest) <= 1e-6 * size) continue;
    contradicting = j;
    return false;
  }
  return true;
}

/// Whether an output at a point, or what it is computed from after the solve, is corrected in row 0.
bool KernelWorkspace::Impl::outputs_follow_accelerations() const {
  const auto follows = [this](Slot slot) { return slot != no_slot && slot >= unknowns && program.tangent_lags[slot] == 2; };
  for (const auto* slots : {&program.switch_slots, &program.events, &program.observables, &program.integrands,
                            &program.constraint_values, &program.constraint_rates})
    if (std::any_of(slots->begin(), slots->end(), follows)) return true;
  return !program.runs[Along].empty() || at_point.follows_acceleration();
}

/// Coefficient k + 2 − ℓ of a slot of lag ℓ follows q̈_k with its order-0 tangents: one by one, or the tangent in the direction of q̈_k.
void KernelWorkspace::Impl::correct(int stage) {
  if (by_matrix) return engine.correct(tables, stage, tangents, solution.data());
  const double* const known = by_lifting ? lifted->tangents(stage) : nullptr;
  if (!known) find_direction();
  packed::TangentMatrix direction = tangents;
  direction.values = known ? known : tangent.data();
  direction.directions = 1;
  const double weight = 1;
  engine.correct(tables, stage, direction, &weight);
}

KernelStatus KernelWorkspace::Impl::run(double t, std::span<const double> q, std::span<const double> v, int stages) {
  MAUP_REQUIRE(q.size() == program.freedoms && v.size() == program.freedoms);
  compute_constants();
  last_stage = stages - 1;
  alone = stages == 1 && !corrects_points;
  if (program.time != no_slot) memory.row(0)[program.time] = t;
  double *const position = memory.row(0), *const velocity = memory.row(1);
  for (std::size_t i = 0; i < q.size(); ++i) position[i] = q[i], velocity[i] = v[i];
  if (run_compiled(stages)) return KernelStatus::Ok;
  for (int stage = program.first_stage; stage < stages; ++stage) {
    if (stage >= 0) std::fill_n(memory.row(stage + 2), unknowns, 0.0);
    run_stage(stage);
    if (stage == 0)
      if (const auto status = factor(); status != KernelStatus::Ok) return status;
    if (stage >= 0) {
      if (const auto status = solve(stage); status != KernelStatus::Ok) return status;
      if (stage == 0 && !constraints_agree()) return KernelStatus::Contradiction;
      engine.set_accelerations(tables, stage, solution.data(), unknowns);
      if (!alone) correct(stage);
    }
    renew_blocks(stage, stages);
    run_along(stage);
  }
  return KernelStatus::Ok;
}

/// Rolled code has no stages before 1.
void KernelWorkspace::Impl::run_stage(int stage) {
  if (compiled.stage && stage >= 1) compiled.stage(&arguments, stage);
  else engine.run_stage(tables, stage);
}
/// What no stage follows needs no copies, and no sums.
void KernelWorkspace::Impl::renew_blocks(int stage, int stages) {
  if (stage + 1 >= stages) return;
  if (compiled.stage && stage >= 0) compiled.ahead(&arguments, stage);
  else engine.renew_blocks(tables, stage);
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
PolynomialIncrements* KernelWorkspace::increments() const {
  return impl_->compiled.increments ? impl_->compiled.increments : polynomial_increments;
}
std::size_t KernelWorkspace::row_stride() const { return impl_->memory.stride; }

/// What compiled code is given.
void KernelWorkspace::Impl::adopt(interpreter::CompiledCode code) {
  compiled = std::move(code);
  if (compiled.stage) {
    sums.assign(packed::count_convolutions(packed) * packed::rolled_group * packed::lanes, 0.0);
    arguments = {.rows = memory.rows.data(), .coefficients = lane_coefficients.data(), .sums = sums.data(), .value = tables.scalar.value,
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

const double* KernelWorkspace::coordinate(int k) const { return impl_->memory.row(k); }
double KernelWorkspace::acceleration(std::size_t i) const { return 2 * impl_->memory.row(2)[i]; }
double KernelWorkspace::observable(std::size_t i) const { return impl_->memory.row(0)[impl_->program.observables[i]]; }
double KernelWorkspace::switch_function(std::size_t i, int k) const {
  return impl_->coefficient(impl_->program.switch_slots[i], k);
}
double KernelWorkspace::event(std::size_t i, int k) const { return impl_->coefficient(impl_->program.events[i], k); }
double KernelWorkspace::integrand(std::size_t i, int k) const {
  return impl_->coefficient(impl_->program.integrands[i], k);
}
double KernelWorkspace::switch_scale(std::size_t i) const {
  const Slot slot = impl_->program.switch_slots[i];
  return interpreter::term_size(impl_->memory, impl_->producer[slot], slot);
}
double KernelWorkspace::event_scale(std::size_t i) const {
  const Slot slot = impl_->program.events[i];
  return interpreter::term_size(impl_->memory, impl_->producer[slot], slot);
}
std::size_t KernelWorkspace::singular_coordinate() const { return impl_->singular; }
std::size_t KernelWorkspace::contradicting_constraint() const { return impl_->contradicting; }

// ---------------------------------------------------------------------------------------------------- constraints

double KernelWorkspace::multiplier(std::size_t i) const { return 2 * impl_->memory.row(2)[impl_->program.freedoms + i]; }
bool KernelWorkspace::multiplier_is_determined(std::size_t i) const {
  return impl_->by_lifting || !impl_->solver || impl_->solver->determines(i);
}

double KernelWorkspace::constraint_value(std::size_t i) const {
  const Slot slot = impl_->program.constraint_values[i];
  return slot == no_slot ? 0.0 : impl_->memory.row(0)[slot];
}
double KernelWorkspace::constraint_rate(std::size_t i) const {
  return impl_->memory.row(0)[impl_->program.constraint_rates[i]];
}
double KernelWorkspace::constraint_scale(std::size_t i) const {
  const Slot slot = impl_->program.constraint_values[i];
  return slot == no_slot ? 0.0 : interpreter::term_size(impl_->memory, impl_->producer[slot], slot);
}
double KernelWorkspace::constraint_rate_scale(std::size_t i) const {
  const Impl& s = *impl_;
  double size = interpreter::term_size(s.memory, s.producer[s.program.constraint_rates[i]], s.program.constraint_rates[i]);
  for (std::size_t k = 0; k < s.program.freedoms; ++k) size = std::max(size, std::abs(constraint_matrix(i, k) * s.memory.row(1)[k]));
  return size;
}

void KernelWorkspace::corrections(std::span<double> dq, std::span<double> dv) {
  Impl& s = *impl_;
  const std::size_t n = s.program.freedoms, m = s.unknowns - n;
  MAUP_REQUIRE(dq.size() == n && dv.size() == n);
  std::fill(dq.begin(), dq.end(), 0.0);
  std::fill(dv.begin(), dv.end(), 0.0);
  if (m == 0) return;
  const auto solve_for = [&](auto&& error, std::span<double> out) {
    std::fill_n(s.unknown.begin(), n, 0.0);
    for (std::size_t j = 0; j < m; ++j) s.unknown[n + j] = error(j);  // −A δ = error
    s.solve_factored();
    std::copy_n(s.unknown.begin(), n, out.begin());
  };
  solve_for([&](std::size_t j) { return constraint_value(j); }, dq);
  solve_for([&](std::size_t j) { return constraint_rate(j); }, dv);
}

std::size_t KernelWorkspace::constraints_in_force() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i + impl_->program.freedoms < impl_->unknowns; ++i) count += impl_->keeps(i);
  return count;
}
double KernelWorkspace::pivot_ratio() const {
  const Impl& s = *impl_;
  if (s.unknowns == s.program.freedoms) return 1;
  return s.by_lifting ? s.lifted->least_pivot() : s.solver ? s.solver->pivot_ratio() : 1;
}

double KernelWorkspace::mass(std::size_t i, std::size_t j) const {
  impl_->need_full();
  return impl_->bordered[i * impl_->unknowns + j];
}
double KernelWorkspace::constraint_matrix(std::size_t constraint, std::size_t coordinate) const {
  impl_->need_full();
  return -impl_->bordered[(impl_->program.freedoms + constraint) * impl_->unknowns + coordinate];
}

}  // namespace maupertuis

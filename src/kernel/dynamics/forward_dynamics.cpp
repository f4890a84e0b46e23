#include <maupertuis/forward_dynamics.hpp>

#include "kernel/dynamics/compiled_dynamics.hpp"
#include "kernel/dynamics/point_program.hpp"
#include "kernel/interpreter/elementary.hpp"
#include "kernel/interpreter/sampled_states.hpp"
#include "kernel/jet/linear_solver.hpp"
#include "kernel/sparse/graph_product.hpp"
#include "kernel/sparse/sparse_solver.hpp"

#include <maupertuis/require.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

/// q̈ in three parts: the residual with q̈ = 0 by a flat program, the entries of the lifted M₀ from values that it has made on its way, and
/// the sparse solution.
namespace maupertuis {
namespace {

using dynamics::PointProgram;

/// A pivot above this needs no check of the solution; below the lower one the full matrix decides.
constexpr double sound_pivot = 1e-3, least_sound_pivot = 1e-7;
/// Of the remainder, in units of its own rounding errors.
constexpr double sound = 64;
/// Beyond, a full matrix allocates.
constexpr std::size_t most_full = 8;
/// Less waits for the determinant of two equations than for eliminations, even where these take fewer products.
constexpr std::size_t by_determinant = 2;

/// About what compiled code saves in a call, and what making it costs: estimates, of the right order only.
constexpr double seconds_saved_a_term = 1e-9, seconds_of_compiler = 0.015, seconds_of_compiler_a_term = 3e-5;

bool same_plan(const std::vector<sparse::Pivot>* pivots, const std::optional<std::vector<sparse::Pivot>>& others) {
  if (!pivots || !others) return !pivots && !others;
  return std::equal(pivots->begin(), pivots->end(), others->begin(), others->end(), [](const sparse::Pivot& x, const sparse::Pivot& y) {
    return x.row == y.row && x.column == y.column && x.rows == y.rows && x.columns == y.columns;
  });
}

/// Slots whose values at order 0 the factors of the tangents are made of.
std::vector<bool> slots_of_entries(const Program& program, const std::optional<sparse::LiftedSystem>& system) {
  std::vector<bool> kept(program.slots, false);
  if (!system) return kept;
  for (const sparse::Edge& edge : system->edges) {
    if (sparse::is_constant(edge.rule)) continue;
    kept[edge.x] = true;
    if (edge.y != no_slot) kept[edge.y] = true;
  }
  return kept;
}

}  // namespace

struct ForwardDynamics::Impl {
  Impl(const Kernel& k, std::span<const std::size_t> which, const ForwardDynamicsOptions& o)
      : kernel(k), options(o), program(k.program()), inputs(which.begin(), which.end()), n(program.freedoms),
        system(sparse::lift(program, std::vector<bool>(program.slots, false))),
        at_rest(program, false, slots_of_entries(program, system)), moving(program, true, std::vector<bool>(program.slots, false)),
        full(k, 1), parameters(program.parameters, 0.0), sides(program.switches.size(), 1), constants(program.constants.size()),
        live(program.constants.size(), false), unknown(program.unknowns), rest(program.unknowns), unit(program.unknowns) {
    if (system) {
      assembly.emplace(*system, program, at_rest.flat().value_of_slot);
      product.emplace(*system);
      entries.resize(system->entries.size());
      cell_of_column.resize(system->size);
      std::iota(cell_of_column.begin(), cell_of_column.end(), 0u);
      x.resize(system->size);
    }
    find_live();
  }

  void find_live();
  double constant(std::size_t i);
  void compute_constants();
  /// In most calls there is nothing to do.
  void set_inputs(std::span<const double> u) {
    MAUP_REQUIRE(u.size() == inputs.size());
    if (stale || !u.empty()) renew_inputs(u);
  }
  void renew_inputs(std::span<const double> u);
  void choose_pivots();
  bool has_symmetric_mass(std::span<const std::vector<double>> samples);
  void renew_interpreter();
  bool pays() const;
  void compile();
  KernelStatus interpreted(double t, std::span<const double> q, std::span<const double> v, std::span<double> a);
  KernelStatus by_full_matrix(double t, std::span<const double> q, std::span<const double> v, std::span<double> a);
  bool solve();
  bool solve_full();

  Kernel kernel;
  ForwardDynamicsOptions options;
  const Program& program;
  std::vector<std::size_t> inputs;
  std::size_t n;
  std::optional<sparse::LiftedSystem> system;
  PointProgram at_rest, moving;          // with q̈ = 0, and with any
  KernelWorkspace full;
  std::vector<double> parameters;
  std::vector<std::int8_t> sides;
  bool stale = true;
  std::vector<double> constants;
  std::vector<bool> live;                // [constants] that follow from inputs
  std::vector<std::uint32_t> live_order; // their indices
  std::optional<sparse::Assembly> assembly;
  std::optional<sparse::GraphProduct> product;
  std::optional<sparse::SparseSolver> solver;  // of either of the two the cheaper one
  std::optional<jet::LinearSolver> linear;
  bool is_symmetric = false;             // M₀, as far as sampled states tell; for `linear`
  std::optional<std::vector<sparse::Pivot>> pivots, compiled_pivots;  // in use; of the code, none: a full matrix
  std::optional<dynamics::CompiledDynamics> compiled;
  CompileReport report;
  bool interpreter_is_behind = false;          // coefficients do not yet follow from the inputs of the last call
  std::vector<std::uint32_t> cell_of_column;
  std::vector<double> entries, x;        // of the lifted system
  std::vector<double> unknown, rest, unit;  // [unknowns]
  double operands[64] = {};
};

void ForwardDynamics::Impl::find_live() {
  for (std::uint32_t i = 0; i < program.constants.size(); ++i) {
    const Constant& c = program.constants[i];
    if (c.kind == Kind::Symbol) live[i] = std::find(inputs.begin(), inputs.end(), c.index) != inputs.end();
    for (std::uint32_t k = 0; k < c.arguments; ++k) live[i] = live[i] || live[program.constant_arguments[c.first_argument + k]];
    if (live[i]) live_order.push_back(i);
  }
}

double ForwardDynamics::Impl::constant(std::size_t i) {
  const Constant& c = program.constants[i];
  if (c.kind == Kind::Number) return c.value;
  if (c.kind == Kind::Symbol) return parameters[c.index];
  if (c.kind == Kind::Sign && c.arguments == 0) return sides[c.index];
  std::vector<double> many;
  double* values = operands;
  if (c.arguments > 64) many.resize(c.arguments), values = many.data();
  for (std::uint32_t k = 0; k < c.arguments; ++k) values[k] = constants[program.constant_arguments[c.first_argument + k]];
  return interpreter::constant_operation<double>(c.kind, {values, c.arguments});
}

void ForwardDynamics::Impl::compute_constants() {
  if (!stale) return;
  stale = interpreter_is_behind = false;
  for (std::size_t i = 0; i < constants.size(); ++i) constants[i] = constant(i);
  at_rest.set_constants(constants);
  moving.set_constants(constants);
  if (assembly) assembly->set_constants(constants.data(), entries);
  full.set_parameters(parameters);
  full.set_branches(sides);
  if (system && program.unknowns == n) choose_pivots();
  if (options.backend == Backend::Compiled || (options.backend == Backend::Automatic && pays())) compile();
}

void ForwardDynamics::Impl::choose_pivots() {
  const std::vector<double> origin(n, 0.0);
  const auto samples = interpreter::sampled_entries(program, *system, constants, 0, origin, origin);
  solver.reset();
  linear.reset();
  pivots = sparse::eliminate(*system, samples, {});
  if (pivots) solver.emplace(*system, *pivots, cell_of_column);
  const std::size_t full_products = product->matrix_products() + n * n * n / 6 + 2 * n * n;
  const bool is_cheaper = solver && solver->factor_products() + solver->solve_products() < full_products;
  if (n > most_full || (is_cheaper && n != by_determinant)) return;
  linear.emplace(n);
  is_symmetric = has_symmetric_mass(samples);
  if (is_cheaper && !is_symmetric) linear.reset();
  else solver.reset();
}

/// The residual of a Lagrangian has a symmetric M; one that is written by hand need not.
bool ForwardDynamics::Impl::has_symmetric_mass(std::span<const std::vector<double>> samples) {
  constexpr double rounding = 1e-12;
  for (const std::vector<double>& sample : samples) {
    const auto m = linear->matrix();
    product->matrix(sample, m);
    double largest = 0, difference = 0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        largest = std::max(largest, std::abs(m[i * n + j]));
        difference = std::max(difference, std::abs(m[i * n + j] - m[j * n + i]));
      }
    if (!(difference <= rounding * largest)) return false;
  }
  return true;
}

// ------------------------------------------------------------------------------------------------------------------ machine code

bool ForwardDynamics::Impl::pays() const {
  const auto& flat = at_rest.flat();
  const std::size_t solution = solver ? solver->factor_products() + solver->solve_products() : linear ? product->matrix_products() : 0;
  const double terms = static_cast<double>(flat.linear_cell.size() + flat.product_a.size() + solution);
  return options.expected_calls * terms * seconds_saved_a_term > seconds_of_compiler + terms * seconds_of_compiler_a_term;
}

/// Code of another order of elimination does not belong to the pivots that were just chosen.
void ForwardDynamics::Impl::compile() {
  const auto decline = [this](const char* trouble) {
    compiled.reset();
    report = {.trouble = trouble};
  };
  if (program.unknowns != n) return decline("the accelerations of systems with constraints are not compiled");
  if (!solver && !linear) return decline("no order of elimination holds at all of the sampled states");
  if (linear && !is_symmetric) return decline("the mass matrix is not symmetric");
  const dynamics::WrittenPlan plan{*system, solver ? &*pivots : nullptr};
  if (!compiled || !same_plan(plan.pivots, compiled_pivots)) {
    compiled.emplace(program, dynamics::write_dynamics(program, moving.flat(), at_rest.flat(), plan), CompileOptions{.cache = options.cache});
    compiled_pivots = solver ? pivots : std::nullopt;
    report = compiled->report();
  }
  if (!report.compiled) return compiled.reset();
  compiled->set_constants(constants, *system, plan.pivots);
}

void ForwardDynamics::Impl::renew_inputs(std::span<const double> u) {
  for (std::size_t i = 0; i < inputs.size(); ++i) parameters[inputs[i]] = u[i];
  compute_constants();
  if (inputs.empty()) return;
  for (const std::uint32_t i : live_order) constants[i] = constant(i);
  interpreter_is_behind = true;
  if (compiled) compiled->renew(constants, live);
  else renew_interpreter();
}

void ForwardDynamics::Impl::renew_interpreter() {
  if (!interpreter_is_behind) return;
  interpreter_is_behind = false;
  at_rest.renew(constants, live);
  moving.renew(constants, live);
  if (assembly) assembly->set_constants(constants.data(), entries);
}

/// unknown → x. False: the full matrix is to decide.
bool ForwardDynamics::Impl::solve() {
  if (!solver) return false;
  (*assembly)(at_rest.cells(), entries);
  const double least = solver->factor(entries);
  if (!(least > least_sound_pivot)) return false;
  solver->solve(unknown, x.data());
  if (!(least > sound_pivot)) {
    if (!(product->remainder(entries, {x.data(), n}, unknown, rest) <= sound)) return false;
  }
  return interpreter::is_finite({x.data(), n});
}

/// The same by M itself, which the tangents give 8 columns at a time.
bool ForwardDynamics::Impl::solve_full() {
  (*assembly)(at_rest.cells(), entries);
  product->matrix(entries, linear->matrix());
  if (!interpreter::is_finite(linear->matrix()) || linear->factor()) return false;
  linear->solve(unknown);
  std::copy_n(unknown.begin(), n, x.begin());
  return interpreter::is_finite({x.data(), n});
}

KernelStatus ForwardDynamics::Impl::by_full_matrix(double t, std::span<const double> q, std::span<const double> v, std::span<double> a) {
  if (!inputs.empty()) full.set_parameters(parameters);
  const KernelStatus status = full.evaluate(t, q, v);
  if (status == KernelStatus::Ok)
    for (std::size_t i = 0; i < n; ++i) a[i] = full.acceleration(i);
  return status;
}

KernelStatus ForwardDynamics::Impl::interpreted(double t, std::span<const double> q, std::span<const double> v, std::span<double> a) {
  renew_interpreter();
  if (!solver && !linear) return by_full_matrix(t, q, v, a);
  at_rest.evaluate(t, q, v, {});
  for (std::size_t i = 0; i < n; ++i) unknown[i] = -at_rest.residual(i);
  if (!(linear ? solve_full() : solve())) return by_full_matrix(t, q, v, a);
  std::copy_n(x.begin(), n, a.begin());
  return KernelStatus::Ok;
}

ForwardDynamics::ForwardDynamics(const Kernel& kernel, std::span<const std::size_t> inputs, const ForwardDynamicsOptions& options)
    : impl_(std::make_unique<Impl>(kernel, inputs, options)) {
  for (const std::size_t input : inputs) MAUP_REQUIRE(input < kernel.parameters());
}
ForwardDynamics::~ForwardDynamics() = default;
ForwardDynamics::ForwardDynamics(ForwardDynamics&&) noexcept = default;

void ForwardDynamics::set_parameters(std::span<const double> values) {
  MAUP_REQUIRE(values.size() == impl_->parameters.size());
  impl_->parameters.assign(values.begin(), values.end());
  impl_->stale = true;
  impl_->compute_constants();
}

void ForwardDynamics::set_branches(std::span<const std::int8_t> sides) {
  MAUP_REQUIRE(sides.size() == impl_->sides.size());
  impl_->sides.assign(sides.begin(), sides.end());
  impl_->stale = true;
  impl_->compute_constants();
}

KernelStatus ForwardDynamics::accelerations(double t, std::span<const double> q, std::span<const double> v, std::span<const double> u,
                                            std::span<double> a) {
  Impl& s = *impl_;
  MAUP_REQUIRE(q.size() == s.n && v.size() == s.n && a.size() == s.n);
  s.set_inputs(u);
  if (s.compiled && s.compiled->accelerations(t, q.data(), v.data(), a.data())) return KernelStatus::Ok;
  return s.interpreted(t, q, v, a);
}

void ForwardDynamics::forces(double t, std::span<const double> q, std::span<const double> v, std::span<const double> a,
                             std::span<const double> u, std::span<double> out) {
  Impl& s = *impl_;
  MAUP_REQUIRE(q.size() == s.n && v.size() == s.n && a.size() == s.n && out.size() == s.n);
  s.set_inputs(u);
  if (s.compiled) return s.compiled->forces(t, q.data(), v.data(), a.data(), out.data());
  s.moving.evaluate(t, q, v, a);
  for (std::size_t i = 0; i < s.n; ++i) out[i] = s.moving.residual(i);
}

void ForwardDynamics::bias(double t, std::span<const double> q, std::span<const double> v, std::span<const double> u,
                           std::span<double> out) {
  Impl& s = *impl_;
  MAUP_REQUIRE(q.size() == s.n && v.size() == s.n && out.size() == s.n);
  s.set_inputs(u);
  if (s.compiled) return s.compiled->forces(t, q.data(), v.data(), nullptr, out.data());
  s.at_rest.evaluate(t, q, v, {});
  for (std::size_t i = 0; i < s.n; ++i) out[i] = s.at_rest.residual(i);
}

void ForwardDynamics::mass(double t, std::span<const double> q, std::span<const double> v, std::span<double> out) {
  Impl& s = *impl_;
  MAUP_REQUIRE(q.size() == s.n && v.size() == s.n && out.size() == s.n * s.n);
  s.compute_constants();
  s.renew_interpreter();
  std::fill(out.begin(), out.end(), 0.0);
  if (!s.system) {
    s.full.evaluate(t, q, v);
    for (std::size_t i = 0; i < s.n; ++i)
      for (std::size_t j = 0; j < s.n; ++j) out[i * s.n + j] = s.full.mass(i, j);
    return;
  }
  s.at_rest.evaluate(t, q, v, {});
  (*s.assembly)(s.at_rest.cells(), s.entries);
  for (std::size_t j = 0; j < s.n; ++j) {
    std::fill(s.unit.begin(), s.unit.end(), 0.0);
    s.unit[j] = 1;
    s.product->multiply(s.entries, s.unit, s.rest);
    for (std::size_t i = 0; i < s.n; ++i) out[i * s.n + j] = s.rest[i];
  }
}

const CompileReport& ForwardDynamics::compile_report() const { return impl_->report; }
std::size_t ForwardDynamics::singular_coordinate() const { return impl_->full.singular_coordinate(); }

}  // namespace maupertuis

#include <maupertuis/forward_dynamics.hpp>

#include "kernel/dynamics/written_dynamics.hpp"
#include "kernel/extended/close_constants.hpp"
#include "kernel/reference/reference.hpp"
#include "kernel/reference/sampled_states.hpp"
#include "kernel/sparse/graph_product.hpp"
#include "kernel/straight_line/compile.hpp"
#include "kernel/straight_line/evaluator.hpp"

#include <maupertuis/arguments.hpp>
#include <maupertuis/require.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

/// q̈ and forces as straight lines (written_dynamics.hpp), run as machine code or number by number. Where a pivot of M₀
/// is small there, the full matrix of a workspace decides.
namespace maupertuis {
namespace {

/// Beyond, a full matrix takes more products than the elimination.
constexpr std::size_t most_full = 8;
/// Less waits for the determinant of two equations than for eliminations, even where these take fewer products.
constexpr std::size_t by_determinant = 2;

/// About what compiled code saves in a call, and what making it costs: estimates, of the right order only.
constexpr double seconds_saved_a_term = 1e-9, seconds_of_compiler = 0.015, seconds_of_compiler_a_term = 3e-5;

using Pivots = std::optional<std::vector<sparse::Pivot>>;

bool same_order(const Pivots& pivots, const Pivots& others) {
  if (!pivots || !others) return !pivots && !others;
  return std::equal(pivots->begin(), pivots->end(), others->begin(), others->end(),
                    [](const sparse::Pivot& x, const sparse::Pivot& y) {
                      return x.row == y.row && x.column == y.column && x.rows == y.rows && x.columns == y.columns;
                    });
}

/// Of an elimination and both substitutions.
std::size_t products_of(const std::vector<sparse::Pivot>& pivots) {
  std::size_t count = 0;
  for (const sparse::Pivot& pivot : pivots)
    count += pivot.rows.size() * pivot.columns.size() + pivot.rows.size() + pivot.columns.size();
  return count;
}

/// Of M₀ along the tangent graph, 8 columns at a time, of its L D Lᵀ and solution.
std::size_t products_of_full(const sparse::LiftedSystem& system, std::size_t n) {
  return (n + 7) / 8 * (system.entries.size() - system.minus_one.size()) + n * n * n / 6 + 2 * n * n;
}

}  // namespace

struct ForwardDynamics::Impl {
  Impl(const Kernel& k, std::span<const std::size_t> which, const ForwardDynamicsOptions& o)
      : kernel(k),
        options(o),
        program(k.program()),
        inputs(which.begin(), which.end()),
        n(program.freedoms),
        full(k, 1),
        parameters(program.parameters, 0.0),
        sides(program.switches.size(), 1),
        constants(program.constants.size()),
        live(program.constants.size(), false),
        rest(program.unknowns, 0.0) {
    if (program.unknowns == n) system = sparse::lift(program, std::vector<bool>(program.slots, false));
    find_live();
    write_lines();
  }

  void find_live();
  double constant(std::size_t i);
  double number(const dynamics::NumberSource& source) const;
  void compute_constants();
  /// In most calls there is nothing to do. False: a switch function has no value at the point.
  bool prepare(double t, std::span<const double> q, std::span<const double> v, std::span<const double> u) {
    if (!stale && u.empty() && (sides.empty() || sides_are_given)) return true;
    return renew(t, q, v, u);
  }
  bool renew(double t, std::span<const double> q, std::span<const double> v, std::span<const double> u);
  bool choose_sides(double t, std::span<const double> q, std::span<const double> v);
  void plan();
  bool is_symmetric(const std::vector<std::vector<double>>& samples);
  void write_lines();
  bool pays() const;
  void compile();
  bool run(std::size_t line, double t, std::span<const double> q, std::span<const double> v, const double* a,
           std::span<double> out);
  KernelStatus by_full_matrix(double t, std::span<const double> q, std::span<const double> v, std::span<double> a);
  void residual(double t, std::span<const double> q, std::span<const double> v, const double* a,
                std::span<const double> u, std::span<double> out);
  void check_point(std::span<const double> q, std::span<const double> v) const;
  void check_inputs(std::span<const double> u) const;

  Kernel kernel;
  ForwardDynamicsOptions options;
  const Program& program;
  std::vector<std::size_t> inputs;
  std::size_t n;
  std::optional<sparse::LiftedSystem> system;  // none with constraints
  KernelWorkspace full;
  std::vector<double> parameters;
  std::vector<std::int8_t> sides;
  bool sides_are_given = false;  // else those of each point
  bool stale = true;
  std::vector<double> constants;
  std::vector<bool> live;                       // [constants] that follow from inputs, or from the sides of a point
  std::vector<std::uint32_t> live_order;        // their indices
  bool has_plan = false;                        // for M₀
  Pivots pivots;                                // of it; none: a full matrix
  dynamics::WrittenDynamics written;            // forces, then accelerations where there is a plan
  std::vector<straight::Evaluator> evaluators;  // [lines]
  std::vector<double> numbers;                  // [written.numbers]
  std::vector<std::uint32_t> live_numbers;      // those that follow from live constants
  std::vector<bool> behind;                     // [lines] whose evaluator does not know the numbers yet
  straight::Code code;
  CompileReport report;
  std::vector<double> rest, scratch;  // [unknowns] zeros; of the code
  std::vector<double> operands;       // of a constant
};

void ForwardDynamics::Impl::find_live() {
  for (std::uint32_t i = 0; i < program.constants.size(); ++i) {
    const Constant& c = program.constants[i];
    if (c.kind == Kind::Symbol) live[i] = std::find(inputs.begin(), inputs.end(), c.index) != inputs.end();
    if (c.kind == Kind::Sign && c.arguments == 0) live[i] = true;
    for (std::uint32_t k = 0; k < c.arguments; ++k)
      live[i] = live[i] || live[program.constant_arguments[c.first_argument + k]];
    if (live[i]) live_order.push_back(i);
  }
}

double ForwardDynamics::Impl::constant(std::size_t i) {
  return reference::compute_constant<double>(program, i, parameters, sides, constants, operands);
}

double ForwardDynamics::Impl::number(const dynamics::NumberSource& source) const {
  switch (source.what) {
    case dynamics::NumberSource::OfConstant:
      return constants[source.index];
    case dynamics::NumberSource::OfChoice:
      return sparse::constant_factor(system->edges[source.index], program.terms.data(), constants.data());
    case dynamics::NumberSource::OfPivot:
      break;
  }
  return (*pivots)[source.index].size;
}

void ForwardDynamics::Impl::compute_constants() {
  if (!stale) return;
  stale = false;
  extended::compute_close_constants(program, parameters, sides, constants);
  full.set_parameters(parameters);
  full.set_branches(sides);
  if (system) plan();
  numbers.clear(), live_numbers.clear();
  for (const dynamics::NumberSource& source : written.numbers) {
    const bool is_choice = source.what == dynamics::NumberSource::OfChoice && !live_order.empty();
    if (is_choice || (source.what == dynamics::NumberSource::OfConstant && live[source.index]))
      live_numbers.push_back(static_cast<std::uint32_t>(numbers.size()));
    numbers.push_back(number(source));
  }
  behind.assign(evaluators.size(), true);
  if (options.backend == Backend::Compiled || (options.backend == Backend::Automatic && pays())) compile();
}

/// Lines of another order of elimination do not belong to the pivots that are chosen here.
void ForwardDynamics::Impl::plan() {
  const std::vector<double> origin(n, 0.0);
  const auto samples = reference::sampled_entries(program, *system, constants, 0, origin, origin);
  Pivots chosen = sparse::eliminate(*system, samples, {});
  const bool is_cheaper = chosen && products_of(*chosen) < products_of_full(*system, n);
  const bool is_full = n <= most_full && (!is_cheaper || n == by_determinant) && is_symmetric(samples);
  if (is_full) chosen.reset();
  const bool may_plan = is_full || chosen, changes = may_plan != has_plan || !same_order(chosen, pivots);
  has_plan = may_plan;
  pivots = std::move(chosen);
  if (changes) write_lines();
}

/// M₀ at the sampled states, column by column. The residual of a Lagrangian has a symmetric M; one that is written by
/// hand need not.
bool ForwardDynamics::Impl::is_symmetric(const std::vector<std::vector<double>>& samples) {
  constexpr double rounding = 1e-12;
  sparse::GraphProduct product(*system);
  std::vector<double> m(n * n), unit(n, 0.0);  // column by column
  for (const std::vector<double>& sample : samples) {
    for (std::size_t j = 0; j < n; ++j) {
      unit[j] = 1;
      product.multiply(sample, unit, std::span(m).subspan(j * n, n));
      unit[j] = 0;
    }
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

void ForwardDynamics::Impl::write_lines() {
  written = dynamics::write_dynamics(program, {has_plan ? &*system : nullptr, pivots ? &*pivots : nullptr});
  evaluators.clear();
  for (const straight::StraightLine& line : written.lines)
    evaluators.emplace_back(line, std::array<std::uint32_t, 1>{dynamics::NumberArray});
  code = {}, report = {};
}

// -------------------------------------------------------------------------------------------------------- machine code

bool ForwardDynamics::Impl::pays() const {
  const double terms = static_cast<double>(written.lines.back().size());
  return options.expected_calls * terms * seconds_saved_a_term >
         seconds_of_compiler + terms * seconds_of_compiler_a_term;
}

void ForwardDynamics::Impl::compile() {
  if (code) return;
  if (program.unknowns != n)
    report = {.trouble = "the accelerations of systems with constraints are not compiled"};
  else if (!has_plan)
    report = {.trouble = "no order of elimination holds at all of the sampled states"};
  else
    std::tie(code, report) = straight::compile(written.lines, {.cache = options.cache});
  for (const straight::StraightLine& line : written.lines)
    scratch.resize(std::max(scratch.size(), straight::scratch_size(line)));
}

// --------------------------------------------------------------------------------------------------------------- calls

bool ForwardDynamics::Impl::renew(double t, std::span<const double> q, std::span<const double> v,
                                  std::span<const double> u) {
  for (std::size_t i = 0; i < inputs.size(); ++i) parameters[inputs[i]] = u[i];
  compute_constants();
  const bool has_sides = choose_sides(t, q, v);
  if (live_order.empty()) return has_sides;
  for (const std::uint32_t i : live_order) constants[i] = constant(i);
  for (const std::uint32_t i : live_numbers) numbers[i] = number(written.numbers[i]);
  behind.assign(evaluators.size(), true);
  return has_sides;
}

/// A kernel in lines has no switch functions: those of the workspace tell.
bool ForwardDynamics::Impl::choose_sides(double t, std::span<const double> q, std::span<const double> v) {
  if (sides.empty() || sides_are_given) return true;
  if (!inputs.empty()) full.set_parameters(parameters);
  const bool all = full.choose_branches(t, q, v);
  sides.assign(full.branches().begin(), full.branches().end());
  return all;
}

/// False: a pivot is small, or a number infinite or undefined; `out` is as it was.
bool ForwardDynamics::Impl::run(std::size_t line, double t, std::span<const double> q, std::span<const double> v,
                                const double* a, std::span<double> out) {
  if (line >= written.lines.size()) return false;
  if (code) return code.guarded(line, &t, q.data(), v.data(), a, numbers.data(), out.data(), scratch.data());
  const double* const unused = nullptr;
  if (behind[line]) evaluators[line].set(unused, unused, unused, unused, numbers.data(), unused);
  behind[line] = false;
  return evaluators[line](&t, q.data(), v.data(), a, numbers.data(), out.data());
}

KernelStatus ForwardDynamics::Impl::by_full_matrix(double t, std::span<const double> q, std::span<const double> v,
                                                   std::span<double> a) {
  if (!inputs.empty()) full.set_parameters(parameters);
  const KernelStatus status = full.evaluate(t, q, v);
  if (status == KernelStatus::Ok)
    for (std::size_t i = 0; i < n; ++i) a[i] = full.acceleration(i);
  return status;
}

void ForwardDynamics::Impl::check_point(std::span<const double> q, std::span<const double> v) const {
  check_argument(q.size() == n, "ForwardDynamics: q has another length than the kernel has coordinates");
  check_argument(v.size() == n, "ForwardDynamics: v has another length than the kernel has coordinates");
}

void ForwardDynamics::Impl::check_inputs(std::span<const double> u) const {
  check_argument(u.size() == inputs.size(), "ForwardDynamics: u has another length than the list of inputs");
}

ForwardDynamics::ForwardDynamics(const Kernel& kernel, std::span<const std::size_t> inputs,
                                 const ForwardDynamicsOptions& options)
    : impl_(std::make_unique<Impl>(kernel, inputs, options)) {
  for (const std::size_t input : inputs)
    check_argument(input < kernel.parameters(), "ForwardDynamics: `inputs` names a parameter that the kernel has not");
}
ForwardDynamics::~ForwardDynamics() = default;
ForwardDynamics::ForwardDynamics(ForwardDynamics&&) noexcept = default;

void ForwardDynamics::set_parameters(std::span<const double> values) {
  check_argument(values.size() == impl_->parameters.size(),
                 "ForwardDynamics::set_parameters: `values` has another length than the kernel has parameters");
  impl_->parameters.assign(values.begin(), values.end());
  if (!impl_->sides_are_given) std::fill(impl_->sides.begin(), impl_->sides.end(), std::int8_t{1});
  impl_->stale = true;
  impl_->compute_constants();
}

void ForwardDynamics::set_branches(std::span<const std::int8_t> sides) {
  check_argument(sides.empty() || sides.size() == impl_->sides.size(),
                 "ForwardDynamics::set_branches: `sides` has another length than the kernel has switch functions");
  impl_->sides_are_given = !sides.empty();
  if (sides.empty()) return;
  impl_->sides.assign(sides.begin(), sides.end());
  impl_->stale = true;
  impl_->compute_constants();
}

KernelStatus ForwardDynamics::accelerations(double t, std::span<const double> q, std::span<const double> v,
                                            std::span<const double> u, std::span<double> a) {
  Impl& s = *impl_;
  s.check_point(q, v);
  s.check_inputs(u);
  check_argument(a.size() == s.n, "ForwardDynamics: a has another length than the kernel has coordinates");
  if (!s.prepare(t, q, v, u)) return KernelStatus::NonFinite;
  return s.run(1, t, q, v, s.rest.data(), a) ? KernelStatus::Ok : s.by_full_matrix(t, q, v, a);
}

void ForwardDynamics::forces(double t, std::span<const double> q, std::span<const double> v, std::span<const double> a,
                             std::span<const double> u, std::span<double> out) {
  Impl& s = *impl_;
  s.check_point(q, v);
  s.check_inputs(u);
  check_argument(a.size() == s.n, "ForwardDynamics: a has another length than the kernel has coordinates");
  s.residual(t, q, v, a.data(), u, out);
}

void ForwardDynamics::bias(double t, std::span<const double> q, std::span<const double> v, std::span<const double> u,
                           std::span<double> out) {
  Impl& s = *impl_;
  s.check_point(q, v);
  s.check_inputs(u);
  s.residual(t, q, v, s.rest.data(), u, out);
}

void ForwardDynamics::Impl::residual(double t, std::span<const double> q, std::span<const double> v, const double* a,
                                     std::span<const double> u, std::span<double> out) {
  check_argument(out.size() == n, "ForwardDynamics: `out` has another length than the kernel has coordinates");
  if (!prepare(t, q, v, u) || !run(0, t, q, v, a, out))
    std::fill(out.begin(), out.end(), std::numeric_limits<double>::quiet_NaN());
}

void ForwardDynamics::mass(double t, std::span<const double> q, std::span<const double> v, std::span<double> out) {
  Impl& s = *impl_;
  s.check_point(q, v);
  check_argument(out.size() == s.n * s.n, "ForwardDynamics::mass: `out` has another length than M has entries");
  s.compute_constants();
  if (!s.inputs.empty()) s.full.set_parameters(s.parameters);
  if (!s.sides_are_given) static_cast<void>(s.full.choose_branches(t, q, v));
  s.full.evaluate(t, q, v);
  for (std::size_t i = 0; i < s.n; ++i)
    for (std::size_t j = 0; j < s.n; ++j) out[i * s.n + j] = s.full.mass(i, j);
}

const CompileReport& ForwardDynamics::compile_report() const { return impl_->report; }
std::size_t ForwardDynamics::singular_coordinate() const { return impl_->full.singular_coordinate(); }

}  // namespace maupertuis

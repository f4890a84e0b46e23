#include "analysis/tangent/extended_source.hpp"
#include "analysis/tangent/through_modes.hpp"

#include <maupertuis/arguments.hpp>
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/expression_lock.hpp>
#include <maupertuis/integrator.hpp>
#include <maupertuis/motion_kernel.hpp>

#include <maupertuis/tangent.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

namespace maupertuis {
namespace {

/// Unknowns of one kernel: with more, the matrix costs as much as a second copy of the motion.
constexpr std::size_t most_unknowns = 96;
/// Directions are made small, so that in the matrix of the extended system the derivative of M never outweighs M
/// itself.
constexpr int exponent_of_directions = -30;
/// Of the largest acceleration of a coordinate: what differs by less across a switch is continuous.
constexpr double least_jump = 1e-9;

/// The power of two that brings the largest component near 2^exponent_of_directions; 0 for the zero direction.
double scale_of(std::span<const double> direction) {
  double largest = 0;
  for (const double x : direction) largest = std::max(largest, std::abs(x));
  return largest > 0 && std::isfinite(largest) ? std::ldexp(1.0, exponent_of_directions - std::ilogb(largest)) : 0.0;
}

/// Whether the accelerations of the motion jump where a step ended at a switch. They are those of the steps'
/// polynomials: a formula may have no value there to rounding.
class JumpWatch {
 public:
  explicit JumpWatch(std::size_t n) : n_(n), largest_(n, 0.0) {}

  /// The accelerations with which a step begins that was made; whether they have jumped.
  bool at_beginning(std::span<const double> a) {
    for (std::size_t i = 0; i < n_; ++i) largest_[i] = std::max(largest_[i], std::abs(a[i]));
    const bool jumps = !before_.empty() && differs(a);
    before_.clear();
    return jumps;
  }
  void switched(std::span<const double> a) { before_.assign(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(n_)); }

 private:
  bool differs(std::span<const double> after) const {
    for (std::size_t i = 0; i < n_; ++i)
      if (!(std::abs(after[i] - before_[i]) <= least_jump * largest_[i])) return true;
    return false;
  }
  std::size_t n_;
  std::vector<double> largest_, before_;
};

/// [switches] Whether it depends on the time alone: all neighbours cross it together, and a jump of the accelerations
/// there changes none of what they differ by.
std::vector<bool> switches_of_time(const Kernel& kernel) {
  std::vector<bool> out;
  for (const SwitchFunction& s : kernel.switches()) {
    const auto symbols = symbols_of(s.right ? ExprVector{s.left, s.right} : ExprVector{s.left});
    out.push_back(std::none_of(symbols.begin(), symbols.end(), [](const Expr& e) {
      return e.role() != Role::Time && e.context().depends_on_time(e.id());
    }));
  }
  return out;
}

TangentStop jump_at(double t) {
  return {StepEnding::None, t,
          fmt::format(
              "An acceleration jumps at a switch at t = {:.9g} s: neighbours cross it at other times, and the tangent "
              "equations do not hold there.",
              t)};
}

/// The motion with some columns beside it.
class Group {
 public:
  Group(const Kernel& kernel, std::span<const double> parameters, const TangentOptions& options, std::size_t n,
        std::size_t columns)
      : n_(n),
        columns_(columns),
        of_time_(switches_of_time(kernel)),
        scales_(columns, 0.0),
        q_(n * (1 + columns)),
        v_(q_.size()),
        stepper_(kernel, parameters,
                 {options.tolerance, 0, options.maximum_steps, options.interrupt, Backend::Automatic, true}) {}

  /// Columns first, first + 1, … of the point; where it has no more, the last one again.
  /// `sizes` [2n] of the motion, or none: a direction that is small in some components was made of larger ones, and
  /// their rounding is what its constraints can be met to.
  void start(const TangentPoint& point, std::size_t first, std::span<const double> sizes) {
    std::copy_n(point.state.q.begin(), n_, q_.begin());
    std::copy_n(point.state.v.begin(), n_, v_.begin());
    for (std::size_t j = 0; j < columns_; ++j) {
      const auto column = point.column(std::min(first + j, point.columns() - 1));
      scales_[j] = scale_of(column);
      for (std::size_t i = 0; i < n_; ++i) {
        q_[(1 + j) * n_ + i] = scales_[j] * column[i];
        v_[(1 + j) * n_ + i] = scales_[j] * column[n_ + i];
      }
    }
    stepper_.start(point.state.t, q_, v_);
    if (!sizes.empty()) measure_by(sizes);
    jumps_ = JumpWatch(n_);
  }

  std::optional<TangentStop> advance(double t) {
    while (stepper_.time() != t)
      if (auto stop = step(t)) return stop;
    return std::nullopt;
  }

  void read(TangentPoint& point, std::size_t first) const {
    for (std::size_t j = 0; j < columns_ && first + j < point.columns(); ++j) {
      const auto column = point.column(first + j);
      const double inverse = scales_[j] > 0 ? 1 / scales_[j] : 0;
      for (std::size_t i = 0; i < n_; ++i) {
        column[i] = inverse * stepper_.q()[(1 + j) * n_ + i];
        column[n_ + i] = inverse * stepper_.v()[(1 + j) * n_ + i];
      }
    }
  }
  /// After start(): what forces do, of the columns that the point has from `first` on.
  void read_forces(TangentForces& out, std::size_t first, std::size_t columns) const {
    const Sample here = stepper_.sample(stepper_.time());
    const auto n = static_cast<std::ptrdiff_t>(n_),
               m = static_cast<std::ptrdiff_t>(here.multipliers.size() / (1 + columns_));
    out.a.assign(here.a.begin(), here.a.begin() + n);
    out.multipliers.assign(here.multipliers.begin(), here.multipliers.begin() + m);
    for (std::size_t j = 0; j < columns_ && first + j < columns; ++j) {
      const double inverse = scales_[j] > 0 ? 1 / scales_[j] : 0;
      const auto k = static_cast<std::ptrdiff_t>(1 + j);
      for (auto x = here.a.begin() + k * n; x != here.a.begin() + (k + 1) * n; ++x)
        out.changes_of_a.push_back(inverse * *x);
      for (auto x = here.multipliers.begin() + k * m; x != here.multipliers.begin() + (k + 1) * m; ++x)
        out.changes_of_multipliers.push_back(inverse * *x);
    }
  }
  MotionState state() const {
    return {stepper_.time(),
            {stepper_.q().begin(), stepper_.q().begin() + static_cast<std::ptrdiff_t>(n_)},
            {stepper_.v().begin(), stepper_.v().begin() + static_cast<std::ptrdiff_t>(n_)}};
  }

 private:
  void measure_by(std::span<const double> sizes) {
    std::vector<double> q(q_.size(), 0.0), v(q_.size(), 0.0);
    for (std::size_t j = 1; j <= columns_; ++j) {
      double largest = 0;
      for (std::size_t i = 0; i < n_; ++i)
        largest = std::max({largest, std::abs(q_[j * n_ + i]) / sizes[i], std::abs(v_[j * n_ + i]) / sizes[n_ + i]});
      for (std::size_t i = 0; i < n_; ++i) q[j * n_ + i] = largest * sizes[i], v[j * n_ + i] = largest * sizes[n_ + i];
    }
    stepper_.set_usual_sizes(q, v, {});
  }

  std::optional<TangentStop> step(double t) {
    const Step step = stepper_.step(t);
    if (step.ending != StepEnding::None) return TangentStop{step.ending, step.begin, step.reason};
    if (of_time_.empty()) return std::nullopt;
    if (jumps_.at_beginning(stepper_.accelerations_of_step(step.begin))) return jump_at(step.begin);
    const bool parts_neighbours =
        std::any_of(step.switches.begin(), step.switches.end(), [&](std::size_t i) { return !of_time_[i]; });
    if (parts_neighbours) jumps_.switched(stepper_.accelerations_of_step(step.end));
    return std::nullopt;
  }

  std::size_t n_, columns_;
  std::vector<bool> of_time_;   // [switches]
  std::vector<double> scales_;  // [columns]
  std::vector<double> q_, v_;   // [n (1 + columns)]
  TaylorStepper stepper_;
  JumpWatch jumps_{0};
};

}  // namespace

struct TangentFlow::Impl {
  Impl(const EquationsOfMotion& e, const TangentOptions& o)
      : equations(e),
        options(o),
        n(e.system->coordinates.size()),
        unknowns(n + e.system->constraints.size()),
        parameters(parameter_values(*e.system)),
        geometry(e) {}

  Group& group(std::size_t columns);
  /// How many groups the columns of a point take, and how many each has.
  std::pair<std::size_t, std::size_t> groups_for(std::size_t columns) const {
    const std::size_t most = std::max<std::size_t>(2, most_unknowns / unknowns) - 1;
    const std::size_t count = std::max<std::size_t>(1, (columns + most - 1) / most);
    return {count, (columns + count - 1) / count};
  }
  KernelWorkspace& point_kernel();
  std::vector<std::int8_t> sides_at(const MotionState& state);
  std::optional<TangentStop> jump_at_start(const MotionState& start, double duration);
  void compare(const MotionState& a, const MotionState& b, const MotionState& start);

  EquationsOfMotion equations;
  TangentOptions options;
  std::size_t n, unknowns;
  std::vector<double> parameters;
  TangentGeometry geometry;
  std::map<std::size_t, Group> groups;  // by their columns
  std::optional<Kernel> motion;
  std::optional<KernelWorkspace> at_point;
  double spread = 0;
  std::vector<double> sizes;  // [2n] of the motion, where they were told
};

Group& TangentFlow::Impl::group(std::size_t columns) {
  const ExpressionLock lock(*equations.system->context);
  const auto found = groups.find(columns);
  if (found != groups.end()) return found->second;
  return groups
      .emplace(columns,
               Group(build_kernel(tangent::extended_source(equations, columns)), parameters, options, n, columns))
      .first->second;
}

void TangentFlow::Impl::compare(const MotionState& a, const MotionState& b, const MotionState& start) {
  const auto include = [this](double x, double y, double from) {
    if (x != y) spread = std::max(spread, std::abs(x - y) / std::max({std::abs(x), std::abs(y), std::abs(from)}));
  };
  for (std::size_t i = 0; i < n; ++i) {
    include(a.q[i], b.q[i], start.q[i]);
    include(a.v[i], b.v[i], start.v[i]);
  }
}

namespace {

void check_state(const MotionState& state, std::size_t n) {
  check_argument(state.q.size() == n, "TangentFlow: state.q has another length than the system has coordinates");
  check_argument(state.v.size() == n, "TangentFlow: state.v has another length than the system has coordinates");
}

void check_point(const TangentPoint& point, std::size_t n) {
  check_state(point.state, n);
  check_argument(n == 0 ? point.directions.empty() : point.directions.size() % (2 * n) == 0,
                 "TangentFlow: the length of `directions` is no multiple of 2n");
}

}  // namespace

KernelWorkspace& TangentFlow::Impl::point_kernel() {
  if (!at_point) {
    const ExpressionLock lock(*equations.system->context);
    motion = build_kernel(motion_source(equations));
    at_point.emplace(*motion, 1);
    at_point->set_parameters(parameters);
  }
  return *at_point;
}

/// Of the switch functions at a state; those of functions within others settle first.
std::vector<std::int8_t> TangentFlow::Impl::sides_at(const MotionState& state) {
  KernelWorkspace& work = point_kernel();
  std::vector<std::int8_t> sides(motion->switches().size(), 1), before;
  for (std::size_t pass = 0; sides != before && pass <= sides.size(); ++pass) {
    before = sides;
    work.set_branches(sides);
    static_cast<void>(work.evaluate(state.t, state.q, state.v));
    for (std::size_t i = 0; i < sides.size(); ++i) sides[i] = work.switch_function(i, 0) < 0 ? -1 : 1;
  }
  return sides;
}

/// A start within rounding of a switch belongs to both sides of it.
std::optional<TangentStop> TangentFlow::Impl::jump_at_start(const MotionState& start, double duration) {
  KernelWorkspace& work = point_kernel();
  const std::size_t count = motion->switches().size();
  const std::vector<std::int8_t> sides = sides_at(start);
  work.set_branches(sides);
  if (count == 0 || work.evaluate(start.t, start.q, start.v) != KernelStatus::Ok) return std::nullopt;
  const std::vector<bool> of_time = switches_of_time(*motion);
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < count; ++i) {
    if (of_time[i]) continue;
    const double s = work.switch_function(i, 0), rate = work.switch_function(i, 1);
    if (rate != 0 && std::abs(s) <= 1e-12 * (work.switch_scale(i) + std::abs(rate * duration))) open.push_back(i);
  }
  const auto accelerations = [&](std::span<const std::int8_t> at) {
    std::vector<double> a(n, std::numeric_limits<double>::quiet_NaN());
    work.set_branches(at);
    if (work.evaluate(start.t, start.q, start.v) == KernelStatus::Ok)
      for (std::size_t i = 0; i < n; ++i) a[i] = work.acceleration(i);
    return a;
  };
  const auto here = accelerations(sides);
  std::optional<TangentStop> stop;
  for (const std::size_t k : open) {
    auto flipped = sides;
    flipped[k] = static_cast<std::int8_t>(-flipped[k]);
    const auto there = accelerations(flipped);
    for (std::size_t i = 0; i < n; ++i)
      if (!(std::abs(here[i] - there[i]) <= least_jump * std::max(std::abs(here[i]), std::abs(there[i]))))
        stop = jump_at(start.t);
  }
  work.set_branches(std::vector<std::int8_t>(count, 1));
  return stop;
}

TangentFlow::TangentFlow(const EquationsOfMotion& equations, const TangentOptions& options) {
  check_one_mode(*equations.system, "TangentFlow(equations)");
  const ExpressionLock lock(*equations.system->context);
  impl_ = std::make_unique<Impl>(solvable_equations(equations), options);
}
TangentFlow::TangentFlow(const Model& model, const EquationsOfMotion& equations, const TangentOptions& options) {
  const ExpressionLock lock(*equations.system->context);
  if (jumps_on_its_way(model))
    modes_ = std::make_unique<ThroughModes>(model, equations, options);
  else
    impl_ = std::make_unique<Impl>(solvable_equations(equations), options);
}
TangentFlow::~TangentFlow() = default;
TangentFlow::TangentFlow(TangentFlow&&) noexcept = default;

std::size_t TangentFlow::freedoms() const { return modes_ ? modes_->freedoms : impl_->n; }
double TangentFlow::spread() const { return modes_ ? 0 : impl_->spread; }

std::optional<double> TangentFlow::log_volume_of_jumps() const { return modes_ ? modes_->log_volume : 0.0; }

void TangentFlow::set_usual_sizes(std::span<const double> sizes) {
  if (modes_)
    modes_->set_usual_sizes(sizes);
  else
    impl_->sizes.assign(sizes.begin(), sizes.end());
}

std::size_t TangentFlow::fewest_directions() const { return modes_ ? modes_->fewest : 2 * impl_->n; }

const EquationsOfMotion& TangentFlow::equations_at(const MotionState& state) {
  return modes_ ? modes_->equations_at(state) : impl_->equations;
}

TangentForces TangentFlow::forces(const TangentPoint& point) {
  check_argument(!modes_, "TangentFlow::forces: the flow goes through modes");
  check_argument(point.columns() > 0, "TangentFlow::forces: the point has no directions");
  check_point(point, impl_->n);
  const auto [count, width] = impl_->groups_for(point.columns());
  Group& group = impl_->group(width);
  TangentForces out;
  for (std::size_t k = 0; k < count; ++k) {
    group.start(point, k * width, impl_->sizes);
    group.read_forces(out, k * width, point.columns());
  }
  return out;
}

TangentPoint TangentFlow::all_directions(const MotionState& state) const {
  check_state(state, freedoms());
  if (modes_) return modes_->all_directions(state);
  return {state, impl_->geometry.basis(state)};
}

std::optional<TangentStop> TangentFlow::along(const TangentPoint& start, std::span<const double> times,
                                              std::vector<TangentPoint>& points) {
  check_point(start, freedoms());
  if (modes_) {
    TangentPoint here = start;
    points.clear();
    for (const double t : times) {
      if (auto stop = modes_->advance(here, t)) return stop;
      points.push_back(here);
    }
    return std::nullopt;
  }
  Impl& s = *impl_;
  s.spread = 0;
  points.assign(times.size(), start);
  const auto [count, width] = s.groups_for(start.columns());
  std::optional<TangentStop> stop =
      times.empty() ? std::nullopt : s.jump_at_start(start.state, times.back() - start.state.t);
  if (stop) points.clear();
  for (std::size_t k = 0; k < count && !points.empty(); ++k) {
    Group& group = s.group(width);
    group.start(start, k * width, s.sizes);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (auto failed = group.advance(times[i])) {
        stop = std::move(failed);
        points.resize(i);
        break;
      }
      group.read(points[i], k * width);
      const MotionState state = group.state();
      if (k == 0)
        points[i].state = state;
      else
        s.compare(points[i].state, state, start.state);
    }
  }
  return stop;
}

std::optional<TangentStop> TangentFlow::advance(TangentPoint& point, double t) {
  check_point(point, freedoms());
  check_argument(std::isfinite(t), "TangentFlow::advance: t is no time");
  if (modes_) return modes_->advance(point, t);
  std::vector<TangentPoint> points;
  if (auto stop = along(point, {&t, 1}, points)) return stop;
  point = std::move(points.front());
  return std::nullopt;
}

std::vector<double> TangentFlow::accelerations(const MotionState& state) {
  check_state(state, freedoms());
  if (modes_) return modes_->accelerations(state);
  Impl& s = *impl_;
  KernelWorkspace& work = s.point_kernel();
  const bool ok =
      work.choose_branches(state.t, state.q, state.v) && work.evaluate(state.t, state.q, state.v) == KernelStatus::Ok;
  work.set_branches(std::vector<std::int8_t>(s.motion->switches().size(), 1));
  if (!ok) return {};
  std::vector<double> out;
  for (std::size_t i = 0; i < s.n; ++i) out.push_back(work.acceleration(i));
  return out;
}

}  // namespace maupertuis

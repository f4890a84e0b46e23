#include "analysis/tangent/through_modes.hpp"

#include "linear_algebra/dense.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

/// Of a direction: what may stick out of the constraints of the mode after an instant. Ends of infinitely many bounces
/// leave some 1e-6.
constexpr double most_outside = 1e-4;

const std::string other_start = "Choose another start or other parameters: near this motion neighbours part.";

Eigen::Map<Matrix> columns_of(TangentPoint& point) {
  return {point.directions.data(), static_cast<Index>(point.width()), static_cast<Index>(point.columns())};
}

/// (q̇, q̈)
Vector flow_of(const MotionState& state, const std::vector<double>& a) {
  const auto n = static_cast<Index>(state.v.size());
  Vector out(2 * n);
  for (Index i = 0; i < n; ++i) {
    out(i) = state.v[static_cast<std::size_t>(i)];
    out(n + i) = a[static_cast<std::size_t>(i)];
  }
  return out;
}

bool has_friction(const MechanicalSystem& system) {
  return !system.frictions.empty() || std::any_of(system.contacts.begin(), system.contacts.end(),
                                                  [](const Contact& c) { return c.friction.present(); });
}

bool same_state(const MotionState& a, const MotionState& b) { return a.t == b.t && a.q == b.q && a.v == b.v; }

}  // namespace

TangentFlow::ThroughModes::ThroughModes(const Model& model, const EquationsOfMotion& equations,
                                        const TangentOptions& options)
    : freedoms(equations.system->coordinates.size()),
      options_(options),
      rubs_(has_friction(model.system)),
      motion_(model, equations, {},
              {.tolerance = options.tolerance, .maximum_steps = options.maximum_steps, .interrupt = options.interrupt}),
      system_(*equations.system) {
  motion_.keep_instants();
  for (std::size_t i = 0; i < system_.contacts.size() + system_.frictions.size(); ++i) {
    const Friction& friction = friction_of(system_, i);
    if (friction.slip.size() != 1) continue;
    const Expr speed = in_terms_of_motion(system_, friction.slip).front();
    Expr terms = system_.context->number(0);
    for (const Coordinate& c : system_.coordinates)
      terms = terms + apply(Kind::Abs, differentiate(speed, c.velocity) * c.velocity);
    slips_.push_back({i, friction.name, speed, terms});
  }
}

/// A slip that begins at a start at rest: the force on neighbours that slip the other way is the opposite one.
std::optional<TangentStop> TangentFlow::ThroughModes::parts_at_start(const MotionState& state) const {
  Bindings at = parameter_bindings(system_);
  at[system_.context->time()] = state.t;
  for (std::size_t i = 0; i < freedoms; ++i)
    at[system_.coordinates[i].q] = state.q[i], at[system_.coordinates[i].velocity] = state.v[i];
  for (const Slip& slip : slips_) {
    const FrictionState mode = motion_.mode().friction[slip.friction];
    if (mode != FrictionState::Forward && mode != FrictionState::Backward) continue;
    constexpr double rounding = 1e-12;
    if (std::abs(evaluate(slip.speed, at)) > rounding * evaluate(slip.terms, at)) continue;
    return TangentStop{StepEnding::None, state.t,
                       fmt::format("The start is at rest under the friction of {}, and begins to slide: on neighbours "
                                   "that slip the other way it acts the other way.",
                                   slip.name),
                       "Start with a slip, or where it sticks."};
  }
  return std::nullopt;
}

/// Where the last advance ended, the motion goes on in its mode; elsewhere it begins anew.
void TangentFlow::ThroughModes::stand_at(const MotionState& state) {
  if (at_ && same_state(*at_, state)) return;
  motion_.start(state.t, state.q, state.v);
  at_ = state;
  has_moved_ = false;
}

TangentFlow::ThroughModes::InMode& TangentFlow::ThroughModes::in(const ContactMode& mode) {
  for (const auto& m : modes_)
    if (m->mode == mode) return *m;
  InMode& made = *modes_.emplace_back(std::make_unique<InMode>(mode, motion_.equations_in(mode), options_));
  if (!sizes_.empty()) made.flow.set_usual_sizes(sizes_);
  return made;
}

TangentPoint TangentFlow::ThroughModes::all_directions(const MotionState& state) {
  stand_at(state);
  return in(motion_.mode()).flow.all_directions(state);
}

std::vector<double> TangentFlow::ThroughModes::accelerations(const MotionState& state) {
  stand_at(state);
  return in(motion_.mode()).flow.accelerations(state);
}

const EquationsOfMotion& TangentFlow::ThroughModes::equations_at(const MotionState& state) {
  stand_at(state);
  return motion_.equations_in(motion_.mode());
}

std::optional<TangentStop> TangentFlow::ThroughModes::advance(TangentPoint& point, double t) {
  stand_at(point.state);
  log_volume = rubs_ ? std::nullopt : std::optional(0.0);
  fewest = point.width();
  if (motion_.time() != point.state.t || motion_.begins_to_slide())
    return TangentStop{StepEnding::None, point.state.t,
                       "A slip in space begins at the start: neighbours are not carried through that yet.",
                       "Start with a slip."};
  if (!same_state(motion_.state(), point.state))
    return TangentStop{StepEnding::None, point.state.t,
                       "The start is an impact, and neighbours have it at other times.",
                       "Start before it or after it."};
  if (!has_moved_)
    if (auto stop = parts_at_start(point.state)) return stop;
  has_moved_ = true;
  TangentPoint here = point;
  while (motion_.time() != t) {
    const Step step = motion_.step(t);
    if (const ModeInstant* instant = motion_.instant()) {
      if (auto stop = carry(here, instant->mode_before, instant->before.t)) return stop;
      if (auto stop = pass(here, *instant)) return stop;
    }
    if (step.ending != StepEnding::None) return TangentStop{step.ending, step.begin, step.reason, {}};
    if (motion_.stopped_by())
      return TangentStop{StepEnding::Interrupted, step.end,
                         fmt::format("The event `{}` of the model stops it.", *motion_.stopped_by()),
                         "Leave the event out, or ask for a shorter time."};
  }
  if (auto stop = carry(here, motion_.mode(), t)) return stop;
  here.state = motion_.state();
  at_ = here.state;
  point = std::move(here);
  return std::nullopt;
}

std::optional<TangentStop> TangentFlow::ThroughModes::carry(TangentPoint& point, const ContactMode& mode, double t) {
  return point.state.t == t ? std::nullopt : in(mode).flow.advance(point, t);
}

/// An instant, from the state before it to the state after it.
std::optional<TangentStop> TangentFlow::ThroughModes::pass(TangentPoint& point, const ModeInstant& instant) {
  if (!instant.obstacle.empty()) return TangentStop{StepEnding::None, instant.before.t, instant.obstacle, other_start};
  point.state = instant.before;
  const double size = point.directions.empty() ? 0 : columns_of(point).cwiseAbs().maxCoeff();
  Vector f = flow_of(instant.before, instant.a_before);
  const ContactMode* mode = &instant.mode_before;
  for (std::size_t k = 0; k < instant.jumps.size(); ++k) {
    const InstantJump& j = instant.jumps[k];
    const bool last = k + 1 == instant.jumps.size();
    const std::vector<double> a = last ? instant.a_after : in(j.mode).flow.accelerations(j.after);
    if (a.size() != freedoms)
      return TangentStop{StepEnding::None, instant.before.t, "An acceleration has no value between two impacts.",
                         other_start};
    const Vector f_after = flow_of(j.after, a);
    if (auto stop = jump(point, j, in(*mode), f, f_after)) return stop;
    point.state = j.after;
    f = f_after;
    mode = &j.mode;
    log_volume = log_volume && j.log_volume ? std::optional(*log_volume + *j.log_volume) : std::nullopt;
  }
  point.state = instant.after;
  return keep_constraints(point, instant.mode_after, size);
}

std::optional<TangentStop> TangentFlow::ThroughModes::jump(TangentPoint& point, const InstantJump& j, InMode& before,
                                                           const Vector& f_before, const Vector& f_after) {
  if (!(std::abs(j.rate) > j.touching))
    return TangentStop{
        StepEnding::None, point.state.t,
        fmt::format("What happens at t = {:.9g} is only touched by the motion (its rate is {:.2g} there): "
                    "some neighbours meet it and others do not.",
                    point.state.t, j.rate),
        other_start};
  const auto found = before.triggers.find(j.function);
  const tangent::Trigger& trigger =
      found != before.triggers.end()
          ? found->second
          : before.triggers.emplace(j.function, tangent::Trigger(before.equations, j.function)).first->second;
  std::optional<TangentForces> forces;
  if (trigger.sees_forces()) forces = before.flow.forces(point);
  const Eigen::RowVectorXd changes = trigger.along(point, forces);
  auto columns = columns_of(point);
  Vector f_carried = f_before;
  if (!j.slopes.empty()) {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Index width = columns.rows();
    const Matrix slopes = Eigen::Map<const Rows>(j.slopes.data(), width, width + 1);
    const Matrix by_state = slopes.leftCols(width);
    columns = (by_state * columns).eval();
    f_carried = by_state * f_before + slopes.col(width);
  }
  columns += (f_after - f_carried) * (changes / j.rate);
  if (columns.allFinite()) return std::nullopt;
  return TangentStop{StepEnding::Overflow, point.state.t, "A direction grew beyond all numbers at an instant.",
                     other_start};
}

/// Directions after an instant are those of the mode after it, to rounding; what is left of it is taken away. `size`:
/// the largest of them before it.
std::optional<TangentStop> TangentFlow::ThroughModes::keep_constraints(TangentPoint& point, const ContactMode& mode,
                                                                       double size) {
  InMode& m = in(mode);
  if (!m.equations.system->constrained()) return std::nullopt;
  const std::vector<double> basis = m.geometry.basis(point.state);
  fewest = std::min(fewest, basis.size() / point.width());
  auto columns = columns_of(point);
  const Index width = columns.rows();
  const Matrix b = Eigen::Map<const Matrix>(basis.data(), width, static_cast<Index>(basis.size()) / width);
  const Matrix kept = b * (b.transpose() * columns);
  if (columns.size() == 0) return std::nullopt;
  const double largest = std::max(size, columns.cwiseAbs().maxCoeff()),
               outside = (columns - kept).cwiseAbs().maxCoeff();
  if (!(outside <= most_outside * largest))
    return TangentStop{StepEnding::None, point.state.t,
                       fmt::format("Neighbours do not come into the same mode at t = {:.9g}.", point.state.t),
                       other_start};
  columns = kept;
  return std::nullopt;
}

}  // namespace maupertuis

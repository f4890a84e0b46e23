#pragma once
#include "integrator/extended/stepper.hpp"
#include "integrator/taylor/met_roots_code.hpp"
#include "integrator/taylor/reasons.hpp"
#include "integrator/taylor/roots_code.hpp"
#include "kernel/extended/workspace_code.hpp"

namespace maupertuis::extended {

template <class T>
Stepper<T>::Stepper(const Kernel& kernel, std::span<const T> parameters, const ExtendedOptions& options,
                    double log2_tolerance)
    : kernel_(kernel),
      options_(options),
      log2_tolerance_(log2_tolerance),
      control_(step_control(log2_tolerance, options.order)),
      work_(kernel, control_.order),
      probe_(kernel, 1),
      n_(kernel.freedoms()),
      switch_state_(kernel.switches().size()),
      event_state_(kernel.events()),
      safe_(work_.program(), control_.order, 1e4 * std::exp2(log2_tolerance)),
      kinks_(work_.program(), kernel.switches().size(), kernel.events()) {
  if (watches()) {
    std::vector<Slot> slots = work_.program().switch_slots;
    slots.insert(slots.end(), work_.program().events.begin(), work_.program().events.end());
    roots_.emplace(work_.program(), control_.order, slots);
  }
  work_.set_parameters(parameters);
  probe_.set_parameters(parameters);
  polynomial_.resize(static_cast<std::size_t>(control_.order + 2) * n_);
}

template <class T>
void Stepper<T>::start(const T& t, std::vector<T> q, std::vector<T> v) {
  t_ = begin_ = t;
  q_ = q_begin_ = std::move(q);
  v_ = v_begin_ = std::move(v);
  std::fill(polynomial_.begin(), polynomial_.end(), T(0));
  std::copy(q_.begin(), q_.end(), polynomial_.begin());
  length_ = std::numeric_limits<double>::quiet_NaN();
  restraint_ = 0;
  first_ = true;
  steps_ = switches_ = rejected_ = 0;
  safe_.forget();
  rates_.assign(n_, 0.0);
  stuck_ = 0;
  std::fill(switch_state_.begin(), switch_state_.end(), taylor::Watched{});
  std::fill(event_state_.begin(), event_state_.end(), taylor::Watched{});
  choose_first_sides();
}

template <class T>
void Stepper<T>::come_from(const T& t, const std::vector<T>& q, const std::vector<T>& v,
                           const std::vector<T>& accelerations) {
  begin_ = t, q_begin_ = q, v_begin_ = v;
  for (std::size_t i = 0; i < n_; ++i) polynomial_[2 * n_ + i] = accelerations[i] / 2;
}

template <class T>
void Stepper<T>::set_usual_sizes(std::vector<T> q, std::vector<T> v, std::vector<T> a) {
  work_.set_usual_accelerations(a);
  probe_.set_usual_accelerations(a);
  usual_ = {std::move(q), std::move(v), std::move(a)};
}

template <class T>
typename Stepper<T>::Outcome Stepper<T>::failure(KernelStatus status) {
  const StepEnding ending = status == KernelStatus::SingularMass    ? StepEnding::SingularMass
                            : status == KernelStatus::Contradiction ? StepEnding::SingularConstraints
                                                                    : StepEnding::Overflow;
  const bool is_finite = ending == StepEnding::Overflow && work_.evaluate(t_, q_, v_) == KernelStatus::Ok;
  return {ending, taylor::reason_of(status, kernel_, work_, is_finite)};
}

template <class T>
T Stepper<T>::constraint_error() const {
  return ConstraintError<T>(work_, std::isfinite(length_) ? exp2_of<T>(length_) : T(0), usual_).largest();
}

/// Brings q and q̇ back to the constraints, by the factors of the expansion; the motion is expanded anew while that
/// helps.
template <class T>
std::optional<typename Stepper<T>::Outcome> Stepper<T>::project() {
  const T rounding = 64 * epsilon<T>(), allowed = epsilon_to<T>(0.45);
  T error = constraint_error();
  // A rotation has no radius of convergence that would bound its steps; what a step leaves in the constraints does.
  if (!first_ && error > rounding + exp2_of<T>(log2_tolerance_)) restraint_ = std::log2(0.45);
  std::vector<T> dq(n_), dv(n_);
  for (int turn = 0; turn < 20; ++turn) {
    if (!first_ && error > allowed) break;
    work_.corrections(dq, dv);
    for (std::size_t i = 0; i < n_; ++i) q_[i] += dq[i], v_[i] += dv[i];
    if (error <= rounding) return std::nullopt;
    if (const KernelStatus status = work_.expand(t_, q_, v_); status != KernelStatus::Ok) return failure(status);
    const T now = constraint_error();
    if (turn > 2 && now > error / 2) break;
    error = now;
  }
  if (error <= epsilon_to<T>(0.8)) return std::nullopt;
  return Outcome{StepEnding::SingularConstraints,
                 "The constraints are singular near here: they do not determine where the motion goes."};
}

template <class T>
std::optional<typename Stepper<T>::Outcome> Stepper<T>::expand(const T& bound) {
  set_sides(work_);
  if (const KernelStatus status = work_.expand(t_, q_, v_); status != KernelStatus::Ok) return failure(status);
  if (kernel_.constraints() > 0)
    if (const auto stopped = project()) return stopped;
  return switch_state_.empty() ? std::nullopt : decide_sides(bound);
}

// ------------------------------------------------------------------------------------------------- switches and events

template <class T>
void Stepper<T>::set_sides(Workspace<T>& work) const {
  std::vector<std::int8_t> sides;
  for (const taylor::Watched& s : switch_state_) sides.push_back(s.side);
  work.set_branches(sides);
}

/// Signs of the switch functions at the start, zeros left open: enough for the values there. A function within another
/// comes before it; forces may have no value until all sides are right.
template <class T>
void Stepper<T>::choose_first_sides() {
  bool changed = !switch_state_.empty();
  for (std::size_t pass = 0; changed && pass <= switch_state_.size(); ++pass) {
    set_sides(work_);
    static_cast<void>(work_.evaluate(t_, q_, v_));
    changed = false;
    for (std::size_t i = 0; i < switch_state_.size(); ++i) {
      const std::int8_t side = taylor::watching::sign(work_.switch_function(i, 0));
      changed = changed || side != switch_state_[i].side;
      switch_state_[i].side = side;
    }
  }
  set_sides(probe_);
}

/// The length over which the motion in the workspace is judged, with the sign of the direction of time.
template <class T>
T Stepper<T>::judged_length(const T& bound) const {
  const T left = bound - t_;
  const double chosen = StepSize<T>(work_, n_, control_).log2_length(length_);
  if (chosen >= log2_size(left)) return left;
  return left > 0 ? exp2_of<T>(chosen) : T(-exp2_of<T>(chosen));
}

template <class T>
std::optional<typename Stepper<T>::Outcome> Stepper<T>::decide_sides(const T& bound) {
  using Chooser = taylor::SideChooserOf<Workspace<T>>;
  Chooser chooser(work_, switch_state_, [&](const std::vector<std::int8_t>&) -> std::optional<T> {
    set_sides(work_);
    if (work_.expand(t_, q_, v_) != KernelStatus::Ok) return std::nullopt;
    return judged_length(bound);
  });
  switch (chooser.decide(judged_length(bound))) {
    case Chooser::Outcome::Decided:
      return without_value();
    case Chooser::Outcome::Failed:
      return failure(KernelStatus::NonFinite);
    case Chooser::Outcome::Sliding:
      break;
  }
  return Outcome{StepEnding::Sliding,
                 "Both sides of a switch push the motion back to it, so that it would slide along the switch."};
}

/// See TaylorStepper::Impl::switches_have_values.
template <class T>
std::optional<typename Stepper<T>::Outcome> Stepper<T>::without_value() {
  const auto motion_on = [&](taylor::Watched& w, std::int8_t side) {
    w.side = side;
    set_sides(work_);
    std::vector<T> coefficients;
    if (work_.expand(t_, q_, v_) != KernelStatus::Ok) return coefficients;
    for (int k = 2; k <= control_.order; ++k)
      coefficients.insert(coefficients.end(), work_.coordinate(k), work_.coordinate(k) + n_);
    return coefficients;
  };
  for (std::size_t i = 0; i < switch_state_.size(); ++i) {
    if (has_value(i)) continue;
    taylor::Watched& w = switch_state_[i];
    const std::vector<T> above = motion_on(w, 1), below = motion_on(w, -1);
    if (above.empty() || above != below)
      return Outcome{StepEnding::Overflow,
                     "The argument of a switch (step, sign, abs, min, max or a comparison) is no real number here, and "
                     "the motion depends on it."};
    static_cast<void>(motion_on(w, 0));
  }
  return std::nullopt;
}

template <class T>
typename Stepper<T>::Crossing Stepper<T>::first_crossing(const T& h) {
  Crossing first;
  if (!watches()) return first;
  first.after = switch_state_;
  first.after.insert(first.after.end(), event_state_.begin(), event_state_.end());
  take_rough_constants();
  roots_->set_constants({work_.constants(), rough_constants_.size()});
  roots_->begin({t_, T(0)}, h, [this](int k) { return work_.coordinate(k); });
  const T together = std::max(T(4 * epsilon<T>()), T(4 * epsilon<T>() * abs(t_ / h)));
  first.x = roots_->window();
  const std::size_t count = switch_state_.size();
  for (std::size_t i = 0; i < first.after.size(); ++i) {
    const bool is_switch = i < count;
    taylor::Watched& watched = first.after[i];
    if (is_switch && watched.side == 0 && has_value(i)) continue;  // it vanishes
    if (!is_switch && !roots_->is_clear(i))
      if (const auto way = taylor::root_at_begin(work_, i - count, h, watched))
        first.note({T(0), taylor::RootKind::Crossing, 0, watched.order}, i, together, *way);
    // Events at one instant are all told: the search goes on beyond the first root by what a polynomial does not
    // resolve.
    const T beyond = is_switch ? together : std::max(together, epsilon_to<T>(0.77));
    const T until = std::min(roots_->window(), T(first.x * (1 + together) + beyond));
    const auto root = roots_->first(i, watched, T(0), until, !is_switch, is_switch);
    if (!root && roots_->lost() && *roots_->lost() < first.x) first.end_where_lost(*roots_->lost());
    if (!root) continue;
    const bool jump = root->kind == taylor::RootKind::Jump;
    first.note(*root, i, together, root->kind == taylor::RootKind::Touching ? 0 : -watched.side);
    if (jump) watched = {root->after, false};
  }
  const T located = std::max(together, epsilon_to<T>(0.77));  // roots are, within the tolerance of the run
  kinks_.leave_open(*roots_, event_state_, h, located, first);
  // A step of no length leaves the others where they were.
  for (std::size_t i = 0; i < count && first.x == 0; ++i) first.after[i].at_zero = switch_state_[i].at_zero;
  for (const taylor::MetRoot<T>& root : first.roots) {
    if (root.is_jump) continue;  // what lies beyond is known
    taylor::Watched& watched = first.after[root.index];
    if (root.index < count)
      watched = {static_cast<std::int8_t>(-watched.side), true};
    else
      watched = {0, true, root.order};
  }
  return first;
}

/// What the step leaves behind in the watched functions: those that it ends at are at a zero.
template <class T>
void Stepper<T>::leave(const Crossing& crossing) {
  const std::size_t count = switch_state_.size();
  for (std::size_t i = 0; i < crossing.after.size(); ++i)
    (i < count ? switch_state_[i] : event_state_[i - count]) = crossing.after[i];
  for (const taylor::MetRoot<T>& root : crossing.roots) switches_ += root.index < count;
}

/// Nothing: the equations do not hold at the end.
template <class T>
std::optional<typename Stepper<T>::Outcome> Stepper<T>::advance(const T& bound, const T& h, bool reaches) {
  const Crossing crossing = first_crossing(h);
  if (crossing.found && stuck_ >= 100)
    return Outcome{StepEnding::Sliding,
                   "Switches follow each other in no time: the motion has come to slide along a switch."};
  if (crossing.is_lost && crossing.x == 0) return Outcome{StepEnding::Overflow, taylor::no_series_of_watched};
  const T tau = h * crossing.x;
  state_after(tau, q_, v_);
  t_ = reaches && !crossing.found && crossing.x == 1 ? bound : T(begin_ + tau);
  if (!equations_hold(tau)) return std::nullopt;
  stuck_ = crossing.found && t_ == begin_ ? stuck_ + 1 : 0;
  leave(crossing);
  first_ = false;
  ++steps_;
  Outcome out;
  for (const taylor::MetRoot<T>& root : crossing.roots)
    if (root.index >= switch_state_.size())
      out.events.push_back({root.index - switch_state_.size(), root.direction, root.order});
  return out;
}

/// The end of a step as a check: see integrator/taylor/end_check.hpp. The mode is that of the step.
template <class T>
bool Stepper<T>::equations_hold(const T& tau) {
  if (tau == 0) return true;
  if (probe_.evaluate(t_, q_, v_) != KernelStatus::Ok) return false;
  std::vector<T> off(n_), here(n_);
  const T allowed = std::max(T(4096 * epsilon<T>()), T(10 * exp2_of<T>(log2_tolerance_)));
  bool good = true;
  for (std::size_t i = 0; i < n_; ++i) {
    T by_polynomial = T(0);
    for (int k = control_.order + 1; k >= 2; --k)
      by_polynomial = by_polynomial * tau + T(k * (k - 1)) * polynomial_[static_cast<std::size_t>(k) * n_ + i];
    here[i] = probe_.acceleration(i);
    off[i] = abs(by_polynomial - here[i]);
    good = good && off[i] <= allowed * std::max({T(T(rates_[i]) / abs(tau)), T(abs(here[i])), T(1e-40)});
  }
  if (good) return true;
  // What rounding of the formula's values and of the state makes of q̈ is no failure.
  take_rough_constants();
  safe_.disks().begin(rows_.of(probe_.coordinate(0), probe_.row_stride(), 1, 0));
  safe_.set_constants(rough_constants_.data());
  const std::vector<double> of_values =
      taylor::acceleration_roundings(taylor::bordered_matrix(probe_, n_, kernel_.constraints()), n_,
                                     kernel_.constraints(), safe_.disks(), static_cast<double>(abs(tau)), 1.0);
  std::vector<T> q = q_, v = v_;
  for (std::size_t i = 0; i < n_; ++i) q[i] *= 1 + (i % 2 == 0 ? 1 : -1) * epsilon<T>(), v[i] *= 1 + epsilon<T>();
  if (probe_.evaluate(T(t_ * (1 + epsilon<T>())), q, v) != KernelStatus::Ok) return false;
  for (std::size_t i = 0; i < n_; ++i) {
    const T rounding = 64 * (abs(probe_.acceleration(i) - here[i]) + epsilon<T>() * (abs(here[i]) + T(of_values[i])));
    if (!(off[i] <= allowed * std::max({T(T(rates_[i]) / abs(tau)), T(abs(here[i])), T(1e-40)}) + rounding))
      return false;
  }
  return true;
}

template <class T>
void Stepper<T>::take_rough_constants() {
  rough_constants_.clear();
  for (std::size_t i = 0; i < work_.program().constants.size(); ++i)
    rough_constants_.push_back(static_cast<double>(work_.constants()[i]));
}

/// log₂ of a length that every value of the program allows.
template <class T>
double Stepper<T>::safe_length(double log2_wanted, double log2_left) {
  const double log2_most = std::min(log2_wanted, log2_left), most = std::exp2(log2_most);
  for (std::size_t i = 0; i < n_; ++i)
    rates_[i] = std::max(
        {rates_[i], std::abs(static_cast<double>(v_[i])), most * std::abs(static_cast<double>(work_.acceleration(i)))});
  if (!safe_.is_needed() || !std::isfinite(log2_most) || most == 0) return log2_wanted;
  if (safe_.wants_momenta(rates_)) safe_.set_momenta(rates_, work_);
  take_rough_constants();
  safe_.set_constants(rough_constants_.data());
  const double safe = safe_.within(
      rows_.of(work_.coordinate(0), work_.row_stride(), control_.order, static_cast<int>(std::floor(log2_most))),
      static_cast<double>(t_), std::exp2(log2_wanted), std::exp2(log2_left));
  return safe >= std::exp2(log2_wanted) ? log2_wanted : std::log2(safe);
}

template <class T>
void Stepper<T>::keep_polynomial() {
  begin_ = t_;
  set_sides(probe_);
  q_begin_ = q_;
  v_begin_ = v_;
  for (int k = 0; k <= control_.order + 1; ++k)
    std::copy_n(work_.coordinate(k), n_,
                polynomial_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * n_));
}

/// Horner's rule for the increments alone: they are small against q and q̇.
template <class T>
void Stepper<T>::state_after(const T& tau, std::vector<T>& q, std::vector<T>& v) const {
  q.resize(n_), v.resize(n_);
  for (std::size_t i = 0; i < n_; ++i) {
    T dq = T(0), dv = T(0);
    for (int k = control_.order + 1; k >= 2; --k) {
      const T& c = polynomial_[static_cast<std::size_t>(k) * n_ + i];
      dq = (dq + c) * tau;
      dv = dv * tau + k * c;
    }
    q[i] = q_begin_[i] + (dq + v_begin_[i]) * tau;
    v[i] = v_begin_[i] + dv * tau;
  }
}

template <class T>
typename Stepper<T>::Outlook Stepper<T>::outlook(const T& bound) {
  Outlook out;
  if (const auto stopped = expand(bound)) {
    out.ending = stopped->ending, out.reason = stopped->reason;
    return out;
  }
  const T h = judged_length(bound);
  for (std::size_t i = 0; i < event_state_.size(); ++i) {
    const Polynomial polynomial = taylor::judged(taylor::event_polynomial(work_, i, h));
    const bool at_zero = event_state_[i].at_zero || polynomial.begins_at_zero();
    const std::int8_t side =
        at_zero ? polynomial.direction(event_state_[i].order) : taylor::watching::sign(polynomial.p[0]);
    out.sides.push_back(event_state_[i].is_open ? event_state_[i].side : side);  // it is on its way
    out.reach.push_back(polynomial.reach);
    out.values.push_back(work_.event(i, 0));
    out.slopes.push_back(work_.event(i, 1));
  }
  for (std::size_t i = 0; i < n_; ++i) out.accelerations.push_back(work_.acceleration(i));
  for (std::size_t i = 0; i < kernel_.constraints(); ++i) out.multipliers.push_back(work_.multiplier(i));
  return out;
}

template <class T>
typename Stepper<T>::Outcome Stepper<T>::step(const T& bound) {
  if (t_ == bound) return {};
  if (options_.interrupt && options_.interrupt->load(std::memory_order_relaxed))
    return {StepEnding::Interrupted, "The run was interrupted."};
  if (steps_ >= options_.maximum_steps) return {StepEnding::TooManySteps, "The run used up its steps."};
  if (const auto stopped = expand(bound)) return *stopped;
  const T left = bound - t_;
  double chosen = restraint_ + StepSize<T>(work_, n_, control_).log2_length(length_);
  if (kernel_.constraints() > 0)
    chosen = within_multipliers(work_, n_, kernel_.constraints(), control_.order, std::min(chosen, log2_size(left)));
  length_ = chosen;
  chosen = safe_length(chosen, log2_size(left));
  keep_polynomial();
  for (;; chosen = std::min(chosen, log2_size(left)) - 1) {
    if (!(chosen > 1 + log2_size(epsilon<T>()) + log2_size(t_)) || chosen < -100'000)
      return {StepEnding::StepUnderflow,
              "The steps shrink below the resolution of time: a force grows without bound, as in a collision, or a "
              "formula has no derivatives, as x^(3/2) where x comes to 0."};
    const bool reaches = chosen >= log2_size(left);
    const T h = reaches ? left : left > 0 ? exp2_of<T>(chosen) : T(-exp2_of<T>(chosen));
    if (const auto outcome = advance(bound, h, reaches)) return *outcome;
    ++rejected_;
    t_ = begin_, q_ = q_begin_, v_ = v_begin_;
  }
}

/// All digits, and the few that tell it from its neighbours.
template <class T>
std::string text_of(const T& x) {
  return is_finite(x) ? x.str(std::numeric_limits<T>::max_digits10, std::ios_base::scientific) : std::string();
}

template <class T>
ExtendedSample Stepper<T>::sample(const T& t) {
  std::vector<T> q, v;
  state_after(t - begin_, q, v);
  if (t == t_) q = q_, v = v_;
  const bool ok = probe_.evaluate(t, q, v) == KernelStatus::Ok;
  ExtendedSample out;
  out.reached = true;
  out.t = text_of(t);
  for (std::size_t i = 0; i < n_; ++i) out.q.push_back(text_of(q[i])), out.v.push_back(text_of(v[i]));
  for (std::size_t i = 0; i < kernel_.observables(); ++i)
    out.observables.push_back(ok ? text_of(probe_.observable(i)) : std::string());
  for (std::size_t i = 0; i < kernel_.constraints(); ++i)
    out.multipliers.push_back(ok && probe_.multiplier_is_determined(i) ? text_of(probe_.multiplier(i)) : std::string());
  return out;
}

}  // namespace maupertuis::extended

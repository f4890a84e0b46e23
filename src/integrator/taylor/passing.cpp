#include "integrator/taylor/passed_stretch.hpp"
#include "integrator/taylor/stepper.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

/// Steps that no series makes. Where a formula has a singularity that the motion has not (sin x/x at 0, multipliers
/// where a linkage is flat), or one that moves nothing yet (max(x, 0)^(3/2) at 0), coefficients are lost to
/// cancellation the earlier the nearer it is, or are not there at all. Such a place is passed by collocation at Gauss's
/// points, none of which is an end: the force is asked for beside the place alone. What was passed must be smooth: at
/// points that are no nodes the polynomial has the acceleration that the equations give.
namespace maupertuis {
namespace {

constexpr int nodes = 8;
constexpr int looks = 33;  // beside the nodes
constexpr int most_sweeps = 40, enough_to_settle = 3;
constexpr double settled = 1e-16;  // change of q̈ h by a sweep, of the velocity
constexpr double epsilon = std::numeric_limits<double>::epsilon();

using Nodes = std::array<double, nodes>;

Nodes gauss_points() {
  constexpr std::array<double, nodes / 2> half{0.18343464249564980, 0.52553240991632899, 0.79666647741362674,
                                               0.96028985649753623};
  Nodes out{};
  for (std::size_t i = 0; i < half.size(); ++i) {
    out[nodes / 2 + i] = (1 + half[i]) / 2;
    out[nodes / 2 - 1 - i] = (1 - half[i]) / 2;
  }
  return out;
}

/// [j][k]: the coefficient of x^k in the polynomial that is 1 at node j and 0 at the others.
std::array<Nodes, nodes> cardinal_polynomials(const Nodes& at) {
  std::array<Nodes, nodes> out{};
  for (int j = 0; j < nodes; ++j) {
    Nodes p{1};
    for (int i = 0; i < nodes; ++i) {
      if (i == j) continue;
      for (int k = nodes - 1; k >= 0; --k) p[k] = ((k > 0 ? p[k - 1] : 0) - at[i] * p[k]) / (at[j] - at[i]);
    }
    out[j] = p;
  }
  return out;
}

double value(const Nodes& p, double x) {
  double sum = 0;
  for (int k = nodes - 1; k >= 0; --k) sum = sum * x + p[k];
  return sum;
}

}  // namespace

/// A step of length h as polynomials of q̈ in x = τ/h, and of what is integrated.
class TaylorStepper::Impl::Collocation {
 public:
  /// `stepper.probe` has the sides of the last point that was asked for, afterwards.
  Collocation(Impl& stepper, double h, Place place);
  /// q̈ at the nodes, until it is that of the polynomial through it.
  bool converges();
  bool is_smooth();
  /// Whether nothing happens between all these points but at the place itself.
  bool is_smooth_between();
  /// [order + 2][count] coefficients in time of the state, of `count` unknowns: coordinates, then multipliers.
  std::vector<double> rows(int order, std::size_t count) const;

  const double h;
  std::vector<Nodes> acceleration, multiplier, integrand;  // coefficients
  std::vector<std::int8_t> sides;                          // at the last point that was asked for

 private:
  bool ask_beside(double x);
  bool evaluate_on_constraints(double time, std::vector<double>& position, std::vector<double>& velocity);
  bool keeps_events() const;
  /// What q̈ h may be off beside the nodes, of the velocity. Next to a singular configuration of the constraints q̈ has
  /// rounding errors across the branch on which the motion goes; the projection takes them out at the end, where the
  /// branches are apart.
  double smooth() const { return place_ == Place::OfConstraints ? 1e-6 : 2e-13; }
  double momentum(std::size_t j) const;
  bool agrees(double x, double by) const;
  bool holds(double x, taylor::PassedStretch& between) const;
  double length_from(double x, double least, taylor::PassedStretch& between);

  Impl& s_;
  Place place_;
  std::vector<double> size_;  // [n] of the velocities
};

TaylorStepper::Impl::Collocation::Collocation(Impl& stepper, double length, Place place)
    : h(length),
      acceleration(stepper.n, Nodes{}),
      multiplier(stepper.m, Nodes{}),
      integrand(stepper.state.integrals.size(), Nodes{}),
      s_(stepper),
      place_(place) {
  const taylor::MotionState& now = stepper.state;
  for (std::size_t i = 0; i < stepper.n; ++i)
    size_.push_back(std::max(std::abs(now.v_now[i]), epsilon * std::abs(now.q_now[i]) / std::abs(h)));
  for (const taylor::Watched& w : stepper.watched.switches) sides.push_back(w.side);
}

/// The constraints are nearly singular at such places, and a state beside them has an acceleration that is far off.
bool TaylorStepper::Impl::Collocation::evaluate_on_constraints(double time, std::vector<double>& position,
                                                               std::vector<double>& velocity) {
  constexpr int turns = 3;
  for (int turn = 0; turn < (s_.m > 0 ? turns : 0); ++turn) {
    if (s_.probe.evaluate(time, position, velocity) != KernelStatus::Ok) return false;
    s_.probe.corrections(s_.constraints.dq, s_.constraints.dv);
    for (std::size_t i = 0; i < s_.n; ++i) position[i] += s_.constraints.dq[i], velocity[i] += s_.constraints.dv[i];
  }
  return s_.probe.evaluate(time, position, velocity) == KernelStatus::Ok;
}

/// The polynomial's state at x; q̈ there by the equations is in `probe`. False: it has no value, or an event changes its
/// sign.
bool TaylorStepper::Impl::Collocation::ask_beside(double x) {
  const taylor::MotionState& now = s_.state;
  std::vector<double> position(s_.n), velocity(s_.n);
  for (std::size_t i = 0; i < s_.n; ++i) {
    double once = 0, twice = 0;
    for (int k = nodes - 1; k >= 0; --k) {
      once = once * x + acceleration[i][k] / (k + 1);
      twice = twice * x + acceleration[i][k] / ((k + 1) * (k + 2));
    }
    velocity[i] = now.v_now[i] + h * x * once;
    position[i] = now.q_now[i] + h * x * (now.v_now[i] + h * x * twice);
  }
  const double time = now.t.hi + h * x;
  if (sides.empty()) return evaluate_on_constraints(time, position, velocity) && keeps_events();
  for (std::size_t pass = 0; pass <= sides.size(); ++pass) {
    s_.probe.set_branches(sides);
    const bool defined = evaluate_on_constraints(time, position, velocity);
    bool changed = false;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const double value = s_.probe.switch_function(i, 0);
      if (std::isnan(value)) return false;
      const std::int8_t side = value > 0 ? 1 : value < 0 ? -1 : sides[i];
      changed = changed || side != sides[i];
      sides[i] = side;
    }
    if (!changed) return defined && keeps_events();
  }
  return false;
}

/// Events are not looked for in such a step: it is none where one happens.
bool TaylorStepper::Impl::Collocation::keeps_events() const {
  for (std::size_t i = 0; i < s_.watched.events.size(); ++i)
    if (s_.probe.event(i, 0) * s_.watched.events[i].side < 0) return false;
  return true;
}

bool TaylorStepper::Impl::Collocation::converges() {
  const Nodes at = gauss_points();
  const auto cardinal = cardinal_polynomials(at);
  double before = std::numeric_limits<double>::infinity();
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    std::vector<Nodes> now(s_.n, Nodes{}), multiplier_now(s_.m, Nodes{}), integrand_now(integrand.size(), Nodes{});
    double change = 0;
    for (int j = 0; j < nodes; ++j) {
      if (!ask_beside(at[j])) return false;
      for (std::size_t i = 0; i < s_.n; ++i) {
        const double a = s_.probe.acceleration(i);
        size_[i] = std::max(size_[i], std::abs(h * a));
        if (const double moved = std::abs(h * (a - value(acceleration[i], at[j]))); moved > 0)
          change = std::max(change, moved / size_[i]);
        for (int k = 0; k < nodes; ++k) now[i][k] += a * cardinal[j][k];
      }
      for (int k = 0; k < nodes; ++k) {
        for (std::size_t i = 0; i < s_.m; ++i) multiplier_now[i][k] += s_.probe.multiplier(i) * cardinal[j][k];
        for (std::size_t i = 0; i < integrand.size(); ++i)
          integrand_now[i][k] += s_.probe.integrand(i, 0) * cardinal[j][k];
      }
    }
    acceleration = std::move(now);
    multiplier = std::move(multiplier_now);
    integrand = std::move(integrand_now);
    if (change <= settled || (change <= smooth() / 2 && change > before / 2)) return true;
    if (sweep >= enough_to_settle && change >= before && change > smooth()) return false;  // the force jumps there
    before = change;
  }
  return false;
}

bool TaylorStepper::Impl::Collocation::is_smooth() {
  for (int k = 1; k <= looks; ++k) {
    const double x = static_cast<double>(k) / looks;
    if (!ask_beside(x) || !agrees(x, smooth())) return false;
  }
  return true;
}

/// Whether q̈ of the point that was asked for is that of the polynomial, but for `by` of what moves.
bool TaylorStepper::Impl::Collocation::agrees(double x, double by) const {
  for (std::size_t i = 0; i < s_.n; ++i)
    if (!(std::abs(h * (s_.probe.acceleration(i) - value(acceleration[i], x))) <= by * size_[i])) return false;
  return true;
}

/// Whether the motion fulfils the equations there: by q̈, where multipliers may have a pole, or by the residual, where
/// rounding hides what a formula is. What a multiplier alone feels is told by the events that read it. Beside a root,
/// as x^(1/5), a polynomial is off more than at the points that were looked at.
bool TaylorStepper::Impl::Collocation::holds(double x, taylor::PassedStretch& between) const {
  const double beside_points = place_ == Place::OfConstraints ? 1 : 16, by = beside_points * smooth();
  if (agrees(x, by)) return true;
  for (std::size_t j = 0; j < s_.n; ++j)
    if (!between.holds(j, by * momentum(j) / std::abs(h))) return false;
  return true;
}

std::vector<double> TaylorStepper::Impl::Collocation::rows(int order, std::size_t count) const {
  std::vector<double> out((static_cast<std::size_t>(order) + 2) * count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    if (i < s_.n) out[i] = s_.state.q_now[i], out[count + i] = s_.state.v_now[i];
    const Nodes& second = i < s_.n ? acceleration[i] : multiplier[i - s_.n];
    for (int k = 0; k < nodes && k + 2 <= order + 1; ++k)
      out[static_cast<std::size_t>(k + 2) * count + i] = second[k] / (std::pow(h, k) * (k + 1) * (k + 2));
  }
  return out;
}

/// Of row j, with the mass matrix of the point that was asked for last.
double TaylorStepper::Impl::Collocation::momentum(std::size_t j) const {
  double sum = 0;
  for (std::size_t k = 0; k < s_.n; ++k) sum += std::abs(s_.probe.mass(j, k)) * size_[k];
  return sum;
}

/// The part of the step from x on over which the formulas are smooth; 0: not even over `least`. Negative: the equations
/// do not hold at x, so that there is something between the nodes.
double TaylorStepper::Impl::Collocation::length_from(double x, double least, taylor::PassedStretch& between) {
  if (!ask_beside(x)) return 0;
  if (s_.safe.is_needed() && s_.safe.wants_momenta(size_)) s_.safe.set_momenta(size_, s_.probe);
  between.look_at(h * x, s_.probe.constants());
  if (!holds(x, between)) return -1;
  return between.length(std::abs(h) * (1 - x), std::abs(h) * least) / std::abs(h);
}

/// From piece to piece; formulas may have no series in a small part about the place, as sin x/x at 0.
bool TaylorStepper::Impl::Collocation::is_smooth_between() {
  const double least = std::max(1e-8, 16 * epsilon * std::abs(s_.state.t.hi / h));  // of the step
  const double most_of_gap = place_ == Place::OfConstraints ? 0 : 64 * least;
  constexpr int most_pieces = 2000;
  taylor::PassedStretch between(s_.work.program(), s_.control.order, s_.safe, s_.state.t.hi, s_.state.t.lo,
                                rows(s_.control.order, s_.n + s_.m));
  double x = 0, gap = 0;
  for (int piece = 0; x < 1 && piece < most_pieces; ++piece) {
    double length = length_from(x, std::min(least, 1 - x), between);
    if (length < 0 && x > 0) return false;
    length = std::max(length, 0.0);  // where the step begins is the place itself, where a root bends most
    if (length == 0 && gap >= most_of_gap) return false;
    if (length == 0) gap += least;
    x += length > 0 ? length : least;
  }
  return x >= 1;
}

/// Makes the step that was found.
void TaylorStepper::Impl::pass(const Collocation& c, double bound, Step& result) {
  last.keep_state(state);
  watched.set_sides(probe);
  last.dense.copy(c.rows(control.order, n).data(), n);
  for (int k = 0; k <= control.order + 1; ++k)
    for (std::size_t i = 0; i < state.integrals.size(); ++i)
      last.dense.integrand(k)[i] = k < nodes ? c.integrand[i][k] / std::pow(c.h, k) : 0;
  last.start_sample = last.sample(last.begin.hi, probe);
  has_start_sample = true;
  const bool reaches_bound = c.h == remaining(bound);
  state.move(last.dense, last.begin, c.h);
  if (reaches_bound) state.arrive(bound);
  for (std::size_t i = 0; i < watched.switches.size(); ++i) {
    if (watched.switches[i].side != c.sides[i]) ++switches, result.switches.push_back(i);
    watched.switches[i] = {c.sides[i], false};
  }
  watched.set_sides(probe);  // what is asked of its end lies beyond the place
  result.end = state.t.hi;
  result.ending = StepEnding::None;
  result.reason.clear();
  expanded = false;
  first = false;
  stuck = 0;
  ++steps;
}

bool TaylorStepper::Impl::passes(double h, double bound, Place place, Step& result) {
  if (!(h > 0 && h <= std::abs(remaining(bound))) || control.order < nodes) return false;
  Collocation c(*this, std::copysign(h, remaining(bound)), place);
  const bool found = c.converges() && c.is_smooth() && (rests_for_ever() || c.is_smooth_between());
  safe.set_constants(work.constants());
  watched.set_sides(probe);
  if (found) pass(c, bound, result);
  return found;
}

/// Where there is no series: from small shares of the longest step, or of the run, downward. Such a step looks at
/// points alone, and must be too short for anything to happen between them, unless everything rests for ever. At a
/// singular configuration of the constraints not even q̈ is there.
bool TaylorStepper::Impl::passes_from_here(double bound, Step& result) {
  const double* const half_a = work.coordinate(2);
  const bool has_accelerations = std::all_of(half_a, half_a + n, [](double a) { return std::isfinite(a); });
  const Place place = m > 0 && !has_accelerations ? Place::OfConstraints : Place::OfFormulas;
  if (m == 0 && rests_for_ever() && passes(std::abs(remaining(bound)), bound, place, result)) return true;
  const double whole = longest > 0 ? longest : std::abs(remaining(bound));
  for (double share = 1e-5; share > 1e-11; share *= 0.2)
    if (passes(share * whole, bound, place, result)) return true;
  return false;
}

/// Whether the low orders of the series say that the motion is smooth over h, as the last ones do not.
bool TaylorStepper::Impl::seems_smooth(double h) const {
  constexpr double small = 1e-7;
  for (std::size_t i = 0; i < n; ++i) {
    const double size = std::max(std::abs(state.v_now[i]), epsilon * std::abs(state.q_now[i]) / h);
    for (int k = 5; k <= 6; ++k)
      if (!(std::abs((k + 1) * work.coordinate(k + 1)[i]) * std::pow(h, k) <= small * size)) return false;
  }
  return true;
}

/// Steps that shrink without end, though the motion is smooth: to a millionth of the longest, which no wall or pulse
/// asks for. Multipliers give a place away early: where they alone shorten the step it comes to lie in the middle, away
/// from all nodes.
bool TaylorStepper::Impl::passes_shrinking(double chosen, double bound, Step& result) {
  constexpr double endless = 1e-6, much = 0.2;
  longest = std::max(longest, std::isfinite(chosen) ? chosen : 0);
  if (!(chosen < (m > 0 ? much : endless) * longest) || control.order < nodes) return false;
  const bool by_multipliers =
      m > 0 && taylor::step_within_multipliers(work, n, m, control, 3.6 * chosen) < 3.6 * chosen;
  if (!by_multipliers && !(chosen < endless * longest)) return false;
  // Steps that shrink slowly, as beside a slip that friction barely stops, are not on their way to such a place.
  constexpr double slowly = 0.95;
  if (chosen > slowly * tried && chosen < 2 * tried) return false;
  // A force that jumps beside constraints, friction that turns round, is no such place.
  const Place place = by_multipliers ? Place::OfConstraints : Place::OfFormulas;
  for (const double times : {by_multipliers ? 3.6 : 5, by_multipliers ? 4.4 : 15, 8.0})
    if (seems_smooth(times * chosen) && passes(times * chosen, bound, place, result)) return true;
  tried = chosen;
  return false;
}

}  // namespace maupertuis

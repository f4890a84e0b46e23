#include "integrator/taylor/stepper.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

/// Steps that no series makes. Where a formula has a singularity that the motion has not (sin x/x at 0, multipliers where a linkage is flat), or one that
/// moves nothing yet (max(x, 0)^(3/2) at 0), coefficients are lost to cancellation the earlier the nearer it is, or are not there at all. Such a place is
/// passed by collocation at Gauss's points, none of which is an end: the force is asked for beside the place alone. What was passed must be smooth:
/// at points that are no nodes the polynomial has the acceleration that the equations give.
namespace maupertuis {
namespace {

constexpr int nodes = 8;
constexpr int looks = 33;          // beside the nodes
constexpr int most_sweeps = 40;
constexpr double settled = 1e-16;  // change of q̈ h by a sweep, of the velocity
constexpr double epsilon = std::numeric_limits<double>::epsilon();

using Nodes = std::array<double, nodes>;

Nodes gauss_points() {
  constexpr std::array<double, nodes / 2> half{0.18343464249564980, 0.52553240991632899, 0.79666647741362674, 0.96028985649753623};
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
struct TaylorStepper::Impl::Collocation {
  double h = 0;
  std::vector<Nodes> acceleration, integrand;  // coefficients
  std::vector<double> size;                    // [n] of the velocities
  std::vector<std::int8_t> sides;              // at the last point that was asked for
};

/// The constraints are nearly singular at such places, and a state beside them has an acceleration that is far off.
bool TaylorStepper::Impl::evaluate_on_constraints(double time, std::vector<double>& position, std::vector<double>& velocity) {
  constexpr int turns = 3;
  for (int turn = 0; turn < (m > 0 ? turns : 0); ++turn) {
    if (probe.evaluate(time, position, velocity) != KernelStatus::Ok) return false;
    probe.corrections(dq, dv);
    for (std::size_t i = 0; i < n; ++i) position[i] += dq[i], velocity[i] += dv[i];
  }
  return probe.evaluate(time, position, velocity) == KernelStatus::Ok;
}

/// The polynomial's state at x; q̈ there by the equations is in `probe`. False: it has no value, or an event changes its sign.
bool TaylorStepper::Impl::ask_beside(Collocation& c, double x) {
  std::vector<double> position(n), velocity(n);
  for (std::size_t i = 0; i < n; ++i) {
    double once = 0, twice = 0;
    for (int k = nodes - 1; k >= 0; --k) {
      once = once * x + c.acceleration[i][k] / (k + 1);
      twice = twice * x + c.acceleration[i][k] / ((k + 1) * (k + 2));
    }
    velocity[i] = v_now[i] + c.h * x * once;
    position[i] = q_now[i] + c.h * x * (v_now[i] + c.h * x * twice);
  }
  const double time = t.hi + c.h * x;
  if (c.sides.empty()) return evaluate_on_constraints(time, position, velocity) && keeps_events();
  for (std::size_t pass = 0; pass <= c.sides.size(); ++pass) {
    probe.set_branches(c.sides);
    const bool defined = evaluate_on_constraints(time, position, velocity);
    bool changed = false;
    for (std::size_t i = 0; i < c.sides.size(); ++i) {
      const double s = probe.switch_function(i, 0);
      const std::int8_t side = s > 0 ? 1 : s < 0 ? -1 : c.sides[i];
      changed = changed || side != c.sides[i];
      c.sides[i] = side;
    }
    if (!changed) return defined && keeps_events();
  }
  return false;
}

/// Events are not looked for in such a step: it is none where one happens.
bool TaylorStepper::Impl::keeps_events() const {
  for (std::size_t i = 0; i < event_state.size(); ++i)
    if (probe.event(i, 0) * event_state[i].side < 0) return false;
  return true;
}

/// What q̈ h may be off beside the nodes, of the velocity. Next to a singular configuration of the constraints q̈ has rounding errors across the
/// branch on which the motion goes; the projection takes them out at the end, where the branches are apart.
double TaylorStepper::Impl::smooth() const { return m > 0 ? 1e-6 : 2e-13; }

/// q̈ at the nodes, until it is that of the polynomial through it.
bool TaylorStepper::Impl::collocate(Collocation& c) {
  const Nodes at = gauss_points();
  const auto cardinal = cardinal_polynomials(at);
  double before = std::numeric_limits<double>::infinity();
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    std::vector<Nodes> now(n, Nodes{}), integrand(integrals.size(), Nodes{});
    double change = 0;
    for (int j = 0; j < nodes; ++j) {
      if (!ask_beside(c, at[j])) return false;
      for (std::size_t i = 0; i < n; ++i) {
        const double a = probe.acceleration(i);
        c.size[i] = std::max(c.size[i], std::abs(c.h * a));
        if (const double moved = std::abs(c.h * (a - value(c.acceleration[i], at[j]))); moved > 0) change = std::max(change, moved / c.size[i]);
        for (int k = 0; k < nodes; ++k) now[i][k] += a * cardinal[j][k];
      }
      for (std::size_t i = 0; i < integrals.size(); ++i)
        for (int k = 0; k < nodes; ++k) integrand[i][k] += probe.integrand(i, 0) * cardinal[j][k];
    }
    c.acceleration = std::move(now);
    c.integrand = std::move(integrand);
    if (change <= settled || (change <= smooth() / 2 && change > before / 2)) return true;
    before = change;
  }
  return false;
}

bool TaylorStepper::Impl::is_smooth(Collocation& c) {
  for (int k = 1; k <= looks; ++k) {
    const double x = static_cast<double>(k) / looks;
    if (!ask_beside(c, x)) return false;
    for (std::size_t i = 0; i < n; ++i)
      if (!(std::abs(c.h * (probe.acceleration(i) - value(c.acceleration[i], x))) <= smooth() * c.size[i])) return false;
  }
  return true;
}

/// Makes the step that was found.
void TaylorStepper::Impl::pass(const Collocation& c, double bound, Step& result) {
  keep_polynomial();
  const std::size_t stride = n;
  std::vector<double> rows((static_cast<std::size_t>(control.order) + 2) * stride, 0.0);
  const auto power = [&](int k) { return std::pow(c.h, k); };
  for (std::size_t i = 0; i < n; ++i) {
    rows[i] = q_now[i], rows[stride + i] = v_now[i];
    for (int k = 0; k < nodes && k + 2 <= control.order + 1; ++k)
      rows[static_cast<std::size_t>(k + 2) * stride + i] = c.acceleration[i][k] / (power(k) * (k + 1) * (k + 2));
  }
  dense.copy(rows.data(), stride);
  for (int k = 0; k <= control.order + 1; ++k)
    for (std::size_t i = 0; i < integrals.size(); ++i) dense.integrand(k)[i] = k < nodes ? c.integrand[i][k] / power(k) : 0;
  start_sample = sample(begin.hi);
  dense.advance(c.h, q, v, integrals);
  if (c.h == remaining(bound)) t = {bound, 0};
  else t.add(c.h);
  for (std::size_t i = 0; i < n; ++i) q_now[i] = q[i].hi, v_now[i] = v[i].hi;
  for (std::size_t i = 0; i < switch_state.size(); ++i) {
    if (switch_state[i].side != c.sides[i]) ++switches, ++result.switches;
    switch_state[i] = {c.sides[i], false};
  }
  result.end = t.hi;
  result.ending = StepEnding::None;
  result.reason.clear();
  expanded = false;
  first = false;
  stuck = 0;
  ++steps;
}

bool TaylorStepper::Impl::passes(double h, double bound, Step& result) {
  Collocation c;
  c.h = std::copysign(h, remaining(bound));
  if (!(h > 0 && h < std::abs(remaining(bound))) || control.order < nodes) return false;
  c.acceleration.assign(n, Nodes{});
  c.integrand.assign(integrals.size(), Nodes{});
  for (std::size_t i = 0; i < n; ++i) c.size.push_back(std::max(std::abs(v_now[i]), epsilon * std::abs(q_now[i]) / h));
  for (const taylor::Watched& s : switch_state) c.sides.push_back(s.side);
  const bool found = collocate(c) && is_smooth(c);
  set_sides(probe);
  if (found) pass(c, bound, result);
  return found;
}

/// Where there is no series: from small shares of the longest step, or of the run, downward. Such a step looks at points alone, and must be too short for
/// anything to happen between them.
bool TaylorStepper::Impl::passes_from_here(double bound, Step& result) {
  const double whole = longest > 0 ? longest : std::abs(remaining(bound));
  for (double share = 1e-5; share > 1e-11; share *= 0.2)
    if (passes(share * whole, bound, result)) return true;
  return false;
}

/// Whether the low orders of the series say that the motion is smooth over h, as the last ones do not.
bool TaylorStepper::Impl::seems_smooth(double h) const {
  constexpr double small = 1e-7;
  for (std::size_t i = 0; i < n; ++i) {
    const double size = std::max(std::abs(v_now[i]), epsilon * std::abs(q_now[i]) / h);
    for (int k = 5; k <= 6; ++k)
      if (!(std::abs((k + 1) * work.coordinate(k + 1)[i]) * std::pow(h, k) <= small * size)) return false;
  }
  return true;
}

/// Steps that shrink without end, though the motion is smooth: to a millionth of the longest, which no wall or pulse asks for. Multipliers give a place away
/// early: where they alone shorten the step it comes to lie in the middle, away from all nodes.
bool TaylorStepper::Impl::passes_shrinking(double chosen, double bound, Step& result) {
  constexpr double endless = 1e-6, much = 0.2;
  longest = std::max(longest, std::isfinite(chosen) ? chosen : 0);
  if (!(chosen < (m > 0 ? much : endless) * longest) || control.order < nodes) return false;
  const bool by_multipliers = m > 0 && taylor::step_within_multipliers(work, n, m, control, 3.6 * chosen) < 3.6 * chosen;
  if (!by_multipliers && !(chosen < endless * longest)) return false;
  for (const double times : {by_multipliers ? 3.6 : 5, by_multipliers ? 4.4 : 15, 8.0})
    if (seems_smooth(times * chosen) && passes(times * chosen, bound, result)) return true;
  return false;
}

}  // namespace maupertuis

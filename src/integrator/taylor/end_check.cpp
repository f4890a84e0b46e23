#include "integrator/taylor/end_check.hpp"

#include "integrator/taylor/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace maupertuis {
namespace taylor {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Below it a velocity is that of rest, whatever its unit.
constexpr double rest = 1e-40;

}  // namespace

double safe_tolerance(double tolerance) { return 1e4 * epsilon + 10 * (tolerance > epsilon ? tolerance : 0); }

EndCheck::EndCheck(std::size_t freedoms, double tolerance) : allowed_(std::max(1e-12, 10 * tolerance)), rates_(freedoms, 0.0) {}

void EndCheck::forget() { std::fill(rates_.begin(), rates_.end(), 0.0); }

void EndCheck::note_rates(const double* v, const double* half_a, std::size_t step, double h) {
  for (std::size_t i = 0; i < rates_.size(); ++i) rates_[i] = std::max({rates_[i], std::abs(v[i * step]), h * std::abs(2 * half_a[i * step])});
}

bool EndCheck::agrees(std::span<const double> by_polynomial, const double* half_by_equations, std::size_t step, double h) const {
  bool good = true;
  for (std::size_t i = 0; i < rates_.size(); ++i) {
    const double a = 2 * half_by_equations[i * step];
    good = good && std::abs(h) * std::abs(by_polynomial[i] - a) <= allowed_ * std::max({rates_[i], std::abs(h * a), rest});
  }
  return good;
}

bool EndCheck::agrees_on_the_whole(std::span<const double> by_polynomial, const double* half_by_equations, double h) const {
  double largest = rest;
  for (std::size_t i = 0; i < rates_.size(); ++i) largest = std::max({largest, rates_[i], std::abs(2 * h * half_by_equations[i])});
  for (std::size_t i = 0; i < rates_.size(); ++i)
    if (!(std::abs(h) * std::abs(by_polynomial[i] - 2 * half_by_equations[i]) <= allowed_ * largest)) return false;
  return true;
}

bool EndCheck::agrees_but_for_rounding(std::span<const double> by_polynomial, std::span<const double> by_equations, std::span<const double> rounding_of,
                                       double h) const {
  constexpr double roundings = 64;
  for (std::size_t i = 0; i < rates_.size(); ++i) {
    const double rounding = roundings * (rounding_of[i] + epsilon * std::abs(by_equations[i]));
    if (!(std::abs(by_polynomial[i] - by_equations[i]) <= allowed_ * std::max({rates_[i] / std::abs(h), std::abs(by_equations[i]), rest}) + rounding)) return false;
  }
  return true;
}

namespace {

/// Gauss and Jordan with partial pivoting: B becomes its inverse, [n × n]. Rows that depend on others, as those of redundant constraints do, become zero with
/// the unknowns that they leave open.
bool invert(std::vector<double>& b, std::size_t n) {
  constexpr double dependent = 1e-10;  // of the largest entry of its column
  std::vector<double> largest(n, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k) largest[k] = std::max(largest[k], std::abs(b[i * n + k]));
  std::vector<std::size_t> order(n);
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::abs(b[i * n + k]) > std::abs(b[pivot * n + k])) pivot = i;
    order[k] = pivot;
    for (std::size_t j = 0; j < n && pivot != k; ++j) std::swap(b[k * n + j], b[pivot * n + j]);
    if (!std::isfinite(b[k * n + k])) return false;
    if (!(std::abs(b[k * n + k]) > dependent * largest[k])) {
      for (std::size_t i = 0; i < n; ++i) b[i * n + k] = b[k * n + i] = 0;
      continue;
    }
    const double inverse = 1 / b[k * n + k];
    b[k * n + k] = 1;
    for (std::size_t j = 0; j < n; ++j) b[k * n + j] *= inverse;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = std::exchange(b[i * n + k], 0.0);
      for (std::size_t j = 0; j < n; ++j) b[i * n + j] -= factor * b[k * n + j];
    }
  }
  for (std::size_t k = n; k-- > 0;)
    for (std::size_t i = 0; i < n && order[k] != k; ++i) std::swap(b[i * n + k], b[i * n + order[k]]);
  return true;
}

}  // namespace

std::vector<double> acceleration_roundings(std::vector<double> b, std::size_t n, std::size_t m, Disks& disks, double length, double unit) {
  const std::size_t unknowns = n + m;
  std::vector<double> result(n, 0.0);
  if (b.empty() || !invert(b, unknowns)) return result;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < unknowns; ++j) result[i] += unit * std::abs(b[i * unknowns + j]) * disks.residual_rounding(j, length);
  return result;
}

/// What a change of the state by rounding does to q̈ is asked first: mostly it is enough. Then q̈ at the state, and what rounding of the formula's values makes of it.
bool agrees_but_for_rounding(const EndCheck& check, std::span<const double> by_polynomial, const double* half_by_equations, std::size_t step, KernelWorkspace& point, double t,
                             std::span<const double> q, std::span<const double> v, double h, Disks& disks) {
  const std::size_t n = q.size(), m = point.program().unknowns - n;
  std::vector<double> here(n), position(n), velocity(n), by_state(n);
  for (std::size_t i = 0; i < n; ++i) {
    here[i] = 2 * half_by_equations[i * step];
    position[i] = q[i] * (1 + (i % 2 == 0 ? epsilon : -epsilon));
    velocity[i] = v[i] * (1 + epsilon);
  }
  if (point.evaluate(t * (1 + epsilon), position, velocity) != KernelStatus::Ok) return false;
  for (std::size_t i = 0; i < n; ++i) by_state[i] = point.acceleration(i);
  const auto add_change = [&](std::vector<double> roundings) {
    for (std::size_t i = 0; i < n; ++i) roundings[i] += std::abs(by_state[i] - here[i]);
    return roundings;
  };
  if (check.agrees_but_for_rounding(by_polynomial, here, add_change(std::vector<double>(n)), h)) return true;
  if (point.evaluate(t, q, v) != KernelStatus::Ok) return false;
  disks.set_constants(point.constants());
  disks.begin({point.coordinate(0), point.row_stride(), 1});
  for (std::size_t i = 0; i < n; ++i) here[i] = point.acceleration(i);
  return check.agrees_but_for_rounding(by_polynomial, here, add_change(acceleration_roundings(bordered_matrix(point, n, m), n, m, disks, std::abs(h), epsilon)), h);
}

}  // namespace taylor

void TaylorStepper::Impl::renew_momenta() {
  if (safe.wants_momenta(end_check.rates())) safe.set_momenta(end_check.rates(), work);
}

/// The end of a step, in the mode in which the step was made, before anything acts there. Where nothing else is in the way, the expansion
/// there is that of the next step.
bool TaylorStepper::Impl::settles(double bound, const Crossing& crossing, Step& result) {
  if (m > 0 && !watches()) {
    constexpr int halvings = 16;
    const double residual_before = constraint_residual;
    dense.keep();
    land(result, (t.hi - begin.hi) + (t.lo - begin.lo));
    // Next to a singular position a shorter step may keep the constraints where a long one does not.
    if (result.ending == StepEnding::SingularConstraints && attempts < halvings) {
      result.ending = StepEnding::None;
      result.reason.clear();
      constraint_residual = residual_before;
      return false;
    }
    if (result.ending != StepEnding::None || !expanded) return true;
    return equations_hold(work);
  }
  const bool goes_on = m == 0 && switch_state.empty() && !crossing.found && t.hi != bound;
  if (goes_on) {
    if (turns.wind(q))
      for (std::size_t i = 0; i < n; ++i) q_now[i] = q[i].hi;
    dense.keep();
    end_status = work.expand(t.hi, q_now, v_now);
    expanded = end_status == KernelStatus::Ok;
    return expanded && equations_hold(work);
  }
  end_status = probe.evaluate(t.hi, q_now, v_now);
  return end_status == KernelStatus::Ok && equations_hold(probe);
}

bool TaylorStepper::Impl::equations_hold(const KernelWorkspace& at_end) {
  const double tau = (t.hi - begin.hi) + (t.lo - begin.lo);  // as the state was advanced: the rounding of t counts in short steps
  const std::span<const double> by_polynomial = dense.accelerations(tau);
  if (tau == 0 || end_check.agrees(by_polynomial, at_end.coordinate(2), 1, tau)) return true;
  const bool rounds = taylor::agrees_but_for_rounding(end_check, by_polynomial, at_end.coordinate(2), 1, probe, t.hi, q_now, v_now, tau, safe.disks());
  safe.set_constants(work.constants());  // the disks had those of the point
  if (rounds) return true;
  // Noise in a coordinate that does not move does not fall with the length of the step.
  constexpr int halvings = 3;
  if (attempts < halvings && !noisy) return false;
  noisy = end_check.agrees_on_the_whole(by_polynomial, at_end.coordinate(2), tau);
  return noisy;
}

/// The state at the beginning of the step that failed, and its expansion.
bool TaylorStepper::Impl::take_back(Step& result) {
  expanded = false;
  t = begin;
  turns = dense_turns;
  std::copy(dense.q.begin(), dense.q.end(), q.begin());
  std::copy(dense.v.begin(), dense.v.end(), v.begin());
  std::copy(dense.integrals.begin(), dense.integrals.end(), integrals.begin());
  for (std::size_t i = 0; i < n; ++i) q_now[i] = q[i].hi, v_now[i] = v[i].hi;
  result.end = t.hi;
  dense.keep();
  const KernelStatus status = work.expand(t.hi, q_now, v_now);
  return status == KernelStatus::Ok || fail(result, status);
}

}  // namespace maupertuis

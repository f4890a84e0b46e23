#include "integrator/taylor/end_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace maupertuis::taylor {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Below it a velocity is that of rest, whatever its unit.
constexpr double least_velocity = 1e-40;

}  // namespace

double safe_tolerance(double tolerance) { return 1e4 * epsilon + 10 * (tolerance > epsilon ? tolerance : 0); }

EndCheck::EndCheck(std::size_t freedoms, double tolerance)
    : allowed_(std::max(1e-12, 10 * tolerance)), rates_(freedoms, 0.0) {}

void EndCheck::forget() {
  std::fill(rates_.begin(), rates_.end(), 0.0);
  noted_.clear();
  ends_left_ = 0;
}

void EndCheck::note_rates(const double* v, const double* half_a, std::size_t step, double h) {
  for (std::size_t i = 0; i < rates_.size(); ++i)
    rates_[i] = std::max({rates_[i], std::abs(v[i * step]), h * std::abs(2 * half_a[i * step])});
}

bool EndCheck::agrees(std::span<const double> by_polynomial, const double* half_by_equations, std::size_t step,
                      double h) const {
  bool good = true;
  for (std::size_t i = 0; i < rates_.size(); ++i) {
    const double a = 2 * half_by_equations[i * step];
    good = good && std::abs(h) * std::abs(by_polynomial[i] - a) <=
                       allowed_ * std::max({rates_[i], std::abs(h * a), least_velocity});
  }
  return good;
}

bool EndCheck::agrees_on_the_whole(std::span<const double> by_polynomial, const double* half_by_equations,
                                   double h) const {
  double largest = least_velocity;
  for (std::size_t i = 0; i < rates_.size(); ++i)
    largest = std::max({largest, rates_[i], std::abs(2 * h * half_by_equations[i])});
  for (std::size_t i = 0; i < rates_.size(); ++i)
    if (!(std::abs(h) * std::abs(by_polynomial[i] - 2 * half_by_equations[i]) <= allowed_ * largest)) return false;
  return true;
}

bool EndCheck::agrees_but_for_rounding(std::span<const double> by_polynomial, std::span<const double> by_equations,
                                       std::span<const double> rounding_of, double h) const {
  constexpr double roundings = 64;
  for (std::size_t i = 0; i < rates_.size(); ++i) {
    const double rounding = roundings * (rounding_of[i] + epsilon * std::abs(by_equations[i]));
    if (!(std::abs(by_polynomial[i] - by_equations[i]) <=
          allowed_ * std::max({rates_[i] / std::abs(h), std::abs(by_equations[i]), least_velocity}) + rounding))
      return false;
  }
  return true;
}

/// Those of the look before count by half: one look leaves some accelerations as they are by accident. Near a singular
/// mass matrix rounding is large, and of this place alone: nothing is noted.
void EndCheck::note_roundings(std::span<const double> roundings, std::span<const double> by_equations) {
  constexpr std::size_t ends = 7;
  constexpr double ordinary = 1e-11;
  double largest = std::numeric_limits<double>::min();
  for (const double a : by_equations) largest = std::max(largest, std::abs(a));
  noted_.resize(roundings.size(), 0.0);
  for (std::size_t i = 0; i < roundings.size(); ++i) noted_[i] = std::max(0.5 * noted_[i], roundings[i] / largest);
  const bool is_ordinary = std::all_of(noted_.begin(), noted_.end(), [](double r) { return r <= ordinary; });
  ends_left_ = is_ordinary ? ends : 0;
}

bool EndCheck::agrees_as_noted(std::span<const double> by_polynomial, std::span<const double> by_equations, double h) {
  if (ends_left_ == 0) return false;
  --ends_left_;
  double largest = 0;
  for (const double a : by_equations) largest = std::max(largest, std::abs(a));
  std::vector<double> roundings = noted_;
  for (double& r : roundings) r *= largest;
  return agrees_but_for_rounding(by_polynomial, by_equations, roundings, h);
}

namespace {

/// Gauss and Jordan with partial pivoting: B becomes its inverse, [n × n]. Rows that depend on others, as those of
/// redundant constraints do, become zero with the unknowns that they leave open.
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

namespace {

/// Forces that balance on what constraints hold leave their rounding there, shared in the measure of the masses by what
/// a constraint ties together: [n] in units of e.
std::vector<double> held_roundings(const std::vector<double>& b, std::size_t n, std::size_t m,
                                   const std::vector<double>& of_residual) {
  const std::size_t unknowns = n + m;
  const auto mass = [&](std::size_t i) { return b[i * unknowns + i]; };
  std::vector<double> out(n, 0.0);
  for (std::size_t j = n; j < unknowns; ++j) {
    const auto is_tied = [&](std::size_t i) { return b[j * unknowns + i] != 0 && mass(i) > 0; };
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i)
      if (is_tied(i)) largest = std::max(largest, of_residual[i] / std::sqrt(mass(i)));
    for (std::size_t i = 0; i < n; ++i)
      if (is_tied(i)) out[i] = std::max(out[i], largest / std::sqrt(mass(i)));
  }
  return out;
}

}  // namespace

std::vector<double> acceleration_roundings(std::vector<double> b, std::size_t n, std::size_t m, Disks& disks,
                                           double length, double unit) {
  const std::size_t unknowns = n + m;
  std::vector<double> result(n, 0.0), of_residual;
  if (b.empty()) return result;
  for (std::size_t j = 0; j < unknowns; ++j) of_residual.push_back(disks.residual_rounding(j, length));
  const std::vector<double> held = held_roundings(b, n, m, of_residual);
  if (!invert(b, unknowns)) return result;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < unknowns; ++j) result[i] += unit * std::abs(b[i * unknowns + j]) * of_residual[j];
    result[i] = std::max(result[i], unit * held[i]);
  }
  return result;
}

namespace {

/// [n] q̈ where the last bits of the state are other ones, those of q by a pattern of signs; nothing where it has none.
std::vector<double> accelerations_beside(KernelWorkspace& point, double t, std::span<const double> q,
                                         std::span<const double> v, std::size_t pattern) {
  const std::size_t n = q.size();
  std::vector<double> position(n), velocity(n), out(n);
  for (std::size_t i = 0; i < n; ++i) {
    position[i] = q[i] * (1 + (i >> pattern & 1 ? -epsilon : epsilon));
    velocity[i] = v[i] * (1 + epsilon);
  }
  if (point.evaluate(t * (1 + epsilon), position, velocity) != KernelStatus::Ok) return {};
  for (std::size_t i = 0; i < n; ++i) out[i] = point.acceleration(i);
  return out;
}

}  // namespace

/// What a change of the state by rounding does to q̈ is asked first: mostly it is enough. Then q̈ at the state, and what
/// rounding of the formula's values makes of it. Where there are too many unknowns for that, other changes of the
/// state, since each leaves some accelerations as they are by accident; what they tell is noted for the next ends.
bool agrees_but_for_rounding(EndCheck& check, std::span<const double> by_polynomial, const double* half_by_equations,
                             std::size_t step, KernelWorkspace& point, double t, std::span<const double> q,
                             std::span<const double> v, double h, Disks& disks) {
  const std::size_t n = q.size(), m = point.program().unknowns - n, patterns = has_bordered_matrix(n, m) ? 1 : 4;
  std::vector<double> here(n);
  std::vector<std::vector<double>> beside;
  for (std::size_t i = 0; i < n; ++i) here[i] = 2 * half_by_equations[i * step];
  if (check.agrees_as_noted(by_polynomial, here, h)) return true;
  const auto add_changes = [&](std::vector<double> roundings) {
    for (std::size_t i = 0; i < n; ++i) {
      double largest = 0;
      for (const std::vector<double>& a : beside) largest = std::max(largest, std::abs(a[i] - here[i]));
      roundings[i] += largest;
    }
    return roundings;
  };
  for (std::size_t pattern = 0; pattern < patterns; ++pattern) {
    beside.push_back(accelerations_beside(point, t, q, v, pattern));
    if (beside.back().empty()) return false;
    const std::vector<double> changes = add_changes(std::vector<double>(n));
    if (!check.agrees_but_for_rounding(by_polynomial, here, changes, h)) continue;
    if (patterns > 1) check.note_roundings(changes, here);
    return true;
  }
  if (point.evaluate(t, q, v) != KernelStatus::Ok) return false;
  disks.set_constants(point.constants());
  disks.begin({point.coordinate(0), point.row_stride(), 1});
  for (std::size_t i = 0; i < n; ++i) here[i] = point.acceleration(i);
  return check.agrees_but_for_rounding(
      by_polynomial, here,
      add_changes(acceleration_roundings(bordered_matrix(point, n, m), n, m, disks, std::abs(h), epsilon)), h);
}

}  // namespace maupertuis::taylor

#include "integrator/taylor/constraint_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::taylor {
namespace {

double ratio(double value, double scale) { return value == 0 ? 0.0 : std::abs(value) / scale; }

/// |q̇| + h |q̈| of a coordinate: its speed in the course of a step.
double speed(const KernelWorkspace& work, std::size_t i, double h) {
  return std::abs(work.coordinate(1)[i]) + h * std::abs(work.acceleration(i));
}

/// A bound of |A q̇| over the step, by Cauchy and Schwarz in the metric of the diagonal of M, so that a motion along the
/// constraint counts; coordinates without inertia count by themselves.
double rate_bound(const KernelWorkspace& work, std::size_t row, std::size_t freedoms, double h) {
  double motion = 0, gradient = 0, rest = 0;
  for (std::size_t i = 0; i < freedoms; ++i) {
    const double a = work.constraint_matrix(row, i), v = speed(work, i, h), mass = work.mass(i, i);
    if (mass > 0)
      motion += mass * v * v, gradient += a * a / mass;
    else
      rest += std::abs(a) * v;
  }
  return std::sqrt(motion * gradient) + rest;
}

/// What rounding of the coordinates makes of φ: a rate that moves φ by less than that in a step does not count, so that
/// a motion which comes to rest ends in peace.
double rounding_of_position(const KernelWorkspace& work, std::size_t row, std::size_t freedoms) {
  double size = work.constraint_scale(row);
  for (std::size_t i = 0; i < freedoms; ++i) size += std::abs(work.constraint_matrix(row, i) * work.coordinate(0)[i]);
  return 64 * std::numeric_limits<double>::epsilon() * size;
}

/// (Aᵀλ)_i/M_ii by the first two terms of λ over a step: what the forces of constraints would do alone.
double held_acceleration(const KernelWorkspace& work, std::size_t i, std::size_t freedoms, std::size_t constraints,
                         double h) {
  if (!(work.mass(i, i) > 0)) return 0;
  double sum = 0;
  for (std::size_t j = 0; j < constraints; ++j) {
    double size = 0, power = 1;
    for (int k = 0; k < 2; ++k, power *= h)
      size = std::max(size, (k + 1) * (k + 2) * std::abs(work.coordinate(k + 2)[freedoms + j]) * power);
    sum += std::abs(work.constraint_matrix(j, i)) * size;
  }
  return sum / work.mass(i, i);
}

/// What rounding makes of the speed of a coordinate in a step in which forces balance.
double rounding_of_speed(const KernelWorkspace& work, const UsualSizes& usual, std::size_t i, std::size_t freedoms,
                         std::size_t constraints, double h) {
  const double held = held_acceleration(work, i, freedoms, constraints, h);
  return 64 * std::numeric_limits<double>::epsilon() * h * std::max(held, usual.a.empty() ? 0 : usual.a[i]);
}

constexpr double small = 1e-13;  // of a correction: it is looked at no further

double beyond(double value, double threshold) { return std::max(0.0, std::abs(value) - threshold); }

}  // namespace

double constraint_error(const KernelWorkspace& work, std::size_t freedoms, std::size_t constraints, double h,
                        const UsualSizes& usual) {
  double largest = 0;
  const auto along = [&](std::size_t row, const std::vector<double>& sizes) {
    double sum = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) sum += std::abs(work.constraint_matrix(row, i)) * sizes[i];
    return sum;
  };
  for (std::size_t j = 0; j < constraints; ++j) {
    const double rate = rate_bound(work, j, freedoms, h) + along(j, usual.v);
    const double place = work.constraint_scale(j) + h * rate + along(j, usual.q);
    const double motion = work.constraint_rate_scale(j) + rate;
    double unseen = h > 0 ? rounding_of_position(work, j, freedoms) / h : 0;
    double off =
        std::max(ratio(work.constraint_value(j), place), ratio(beyond(work.constraint_rate(j), unseen), motion));
    if (off > rounding_of_constraints) {  // seldom: what a rest leaves of forces that balance
      double speed = 0;
      for (std::size_t i = 0; i < freedoms; ++i)
        speed += std::abs(work.constraint_matrix(j, i)) * rounding_of_speed(work, usual, i, freedoms, constraints, h);
      unseen = std::max(unseen, speed);
      off = std::max(ratio(beyond(work.constraint_value(j), h * speed), place),
                     ratio(beyond(work.constraint_rate(j), unseen), motion));
    }
    largest = std::max(largest, off);
  }
  return largest;
}

double correction_size(const KernelWorkspace& work, std::size_t constraints, std::span<const double> dq,
                       std::span<const double> dv, double h, const UsualSizes& usual) {
  double positions = 0, velocities = 0, motion = 0, place = 0;
  for (std::size_t i = 0; i < dq.size(); ++i) {
    const double mass = work.mass(i, i) > 0 ? work.mass(i, i) : 0, moving = speed(work, i, h);
    positions += mass * dq[i] * dq[i];
    velocities += mass * dv[i] * dv[i];
    motion += mass * moving * moving;
    place += mass * work.coordinate(0)[i] * work.coordinate(0)[i];
  }
  // What rounding of q is in a step is no motion.
  double rounding = 64 * std::numeric_limits<double>::epsilon() * std::sqrt(place);
  const auto off = [&] {
    const double by_position =
        std::sqrt(positions) <= rounding ? 0 : ratio(std::sqrt(positions), std::sqrt(place) + h * std::sqrt(motion));
    const double by_velocity =
        h * std::sqrt(velocities) <= rounding ? 0 : ratio(std::sqrt(velocities), std::sqrt(motion));
    return std::max(by_position, by_velocity);
  };
  if (const double size = off(); size <= small) return size;
  double speeds = 0;  // nor is what it makes of forces that balance
  for (std::size_t i = 0; i < dq.size(); ++i)
    if (work.mass(i, i) > 0)
      speeds += work.mass(i, i) * std::pow(rounding_of_speed(work, usual, i, dq.size(), constraints, h), 2);
  rounding += h * std::sqrt(speeds);
  return off();
}

double start_shift(const KernelWorkspace& work, std::size_t constraints, std::span<const double> dq,
                   std::span<const double> dv, double h) {
  double positions = 0, velocities = 0, place = 0, motion = 0;
  for (std::size_t i = 0; i < dq.size(); ++i) {
    if (work.mass(i, i) > 0) continue;
    const double moving = speed(work, i, h);
    positions += dq[i] * dq[i], velocities += dv[i] * dv[i];
    place += work.coordinate(0)[i] * work.coordinate(0)[i], motion += moving * moving;
  }
  const double without_inertia =
      std::max(ratio(std::sqrt(positions), std::sqrt(place)), ratio(std::sqrt(velocities), std::sqrt(motion)));
  return std::max(without_inertia, correction_size(work, constraints, dq, dv, h));
}

void ConstraintRecord::start() {
  residual = best_pivot_ratio = 0;
  restraint = 1;
  most_in_force = 0;
  largest_row.assign(largest_row.size(), 0.0);
}

bool ConstraintRecord::has_vanishing_row(const KernelWorkspace& work) {
  bool vanishes = false;
  for (std::size_t j = 0; j < largest_row.size(); ++j) {
    double size = 0;
    for (std::size_t i = 0; i < dq.size(); ++i) size = std::max(size, std::abs(work.constraint_matrix(j, i)));
    largest_row[j] = std::max(largest_row[j], size);
    vanishes = vanishes || size < vanishing * largest_row[j];
  }
  return vanishes;
}

}  // namespace maupertuis::taylor

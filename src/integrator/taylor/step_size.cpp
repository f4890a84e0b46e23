#include "integrator/taylor/step_size.hpp"

#include "integrator/taylor/end_check.hpp"

#include <maupertuis/arguments.hpp>
#include <maupertuis/integrator.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

/// À. Jorba, M. Zou, A software package for the numerical integration of ODEs by means of high-order Taylor methods,
/// Experimental Mathematics 14 (2005): the last two coefficients estimate the radius of convergence ρ, and h near ρ/e²
/// with p = ⌈−½ ln ε + 1⌉ costs least.
///
/// Two differences. Each coordinate is measured against its own size, so that units do not matter (a charge of 10⁻⁹ C
/// beside an angle of 1 rad). Its size is the largest of the first terms of its velocity over a step, so that it does
/// not vanish where the velocity passes through zero. And h/ρ follows from ε alone, the order from both: with the order
/// first, a larger ε would take more steps wherever the rounded order falls.
namespace maupertuis {

double rounding_tolerance() { return std::numeric_limits<double>::epsilon(); }

namespace {

/// At h = ρ (ε/e⁴)^{1/p} the last term kept is ε/55 times the size. The terms left out have one sign along a motion: at
/// h = ρ ε^{1/p} the energy of a double pendulum grew by 4e-18 a step.
double log_of_last_term(double tolerance) { return std::log(std::max(tolerance, rounding_tolerance())) - 4; }

constexpr int order_at_rounding = 20;

/// ln(h/ρ): −2 at rounding level, where the order is 20; near there the cost is flat. A tolerance 100 times as large
/// takes a step 1.1 times as long.
double log_of_factor(double tolerance) {
  constexpr double growth = 0.02;
  const double finest = log_of_last_term(0);
  return finest / order_at_rounding + growth * (log_of_last_term(tolerance) - finest);
}

}  // namespace

int taylor_order(double tolerance) {
  constexpr double rounding = 1e-9;
  // Disks allow (their tolerance)^{1/(p + 1)} of a radius: no less than at rounding level.
  const double by_disks =
      (order_at_rounding + 1) * std::log(taylor::safe_tolerance(tolerance)) / std::log(taylor::safe_tolerance(0)) - 1;
  return std::max(2, static_cast<int>(std::ceil(
                         std::max(by_disks, log_of_last_term(tolerance) / log_of_factor(tolerance)) - rounding)));
}

namespace taylor {
namespace {

/// Earlier coefficients estimate the radius less well: they speak up only where the last ones are silent.
constexpr double widened = 1.25;
/// The last terms of λ against the first, at the end of a step; some 1e-15 where its radius is that of q.
constexpr double converged = 1e-6;
/// So many cuts leave nothing of a step. Where they are not enough the first terms of λ vanish: such a λ says nothing.
constexpr double cut = 0.8;
constexpr int most_cuts = 200;
/// Of the largest λ: one that stays below it over the whole step is zero but for rounding, whose terms do not converge.
constexpr double silent = 1e-13;

double velocity(const KernelWorkspace& work, std::size_t i, int k) {
  return (k + 1) * std::abs(work.coordinate(k + 1)[i]);
}

/// Velocities below it are those of rest, whatever their unit; what underflows on the way has no ratio to go by.
constexpr double no_motion = 1e-200;

/// The size of a coordinate's velocity over a step of length h.
double size_of(const KernelWorkspace& work, std::size_t i, int order, double h) {
  double size = 0, power = 1;
  for (int k = 0; k <= std::min(3, order - 2); ++k, power *= h) size = std::max(size, velocity(work, i, k) * power);
  // A coordinate that others set in motion late begins with a higher power of time.
  for (int k = 4; size == 0 && k <= order; ++k) size = velocity(work, i, k) * std::pow(h, k);
  // A velocity that moves q by less than its rounding within the step does not count.
  return std::max({size, rounding_tolerance() * std::abs(work.coordinate(0)[i]) / h, no_motion});
}

/// KernelWorkspace::radius where a coordinate begins to move late: min of (size / |v_k|)^(1/k) over the coordinates and
/// the last two k; earlier k speak up only where these are silent, since a motion with a symmetry (a pendulum let go at
/// 90°) has coefficients 4 or more orders apart, so that the last two may vanish.
double radius_of_late(const KernelWorkspace& work, std::size_t freedoms, int order, double h) {
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < freedoms; ++i) {
    const double size = std::log2(size_of(work, i, order, h));
    for (int k = order; k >= std::max(std::min(2, order - 1), order - 5); --k)
      if (const double last = velocity(work, i, k); last > 0)
        least = std::min(least, (size - std::log2(last)) / k + (k < order - 1 ? std::log2(widened) : 0));
  }
  return std::exp2(least);
}

double radius(const KernelWorkspace& work, std::size_t freedoms, int order, double h) {
  const double estimate = work.radius(h);
  return estimate == estimate ? estimate : radius_of_late(work, freedoms, order, h);
}

/// A length to start from, where no step was made before: the decay from the first coefficients to the last.
double first_guess(const KernelWorkspace& work, std::size_t freedoms, int order) {
  double growth = 0;
  for (int k = order - 1; k <= order; ++k)
    for (int j = std::min({3, order - 2, k - 1}); j >= 0; --j) {
      double largest = 0;
      for (std::size_t i = 0; i < freedoms; ++i)
        if (const double early = velocity(work, i, j); early > no_motion)
          largest = std::max(largest, velocity(work, i, k) / early);
      growth = std::max(growth, std::pow(largest, 1.0 / (k - j)));
    }
  return growth > 0 ? 1 / growth : 1;
}

/// Whether a λ of this size changes a velocity in the course of a step by more than its rounding. Beside forces that
/// need no constraint λ is 0, and what stands there instead is rounding of them.
bool is_felt(const KernelWorkspace& work, std::size_t freedoms, std::size_t constraint, int order, double multiplier,
             double h) {
  bool moves_mass = false;
  for (std::size_t i = 0; i < freedoms; ++i) {
    const double mass = work.mass(i, i), force = std::abs(multiplier * work.constraint_matrix(constraint, i));
    if (!(mass > 0)) continue;
    moves_mass = moves_mass || force > 0;
    if (h * force > silent * mass * size_of(work, i, order, h)) return true;
  }
  return !moves_mass;
}

constexpr int largest_order = 100;

/// The nearest number of 12 bits (T. J. Dekker, 1971). Its square and fourth power, which sum up the polynomials, are
/// exact then; rounded they would err the same way in all steps of an oscillator, which are equal, and its energy would
/// drift with the time instead of its root.
double with_few_bits(double h) {
  constexpr double splitter = 0x1p41 + 1, largest = 0x1p960;
  const double part = splitter * h;
  return h < largest ? part - (part - h) : h;
}

}  // namespace

StepControl step_control(double tolerance, int order) {
  check_argument(tolerance >= 0 && tolerance < 1, "Taylor's steps: the tolerance is not from 0 to less than 1");
  check_argument(order == 0 || (order >= 1 && order <= largest_order),
                 "Taylor's steps: the order is not from 1 to 100");
  if (order > 0) return {std::max(order, 2), std::exp(log_of_last_term(tolerance) / std::max(order, 2))};
  return {taylor_order(tolerance), std::exp(log_of_factor(tolerance))};
}

double step_size(const KernelWorkspace& work, std::size_t freedoms, const StepControl& control, double previous) {
  if (control.is_exact) return HUGE_VAL;
  const int p = control.order;
  double h = previous;
  int turns = 1;
  if (!(h > 0)) {
    h = first_guess(work, freedoms, p);
    turns = 4;
  }
  for (int turn = 0; turn < turns; ++turn) {
    const double reached = control.factor * radius(work, freedoms, p, h);
    if (!(reached < HUGE_VAL)) return HUGE_VAL;
    h = reached;
  }
  return with_few_bits(h);
}

double step_within_multipliers(const KernelWorkspace& work, std::size_t freedoms, std::size_t constraints,
                               const StepControl& control, double h) {
  if (control.is_exact) return h;
  const auto largest = [&](std::size_t j, int begin, int end, double length) {
    double size = 0, power = std::pow(length, begin);
    for (int k = begin; k < end; ++k, power *= length)
      size = std::max(size, (k + 1.0) * (k + 2.0) * std::abs(work.coordinate(k + 2)[freedoms + j]) * power);
    return size;
  };
  const auto first = [&](std::size_t j, double length) { return largest(j, 0, std::min(4, control.order), length); };
  const auto last = [&](std::size_t j, double length) {
    return largest(j, std::max(0, control.order - 4), control.order, length);
  };
  double scale = 0, least = h;
  for (std::size_t j = 0; j < constraints; ++j) scale = std::max(scale, first(j, h));
  for (std::size_t j = 0; j < constraints; ++j) {
    const double size = std::max(first(j, h), last(j, h));
    if (size <= silent * scale || !is_felt(work, freedoms, j, control.order, size, h)) continue;
    double own = h;
    int cuts = 0;
    while (cuts < most_cuts && last(j, own) > converged * first(j, own)) own *= cut, ++cuts;
    if (cuts < most_cuts) least = std::min(least, own);
  }
  return least;
}

double step_within_integrals(const KernelWorkspace& work, std::vector<double>& sizes, const StepControl& control,
                             double h) {
  constexpr double converged_integral = 1e-8, rounding = 1e-13;
  const int p = control.order;
  if (p < 8) return h;
  const auto largest = [&](std::size_t i, int begin, double length) {  // of four terms
    double size = 0;
    for (int k = begin + 3; k >= begin; --k) size = std::max(size * length, std::abs(work.integrand(i, k)));
    return size;
  };
  double least = h;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    sizes[i] = std::max(sizes[i], std::abs(work.integrand(i, 0)));
    const auto last = [&](double length) { return largest(i, p - 3, length) * std::pow(length, p - 3); };
    const auto converges = [&](double length) {
      return last(length) <= std::max(converged_integral * largest(i, 0, length), rounding * sizes[i]);
    };
    double own = least;
    int cuts = 0;
    while (cuts < most_cuts && !converges(own)) own *= cut, ++cuts;
    if (cuts < most_cuts) least = own;
  }
  return least;
}

}  // namespace taylor
}  // namespace maupertuis

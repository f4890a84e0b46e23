#pragma once
#include "kernel/extended/workspace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

/// The step control of integrator/taylor/step_size.cpp, in logarithms of base 2: coefficients of order 100 leave the
/// range of double.
namespace maupertuis::extended {

struct StepControl {
  int order = 40;           // of the polynomial of q̇
  double log2_factor = -3;  // of the estimated radius of convergence
};

inline StepControl step_control(double log2_tolerance, int order) {
  StepControl control;
  control.order = order > 0 ? std::max(order, 2)
                            : std::max(2, static_cast<int>(std::ceil(-0.5 * log2_tolerance * std::log(2.0) + 1)));
  control.log2_factor = log2_tolerance / control.order;
  return control;
}

template <class T>
class StepSize {
 public:
  StepSize(const Workspace<T>& work, std::size_t freedoms, const StepControl& control)
      : work_(work), n_(freedoms), p_(control.order), factor_(control.log2_factor) {}

  /// log₂ of the length, ∞ for a motion that is a polynomial. `previous`: that of an earlier step, or NaN.
  double log2_length(double previous) const {
    double h = std::isfinite(previous) ? previous : first_guess();
    for (int turns = std::isfinite(previous) ? 1 : 4; turns > 0; --turns) {
      double reached = std::min(radius(p_ - 1, h), radius(p_, h));
      for (int k = p_ - 2; k >= std::max(2, p_ - 5); --k) reached = std::min(reached, widened + radius(k, h));
      if (!(reached < infinity)) return infinity;
      h = reached + factor_;
    }
    return h;
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  static constexpr double widened = 0.3219;  // log₂ 1.25

  double velocity(std::size_t i, int k) const { return std::log2(k + 1.0) + log2_size(work_.coordinate(k + 1)[i]); }

  double size_of(std::size_t i, double h) const {
    double size = -infinity;
    for (int k = 0; k <= std::min(3, p_ - 2); ++k) size = std::max(size, velocity(i, k) + k * h);
    for (int k = 4; size == -infinity && k <= p_; ++k) size = velocity(i, k) + k * h;
    return std::max(size, log2_size(epsilon<T>()) + log2_size(work_.coordinate(0)[i]) - h);
  }

  double radius(int k, double h) const {
    double largest = -infinity;
    for (std::size_t i = 0; i < n_; ++i)
      if (const double last = velocity(i, k); last > -infinity) largest = std::max(largest, last - size_of(i, h));
    return largest > -infinity ? -largest / k : infinity;
  }

  double first_guess() const {
    double growth = -infinity;
    for (std::size_t i = 0; i < n_; ++i)
      for (int k = p_ - 1; k <= p_; ++k)
        for (int j = std::min(3, p_ - 2); j >= 0; --j)
          if (k > j && velocity(i, j) > -infinity && velocity(i, k) > -infinity)
            growth = std::max(growth, (velocity(i, k) - velocity(i, j)) / (k - j));
    return growth > -infinity ? -growth : 0;
  }

  const Workspace<T>& work_;
  std::size_t n_;
  int p_;
  double factor_;
};

/// log₂ of a length up to log₂ h, so short that the series of the multipliers converge: step_within_multipliers of
/// integrator/taylor, its constants in units of the digits of T.
template <class T>
double within_multipliers(const Workspace<T>& work, std::size_t freedoms, std::size_t constraints, int order,
                          double h) {
  const double converged = 0.4 * log2_size(epsilon<T>());
  const double silent = 0.9 * log2_size(epsilon<T>());
  constexpr int most_cuts = 200;
  const double cut = std::log2(0.8);
  const auto largest = [&](std::size_t j, int begin, int end, double length) {
    double size = -std::numeric_limits<double>::infinity();
    for (int k = begin; k < end; ++k)
      size = std::max(size,
                      std::log2((k + 1.0) * (k + 2.0)) + log2_size(work.coordinate(k + 2)[freedoms + j]) + k * length);
    return size;
  };
  const auto first = [&](std::size_t j, double length) { return largest(j, 0, std::min(4, order), length); };
  const auto last = [&](std::size_t j, double length) { return largest(j, std::max(0, order - 4), order, length); };
  double scale = -std::numeric_limits<double>::infinity(), least = h;
  for (std::size_t j = 0; j < constraints; ++j) scale = std::max(scale, first(j, h));
  for (std::size_t j = 0; j < constraints; ++j) {
    if (std::max(first(j, h), last(j, h)) <= silent + scale) continue;
    double own = h;
    int cuts = 0;
    while (cuts < most_cuts && last(j, own) > converged + first(j, own)) own += cut, ++cuts;
    if (cuts < most_cuts) least = std::min(least, own);
  }
  return least;
}

}  // namespace maupertuis::extended

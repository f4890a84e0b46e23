#include "simulation/hybrid_carried.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace maupertuis::hybrid {

void Carried::take(const TaylorStepper& stepper) {
  for (std::size_t k = 0; k < std::size(integrals); ++k) integrals[k] += stepper.integral(k);
  steps += stepper.steps(), rejected += stepper.rejected(), switches += stepper.switches();
  residual = std::max(residual, stepper.constraint_residual());
}

void Carried::forget_work() { std::fill(std::begin(integrals), std::end(integrals), 0.0); }

void PassedMoment::begin(double t, std::vector<double> accelerations) {
  begin_ = t;
  accelerations_ = std::move(accelerations);
  just_passed_ = true;
}

void PassedMoment::forget() { begin_ = std::numeric_limits<double>::quiet_NaN(); }

void PassedMoment::end_step() {
  if (!just_passed_) forget();
  just_passed_ = false;
}

double PassedMoment::covered(double t, double begin) const {
  const bool is_within = begin_ <= begin ? begin_ <= t && t < begin : begin < t && t <= begin_;
  return is_within ? begin : t;
}

void PassedMoment::move_back(double t, double begin, std::span<double> q, std::span<double> v) const {
  const double by = t - covered(t, begin);
  for (std::size_t i = 0; by != 0 && i < q.size(); ++i) {
    q[i] += by * (v[i] + 0.5 * by * accelerations_[i]);
    v[i] += by * accelerations_[i];
  }
}

}  // namespace maupertuis::hybrid

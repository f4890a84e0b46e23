#include "integrator/dense_output/dense_output.hpp"

namespace maupertuis {

void Compensated::add(double increment) {
  const double b = lo + increment;
  const double sum = hi + b;
  const double part = sum - hi;
  lo = (hi - (sum - part)) + (b - part);
  hi = sum;
}

void DenseOutput::resize(std::size_t freedoms, std::size_t integral_count, int degree) {
  freedoms_ = freedoms;
  degree_ = degree;
  const auto rows = static_cast<std::size_t>(degree) + 1;
  coefficients_.assign(rows * freedoms, 0.0);
  integrands_.assign(rows * integral_count, 0.0);
  q.assign(freedoms, {});
  v.assign(freedoms, {});
  integrals.assign(integral_count, {});
}

void DenseOutput::advance(double tau, std::span<Compensated> q_out, std::span<Compensated> v_out,
                          std::span<Compensated> integrals_out) const {
  // Horner for the increments alone, q − q_0 and v − v_0: they are small, and summed with compensation.
  for (std::size_t i = 0; i < freedoms_; ++i) {
    double dq = 0, dv = 0;
    for (int k = degree_; k >= 2; --k) {
      const double c = coefficients(k)[i];
      dq = (dq + c) * tau;
      dv = dv * tau + k * c;
    }
    q_out[i] = q[i];
    q_out[i].add((dq + (v[i].hi + v[i].lo)) * tau);
    v_out[i] = v[i];
    v_out[i].add(dv * tau);
  }
  const std::size_t m = integrals.size();
  for (std::size_t i = 0; i < m; ++i) {
    double sum = 0;
    for (int k = degree_; k >= 0; --k) sum = (sum + integrands_[static_cast<std::size_t>(k) * m + i] / (k + 1)) * tau;
    integrals_out[i] = integrals[i];
    integrals_out[i].add(sum);
  }
}

}  // namespace maupertuis

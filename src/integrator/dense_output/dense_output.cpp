#include "integrator/dense_output/dense_output.hpp"

#include <algorithm>

namespace maupertuis {

void DenseOutput::resize(std::size_t freedoms, std::size_t integral_count, int degree) {
  freedoms_ = freedoms;
  degree_ = degree;
  const auto rows = static_cast<std::size_t>(degree) + 1;
  coefficients_.assign(rows * freedoms, 0.0);
  refer_to(coefficients_.data(), freedoms);
  integrands_.assign(rows * integral_count, 0.0);
  q.assign(freedoms, {});
  v.assign(freedoms, {});
  integrals.assign(integral_count, {});
}

void DenseOutput::copy(const double* first, std::size_t stride) {
  for (int k = 0; k <= degree_; ++k)
    std::copy_n(first + static_cast<std::size_t>(k) * stride, freedoms_, coefficients_.data() + static_cast<std::size_t>(k) * freedoms_);
  refer_to(coefficients_.data(), freedoms_);
}

/// Σ_{k≥2} c_k τ^{k−1} and Σ_{k≥2} k c_k τ^{k−1}: even and odd powers apart, each by Horner's rule, so that half as many operations
/// wait for each other. They are small against q and q̇, and summed with compensation.
void DenseOutput::increments(double tau, std::size_t i, double& dq, double& dv) const {
  const double square = tau * tau;
  double q_even = 0, q_odd = 0, v_even = 0, v_odd = 0;
  int k = degree_;
  const double* c = first_ + static_cast<std::size_t>(k) * stride_ + i;
  if (k % 2 == 1) q_odd = *c, v_odd = k * *c, --k, c -= stride_;
  for (; k >= 2; k -= 2) {
    q_even = q_even * square + *c, v_even = v_even * square + k * *c, c -= stride_;
    if (k > 2) q_odd = q_odd * square + *c, v_odd = v_odd * square + (k - 1) * *c, c -= stride_;
  }
  dq = (q_even + q_odd * tau) * tau;
  dv = (v_even + v_odd * tau) * tau;
}

void DenseOutput::advance(double tau, std::span<Compensated> q_out, std::span<Compensated> v_out,
                          std::span<Compensated> integrals_out) const {
  for (std::size_t i = 0; i < freedoms_; ++i) {
    double dq = 0, dv = 0;
    increments(tau, i, dq, dv);
    q_out[i] = q[i];
    q_out[i].add((dq + (v[i].hi + v[i].lo)) * tau);
    v_out[i] = v[i];
    v_out[i].add(dv);
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

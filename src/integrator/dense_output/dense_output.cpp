#include "integrator/dense_output/dense_output.hpp"

#include <algorithm>
#include <cstring>

namespace maupertuis {
namespace {

/// Polynomials are evaluated eight at a time.
std::size_t padded(std::size_t count) { return (count + 7) / 8 * 8; }

}  // namespace

void DenseOutput::resize(std::size_t freedoms, std::size_t integral_count, int degree) {
  freedoms_ = freedoms;
  degree_ = degree;
  const auto rows = static_cast<std::size_t>(degree) + 1;
  coefficients_.assign(rows * padded(freedoms), 0.0);
  increments_.assign(2 * padded(freedoms), 0.0);
  refer_to(coefficients_.data(), padded(freedoms));
  integrands_.assign(rows * integral_count, 0.0);
  q.assign(freedoms, {});
  v.assign(freedoms, {});
  integrals.assign(integral_count, {});
}

void DenseOutput::copy(const double* first, std::size_t stride) {
  const std::size_t row = padded(freedoms_);
  double* to = coefficients_.data();
  for (int k = 0; k <= degree_; ++k, first += stride, to += row)
    if (stride < row)
      std::copy_n(first, freedoms_, to);
    else if (freedoms_ == 1 || freedoms_ == 2)
      std::memcpy(to, first, 2 * sizeof(double));
    else  // rows of a workspace end with whole vectors
      for (std::size_t i = 0; i < row; i += 8) std::memcpy(to + i, first + i, 8 * sizeof(double));
  refer_to(coefficients_.data(), row, {.accelerations = by_.accelerations});
}

void DenseOutput::leave_out_acceleration(std::size_t i, bool rests) {
  keep();
  for (int k = rests ? 1 : 2; k <= degree_; ++k) coefficients_[static_cast<std::size_t>(k) * stride_ + i] = 0;
  if (rests) v[i] = {};
}

/// The increments are small against q and q̇, and summed with compensation.
void DenseOutput::advance(double tau, std::span<Compensated> q_out, std::span<Compensated> v_out,
                          std::span<Compensated> integrals_out) const {
  double* const dq = increments_.data();
  double* const dv = dq + padded(freedoms_);
  by_.increments(first_, stride_, freedoms_, degree_, tau, dq, dv);
  if (freedoms_ > 0) add_increments(freedoms_, tau, dq, dv, &q[0].hi, &v[0].hi, &q_out[0].hi, &v_out[0].hi);
  const std::size_t m = integrals.size();
  for (std::size_t i = 0; i < m; ++i) {
    double sum = 0;
    for (int k = degree_; k >= 0; --k) sum = (sum + integrands_[static_cast<std::size_t>(k) * m + i] / (k + 1)) * tau;
    integrals_out[i] = integrals[i];
    integrals_out[i].add(sum);
  }
}

std::span<const double> DenseOutput::accelerations(double tau) const {
  by_.accelerations(first_, stride_, freedoms_, degree_, tau, increments_.data());
  return {increments_.data(), freedoms_};
}

}  // namespace maupertuis

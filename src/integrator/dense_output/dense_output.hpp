#pragma once
#include <maupertuis/kernel.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace maupertuis {

/// A value and the rounding error that it left behind: hi + lo.
struct Compensated {
  double hi = 0, lo = 0;
  /// Adds with Knuth's TwoSum, so that nothing is lost but the rounding of lo itself.
  void add(double increment) {
    const double b = lo + increment;
    const double sum = hi + b;
    const double part = sum - hi;
    lo = (hi - (sum - part)) + (b - part);
    hi = sum;
  }
};
static_assert(sizeof(Compensated) == 2 * sizeof(double));  // add_increments() reads them pair by pair

/// The motion within one step: q(begin + τ) = Σ c_k τ^k with its derivative, and time integrals beside it.
class DenseOutput {
 public:
  void resize(std::size_t freedoms, std::size_t integrals, int degree);

  /// Takes the coefficients c_k = first[k · stride …] of q from where they are, as long as they stay there …
  void refer_to(const double* first, std::size_t stride, const Polynomials& by = {}) {
    first_ = first, stride_ = stride, by_ = by;
  }
  /// … or copies them.
  void copy(const double* first, std::size_t stride);
  /// Copies what it referred to, before something else takes its place.
  void keep() {
    if (first_ != coefficients_.data()) copy(first_, stride_);
  }
  /// Coordinate i goes on with its velocity, or stays where it is.
  void leave_out_acceleration(std::size_t i, bool rests);
  /// Of the integrands; their integrals start from `integrals`.
  double* integrand(int k) { return integrands_.data() + static_cast<std::size_t>(k) * integrals.size(); }

  /// The state after τ, with the rounding errors carried on. Spans: [n], [n], [m].
  void advance(double tau, std::span<Compensated> q_out, std::span<Compensated> v_out,
               std::span<Compensated> integrals_out) const;

  /// [n] q̈ after τ, until the next call of this or advance().
  std::span<const double> accelerations(double tau) const;

  std::vector<Compensated> q, v;       // [n] at τ = 0
  std::vector<Compensated> integrals;  // [m] at τ = 0

 private:
  std::size_t freedoms_ = 0;
  int degree_ = 0;
  const double* first_ = nullptr;
  std::size_t stride_ = 0;
  Polynomials by_;
  std::vector<double> coefficients_;        // [degree + 1][n] of q, where they are copied
  std::vector<double> integrands_;          // [degree + 1][m]
  mutable std::vector<double> increments_;  // of q and q̇
};

}  // namespace maupertuis

#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace maupertuis {

/// A value and the rounding error that it left behind: hi + lo.
struct Compensated {
  double hi = 0, lo = 0;
  /// Adds with Knuth's TwoSum, so that nothing is lost but the rounding of lo itself.
  void add(double increment);
};

/// The motion within one step: q(begin + τ) = Σ c_k τ^k with its derivative, and time integrals beside it.
class DenseOutput {
 public:
  void resize(std::size_t freedoms, std::size_t integrals, int degree);

  double* coefficients(int k) { return coefficients_.data() + static_cast<std::size_t>(k) * freedoms_; }
  const double* coefficients(int k) const { return coefficients_.data() + static_cast<std::size_t>(k) * freedoms_; }
  /// Of the integrands; their integrals start from `integrals`.
  double* integrand(int k) { return integrands_.data() + static_cast<std::size_t>(k) * integrals.size(); }

  /// The state after τ, with the rounding errors carried on. Spans: [n], [n], [m].
  void advance(double tau, std::span<Compensated> q_out, std::span<Compensated> v_out,
               std::span<Compensated> integrals_out) const;

  std::vector<Compensated> q, v;        // [n] at τ = 0
  std::vector<Compensated> integrals;   // [m] at τ = 0

 private:
  std::size_t freedoms_ = 0;
  int degree_ = 0;
  std::vector<double> coefficients_;    // [degree + 1][n] of q
  std::vector<double> integrands_;      // [degree + 1][m]
};

}  // namespace maupertuis

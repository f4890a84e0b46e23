#pragma once
#include <maupertuis/function_kernel.hpp>

#include <memory>
#include <span>

namespace maupertuis {

/// Bounds of a function's values where its inputs are polynomials in s and |s| ≤ r in the complex plane
/// (docs/design/safe_steps.md): what points cannot see, a disk that contains them can. Each value f has a *reach* ≥
/// |f(s) − f(0)|, bounds of its modulus, and a *tail*: the reach of what is no polynomial of the inputs' degree; ∞
/// where the disk meets a singularity, or a switch that is not decided on it. By Cauchy's estimate a polynomial of
/// degree K − 1 leaves out at most tail · x^K/(1 − x) of f at |s| = x r.
///
/// Cost: some 10 operations a term.
class FunctionDisks {
 public:
  FunctionDisks(const FunctionKernel& kernel, std::span<const double> parameters);
  ~FunctionDisks();
  FunctionDisks(FunctionDisks&&) noexcept;
  /// The inputs at s = 0, [inputs].
  void set_centre(std::span<const double> inputs);
  /// reach: [inputs] on the disk about the centre.
  void evaluate(std::span<const double> reach);
  double reach(std::size_t output) const;
  double tail(std::size_t output) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace maupertuis

#pragma once
#include "simulation/function_kernels.hpp"
#include "simulation/run_plan.hpp"

#include <maupertuis/kernel.hpp>

#include <cstdint>
#include <vector>

namespace maupertuis {

/// The numbers of a motion and which of them double does not hold exactly: parameters, start values, and the constants
/// that its kernel makes of literals and parameters (9.81, 1/3, π, 1 + 1e-8). A companion run takes each of those one
/// unit in the last place higher or lower, at random: so the motion shows what its numbers were rounded by. 1/2 and 2
/// are exact and stay. Its equations have a factor of their own besides, so that sums of the mass matrix are rounded
/// otherwise too: of 1 + e and 1, whose difference is all that counts.
class RoundedNumbers {
 public:
  /// Of a model with modes its literals are parameters already (literals.hpp), or stay, and there is no kernel. The
  /// kernel has neither integrands nor, unless the run ends at one, events. Cost: that of build_kernel.
  RoundedNumbers(const Model& model, const EquationsOfMotion& equations, const RunPlan& plan,
                 const WantedFunctions& wanted);

  const Kernel& kernel() const { return kernel_; }

  struct Draw {
    std::vector<double> parameters;  // of kernel()
    std::vector<double> q, v;        // [n] the start
  };
  /// Equal seeds give equal numbers.
  Draw draw(std::uint64_t seed) const;

  /// Whether a start value stands as it was given, so that there is nothing to be known about it.
  bool given_q(std::size_t i) const { return q_[i].given; }
  bool given_v(std::size_t i) const { return v_[i].given; }

 private:
  struct Value {
    double value = 0;
    bool rounded = false;
  };
  struct StartNumber {
    double value = 0;
    bool rounded = false, given = false;
    Expr formula;  // in parameters, where the value follows from them
  };
  void take_start(const Model& model, const RunPlan& plan);

  bool has_modes_;
  std::vector<Value> parameters_;   // of the system
  std::vector<Expr> symbols_;       // of those of the system
  std::vector<StartNumber> q_, v_;  // [n]
  Kernel kernel_{nullptr};
};

}  // namespace maupertuis

#pragma once
#include "integrator/point/step_search.hpp"
#include "integrator/stiff/radau_method.hpp"
#include "linear_algebra/dense.hpp"

#include <span>
#include <vector>

namespace maupertuis::stiff {

/// Backward differentiation looks at forces at the ends of steps alone: what rises and dies between them it does not
/// know of. This check follows the forces along the step's own polynomials of q and v, everywhere (StepSearch), with
/// a and λ as they are at the end. What of them is no polynomial of the step's order may change v, through Newton's
/// matrix of the step, by ten times the error that a step may make, not by more.
class ForceCheck {
 public:
  explicit ForceCheck(Motion& motion);
  /// y: the state at the end.
  bool sees_all(const RadauMethod& method, double begin, double end, std::span<const double> y);

 private:
  void follow(const RadauMethod& method, double begin, double end);
  void find_effect(double h);
  void fit(int order);
  std::span<const double> fitted(double x);
  bool is_small(std::span<const double> forces, double share) const;

  Motion& motion_;
  StepSearch search_;
  std::size_t inputs_;
  std::vector<double> path_, state_;
  Eigen::MatrixXd effect_, by_q_, by_v_;  // effect: of forces on v, over the step
  std::vector<double> allowed_;           // changes of velocities
  std::vector<double> nodes_;             // of the fit, [order + 1]
  std::vector<std::vector<double>> at_nodes_;
  std::vector<double> fitted_, rest_;
};

}  // namespace maupertuis::stiff

#pragma once
#include "integrator/point/step_search.hpp"
#include "integrator/variational/stages.hpp"

#include <span>
#include <vector>

namespace maupertuis::variational {

/// NotAll: a force acts between the nodes that they do not tell of.
enum class Sight { All, NotAll, NonFinite };

/// A variational step looks at forces at its nodes alone, and all steps are alike: what lies between the nodes is not
/// found by shorter ones. This check follows ∂L/∂q + F along the polynomials of a step, everywhere (StepSearch), and
/// compares its mean with the mean that the nodes give. They may differ as smooth forces make them differ in coarse
/// steps, and where a switch lies in the step. A force that the nodes missed makes them differ by most of what it is;
/// or its variation is more than what nodes and ends tell of.
class ForceCheck {
 public:
  ForceCheck(const VariationalFunctions& functions, std::span<const double> parameters);
  /// A run begins. inertia: [n] of the coordinates at the start.
  void start(std::span<const double> inertia);
  /// What the nodes of a solved step saw; `solver` holds the step, from t to t + h, p: [n] at its end.
  Sight look(StageSolver& solver, double t, double h, std::span<const double> p);

 private:
  struct Means {
    double force = 0, size = 0, variation = 0;  // of f, |f|, |f − mean|
  };
  void follow(StageSolver& solver, double t, double h);
  void look_at_nodes(const Tableau& tableau);
  Means means(std::size_t i) const;
  bool is_seen(std::size_t i, double least, bool switched, double accuracy) const;

  StepSearch search_;
  std::size_t n_, inputs_;
  std::vector<double> path_;
  std::vector<double> inertia_, momentum_;  // [n]; the largest so far
  std::vector<double> by_nodes_,
      spread_;  // [n] the mean that the nodes give; how far values there and at the ends are from it
  std::vector<double> weights_, values_;  // [found], [found × n]
};

}  // namespace maupertuis::variational

#pragma once
#include "analysis/linearization/branch_walk.hpp"
#include "analysis/linearization/point_equations.hpp"

#include <maupertuis/locus.hpp>

#include <optional>
#include <vector>

namespace maupertuis {

inline constexpr double longest_step = 1.0 / 3, one_place = 1e-5;  // of typical sizes

/// Equilibria at values of the parameter of a sweep, with their verdicts, and how a branch goes on from one to another.
class BranchFollower {
 public:
  /// step: of the sweep, with its sign. All of them outlive this.
  BranchFollower(PointEquations& equations, const MotionState& start, std::size_t parameter, double step,
                 const NeighboursAt& driven);

  /// A force that vanishes at one value leaves symmetries there that the others do not have.
  void set_parameter(double value);
  const std::vector<Translation>& symmetries() const { return symmetries_; }  // at that value
  const std::vector<double>& sizes() const { return sizes_; }                 // [n] typical ones
  double step() const { return step_; }
  /// Neighbours are judged over a period, and have been.
  bool in_time() const { return driven_ && !equations_.autonomous(); }
  bool was_driven() const { return was_driven_; }
  /// A member of a family, or a motion that keeps the momenta of the start, is no curve that one could follow.
  static bool is_followed(const Equilibrium& x) { return x.at_rest && x.family == 0; }
  /// One curve alone goes through it.
  static bool is_regular(const LocusPoint& x) { return x.stability.verdict != Stability::Undecided; }

  /// An equilibrium at a value, which the parameter has from then on.
  LocusPoint judged(double value, const Equilibrium& x);
  /// Of typical sizes; infinite between a rest and a steady motion.
  double distance(const Equilibrium& x, const Equilibrium& y) const;
  /// The equilibrium of a branch near a guess, at any value of the parameter.
  std::optional<LocusPoint> point_near(double value, const Equilibrium& guess);
  /// The point of a branch at another value. Along the curve itself, as far as that can be followed; beyond a fold
  /// another branch begins.
  std::optional<Equilibrium> continued(const std::vector<LocusPoint>& points, double to);
  /// Next to the straight line, much nearer than the ends are to each other; else from one of the ends.
  std::optional<LocusPoint> between(const LocusPoint& low, const LocusPoint& high, double middle);
  /// On the straight line through two points of a branch, at another value.
  Equilibrium on_line(const LocusPoint& a, const LocusPoint& b, double value) const;
  BranchWalk walk_from(const LocusPoint& from, double to);
  /// The rest next to a place that a walk has come to, as a search tells it.
  std::optional<Equilibrium> settled(const Equilibrium& like, const RestAt& place);

 private:
  struct Step {
    double parameter = 0;
    Equilibrium equilibrium;
  };
  Equilibrium on_line(const Step& a, const Step& b, double value) const;
  double along(std::size_t i, const Equilibrium& x, const Equilibrium& y) const;
  double product_of_eigenvalues(const ModalAnalysis& analysis, const Equilibrium& x) const;
  std::optional<Equilibrium> near(const Equilibrium& guess) const;
  std::optional<Equilibrium> in_steps(const std::vector<LocusPoint>& points, double to);

  PointEquations& equations_;
  const MotionState& start_;
  std::size_t parameter_;
  double step_;
  const NeighboursAt& driven_;
  std::vector<double> sizes_;
  std::vector<Translation> symmetries_;
  bool was_driven_ = false;
};

}  // namespace maupertuis

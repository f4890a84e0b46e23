#pragma once
#include "analysis/linearization/steady_state.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace maupertuis {

/// Largest difference of positions and rates by typical sizes; coordinates in which the equations are periodic by the
/// shorter way round. `sizes`: [n], of the coordinates.
double distance(const PointEquations::Impl& equations, const std::vector<double>& sizes, const OperatingPoint& x,
                const OperatingPoint& y);

/// Gathers equilibria that lie on one curve or surface of equilibria (a trough, a ring). Two members belong together
/// where one walks to the other by short steps, each along the directions of the family that lead towards it, and then
/// back to the nearest equilibrium by Newton's method:
///
///          · ·            ·: a step towards y    o: the equilibrium next to it
///     x ──o──o──o── y
///
/// Beside another family no direction leads there. Nor does one from the opposite place of a ring, or of the sphere of
/// a quaternion: members in between link these. What the search met too sparsely to link stays apart: a family is then
/// listed twice, never is one hidden.
class Families {
 public:
  Families(const PointEquations::Impl& equations, std::vector<double> sizes)
      : e_(equations), sizes_(std::move(sizes)) {}

  /// `candidate` has candidate.family > 0.
  void add(Equilibrium candidate);
  /// Joins what belongs together among the members that are `at_rest` or not, solutions of `system`.
  void link(bool at_rest, const SteadyState& system);
  /// Of each family the member nearest to `start`, with the coordinates along which any member can be moved.
  std::vector<Equilibrium> representatives(const OperatingPoint& start) const;

 private:
  struct Walk {
    std::function<std::optional<OperatingPoint>(const OperatingPoint& at, double part)>
        beside;  // of the way that is left
    std::function<double(const OperatingPoint&, const OperatingPoint&)> distance;
    double least = 0;  // part of a step by which each has to come nearer
  };

  double chord(const OperatingPoint& x, const OperatingPoint& y) const;
  bool linked(const Equilibrium& x, const Equilibrium& y, const SteadyState& system);
  bool walks(const Equilibrium& x, const Equilibrium& y, const SteadyState& system, const Walk& walk);
  /// By Newton's method in double, or where that does not arrive soon in 100 digits.
  std::optional<OperatingPoint> next_to(const OperatingPoint& from, double farthest, const SteadyState& system);
  std::size_t leader(std::size_t member) const;

  const PointEquations::Impl& e_;
  std::vector<double> sizes_;
  std::vector<Equilibrium> members_;
  int steps_along_ = 0, precise_steps_ = 0;
  std::vector<std::size_t> above_;  // [members] towards the leader of the family, itself for the leader
};

}  // namespace maupertuis

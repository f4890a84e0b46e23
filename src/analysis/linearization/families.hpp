#pragma once
#include "analysis/linearization/steady_state.hpp"

#include <vector>

namespace maupertuis {

/// Largest difference of positions and rates by typical sizes; coordinates in which the equations are periodic by the
/// shorter way round. `sizes`: [n], of the coordinates.
double distance(const PointEquations::Impl& equations, const std::vector<double>& sizes, const OperatingPoint& x,
                const OperatingPoint& y);

/// Gathers equilibria that lie on one curve or surface of equilibria (a trough, a ring). Two members belong together
/// where one walks to the other by short steps, each towards it and then back to the nearest equilibrium by Newton's
/// method:
///
///          · ·            ·: a step towards y    o: the equilibrium next to it
///     x ──o──o──o── y
///
/// Beside another family the walk comes back to its own and gets no further. A walk across a ring gets stuck as well:
/// rings are closed by their members in between. What the search met too sparsely to link stays apart: a family is then
/// listed twice, never is one hidden.
class Families {
 public:
  Families(const PointEquations::Impl& equations, std::vector<double> sizes)
      : e_(equations), sizes_(std::move(sizes)) {}

  /// `candidate` was found as a solution of `system` and has candidate.family > 0.
  void add(Equilibrium candidate, const SteadyState& system);
  /// Of each family the member nearest to `start`, with the coordinates along which any member can be moved.
  std::vector<Equilibrium> representatives(const OperatingPoint& start) const;

 private:
  bool linked(const Equilibrium& x, const Equilibrium& y, const SteadyState& system) const;
  std::size_t leader(std::size_t member) const;

  const PointEquations::Impl& e_;
  std::vector<double> sizes_;
  std::vector<Equilibrium> members_;
  std::vector<std::size_t> above_;  // [members] towards the leader of the family, itself for the leader
};

}  // namespace maupertuis

#pragma once
#include <maupertuis/modes.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

/// Equilibria and their eigenvalues as functions of one parameter: bifurcation diagrams and root loci.
namespace maupertuis {

struct LocusPoint {
  double parameter = 0;  // SI
  Equilibrium equilibrium;
  StabilityReport stability;
  std::vector<std::complex<double>> eigenvalues;  // ascending by real, then imaginary part; driven: exponents
  std::vector<double> passes;                     // 0 where a verdict may change; driven: as of NeighboursInTime
};

/// What the neighbours of an equilibrium do when the parameter has a value, in the place of eigenvalues of coefficients
/// that are frozen at an instant: `driven_neighbours` of orbits.hpp. Nothing: not known.
struct NeighboursInTime {
  StabilityReport stability;
  std::vector<std::complex<double>> exponents;  // log μ / T of the Floquet multipliers, 1/s
  std::vector<double> passes;  // Π (1 − μ) and Π (1 + μ): smooth in the parameter, 0 where a multiplier passes 1 or −1
};
using NeighboursAt = std::function<std::optional<NeighboursInTime>(double value, const Equilibrium&)>;

/// Equilibria that belong together, in the order of the parameter.
struct LocusBranch {
  std::vector<LocusPoint> points;
};

/// Where the verdict on a branch changes: between two values of the sweep, then to rounding by bisection, or where a
/// multiplier passes 1 or −1.
struct StabilityChange {
  double parameter = 0;
  std::size_t branch = 0;
  Stability before = Stability::Undecided, after = Stability::Undecided;
};

/// Where branches of rests turn back into each other (a fold, limit point, saddle-node): a parameter on one side of it
/// has two rests, on the other none.
struct Fold {
  double parameter = 0;  // SI
  Equilibrium equilibrium;
  std::vector<std::size_t> branches;  // one or two that end there: of the other no point may have been found
};

struct Locus {
  std::size_t parameter = 0;              // index in MechanicalSystem::parameters
  std::vector<double> values;             // SI
  std::vector<LocusBranch> branches;      // in order of appearance
  std::vector<StabilityChange> changes;   // ascending by parameter
  std::vector<Fold> folds;                // ascending by parameter; of rests that are judged at an instant
  std::vector<Translation> translations;  // of the model's own value
  bool driven = false;                    // points were judged over a period
  bool interrupted = false;               // values may be missing at the end, and changes anywhere
};

/// Equilibria and steady motions at equally spaced values of a parameter, joined to branches: at each value Newton's
/// method begins at the points of the value before and at the starts of `find_equilibria`. Branches of rests are
/// followed along their curves to folds, their last points then, and beyond: the other arm is a branch too. Steady
/// motions and members of families that a step carries further than a third of a typical size begin new ones. The
/// parameter has its own value again afterwards. Where t stands in the equations, `driven` judges the points. Where a
/// multiplier comes nearest to 1 or −1, or an eigenvalue to 0, a point of a window narrower than the step that opens
/// there is among those of the branch. Cost: that of a search, times `steps`. Throws Interrupted before there is a
/// point. Precondition: steps ≥ 2.
Locus parameter_locus(PointEquations& equations, const MotionState& start, std::size_t parameter, double from,
                      double to, std::size_t steps, const NeighboursAt& driven = {});

/// Values of the sweep at which no branch has a point: there is none, or the equations hold no longer.
std::vector<double> values_without_points(const Locus& locus);

/// A row for each point: the parameter, the branch, the verdict, coordinates and rates, then real and imaginary parts
/// of the eigenvalues.
std::string to_csv(const MechanicalSystem& system, const Locus& locus);

}  // namespace maupertuis

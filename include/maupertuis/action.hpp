#pragma once
#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/diagnostic.hpp>
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/stop_flag.hpp>
#include <maupertuis/trajectory.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// The action S[q] = ∫ L dt: its value on paths, the paths on which it is stationary, and of what kind they are
/// (docs/theory/action.md).
namespace maupertuis {

/// How the parameter s in [0, 1] of a path runs: t = start + (end − start) g(s). Where L is infinite at an end, g has a
/// triple root there, so that a path y ∝ t^(2/3), as of a brachistochrone, is smooth in s.
enum class Pace { Even, SlowStart, SlowEnd, SlowEnds };
double pace(Pace which, double s);       // g(s)
double pace_rate(Pace which, double s);  // dg/ds

namespace action {
struct Rule;  // the polynomials of an element by their values at its nodes
}

/// A continuous path of polynomials in s, an element each.
struct ActionPath {
  double start = 0, end = 0;  // of the independent variable
  Pace pace = Pace::Even;
  std::vector<double> breaks;  // [elements + 1] of s, from 0 to 1
  std::size_t degree = 0, coordinates = 0;
  std::shared_ptr<const action::Rule> rule;
  std::vector<double> nodes;  // [elements × (degree + 1) × n] q at the Gauss-Lobatto points of each element

  std::size_t elements() const { return breaks.empty() ? 0 : breaks.size() - 1; }
  /// q and q' at a time between the ends.
  MotionState at(double t) const;
};

/// A place where a field of neighbours that leave the start together meets the path again.
struct ConjugatePoint {
  double t = 0;
  std::size_t multiplicity = 1;
};

/// S on neighbours q + ε ξ of a path.
struct TestVariation {
  std::string name;                     // "lowest", "θ: sin(2π τ)"
  double curvature = 0;                 // d²S/dε² at 0, relative to that of ∫ ½ ξ' M ξ' dt
  std::vector<double> epsilon, change;  // S(ε) − S(0), of equal length
  double slope = 0;                     // dS/dε at 0, relative to Σ |its terms|
};

/// What kind of stationary path it is.
struct SecondVariation {
  /// The Morse index: in how many independent ways the action of neighbours is smaller. Only where both counts agree.
  std::optional<std::size_t> index;
  std::optional<std::size_t> by_inertia;  // negative inertia of the discretized second variation
  std::optional<std::size_t> by_fields;   // conjugate points inside, with multiplicity, and the concavity of other ends
  std::size_t nullity = 0;                // independent variations that leave S as it is to second order
  std::vector<ConjugatePoint> conjugate;  // to the start, strictly inside
  std::optional<std::size_t> concavity;   // of ends that are free or closed
  double nearest = 0;  // the eigenvalue next to zero lies beyond ± this, relative to ∫ ½ ξ' M ξ' dt
  std::string reason;  // why there is no index; empty: there is one
  std::vector<TestVariation> variations;
};

/// The same path by the other method: the equations of motion carried from its states.
struct MotionCheck {
  bool done = false;
  std::size_t stretches = 0;  // the path is carried from the beginning of each to the next
  double missed = 0;          // the largest distance there, relative to the size of the path
  double action = 0;          // ∫ L dt along those motions
  double from = 0, to = 0;    // what of the path was carried: all, but for an end where L is infinite
  std::string reason;         // why not; empty: done
};

/// A path on which S is stationary.
struct StationaryPath {
  ActionPath path;
  double action = 0;
  double action_error = 0;          // the change of S when every element is halved, and a bound on rounding
  double path_error = 0;            // the change of q then, relative to its size
  double residual = 0;              // the last correction of Newton's method, relative to the size
  std::vector<double> multipliers;  // λ of each integral constraint: the equations are those of L + λ G
  std::vector<double> start_velocity, start_momentum,
      end_momentum;                                // ∂S/∂q at the end is p there; NaN where L is infinite
  std::optional<double> start_energy, end_energy;  // −∂S/∂T is h_E at the end
  std::vector<int> turns;                          // [n] whole turns by which an angle ends beyond what was asked
  std::string found_from;                          // "the straight line"
  SecondVariation second;
  MotionCheck check;
};

/// Between what ends paths are looked for. A free component has no number.
struct ActionEnds {
  std::vector<std::optional<double>> from, to;  // [n]
  double start = 0, end = 0;
  bool closed = false;  // from and to the same, whatever they are
};

struct ActionOptions {
  std::size_t paths = 8;   // at most so many are looked for
  std::size_t turns = 0;   // angles may also end up to so many whole turns further
  bool variations = true;  // S on neighbours
  const StopFlag* interrupt = nullptr;
};

struct PathSearch {
  ActionEnds ends;
  std::vector<StationaryPath> paths;  // the smallest action first
  std::size_t starts = 0;             // from so many the search began
  std::size_t failed = 0;             // of them led to no stationary path
  std::string bound;                  // within what the search saw everything, or that it is no proof
};

/// The numbers of the model's `path` statement. Precondition: it has one.
ActionEnds ends_of(const Model& model);

/// The paths between the ends on which S is stationary, by Newton's method on its stationarity from many starts, with
/// the second variation of each. Nothing, with a diagnostic: forces that no Lagrangian gives or constraints between
/// velocities (E1201), ends that are off the constraints (E1202), times in the wrong order (E1203), no path found
/// (E1204), or rates beyond the range of doubles (E1209), an interruption (E1210, as everywhere below). W1201: the two
/// counts of the index disagree.
std::optional<PathSearch> stationary_paths(const Model& model, const EquationsOfMotion& equations,
                                           const ActionEnds& ends, const ActionOptions& options,
                                           Diagnostics& diagnostics);

/// Where p = ∂L/∂q', or h_E, does not go on: there a path is not stationary (Weierstrass, Erdmann).
struct PathCorner {
  double t = 0;
  std::size_t row = 0;           // of which coordinate's momentum; n: of h_E
  double before = 0, after = 0;  // NaN or infinite where it has no value
};

/// S along a path that is given as formulas of t.
struct GivenPath {
  double action = 0, action_error = 0;
  std::vector<double> integrals;     // ∫ G dt of each integral constraint
  double residual = 0;               // the largest |d/dt ∂L/∂q' − ∂L/∂q|, relative to the sizes of its terms
  double residual_at = 0;            // where
  std::size_t residual_row = 0;      // of which coordinate
  std::optional<PathCorner> corner;  // the first
  bool stationary = false;           // the residual vanishes to rounding, and there is no corner
  std::vector<TestVariation> variations;
  ActionPath path;  // to be drawn
  double start = 0, end = 0;
};

/// `path`: q(t) [n] of numbers, parameters and the independent variable. Nothing, with a diagnostic: it misses the ends
/// of the model (E1205), leaves the constraints (E1202) or jumps (E1213), L has no value on it (E1206), or S is
/// infinite or cannot be told (E1212).
std::optional<GivenPath> action_of_path(const Model& model, const EquationsOfMotion& equations,
                                        std::span<const Expr> path, double start, double end,
                                        const std::optional<ActionEnds>& ends, const ActionOptions& options,
                                        Diagnostics& diagnostics);

/// S along the model's own motion.
struct MotionAction {
  StationaryPath path;  // as a path between the ends that the motion reaches
  Trajectory rows;      // t, q, S
};

/// Nothing, with a diagnostic: no run (E1207), or it ends early (E1208) or takes too many steps (E1211), functions of
/// the motion are free (E0631), and as for stationary_paths.
std::optional<MotionAction> action_of_motion(const Model& model, const EquationsOfMotion& equations,
                                             const ActionOptions& options, Diagnostics& diagnostics);

/// A closed path with its period.
struct PeriodicAction {
  StationaryPath path;
  double period = 0;
  double abbreviated = 0;  // ∮ p dq
};

/// The periodic motion next to the model's start (as `floquet` finds it) as a closed path.
std::optional<PeriodicAction> action_of_orbit(const Model& model, const EquationsOfMotion& equations,
                                              std::optional<double> period, const ActionOptions& options,
                                              Diagnostics& diagnostics);

/// "minimum", "saddle", "degenerate", or "stationary" where there is no index.
std::string kind_of(const SecondVariation& second);

/// Columns q and q' of a path at 401 times, and the first momentum row; several paths one after the other, told apart
/// by a column `path`.
Trajectory path_rows(const std::vector<const ActionPath*>& paths, const MechanicalSystem& system);

}  // namespace maupertuis

#pragma once
#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/step.hpp>
#include <maupertuis/stop_flag.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// The neighbours of a motion to first order: dΦ of its flow Φ, by the tangent (first-variation) equations
///
///     R(q,q̇,q̈,λ,t) = 0,   δR = ∂R/∂q δq + ∂R/∂q̇ δq̇ + ∂R/∂q̈ δq̈ + ∂R/∂λ δλ = 0,   δφ = 0, δψ = 0 where there are
///     constraints,
///
/// exact, integrated together with the motion itself at rounding tolerance (docs/theory/tangent.md).
///
///     TangentFlow flow(equations);
///     TangentPoint point = flow.all_directions(start);       // columns: a basis of the directions that the
///     constraints allow if (const auto stop = flow.advance(point, 10)) …       // stop->reason point.column(j) // δq,
///     then δq̇: ∂(q,q̇)(10) along direction j of the start
namespace maupertuis {

/// A state of the motion and directions at it. A direction is δq [n], then δq̇ [n].
struct TangentPoint {
  MotionState state;
  std::vector<double> directions;  // [columns × 2n], one after the other

  std::size_t width() const { return 2 * state.q.size(); }
  std::size_t columns() const { return width() == 0 ? 0 : directions.size() / width(); }
  std::span<double> column(std::size_t j) { return std::span(directions).subspan(j * width(), width()); }
  std::span<const double> column(std::size_t j) const { return std::span(directions).subspan(j * width(), width()); }
};

/// Why a flow did not reach its end.
struct TangentStop {
  StepEnding ending = StepEnding::None;  // None: an acceleration jumps at a switch, where the tangent equations end
  double t = 0;                          // s
  std::string reason;                    // one sentence
  std::string help = {};                 // what to do instead, where it is not to make a jump smooth
};

/// q̈ and λ at a point, and what they change by along each direction: by the tangent equations.
struct TangentForces {
  std::vector<double> a, multipliers;                        // [n], [m]
  std::vector<double> changes_of_a, changes_of_multipliers;  // [columns × n], [columns × m]
};

struct TangentOptions {
  double tolerance = 0;                     // relative, per step; 0: rounding level of double
  std::size_t maximum_steps = 100'000'000;  // of each advance
  const StopFlag* interrupt = nullptr;      // looked at once a step
};

/// The flow of a system together with its derivative. One thread at a time.
class TangentFlow {
 public:
  /// Kernels are made at first use, for as many directions at once as 96 unknowns have room for. Of a degenerate
  /// Lagrangian that determines a motion: the flow of `equations.determined`. Lists of another length than the comments
  /// say, here and below: std::invalid_argument. So are models with contacts or friction, whose flow is the one below.
  /// Other threads that use the expressions of the same model: study.hpp.
  explicit TangentFlow(const EquationsOfMotion& equations, const TangentOptions& options = {});
  /// Through the contacts, the friction and the events of a model, if there are any (docs/theory/contacts.md): its
  /// directions jump at instants, and have in each mode those that it allows. It stops where neighbours have no
  /// derivative, also where the start itself is such a place: at rest under friction. Model and equations outlive it.
  TangentFlow(const Model& model, const EquationsOfMotion& equations, const TangentOptions& options);
  ~TangentFlow();
  TangentFlow(TangentFlow&&) noexcept;

  std::size_t freedoms() const;  // n, the number of coordinates

  /// The state with a basis of the directions that the constraints allow: the 2n unit vectors without constraints, else
  /// an orthonormal basis of the tangent space of {φ = 0, dφ/dt = 0, ψ = 0}. Precondition: the state is on the
  /// constraints.
  TangentPoint all_directions(const MotionState& state) const;

  /// Carries state and directions to the time t, forwards or backwards. Directions are linear: any scale, any number of
  /// columns. Where it stops on the way, `point` is what was reached before the step that was not possible. Switches of
  /// abs, min, piecewise, … are crossed where the accelerations are continuous (then dΦ is); elsewhere it stops.
  /// Precondition: with constraints, each column is a direction that they allow.
  /// Cost per step: about that of (1 + 3 · columns) expansions of the motion.
  std::optional<TangentStop> advance(TangentPoint& point, double t);

  /// The same with the points at `times` on the way (in the order of the run, the last one ends it). Those reached are
  /// in `points`.
  std::optional<TangentStop> along(const TangentPoint& start, std::span<const double> times,
                                   std::vector<TangentPoint>& points);

  /// Accelerations at a state [n]; empty where they have no value.
  std::vector<double> accelerations(const MotionState& state);
  /// Columns are carried in groups, each with the motion itself: how far those copies of the motion came apart in the
  /// last advance, relative to the size of each coordinate. An estimate of the error of the motion; 0 for one group.
  double spread() const;
  /// Sizes of the motion [2n]: in later starts, what is much smaller is rounding.
  void set_usual_sizes(std::span<const double> sizes);
  /// q̈, λ and their changes at a point. Precondition: not through modes.
  TangentForces forces(const TangentPoint& point);
  /// The equations that hold at a state: those of its mode.
  const EquationsOfMotion& equations_at(const MotionState& state);
  bool through_modes() const { return modes_ != nullptr; }
  /// log of what the jumps of the last advance multiply volumes of q and p by: 2 log e an impact without friction.
  /// Nothing where one is not known, or is 0.
  std::optional<double> log_volume_of_jumps() const;
  /// The least number of independent directions that a mode on the way of the last advance allows.
  std::size_t fewest_directions() const;

 private:
  struct Impl;
  struct ThroughModes;
  std::unique_ptr<Impl> impl_;
  std::unique_ptr<ThroughModes> modes_;  // else
};

/// What the geometry of mechanics says of directions at a state. The state space has the coordinates (q, q̇).
class TangentGeometry {
 public:
  explicit TangentGeometry(const EquationsOfMotion& equations);
  ~TangentGeometry();
  TangentGeometry(TangentGeometry&&) noexcept;

  /// An orthonormal basis of the directions that the constraints allow [d × 2n], row by row; d = 2n without
  /// constraints.
  std::vector<double> basis(const MotionState& state) const;
  /// Whether the motion is that of a Lagrangian alone (no Q, no D, no constraint between velocities): then dΦ preserves
  /// ω = Σ dq_i ∧ dp_i with p = ∂L/∂q̇.
  bool symplectic() const;
  /// ω of each pair of columns [columns × columns], row by row: ω(a, b) = δq_a·δp_b − δp_a·δq_b with δp = ∂p/∂q δq + M
  /// δq̇.
  std::vector<double> symplectic_products(const TangentPoint& point) const;
  /// ‖a‖ ‖b‖ of each pair in canonical coordinates w q, p/w, in which ω keeps its form, with w for each freedom such
  /// that both are alike in a motion whose coordinates and velocities have these sizes [2n, > 0]: a relative error ε of
  /// the columns changes a product by some ε of that.
  std::vector<double> symplectic_sizes(const TangentPoint& point, std::span<const double> sizes) const;
  /// d/dt log of the volume that dΦ carries along in the phase space of q and p, over the directions that the
  /// constraints allow: tr((ZᵀMZ)⁻¹ Zᵀ (∂F/∂q̇) Z), F = Q − ∂D/∂q̇, A Z = 0 (Liouville). 1/s Nothing for constraints
  /// between velocities, and where Q depends on a reaction.
  std::optional<double> divergence(const MotionState& state) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace maupertuis

#pragma once
#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/equations_of_motion.hpp>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Equilibria, steady motions, and the equations linearized about a point: docs/theory/linearization.md.
namespace maupertuis {

/// A matrix of numbers, by rows.
struct RealMatrix {
  std::size_t rows = 0, columns = 0;
  std::vector<double> entries;  // [rows × columns]
  double at(std::size_t i, std::size_t j) const { return entries[i * columns + j]; }
};

/// Where the equations are linearized. At an equilibrium v = a = 0; in a steady motion along translations a = 0; in one
/// along rotations, q(t) turns as exp(Ξ t), v = Ξ q + d and a = Ξ v.
struct OperatingPoint {
  double t = 0;
  std::vector<double> q, v, a;      // [n] each, SI
  std::vector<double> multipliers;  // [m]
  std::vector<double> inputs;       // [k] the values that the inputs are held at
  /// Ξ [n × n], a symmetry: what lies beside the motion is seen in the frame that turns along with it, q = q₀(t) +
  /// exp(Ξ t) ξ, in which the coefficients are constant. Empty: none.
  RealMatrix turning = {};
  std::vector<double> input_rates = {};  // [2k] u', then u'', of a point of a motion; empty: inputs are held
};

/// A translation q → q + ε d of the coordinates that changes neither the equations nor the constraints: one cyclic
/// coordinate, or several that move together (all carriages of a train).
struct Translation {
  std::vector<double> direction;  // [n], 1 at `pivot`
  std::size_t pivot = 0;          // the coordinate that tells how far
  bool conserved = false;         // its momentum d·p is conserved: no force works along it
};

/// The equations of a system as functions of a point, with exact derivatives. Made once, used for many points.
class PointEquations {
 public:
  /// `outputs`: what is measured, functions y of q, q̇, q̈, λ, reactions, u and t, which `linearize` takes along.
  /// Cost: n + m reverse sweeps over the residual and the constraints, and one an output.
  /// Throws std::invalid_argument where the model has contacts or friction, which are no part of its equations: take
  /// those of one mode (system_in_mode, Study::fix_mode). Threads: study.hpp.
  explicit PointEquations(const EquationsOfMotion& equations, std::span<const Expr> outputs = {});
  ~PointEquations();
  PointEquations(PointEquations&&) noexcept;

  const MechanicalSystem& system() const;
  /// Whether no t stands in R or the constraints, beside that of the inputs; proved.
  bool autonomous() const;
  /// Whether an energy exists that never grows while inputs are held: no explicit time, forces that have a potential
  /// (both proved), friction that takes at random states. With holonomic constraints alone.
  bool energy_never_grows() const;
  /// The same near a point: friction takes at random states at all distances from it where it has values.
  bool energy_never_grows_near(const OperatingPoint& point) const;
  /// Coordinates after which the equations repeat at 2π [n]; by values at random points.
  const std::vector<bool>& periodic() const;
  /// All translations that are symmetries; by the rank of ∂(R, φ, ψ)/∂q at random points. Pivots are chosen among
  /// `preferred` first.
  std::vector<Translation> translations(const std::vector<bool>& preferred = {}) const;

  double parameter(std::size_t index) const;
  /// For loci: the value of one parameter (SI) from now on.
  void set_parameter(std::size_t index, double value);
  /// The inputs' formulas at t.
  std::vector<double> inputs_at(double t) const;

  struct Impl;
  Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

// ------------------------------------------------------------------------------------------ equilibria, steady motions

/// Coordinates and velocities that a search keeps.
struct FixedValues {
  std::vector<bool> q, v;  // [n] or empty: none
  bool any() const;
};

struct EquilibriumSearch {
  MotionState start;                    // of the model: the first start, and the momenta that steady motions keep
  FixedValues fixed;                    // values of `start` that are kept
  bool steady = true;                   // steady motions as well
  std::size_t starts = 0;               // 0: chosen from n
  std::vector<OperatingPoint> guesses;  // further starts, tried first
  bool everywhere = false;              // as many starts again, up to ten typical sizes away
};

/// A configuration of rest, or a motion in which only translations that are symmetries go on, at constant rates.
struct Equilibrium {
  OperatingPoint point;
  bool at_rest = true;                    // an equilibrium; else a steady motion
  double residual = 0;                    // largest |R_i| divided by the size of its derivatives: rounding level
  std::size_t family = 0;                 // how many further ways it can be moved and stay one, beside translations
  std::vector<std::size_t> family_along;  // the coordinates that change on these ways, ascending
  bool coordinates_fail = false;  // M is singular there on what the constraints leave free: r = 0 of polar coordinates
  /// Of a motion along rotations: how those that commute with it move its point, itself first. Neighbours there are
  /// such motions too, and each keeps a momentum, as along a conserved translation.
  std::vector<Translation> ways;
};

struct EquilibriumSearchResult {
  std::vector<Equilibrium> found;  // the one nearest to the start, then those at rest, by energy, then by coordinates
  std::vector<Translation> translations;
  std::size_t starts = 0;   // Newton's method began from so many points
  std::size_t outside = 0;  // further ones, ten typical sizes and more from the start: left out
};

/// Newton's method (Gauss-Newton with damping, minimum norm steps) from many starts, the same in every run: the model's
/// own, all coordinates zero, angles at 0 and π, then scattered points. Nothing says that no further ones exist. Points
/// are distinct modulo 2π in coordinates in which the equations are periodic, and modulo translations. Of a family, a
/// curve or surface of equilibria, the member nearest to the start stands for all. Steady motions keep the momenta of
/// the start along conserved translations, unless `fixed` holds their velocities.
EquilibriumSearchResult find_equilibria(const PointEquations& equations, const EquilibriumSearch& search);

/// The steady motion along rotations that are symmetries (of bodies turned by quaternions about axes of space and of
/// their own, of pairs of lengths in their plane, alone or together) and along translations, nearest to the positions
/// and velocities of the start: Newton's method from there. Nothing where no such motion has them.
std::optional<Equilibrium> steady_rotation_near(const PointEquations& equations, const MotionState& start);

/// The one nearest to a start: Newton's method from there alone. Nothing where it does not converge.
std::vector<Equilibrium> equilibrium_near(const PointEquations& equations, const EquilibriumSearch& search);

// ------------------------------------------------------------------------------------------------------ linearization

/// What is measured, to first order: y = y₀ + C x + D w + D₁ ẇ + D₂ ẅ. An output that holds q̈ or λ passes inputs on
/// directly, D ≠ 0.
/// Values that are not finite: y has none at the point; a row of C and D that is not: y has no derivative there.
struct MeasuredOutputs {
  std::vector<double> values;         // [p] y₀ at the point, SI
  RealMatrix c, d;                    // [p × (f+g)], [p × k]
  RealMatrix d_rate, d_acceleration;  // D₁, D₂ [p × k]
};

/// The equations to first order about a point, ξ = q − q₀ and w = u − u₀.
///
///     M ξ̈ + (C + G) ξ̇ + (K + N) ξ = B w + B₁ ẇ + B₂ ẅ     C, K symmetric, G, N skew; in the independent coordinates
///     ẋ = A x + B w + B₁ ẇ + B₂ ẅ,  y = C x + D w           x = (independent positions, independent velocities),
///                                                           y = (q, q̇)
///
/// B₁ and B₂ are those of inputs that act by their rates: a support that moves, a damper whose other end does.
struct Linearization {
  OperatingPoint point;
  std::vector<std::size_t> independent;             // [f] coordinates
  std::vector<std::size_t> independent_velocities;  // [g] coordinates; g < f with non-holonomic constraints
  RealMatrix positions;                             // [n × f] ξ of all coordinates from the independent ones
  /// The second-order form; absent (0 × 0) where non-holonomic constraints couple velocities with positions, and along
  /// a trajectory on which the independent directions turn.
  RealMatrix mass, damping, gyroscopic, stiffness, circulatory;  // [f × f]
  RealMatrix input, input_rate, input_acceleration;              // B, B₁, B₂ [f × k]
  RealMatrix a, b, c, d;              // [(f+g) × (f+g)], [(f+g) × k], [2n × (f+g)], [2n × k]
  RealMatrix b_rate, b_acceleration;  // B₁, B₂ of the states [(f+g) × k]
  MeasuredOutputs measured;           // of the outputs of PointEquations; empty without
  bool second_order() const { return mass.rows > 0 || independent.empty(); }
};

/// The same in the rates σ (quasi-velocities) that the model names: ż = A z + B w + B₁ ẇ + B₂ ẅ with z = (independent
/// positions, σ).
struct LinearizationInRates {
  std::vector<std::size_t> positions;       // [f] coordinates
  RealMatrix a, b, b_rate, b_acceleration;  // [(f+g) × (f+g)], [(f+g) × k]
  RealMatrix of_states;                     // [g × (f+g)]: δσ of the states x of the Linearization
};

/// The rates of the model, then their derivatives: what PointEquations has to measure, after `first` outputs of others,
/// for `in_rates`.
ExprVector rates_as_outputs(const MechanicalSystem& system);
/// Nothing where the rates are fewer than the independent velocities, or do not determine them, and in a frame that
/// turns. `rates`: how many there are.
std::optional<LinearizationInRates> in_rates(const Linearization& linearization, std::size_t first, std::size_t rates);
/// Without the outputs after so many.
void keep_first_outputs(Linearization& linearization, std::size_t count);

/// Exact derivatives at the point; std::invalid_argument, which names the list, where one of the point has another
/// length than its comment says (`operating_point` fills all of them). Nothing, and `singular` true, where M and the
/// constraints do not determine the accelerations. Cost O((n + m)³).
struct LinearizationResult {
  Linearization linearization;
  bool singular = false;
  std::size_t singular_coordinate = 0;  // has the largest part in the motion without inertia
};
LinearizationResult linearize(const PointEquations& equations, const OperatingPoint& point);

/// Accelerations, multipliers and inputs at a state: the operating point of a trajectory. Nothing where they are not
/// determined.
std::optional<OperatingPoint> operating_point(const PointEquations& equations, const MotionState& state);

}  // namespace maupertuis

#pragma once
#include <maupertuis/diagnostic.hpp>
#include <maupertuis/locus.hpp>
#include <maupertuis/modes.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/stop_flag.hpp>
#include <maupertuis/tangent.hpp>
#include <maupertuis/trajectory.hpp>

#include <complex>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// Periodic motions, sections through the motion, and how fast neighbours part (docs/theory/orbits.md).
namespace maupertuis {

// ------------------------------------------------------------------------------------------------- periodic motions

struct FloquetOptions {
  std::optional<double> period;  // s: of the motion, or near it; nothing: looked for within the model's run
  const StopFlag* interrupt = nullptr;
  std::optional<MotionState> start = std::nullopt;  // instead of that of the model
};

/// What decides whether neighbours of a periodic motion stay near it.
enum class OrbitalStability {
  Attracting,  // every multiplier but the trivial ones lies inside the unit circle
  Neutral,     // all of them on it, to what rounding lets see: stable to first order
  Unstable,    // one lies outside
  Undecided,  // none lies clearly outside, and what the geometry asks of dΦ_T contradicts that all lie inside or on it
};

/// A motion that repeats: Φ_T(x) = x, angles up to whole turns, quaternions up to their sign: q and −q are one
/// orientation.
struct PeriodicMotion {
  MotionState start;       // on the orbit
  double period = 0;       // s
  std::vector<int> turns;  // [n] by how many turns each coordinate advances; 0 for those that are no angles
  std::vector<std::string> other_sign;  // bodies and frames whose quaternion comes back as −q
  bool driven = false;                  // t stands in the equations: the period is that of the drive, or a multiple
  bool rests = false;                   // an equilibrium of a driven system: it stays where it is at all times
  double moved = 0;                     // how far Newton's method moved the start, relative to the size of the orbit
  double closure = 0;                   // |Φ_T(x) − x| relative to that size
  int iterations = 0;
};

/// The eigenvalues of dΦ_T at a periodic motion, on the directions that the constraints allow.
struct FloquetResult {
  PeriodicMotion motion;
  /// [d] largest first; the trivial ones, exactly 1, last: one along the motion (no drive), a second where the energy
  /// is conserved. The others are those of dΦ_T on the quotient, so that the defective pair at 1 does not spoil them.
  std::vector<std::complex<double>> multipliers;
  std::size_t trivial = 0;
  /// Directions that contacts and friction hold all the time: neighbours there come into the motion within a period,
  /// and have the multiplier 0. 0 where a contact bounces for ever, e = 1.
  std::size_t vanished = 0;
  /// log |μ| of the smallest that is not trivial, where rounding of dΦ_T hides its digits and the determinant, known
  /// from the divergence, tells them; μ itself may lie below the range of numbers and be 0.
  std::optional<double> log_smallest;
  /// Multipliers of which no more is known than that they lie below the rounding of dΦ_T: they stand as 0.
  std::size_t lost = 0;
  double trace = 0;    // of dΦ_T
  double largest = 0;  // |μ| of the largest that is not trivial; 0 if there is none
  OrbitalStability stability = OrbitalStability::Neutral;
  /// Checks. ω(T) against ω(0) on a basis, relative; nothing where the motion is not that of a Lagrangian alone.
  std::optional<double> symplectic_residual;
  /// log |det dΦ_T| and ∫ divergence dt over the period, which must agree (Liouville); nothing for constraints between
  /// velocities.
  std::optional<double> log_determinant, integrated_divergence;
  /// The relative error of dΦ_T that these checks show (of ω against the sizes of the directions); nothing where there
  /// is none of them.
  std::optional<double> error;
};

/// Finds the periodic motion next to the start by Newton's method on Φ_T(x) − x with the derivative of the
/// tangent equations, T free unless the system is driven, and its multipliers. Where periodic motions come in families,
/// the nearest. W1402 where the checks show more than rounding. An equilibrium of a driven system is one, with the
/// period of the drive. Nothing, with a diagnostic: no return is found or Newton's method does not converge (E1401),
/// the motion rests (E1402), an acceleration jumps (E1403), the drive does not repeat with the period, or there is a
/// drive of unknown period (E1404), a run ends early (E1408).
std::optional<FloquetResult> floquet(const Model& model, const EquationsOfMotion& equations,
                                     const FloquetOptions& options, Diagnostics& diagnostics);

/// Equilibria of a driven system. The frequencies of coefficients that are frozen at an instant say nothing of their
/// neighbours: in the place of modes each entry gets its multipliers over the period of the drive, and the verdict that
/// these give. [entries]; nothing where the drive does not repeat; empty where the equations do not depend on the time.
std::vector<std::optional<FloquetResult>> settle_driven(ModalStudy& study, const PointEquations& points,
                                                        const Model& model, const EquationsOfMotion& equations,
                                                        const StopFlag* interrupt);

/// The same for the points of a locus over the values of a parameter (its index): a run over one period of the drive
/// each. Nothing of a point where the drive does not repeat. Throws Interrupted. The model and its equations outlive
/// it.
NeighboursAt driven_neighbours(const Model& model, const EquationsOfMotion& equations, std::size_t parameter,
                               const StopFlag* interrupt);

// --------------------------------------------------------------------------------------------------- Poincaré sections

enum class SectionDirection { Rising, Falling, Both };

struct SectionOptions {
  Expr section;  // of q, q', t; its zeros are the section. Empty: a strobe
  SectionDirection direction = SectionDirection::Both;
  std::optional<double> strobe;  // s: the state after each of these times, for driven systems
  std::size_t crossings = 500;   // of each motion
  std::size_t starts = 1;        // 1: that of the model alone; more: spread over the section at its energy
  std::optional<double> energy;  // J, instead of that of the model's start
  double longest = 0;            // s: no motion is followed for longer; 0: 10⁴ times the model's run, or 10⁶ s
  double tolerance = 0;          // of the steps; 0: rounding level
  const StopFlag* interrupt = nullptr;
  std::function<void(double)> progress;
};

struct Crossing {
  std::size_t orbit = 0;   // index in SectionResult::starts
  std::size_t number = 0;  // 1, 2, … along its motion
  MotionState state;
};

struct SectionOrbit {
  MotionState start;
  double energy = 0;        // J
  double energy_drift = 0;  // largest |h_E − energy| at the crossings, relative to the sizes of the terms of h_E
  std::size_t crossings = 0;
  double reached = 0;  // s
  std::string ended;   // why before all crossings; empty: it did not
};

struct SectionResult {
  std::vector<SectionOrbit> orbits;
  std::vector<Crossing> crossings;  // orbit by orbit
  bool energy_conserved = false;
  double largest_miss = 0;  // the largest |section| at a crossing, relative to the largest between crossings
  std::size_t across = 0;   // the coordinate whose q and q' show the section best
  std::vector<std::pair<double, double>>
      outline;  // several starts: the border of what the energy allows, in q and q' of `across`; closed
};

/// Where motions cross a section, located to rounding by the events of the Taylor steps. Several starts are spread
/// evenly over the part of the section that their common energy allows: two coordinates, no constraints, energy
/// conserved. Nothing, with a diagnostic: never crossed (E1405), no time (E1406), several starts where they cannot be
/// had (E1407), the section is constant (E1409).
std::optional<SectionResult> poincare_section(const Model& model, const EquationsOfMotion& equations,
                                              const SectionOptions& options, Diagnostics& diagnostics);

/// Columns orbit, number, then q and q': a row a crossing, its time that of the crossing.
Trajectory section_rows(const SectionResult& result, const MechanicalSystem& system);

// ------------------------------------------------------------------------------------------------ Lyapunov exponents

struct LyapunovOptions {
  std::size_t exponents = 0;        // how many, the largest first; 0: all
  std::optional<double> duration;   // s; nothing: the model's run
  double interval = 0;              // s between orthogonalizations; 0: chosen
  std::optional<double> transient;  // s of the motion before the average begins; nothing: a tenth of the duration
  const StopFlag* interrupt = nullptr;
  std::function<void(double)> progress;
};

/// What the exponents say of the motion itself.
enum class Chaos {
  Shown,     // neighbours part exponentially for certain, and the motion neither runs away nor lies in a plane
  NotShown,  // the growth is not told from that of regular motion, which is like a power of t
  Excluded,  // the states of the motion fill two dimensions at most, t counted where it stands in the equations
  RunsAway,  // neighbours part no faster than the motion itself grows
};

struct LyapunovResult {
  std::size_t dimension = 0;      // d: directions that the constraints allow
  std::vector<double> exponents;  // [k] 1/s, the largest first
  /// [k] The standard error from the scatter of blocks, the change over the second half of the run, or what powers of t
  /// and a breathing by a factor e leave of an exponent, (1 + log of the growth of t) / duration: the largest of these.
  std::vector<double> errors;
  std::vector<double> times;          // s since the average began
  std::vector<double> running;        // [times × k] the averages so far
  double duration = 0, interval = 0;  // s
  std::size_t blocks = 0;
  Chaos chaos = Chaos::NotShown;
  double sum = 0;  // of the exponents
  // The mean divergence of the flow in (q, q̇), from that in (q, p) and the volumes that the directions at both ends
  // have there; all exponents asked for.
  std::optional<double> expected_sum;
  // |sum − mean divergence|, 1/s: rounding alone. There where expected_sum is.
  std::optional<double> sum_rule_residual;
  /// Dimension of the attractor, where all exponents are there, their sum is negative for certain, and none that it
  /// rests on may be 0 within its error but the one that is 0 along a motion without a drive, and is taken as that.
  std::optional<double> kaplan_yorke;
  std::string ended;  // why before the end; empty: it did not
};

/// Mean growth rates of neighbours by the tangent equations, orthogonalized at intervals (Benettin; Shimada and
/// Nagashima): exact equations, so that no distance has to be chosen. Nothing, with a diagnostic: no time (E1406), an
/// acceleration jumps (E1403), the run ends before anything was measured (E1408).
std::optional<LyapunovResult> lyapunov_exponents(const Model& model, const EquationsOfMotion& equations,
                                                 const LyapunovOptions& options, Diagnostics& diagnostics);

/// The averages so far, a column λ1, λ2, … an exponent.
Trajectory lyapunov_rows(const LyapunovResult& result, const MechanicalSystem& system);

}  // namespace maupertuis

#pragma once
#include <maupertuis/linearization.hpp>

#include <complex>
#include <string>
#include <vector>

/// What the linearized equations say: frequencies, damping, mode shapes, stability. docs/theory/linearization.md.
namespace maupertuis {

/// One mode ξ = Re(shape e^{λ t}): an eigenvalue λ with Im λ ≥ 0, or one or two vanishing ones.
struct Mode {
  enum class Kind { Zero, Oscillation, Decay, Growth } kind = Kind::Oscillation;  // the last two: λ real
  std::complex<double> eigenvalue;  // rad/s; 0 exactly where it vanishes up to rounding
  double error = 0;                 // rounding errors of the eigenvalue, by its condition number; 0 where it is 0 by a
                                    // symmetry, else what a Zero may be instead
  std::size_t zeros = 0;            // Zero: how many eigenvalues it stands for, 1 or 2
  std::size_t multiplicity = 1;     // of the eigenvalue, within rounding
  std::size_t chain = 1;            // eigenvalues with this one shape; above 1: a Jordan chain, t e^{λt} is a motion
  std::vector<std::complex<double>>
      shape;          // [n] all coordinates; unit modal mass shapeᴴ M shape = 1, largest part real and positive
  std::string cause;  // Zero: what it is, "translation along x"; empty where no symmetry explains it

  double frequency() const { return eigenvalue.imag(); }             // rad/s, of the oscillation as it is damped
  double natural_frequency() const { return std::abs(eigenvalue); }  // rad/s
  /// −Re λ/|λ|; 0 for Zero.
  double damping_ratio() const { return std::abs(eigenvalue) > 0 ? -eigenvalue.real() / std::abs(eigenvalue) : 0; }
};

enum class Stability {
  Energetic,   // stable: the energy, or the effective potential, has a strict minimum (Lagrange-Dirichlet, Routh)
  Linear,      // stable: the equations are linear, the eigenvalues on the imaginary axis, without Jordan chains
  Asymptotic,  // asymptotically stable: all eigenvalues have negative real parts, but those of symmetries
  Unstable,    // an eigenvalue has a positive real part
  Undecided,   // the linearization does not decide
};

struct StabilityReport {
  Stability verdict = Stability::Undecided;
  std::string reason;           // half a sentence: "the Hessian of the potential is positive definite"
  double growth_rate = 0;       // 1/s, the largest real part
  std::vector<double> hessian;  // eigenvalues, ascending, of the Hessian of the (effective) potential in coordinates
                                // with unit mass, rad²/s²; empty where there is no potential
  bool effective = false;       // momenta of translations are kept: it is the effective potential
};

struct ModalAnalysis {
  std::vector<Mode> modes;                        // Zero, then by |Im λ|, then by |λ|
  std::vector<std::complex<double>> eigenvalues;  // [f + g] of A, ascending by real, then imaginary part
  bool symmetric = false;  // M ξ̈ + K ξ = 0 with M positive definite: ω² of a symmetric problem
  double residual = 0;     // largest |(λ² M + λ (C + G) + K + N) φ| or |A x − λ x|, relative
  StabilityReport stability;
};

/// Modes of a linearization. Symmetric problems by K φ = ω² M φ (Cholesky of M); gyroscopic, damped and constrained
/// ones by the quadratic problem, brought to first order in coordinates with unit mass and a unit of time of their own.
/// Vanishing eigenvalues are split off by ranks first, so that the defective zeros of free motions do not blur the
/// others. Cost O((f + g)³).
ModalAnalysis modal_analysis(const PointEquations& equations, const Linearization& linearization,
                             const std::vector<Translation>& translations, const Equilibrium* equilibrium = nullptr);

// ---------------------------------------------------------------------------------------------------------- a whole
// study

/// One equilibrium, steady motion or instant with its linearization and modes.
struct ModalEntry {
  Equilibrium equilibrium;
  Linearization linearization;
  ModalAnalysis analysis;
  std::string side;  // "x > 0": the point is on a kink, and these are the equations of that side; empty: none
  std::optional<LinearizationInRates> in_rates{};  // where it was asked for, and is
};

/// An equilibrium on a kink beyond which the forces do not balance: no linearization.
struct Kink {
  Equilibrium equilibrium;
  std::string side;          // where they do not
  bool steep = false;        // they do, but the stiffness grows without bound: |x|^1.5 at 0
  std::size_t switches = 0;  // that meet there, where they are too many for their sides to be looked at
};

struct ModalStudy {
  std::vector<ModalEntry> entries;   // those where the coordinates fail are left out
  std::vector<Equilibrium> failing;  // … and listed here
  std::vector<Kink> kinks;           // sides of points that have no entry
  std::vector<Translation> translations;
  std::size_t starts = 0;   // of the search; 0: a point was given
  std::size_t outside = 0;  // equilibria that were found too far from the start to be meant
};

/// All equilibria and steady motions that the search finds, each linearized. Nothing, and E1301 or E1303, where there
/// are none.
std::optional<ModalStudy> modal_study(const PointEquations& equations, const MotionState& start,
                                      Diagnostics& diagnostics);

/// The one whose coordinates (and rates) are as given; what is not given is solved for, beginning at `start`. A given
/// value may be rounded: the equilibrium within a ten-thousandth of it is meant. Nothing, and E1302 to E1304, where
/// there is none.
std::optional<ModalStudy> modal_study_at(const PointEquations& equations, const MotionState& start,
                                         const std::vector<StartValue>& at, Diagnostics& diagnostics);

/// The equations about one state of a motion. Nothing, and E1304, where M is singular there.
std::optional<ModalStudy> modal_study_of(const PointEquations& equations, const MotionState& state,
                                         Diagnostics& diagnostics);

/// What is measured, as a user wrote it.
struct OutputName {
  std::string text;
  std::optional<Span> span;
};
/// Whether every output has a value and a derivative at every point of the study; else E1306 for each that has not.
/// `outputs` in the order of PointEquations.
bool check_measured(const MechanicalSystem& system, const ModalStudy& study, std::span<const OutputName> outputs,
                    Diagnostics& diagnostics);

/// "θ1 = 0, θ2 = π", "r = 1 m; φ' = 1 rad/s": coordinates along translations are left out; rates are those that go on.
std::string point_text(const MechanicalSystem& system, const Equilibrium& equilibrium,
                       const std::vector<Translation>& translations);
/// "π/2", "0.523 rad", "1.2 m".
std::string value_text(const MechanicalSystem& system, double value, const Dimension& dimension, bool angle = false);
/// "asymptotically stable", "stable", "unstable", "not decided by the linearization".
std::string_view stability_word(Stability verdict);

}  // namespace maupertuis

#pragma once
#include <maupertuis/certificate.hpp>
#include <maupertuis/momentum.hpp>
#include <maupertuis/simulation.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

/// Phase space: momenta, Legendre transform, canonical equations, brackets, Routhian (docs/theory/hamiltonian.md).
/// Everything here is in the symbols of the model as written (EquationsOfMotion::shown); momenta are those of
/// momentum.hpp.
namespace maupertuis {

/// How the velocities of coordinates that M couples follow from their momenta.
enum class LegendreKind {
  Quadratic,  // M does not depend on q̇: q̇ = M⁻¹ (p − b), written out
  Implicit,   // the same, but M⁻¹ is too long to be written out: M q̇ = p − b stands instead
  Root,       // L = c wᵃ + b·q̇ with w quadratic in q̇, as of the relativistic particle: solved for w first
  Singular,   // M has no inverse: not every velocity follows from the momenta, which obey primary constraints
  Unsolved,   // p = ∂L/∂q̇ is not linear in q̇, and has none of the forms above
};

/// One group of coordinates that M couples.
struct LegendreBlock {
  std::vector<std::size_t> coordinates;
  LegendreKind kind = LegendreKind::Quadratic;
  ExprMatrix mass;        // ∂p/∂q̇ of the group
  ExprVector shift;       // b: ∂L/∂q̇ where the group is at rest; readable
  ExprVector velocities;  // q̇(q, p, t); empty handles where they do not follow (Singular) or are not written (Unsolved)
  Expr energy;            // what the group adds to H; on the primary constraints where they exist; empty: Unsolved
  bool energy_is_readable = false;  // `energy` is fit to be printed
  ExprVector primary_constraints;   // φ(q, p, t) = 0, readable; Singular alone
};

/// p = ∂L/∂q̇ solved for the velocities of some coordinates, the others left as they are.
struct LegendreTransform {
  std::vector<LegendreBlock> blocks;
  Expr at_rest;           // −L where the coordinates of the transform are at rest; readable
  Expr value;             // Σ energy + at_rest, a shared DAG; empty handle where a block is Unsolved
  ReadableForm readable;  // the same for a reader; empty handle where a block is Implicit or Unsolved
  bool has(LegendreKind kind) const;
  /// q̇_i(q, p, t); an empty handle where it does not follow or `i` takes no part.
  Expr velocity(std::size_t coordinate) const;
};

/// One canonical equation for a reader.
struct CanonicalEquation {
  Expr left;                    // the symbol q' or p'
  ReadableForm right;           // an empty handle where M q̇ = p − b stands instead
  bool has_velocities = false;  // `right` is written with q', which stand for the right sides of their own equations
};

/// A system in phase space.
struct Hamiltonian {
  std::shared_ptr<const MechanicalSystem> system;  // as written
  ReadingOrder order;
  ExprVector momenta;          // p, symbols [n]
  ExprVector momentum_values;  // ∂L/∂q̇ [n]
  LegendreTransform legendre;
  Expr value;                                 // H(q, p, t): legendre.value
  std::vector<CanonicalEquation> velocities;  // q' = ∂H/∂p [n]; empty where H is
  std::vector<CanonicalEquation> forces;      // p' = −∂H/∂q + Q − ∂D/∂q̇ + Aᵀλ [n]
  std::vector<Intermediate> legend;           // definitions of the model that stand in any of these

  bool regular() const { return value && !legendre.has(LegendreKind::Singular); }
  /// Right sides of the canonical equations as shared DAGs: (q', p') [2n]. Precondition: regular().
  ExprVector flow;
};

/// The Legendre transform of a derived system, and its canonical equations. A group of coordinates whose M⁻¹ would fill
/// more than some lines is Implicit; beyond `largest_eliminated` coordinates in one group its velocities are not formed
/// at all, and H is Unsolved. Cost: that of M, O(n³) nodes for a group, and readable forms.
Hamiltonian hamiltonian(const EquationsOfMotion& equations);
inline constexpr std::size_t largest_eliminated = 16;

/// By zero tests: p(q, q̇(q, p)) = p; H = p·q̇ − L; ∂H/∂q = −∂L/∂q, ∂H/∂t = −∂L/∂t; the canonical equations with
/// p = ∂L/∂q̇ put in are Lagrange's; what is printed is what was derived. Where L is singular, H at p = ∂L/∂q̇ is h_E,
/// and the primary constraints vanish there. Roots of velocities are compared at points, to 60 digits.
Certificate certify(const Hamiltonian& hamiltonian, const EquationsOfMotion& equations);

/// {A, B} = Σ ∂A/∂q ∂B/∂p − ∂A/∂p ∂B/∂q. Velocities in A and B stand for ∂H/∂p.
/// Nothing where a velocity stands in them that does not follow from the momenta.
std::optional<ReadableForm> poisson_bracket(Expr a, Expr b, const Hamiltonian& hamiltonian);
/// e with its velocities replaced by ∂H/∂p; an empty handle where one does not follow.
Expr in_phase_space(Expr e, const Hamiltonian& hamiltonian);
/// Lets of parameters and inputs put in, momenta left: for proofs about what a reader is shown.
std::vector<Expr> with_definitions(const MechanicalSystem& system, std::span<const Expr> expressions);

/// 𝓡(q, q̇, p, t) = L − Σ p q̇ over some coordinates, whose velocities are replaced by their momenta.
struct Routhian {
  std::vector<std::size_t> replaced;          // the coordinates
  bool conserved = false;                     // all of them are cyclic, and no force changes their momenta
  LegendreTransform legendre;                 // of −𝓡
  Expr value;                                 // 𝓡; empty handle where the momenta do not determine the velocities
  ReadableForm readable;                      // empty handle where it would fill more than some lines
  ReadableForm effective_potential;           // −𝓡 with the other velocities at rest
  std::vector<CanonicalEquation> velocities;  // q̇ = −∂𝓡/∂p of the replaced
  std::vector<std::size_t> rest;              // the other coordinates
  std::vector<ReadableForm> equations;  // of the others, d/dt ∂𝓡/∂q̇ − ∂𝓡/∂q − Q + ∂D/∂q̇ = 0 (or Aᵀλ), p constant;
                                        // empty unless conserved, and where a row would fill more than some lines
  ReadingOrder order;
};

/// The Routhian without `coordinates`; without a list, of the cyclic coordinates whose momenta are conserved (nothing
/// where there are none). Precondition: indices are those of system.coordinates, each once.
std::optional<Routhian> routhian(const EquationsOfMotion& equations, const Hamiltonian& hamiltonian,
                                 const std::vector<std::size_t>* coordinates = nullptr);
/// With p = ∂L/∂q̇ put in: 𝓡 = L − Σ p q̇, ∂𝓡/∂q = ∂L/∂q, ∂𝓡/∂q̇ = ∂L/∂q̇, ∂𝓡/∂p = −q̇.
Certificate certify(const Routhian& routhian, const Hamiltonian& hamiltonian, const EquationsOfMotion& equations);

/// What a textbook prints: momenta, primary constraints, H, canonical equations, and the Routhian if there is one.
/// Lines whose left side is "0" are equations `right = 0`; DerivationStep::right may be empty beside a sentence.
std::vector<DerivationStep> phase_space_lines(const Hamiltonian& hamiltonian, const Routhian* routhian,
                                              const EquationsOfMotion& equations);
/// W1101 or W1103 where the velocities do not follow from the momenta, or were not solved for.
void report_legendre(const Hamiltonian& hamiltonian, Diagnostics& diagnostics);

/// The canonical equations integrated: q and p are the unknowns, and nothing of Lagrange's equations takes part.
struct CanonicalMotion {
  Trajectory trajectory;                 // q, p, H
  std::vector<double> final_q, final_p;  // [n]
  double final_time = 0;
  std::size_t steps = 0;
  int order = 0;
  std::string ending;  // one sentence where it ended early; else empty
  /// Against the run of Lagrange's equations at its rows: the largest difference of q, and of p and ∂L/∂q̇ at its q and
  /// q̇, divided by the largest value of the coordinate, or momentum.
  double difference = 0;
  std::string difference_name;  // of what
  double difference_time = 0;   // s
};

/// Integrates from the start of `run` to its end, with rows at its rows, by Taylor's steps. With constraints
/// λ follows from d²φ/dt² = 0 or dψ/dt = 0 in q and p, and dφ/dt = 0, ψ = 0 are kept by projection; constraints that
/// are redundant at the start are left out. Nothing, with E1102, where the Legendre transform is singular or has no
/// closed form.
std::optional<CanonicalMotion> canonical_motion(const Hamiltonian& hamiltonian, const EquationsOfMotion& equations,
                                                const SimulationResult& run, const SimulationOptions& options,
                                                Diagnostics& diagnostics);

}  // namespace maupertuis

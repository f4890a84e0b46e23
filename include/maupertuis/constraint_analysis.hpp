#pragma once
#include <maupertuis/constraint_manifold.hpp>

#include <string>
#include <vector>

/// Counting and classification of constraints (docs/theory/constraints.md).
namespace maupertuis {

enum class ConstraintClass {
  Holonomic,     // φ(q,t) = 0
  Nonholonomic,  // a·q̇ + a₀ = 0, no function of q and t says the same
  Integrable,    // a·q̇ + a₀ = 0, but the motion stays on a surface F(q,t) = const: holonomic in disguise
  Nonlinear,     // ψ(q,q̇,t) = 0, not affine in q̇: Chetaev's rule, not classified
};
/// "holonomic", "nonholonomic", "integrable", "nonlinear": as in models and in JSON.
const char* word(ConstraintClass constraint_class);
/// For a reader: "holonomic", "non-holonomic", "holonomic in disguise", "non-linear in the velocities (Chetaev)".
const char* words(ConstraintClass constraint_class);

/// F(q,t) = const on the motion: F is readable, with no numeric factor; empty where no elementary one was found.
struct FirstIntegral {
  Expr value;
  bool found() const { return static_cast<bool>(value); }
};

struct ConstraintReport {
  ConstraintClass constraint_class = ConstraintClass::Holonomic;
  bool scleronomic = true;              // its one-form dφ or a·dq + a₀ dt has neither t nor dt in it
  FirstIntegral integral;               // of an integrable one
  bool redundant = false;               // its row is a combination of earlier ones on the whole manifold …
  std::vector<std::size_t> depends_on;  // … of these; none: its own row vanishes there
};

/// A combination of velocity constraints that is integrable though not each of them is.
struct IntegrableCombination {
  std::vector<std::size_t> constraints;
  FirstIntegral integral;
};

/// What the constraints of a system leave free. Ranks are the largest found at random consistent points.
struct ConstraintAnalysis {
  std::vector<ConstraintReport> constraints;        // [m]
  std::vector<IntegrableCombination> combinations;  // one for each integrable direction that no single row gives
  std::size_t rank = 0;                             // of all rows of A
  std::size_t holonomic_rank = 0;                   // of the rows ∂φ/∂q
  std::size_t integrable_rank = 0;                  // what the integrable part of the velocity constraints adds
  std::size_t configuration_freedoms = 0, instantaneous_freedoms = 0;
  std::vector<std::size_t> undetermined;  // constraints whose λ the motion does not determine
  std::size_t start_rank = 0;             // of all rows at the start; less than `rank` where that is singular
  bool rank_varies = false;               // other ranks than these were found at points that are not the start
  std::vector<std::size_t> clashing;      // a smallest set that no state satisfies (later than the start); else empty

  bool redundant() const { return !undetermined.empty(); }
  bool singular_start() const { return start_rank < rank; }
};

/// Counts and classifies by the derived flag of the constraint one-forms in the space of (q,t).
///
/// `start`: a consistent state near which the ranks are taken; null: zeros, moved onto the constraints.
/// Cost: some evaluations of A and M; with velocity constraints the brackets of the directions that they leave, and for
/// integrals a search over simple integrating factors. Reference: Bryant et al., Exterior Differential Systems, II.1.
ConstraintAnalysis analyse_constraints(const EquationsOfMotion& equations, const MotionState* start = nullptr);

/// What the analysis has to tell a user: redundant, clashing, disguised and singular ones, each once.
void report_constraints(const ConstraintAnalysis& analysis, const EquationsOfMotion& equations,
                        const MotionState* start, Diagnostics& diagnostics);

}  // namespace maupertuis

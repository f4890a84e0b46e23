#pragma once
#include <maupertuis/simulation.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Two descriptions of one motion: the proof that they agree (docs/theory/two_descriptions.md).
namespace maupertuis {

/// x = f(q, t): the coordinates of a model A by what a model B has. Expressions live in the context of `b`.
struct CoordinateMap {
  std::shared_ptr<const Model> b;
  ExprVector values;                 // [coordinates of A]
  std::vector<std::string> written;  // [coordinates of A] the right sides, as written
  std::vector<Expr> parameters;      // [parameters of A] what stands for them; empty: no counterpart
};

/// Reads `x = l sin θ, y = -l cos θ`. The left sides are coordinates, or parameters, of A; the right sides are formulas
/// of B, whose coordinates, parameters, points and lets may stand in them. What the map leaves out is what has the same
/// name in B. Spans of `diagnostics` are in `map`. Precondition: B's text elaborates without an error.
std::optional<CoordinateMap> read_map(const Model& a, const SourceText& b, const SourceText& map,
                                      Diagnostics& diagnostics);

enum class Sameness {
  Same,  // each motion of one is one of the other
  Part,  // each motion of B is one of A, but not the other way round: fewer freedoms, or states where only one is
         // defined
  Different,
  Undecided,  // never passes
};

/// How h_E of A, mapped, stands to h_E of B.
enum class EnergyRelation { Equal, EqualButConstant, Different, Undecided };

/// A state of B at which the two descriptions disagree.
struct Disagreement {
  MotionState state;           // of B
  std::size_t coordinate = 0;  // of A
  double of_a = 0, of_b = 0;   // its acceleration: by A's equations, and mapped from B's
};

/// Both models run from B's start.
struct CrossCheck {
  bool ran = false;
  std::string reason;          // why not, or why it ended early
  double duration = 0;         // s
  double difference = 0;       // largest, divided by the largest coordinate of the same dimension
  std::size_t coordinate = 0;  // of A, where it is largest
  double time = 0;
};

struct Comparison {
  std::string name_a, name_b;  // of the systems; told apart where they are the same
  Sameness verdict = Sameness::Undecided;
  std::string reason;  // one sentence where it is not Same
  ZeroTest ground;     // what the equations' zero test found
  /// For which values of the parameters: all; those near the model's (a root's sign depends on them); the model's
  /// alone.
  enum class Parameters { Any, NearThese, TheseAlone } parameters = Parameters::Any;
  std::size_t freedoms_a = 0, freedoms_b = 0;  // of the configuration
  std::size_t instantaneous_freedoms_a = 0, instantaneous_freedoms_b = 0;
  std::size_t rank = 0;    // of ∂f/∂q on the velocities that B allows
  std::string degenerate;  // a state where it was seen to be smaller; empty: none seen
  EnergyRelation energies = EnergyRelation::Undecided;
  std::optional<Disagreement> disagreement;
  CrossCheck run;

  /// Same, and not by evidence from points alone.
  bool proved() const { return verdict == Sameness::Same && ground.error_bound < 1e-6; }
};

struct ComparisonOptions {
  SimulationOptions simulation;  // of the cross-check; its duration, else the shorter run of the two
  bool run = true;
};

/// Proves, or refutes, that x = f(q, t) turns each motion of B into one of A, and that this reaches all motions of A.
///
///     φ_A(f, t) = 0,  ψ_A(f, ḟ, t) = 0,  R_A(f, ḟ, f̈, t) ∈ image of A_Aᵀ      along the motions of B
///     rank of ∂f/∂q on ker A_B = freedoms of A = freedoms of B
///
/// Most pairs do the same virtual work identically, (∂f/∂q)ᵀ R_A = R_B for all q, q̇, q̈: that is tried first. Else λ_A
/// is eliminated from the first line by Gaussian elimination in the DAG; q̈_B is put in by B's equations. Where B has
/// constraints the identities are tested on them to 60 digits, which is evidence and no proof: error bound 1.
/// Errors: parameters of one name that differ (E0825). Notes: a parameter without a counterpart (N0826).
Comparison compare(const Model& a, const EquationsOfMotion& a_equations, const CoordinateMap& map,
                   const EquationsOfMotion& b_equations, const ComparisonOptions& options, Diagnostics& diagnostics);

/// A constrained model in independent coordinates.
struct Reduction {
  std::vector<std::string> dependent,
      independent;                  // coordinates: pivots of A at the start in the metric of M, and the rest
  std::vector<std::string> steps;   // a sentence for each constraint that was removed, for each line that was left out
  std::string text;                 // the model; empty where the elimination is not elementary
  std::optional<Comparison> proof;  // that the two are the same motion
};

/// Solves the holonomic constraints and writes the model in what is left: linear ones for a coordinate, spheres and
/// ellipsoids in two or three coordinates by angles. The old coordinates live on as `let` lines, so that the other
/// lines stay as they are. Velocity constraints stay. The text is given back only when it elaborates and `compare`
/// proves it. Errors: no holonomic constraint (E0830), none that is solved in closed form (E0831), a line that cannot
/// be carried over (E0832), a reduction that is not proved (E0833).
Reduction reduce(const Model& model, const EquationsOfMotion& equations, const syntax::SyntaxTree& tree,
                 const SourceText& source, Diagnostics& diagnostics);

}  // namespace maupertuis

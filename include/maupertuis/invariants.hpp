#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/simulation.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

struct InvariantsOptions {
  int velocity_degree = 2;           // of the direct search: polynomials in the velocities up to this degree (1 to 4)
  std::size_t largest_basis = 1400;  // unknowns of one search; its matrix takes 8 bytes an entry: 16 MB
  bool drift = true;                 // run the model's experiment and measure the drift of each integral
  bool relations = true;             // relations, Poisson brackets and the statement on integrability
  bool completeness = true;          // the bound on the number of point symmetries
  std::uint64_t seed = 0x696e76;
};

/// How an integral came about.
enum class IntegralKind {
  Noether,  // linear in p and h_E: from a point symmetry of the action, up to gauge
  Hidden,   // a polynomial in the velocities that no point symmetry gives, found directly
  Direct,   // found directly in a system with forces or velocity constraints, where Noether's theorem does not apply
};

/// A conserved quantity: a function of q, q', t and the parameters.
struct ConservedFunction {
  Expr value;  // in the symbols of the model; dI/dt = 0 along the motion
  ReadableForm readable;
  std::string name;  // "energy", "total momentum along x", "Laplace-Runge-Lenz vector, x"; empty: none known
  IntegralKind kind = IntegralKind::Noether;
  std::string symmetry;  // the transformation it comes from, in words; empty where none is known
  ExprVector characteristic;  // δq_i at fixed t [n], M δq = ∂I/∂q': the symmetry; empty with constraints or where it is
                              // too long
  int velocity_degree = 1;
  bool explicit_time = false;
  bool independent = true;      // of those before it, by the rank of gradients in (q, q')
  ZeroTest certificate;         // of dI/dt
  std::optional<double> drift;  // along the default run: largest change by the largest size √Σ term² of its terms
};

/// Σ coefficient · Π integrals^exponents = 0, between the integrals of one result.
struct IntegralRelation {
  ReadableForm value;  // in the symbols I1, I2, …; = 0
};

/// {I_first, I_second} in terms of the integrals; zero ones are not listed.
struct PoissonBracket {
  std::size_t first = 0, second = 0;
  ReadableForm value;  // in I1, I2, …; an empty handle: a further function
};

/// d(I)/dt = right: what a symmetry of L gives where forces or constraints break it.
struct BalanceLaw {
  std::string name;
  ReadableForm quantity, rate;
};

struct Invariants {
  std::vector<ConservedFunction> integrals;
  /// The first so many are for a reader: independent ones, those with a name, and what their Poisson brackets lead to.
  /// The others are functions of them that no name tells apart.
  std::size_t shown = 0;
  ExprVector symbols;                       // I1, I2, … [integrals]: what relations and brackets are written in
  std::vector<IntegralRelation> relations;  // those between shown ones first
  std::vector<PoissonBracket> brackets;
  std::vector<BalanceLaw> balance_laws;
  std::size_t noether_symmetries = 0;  // linearly independent point symmetries that were found
  std::size_t rank = 0;                // functionally independent integrals at fixed t
  std::size_t autonomous_rank = 0;     // of those without explicit t
  std::size_t freedoms = 0;            // degrees of freedom: coordinates less what the constraints take
  bool completely_integrable = false;
  std::vector<std::string> involution;        // n independent functions in involution, in words of I1, I2, …
  std::optional<std::size_t> symmetry_bound;  // at most so many point symmetries, at a generic point
  std::vector<std::string> basis;             // what was searched, one line a search: "none further in this basis"
  /// Functions that are constant on each side of a switch and jump there: no integrals.
  struct OnOneSide {
    Expr value;
    std::string place;  // "x = 1"
  };
  std::vector<OnOneSide> on_one_side;
  std::size_t too_long =
      0;  // integrals whose coefficients could not be written as fractions of the parameters, or not proved
};

/// Searches conserved quantities of the motion, relative to a finite basis that the result names.
///
/// Each search is linear algebra over a prime field of 61 bits: I = Σ c_k B_k with dI/dt = 0 at random points of (q,
/// q', t), with accelerations (and multipliers) from the equations over the same field; parameters stay symbols. What
/// is found is certified by the zero test of dI/dt on the symbolic accelerations; what does not pass is not shown.
///
/// Degenerate systems: by their determined equations; what depends on free functions of time is left out.
/// With constraints the points lie on the leaves φ(q,t) = const: what is found holds on each of them.
/// Errors: E1001 (the basis asked for is larger than largest_basis; said before anything is computed), E1002 (singular
/// mass matrix), E1003 (constraints that are not linear in the velocities), W1004 (the run for the drift failed). Cost:
/// (size of the basis)³/3 multiplications. Reference: docs/theory/invariants.md.
std::optional<Invariants> find_invariants(const Model& model, const EquationsOfMotion& equations,
                                          const InvariantsOptions& options, Diagnostics& diagnostics);

/// Whether `e` is conserved and a function of the integrals (and of constants of the constraints): de/dt vanishes at
/// random points over a prime field, and its gradient by (q, q') adds nothing to the rank of theirs; t held fixed.
bool is_function_of(Expr e, const Invariants& invariants, const EquationsOfMotion& equations);

/// The degree of `e` as a polynomial in the velocities, or nothing where it is none.
std::optional<int> velocity_degree(Expr e, const MechanicalSystem& system);

}  // namespace maupertuis

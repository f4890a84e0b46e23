#pragma once
#include <maupertuis/evaluate.hpp>
#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/transform.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

/// The constraint algorithm of degenerate systems, in the form that serves Lagrange's side and Hamilton's alike: some
/// equations are linear in unknowns (accelerations; multipliers of primary constraints), and where their rows depend on
/// each other they leave conditions on the states alone, which have to go on holding.
/// Sources: M. J. Gotay, J. M. Nester, Ann. Inst. Henri Poincaré A 30 (1979) 129 and 32 (1980) 1; P. A. M. Dirac,
/// Lectures on Quantum Mechanics (1964).
namespace maupertuis {

/// Σ_j coefficients_j u_j + rest = 0.
struct LinearCondition {
  ExprVector coefficients;  // [unknowns], in states, parameters, t
  Expr rest;
  bool is_derivative = false;  // dφ/dt = 0 of a constraint φ
};

struct ConstraintProblem {
  ExprVector states;                        // z, symbols
  ExprVector relations;                     // in z, t; they hold from the start
  std::vector<LinearCondition> conditions;  // on u, not empty
  /// dφ/dt along the motion, linear in u.
  std::function<LinearCondition(Expr)> derivative;
  ReadingOrder order;
  Bindings center;                // binds all symbols; random points are taken near it
  std::optional<Bindings> start;  // the state of which the branch is taken, where constraints have several
  /// Parameters keep their values; else they vary by a hundredth, and the class is that of the general values.
  bool hold_parameters = true;
};

/// φ(z, t) = 0.
struct FoundConstraint {
  Expr value;            // readable; without factors that do not vanish
  int generation = 1;    // 1: from the conditions themselves; 2: from the derivatives of those; …
  bool follows = false;  // it is the derivative of an earlier one, without any unknown in it
};

/// A product that vanishes where any of its factors does: the chain goes on with one of them.
struct BranchChoice {
  Expr product, kept;
  bool at_start = false;     // the start is on this branch
  bool start_meets = false;  // and on another one
};

struct ConstraintChain {
  enum class Outcome {
    Closed,         // nothing new comes
    Contradiction,  // the last constraint cannot be fulfilled
    Unreached,      // no state was found that fulfils the last constraint together with those before it
    Varies,         // what vanishes near the start does not vanish elsewhere: the class is that of one region
  };
  Outcome outcome = Outcome::Closed;
  Expr varying;  // Varies: the function
  std::vector<FoundConstraint> constraints;
  std::vector<BranchChoice> branches;  // not those on which the conditions have a lower rank: r = 0 of r²(θ' − z) = 0
  std::vector<LinearCondition> conditions;   // those of the problem, then the derivatives of the constraints
  std::vector<LinearCondition> on_manifold;  // the same, with 0 for each coefficient that vanishes there
  std::shared_ptr<const PointsWhere> where;  // points of the final manifold; null where there are none
  std::size_t manifold_dimension = 0;        // states less independent relations and constraints
  std::size_t rank = 0;                      // of the conditions in the unknowns, there
};

/// Cost: for each row that depends on others a linear system of as many expressions as take part; ranks and weak zero
/// tests at three random points to 100 digits.
ConstraintChain constraint_algorithm(const ConstraintProblem& problem);

/// Coefficients that vanish on the manifold, though not as formulas, are 0: in double they are rounding, which no rank
/// can tell from a small number.
std::vector<LinearCondition> with_zeros_of(const PointsWhere& where, std::vector<LinearCondition> conditions);

/// The values of rows × columns at a point, and a set of rows that are independent there, earlier ones first.
std::vector<std::size_t> independent_conditions(const std::vector<LinearCondition>& conditions,
                                                const std::vector<Bindings>& points);
/// The same at one point: the first `fixed` rows in their order, then always the one that adds most.
std::vector<std::size_t> independent_by_size(const std::vector<LinearCondition>& conditions, std::size_t fixed,
                                             const Bindings& point);
/// Unknowns that the rows leave open, as many as `count`, those that they leave most open at a point.
std::vector<std::size_t> most_open_unknowns(const std::vector<LinearCondition>& conditions, std::size_t count,
                                            const Bindings& point);
/// Unknowns that the rows leave open: those without a pivot, later ones first.
std::vector<std::size_t> open_unknowns(const std::vector<LinearCondition>& conditions,
                                       const std::vector<Bindings>& points);

}  // namespace maupertuis

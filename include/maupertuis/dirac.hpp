#pragma once
#include <maupertuis/degenerate.hpp>
#include <maupertuis/hamiltonian.hpp>

#include <optional>
#include <vector>

/// Constraints of phase space (Dirac and Bergmann; docs/theory/degenerate.md). Sources: P. A. M. Dirac, Lectures on
/// Quantum Mechanics (1964), lecture 1 and 2; M. Henneaux, C. Teitelboim, Quantization of Gauge Systems (1992), ch. 1
/// and 3; L. Castellani, Ann. Phys. 143 (1982) 357 (generators).
namespace maupertuis {

struct PhaseConstraint {
  Expr value;          // φ(q, p, t), readable
  int generation = 0;  // 0: primary, 1: secondary, 2: tertiary, …
};

/// G = Σ_k ε^(k) parts_k with an arbitrary function ε(t): δq = {q, G} leaves Lagrange's equations as they are.
struct GaugeGenerator {
  ExprVector parts;                 // [k], from ε on
  std::vector<ExprVector> changes;  // of the coordinates: δq_i = Σ_k ε^(k) changes[i][k]
};

struct DiracAnalysis {
  ConstraintChain::Outcome outcome = ConstraintChain::Outcome::Closed;
  std::vector<PhaseConstraint> constraints;  // primary first; those of the model among the secondary ones
  std::vector<BranchChoice> branches;
  std::size_t first_class = 0, second_class = 0;
  std::size_t primary_first_class = 0;        // the free functions of the total Hamiltonian
  std::size_t physical_dimension = 0;         // of phase space: 2n − 2F − S
  std::vector<std::size_t> second_class_set;  // constraints whose brackets are a regular matrix
  ExprMatrix brackets;                        // of that set, C_ij = {χ_i, χ_j}
  ExprVector first_class_functions;           // combinations of constraints whose brackets with all vanish; readable
  std::vector<GaugeGenerator> generators;     // proved by Noether's identity; empty where none was found
};

/// The algorithm of Dirac and Bergmann for a singular Legendre transform, near `center`, which binds q, parameters and
/// t; momenta are taken near those of its velocities. Of constraints that branch the branch of `start` is taken, a
/// state (q, q̇). Holonomic constraints of the model count as constraints. Nothing where H is not known, where forces,
/// dissipation or velocity constraints act, which have no place in H.
std::optional<DiracAnalysis> dirac_analysis(const Hamiltonian& hamiltonian, const EquationsOfMotion& equations,
                                            const Bindings& center, const Bindings& start);

/// {A, B}_D = {A, B} − {A, χ_i} C⁻¹_ij {χ_j, B} over the second-class set; velocities as in poisson_bracket.
std::optional<ReadableForm> dirac_bracket(Expr a, Expr b, const Hamiltonian& hamiltonian,
                                          const DiracAnalysis& analysis);

/// Whether functions of phase space, generation by generation, have the same zeros as the constraints that were found.
bool same_constraints(const std::vector<std::vector<Expr>>& generations, const DiracAnalysis& analysis,
                      const Hamiltonian& hamiltonian, const Bindings& center);

/// What a textbook prints of it; beside it, the numbers of Lagrange's equations (degenerate.hpp), where given.
std::vector<DerivationStep> dirac_lines(const DiracAnalysis& analysis, const Hamiltonian& hamiltonian,
                                        const DegenerateAnalysis* of_lagrange);

}  // namespace maupertuis

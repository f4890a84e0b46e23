#pragma once
#include "analysis/action/discrete.hpp"

#include <eigen3/Eigen/SparseCore>
#include <vector>

namespace maupertuis::action {

using Sparse = Eigen::SparseMatrix<double>;

/// Which components of the first and the last node are fixed. A closed path has neither.
struct FixedEnds {
  std::vector<bool> from, to;  // [n]
};

/// Whether no end leaves a configuration free: Ostrogradsky's p is none.
bool all_fixed(const Functional& functional, const Trial& trial, const FixedEnds& fixed);

/// The directions in which each node may move: those of free components that keep φ = 0, in units of `scale`.
struct Directions {
  std::vector<Matrix> basis;  // [nodes] n × d
  std::vector<Index> first;   // [nodes + 1] where the unknowns of a node begin
  Vector normal;              // [n nodes] the shortest step that brings φ to zero
  std::vector<Vector> mu;     // [nodes] multipliers of φ that best balance the gradient
  double off = 0;             // the largest φ, as the step that it takes, in units of the scale

  Index size() const { return first.back(); }
  Index nodes() const { return static_cast<Index>(basis.size()); }
  /// Zᵀ of a vector over all nodes, and Z of reduced unknowns.
  Vector reduce(const Vector& full) const;
  Vector expand(const Vector& reduced) const;
};

/// `scale` [n × nodes] > 0. `gradient` [n nodes] of the action, for the multipliers.
Directions directions_of(Functional& functional, const Trial& trial, const FixedEnds& fixed, const Matrix& scale,
                         const Vector& gradient);

/// The gradient with the reactions of φ in it, at the same nodes: g + Aᵀμ.
Vector with_reactions(Functional& functional, const Trial& trial, const Directions& directions, Vector gradient);

/// An orthonormal basis (columns) of what the rows leave free; dependent rows are no obstacle.
Matrix null_basis(const Matrix& rows, Index n);

/// Element matrices with the curvature of φ, on the directions: entry by entry. `with_integrals` adds the rows and
/// columns of the integral constraints at the end.
Sparse reduced_matrix(Functional& functional, const Trial& trial, const Assembly& assembly,
                      const Directions& directions);
/// The blocks of one element [Σ d]²; `hessian` one of Assembly's. Nodes that two elements share are shared by the sum.
Matrix reduced_element(const Trial& trial, const Matrix& hessian, const Directions& directions, Index element);
/// Zᵀ Σ μ ∂²φ Z of a node.
Matrix node_curvature(Functional& functional, const Trial& trial, const Directions& directions, Index node);

}  // namespace maupertuis::action

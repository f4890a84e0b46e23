#pragma once
#include "analysis/linearization/matrices.hpp"

#include <complex>

namespace maupertuis {

using ComplexMatrix = Eigen::MatrixXcd;
using ComplexVector = Eigen::VectorXcd;

/// Eigenvalues and right eigenvectors of a real matrix whose zero eigenvalues were split off by ranks.
struct EigenSystem {
  std::size_t zeros = 0;    // how often 0 is an eigenvalue
  Matrix kernel;            // [n × d] orthonormal: the eigenvectors of 0
  std::size_t chained = 0;  // kernel vectors that begin a Jordan chain: A x = (kernel vector) has a solution
  double zero_error = 0;    // what they may be instead: the root of the rounding of chains
  ComplexVector values;     // [n − zeros] the others
  ComplexMatrix vectors;    // [n × (n − zeros)] unit columns
  Vector errors;            // [n − zeros] n ε ‖A‖ times the condition of the eigenvalue
};

/// A V₂ = 0 for the kernel V₂ of A brings A to [0 X; 0 A₂₂] by an orthogonal change of basis; then the same for A₂₂,
/// until no kernel is left. (The staircase of Kublanovskaya for the eigenvalue 0.)
EigenSystem eigen_system(const Matrix& a);

}  // namespace maupertuis

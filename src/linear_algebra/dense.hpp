#pragma once
// Eigen's dense matrices, whose factorizations are compiled once: here they are only declared, dense.cpp instantiates
// them. What is not in the list works as well and is compiled where it is used. A solve is found in the list when its
// right-hand side is a matrix or a vector, `qr.solve(Vector(-r))`; `qr.solve(-r)` compiles a solve of its own.
#include <eigen3/Eigen/Dense>

#define MAUP_FACTORIZATIONS(EXTERN)                                              \
  EXTERN template class Eigen::PartialPivLU<Eigen::MatrixXd>;                    \
  EXTERN template class Eigen::FullPivLU<Eigen::MatrixXd>;                       \
  EXTERN template class Eigen::HouseholderQR<Eigen::MatrixXd>;                   \
  EXTERN template class Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;             \
  EXTERN template class Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>; \
  EXTERN template class Eigen::LLT<Eigen::MatrixXd>;                             \
  EXTERN template class Eigen::JacobiSVD<Eigen::MatrixXd>;                       \
  EXTERN template class Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;          \
  EXTERN template class Eigen::EigenSolver<Eigen::MatrixXd>;

// What depends on one more type than the class: solves, and the factorization of a matrix that is given later.
#define MAUP_SOLVE(EXTERN, FACTORIZATION, RIGHT) \
  EXTERN template void FACTORIZATION<Eigen::MatrixXd>::_solve_impl<RIGHT, RIGHT>(const RIGHT&, RIGHT&) const;
#define MAUP_SOLVES(EXTERN, FACTORIZATION)           \
  MAUP_SOLVE(EXTERN, FACTORIZATION, Eigen::VectorXd) \
  MAUP_SOLVE(EXTERN, FACTORIZATION, Eigen::MatrixXd)
#define MAUP_COMPUTE(EXTERN, FACTORIZATION, ...)                                           \
  EXTERN template FACTORIZATION<Eigen::MatrixXd>& FACTORIZATION<Eigen::MatrixXd>::compute( \
      const Eigen::EigenBase<Eigen::MatrixXd>& __VA_OPT__(, ) __VA_ARGS__);
#define MAUP_DENSE(EXTERN)                                    \
  MAUP_FACTORIZATIONS(EXTERN)                                 \
  MAUP_SOLVES(EXTERN, Eigen::PartialPivLU)                    \
  MAUP_SOLVES(EXTERN, Eigen::FullPivLU)                       \
  MAUP_SOLVES(EXTERN, Eigen::HouseholderQR)                   \
  MAUP_SOLVES(EXTERN, Eigen::ColPivHouseholderQR)             \
  MAUP_SOLVES(EXTERN, Eigen::CompleteOrthogonalDecomposition) \
  MAUP_COMPUTE(EXTERN, Eigen::ColPivHouseholderQR)            \
  MAUP_COMPUTE(EXTERN, Eigen::LLT)                            \
  MAUP_COMPUTE(EXTERN, Eigen::SelfAdjointEigenSolver, int)    \
  MAUP_COMPUTE(EXTERN, Eigen::EigenSolver, bool)

#ifndef MAUP_DENSE_INSTANCES
MAUP_DENSE(extern)
#endif

namespace maupertuis {

/// The first columns of the orthogonal factor Q.
Eigen::MatrixXd columns_of_q(const Eigen::HouseholderQR<Eigen::MatrixXd>& qr, Eigen::Index columns);
Eigen::MatrixXd columns_of_q(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr, Eigen::Index columns);
Eigen::MatrixXd columns_of_q(const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>& factors,
                             Eigen::Index columns);
/// Orthonormal columns that span the null space, as many as the matrix has columns beyond its rank.
Eigen::MatrixXd null_space(const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>& factors);

}  // namespace maupertuis

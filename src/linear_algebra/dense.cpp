#define MAUP_DENSE_INSTANCES
#include "linear_algebra/dense.hpp"

MAUP_DENSE()

namespace maupertuis {

Eigen::MatrixXd columns_of_q(const Eigen::HouseholderQR<Eigen::MatrixXd>& qr, Eigen::Index columns) {
  return qr.householderQ() * Eigen::MatrixXd::Identity(qr.rows(), columns);
}

Eigen::MatrixXd columns_of_q(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr, Eigen::Index columns) {
  return qr.householderQ() * Eigen::MatrixXd::Identity(qr.rows(), columns);
}

Eigen::MatrixXd columns_of_q(const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>& factors,
                             Eigen::Index columns) {
  return factors.householderQ() * Eigen::MatrixXd::Identity(factors.rows(), columns);
}

Eigen::MatrixXd null_space(const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>& factors) {
  const Eigen::MatrixXd z = factors.matrixZ();
  return factors.colsPermutation() * Eigen::MatrixXd(z.transpose().rightCols(z.cols() - factors.rank()));
}

}  // namespace maupertuis

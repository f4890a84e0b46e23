#pragma once
#include "linear_algebra/dense.hpp"

#include <cmath>

namespace maupertuis {

/// A matrix in units of its own: R A C with diagonal R, C, in which the largest entries of all rows and columns are
/// about 1, so that no pivot is taken for rounding because lengths are counted in m and masses in kg. R, C hold powers
/// of 2: nothing is rounded. C = R of symmetric matrices.
struct Equilibrated {
  Eigen::VectorXd rows, columns;  // R, C
  Eigen::MatrixXd matrix;

  explicit Equilibrated(Eigen::MatrixXd given)
      : rows(Eigen::VectorXd::Ones(given.rows())),
        columns(Eigen::VectorXd::Ones(given.cols())),
        matrix(std::move(given)) {
    constexpr int turns = 10;  // each takes the root of what is left (D. Ruiz, Rutherford Report RAL-TR-2001-034)
    for (int turn = 0; turn < turns; ++turn) {
      const Eigen::VectorXd of_rows = matrix.cwiseAbs().rowwise().maxCoeff().unaryExpr(&root);
      const Eigen::VectorXd of_columns = matrix.cwiseAbs().colwise().maxCoeff().transpose().unaryExpr(&root);
      if (of_rows.isOnes(0) && of_columns.isOnes(0)) break;
      matrix = of_rows.asDiagonal() * matrix * of_columns.asDiagonal();
      rows = rows.cwiseProduct(of_rows), columns = columns.cwiseProduct(of_columns);
    }
  }

 private:
  static double root(double largest) { return largest > 0 ? std::ldexp(1.0, -std::ilogb(largest) / 2) : 1; }
};

}  // namespace maupertuis

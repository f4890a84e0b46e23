#pragma once
// Products of matrices of doubles, compiled once (products.cpp). An expression of Eigen with two or three products is a
// type of its own, for which each source compiles the products anew, half a second each. The same code runs on the same
// numbers as in the expression: a product of three is (a b) c.
#include <eigen3/Eigen/Core>

namespace maupertuis {

using ConstMatrixRef = Eigen::Ref<const Eigen::MatrixXd>;  // a matrix or a block of one, not copied

/// a b.
Eigen::MatrixXd product(const ConstMatrixRef& a, const ConstMatrixRef& b);
/// (−a) b: zeros have the sign that this expression gives them.
Eigen::MatrixXd negated_product(const ConstMatrixRef& a, const ConstMatrixRef& b);
/// aᵀ b.
Eigen::MatrixXd transposed_product(const ConstMatrixRef& a, const ConstMatrixRef& b);
/// a bᵀ.
Eigen::MatrixXd product_transposed(const ConstMatrixRef& a, const ConstMatrixRef& b);
/// (zᵀ m) z.
Eigen::MatrixXd quadratic_form(const ConstMatrixRef& z, const ConstMatrixRef& m);
/// (m + mᵀ) / 2.
Eigen::MatrixXd symmetric_part(const Eigen::MatrixXd& m);

}  // namespace maupertuis

#include "linear_algebra/products.hpp"

namespace maupertuis {

using Matrix = Eigen::MatrixXd;

Matrix product(const ConstMatrixRef& a, const ConstMatrixRef& b) { return a * b; }
Matrix negated_product(const ConstMatrixRef& a, const ConstMatrixRef& b) { return -a * b; }
Matrix transposed_product(const ConstMatrixRef& a, const ConstMatrixRef& b) { return a.transpose() * b; }
Matrix product_transposed(const ConstMatrixRef& a, const ConstMatrixRef& b) { return a * b.transpose(); }
Matrix quadratic_form(const ConstMatrixRef& z, const ConstMatrixRef& m) { return product(transposed_product(z, m), z); }
Matrix symmetric_part(const Matrix& m) { return (m + m.transpose()) / 2; }

}  // namespace maupertuis

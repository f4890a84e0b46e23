#include "analysis/linearization/eigenproblem.hpp"

#include "analysis/linearization/dense.hpp"
#include "linear_algebra/products.hpp"

#include <cmath>
#include <limits>

namespace maupertuis {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// ε n ‖A‖ |w||v|/|wᴴv| with left eigenvectors w, the rows of V⁻¹.
Vector error_bounds(const GeneralEigen& system, double norm) {
  Vector out(system.values.size());
  for (Index i = 0; i < out.size(); ++i) {
    const double condition = system.left.row(i).norm() * system.vectors.col(i).norm();
    const double defective = std::sqrt(epsilon) * norm;  // eigenvectors that coincide: a double root
    out[i] = std::isfinite(condition) ? epsilon * static_cast<double>(out.size()) * norm * condition : defective;
  }
  return out;
}

/// z of (λ − T₁₁) z = T₁₂ y by back substitution in blocks of one: T₁₁ is nilpotent, zero on and below its diagonal.
ComplexVector lift(const Matrix& t, Index zeros, std::complex<double> value, const ComplexVector& y) {
  ComplexVector z(zeros);
  for (Index i = zeros; i-- > 0;) {
    std::complex<double> sum = 0;
    for (Index j = i + 1; j < zeros; ++j) sum += t(i, j) * z[j];
    for (Index j = zeros; j < t.cols(); ++j) sum += t(i, j) * y[j - zeros];
    z[i] = sum / value;
  }
  return z;
}

}  // namespace

EigenSystem eigen_system(const Matrix& a) {
  const Index n = a.rows();
  EigenSystem out;
  out.kernel = Matrix(n, 0);
  if (n == 0) return out;
  const double norm = a.norm(), tolerance = 64 * static_cast<double>(n) * epsilon * norm;
  Matrix t = a, q = Matrix::Identity(n, n);  // t = qᵀ a q, zero below the diagonal in its first columns
  Index zeros = 0;
  for (int stage = 0; zeros < n; ++stage) {
    const KernelFirst split = kernel_first(t.bottomRightCorner(n - zeros, n - zeros), tolerance);
    if (split.kernel == 0) break;
    if (stage == 1) out.chained = static_cast<std::size_t>(split.kernel);
    Matrix change = Matrix::Identity(n, n);
    change.bottomRightCorner(n - zeros, n - zeros) = split.basis;
    t = quadratic_form(change, t);
    q = product(q, change);
    if (stage == 0) out.kernel = q.leftCols(split.kernel);
    t.block(zeros, zeros, n - zeros, split.kernel).setZero();
    zeros += split.kernel;
  }
  out.zeros = static_cast<std::size_t>(zeros);
  out.zero_error = out.chained > 0 ? std::sqrt(tolerance * norm) : tolerance;
  const Index rest = n - zeros;
  if (rest == 0) return out;
  const GeneralEigen system = general_eigen(t.bottomRightCorner(rest, rest));
  out.values = system.values;
  out.errors = error_bounds(system, norm);
  out.vectors = ComplexMatrix(n, rest);
  for (Index i = 0; i < rest; ++i) {
    ComplexVector x(n);
    x.tail(rest) = system.vectors.col(i);
    x.head(zeros) = lift(t, zeros, out.values[i], x.tail(rest));
    out.vectors.col(i) = (q.cast<std::complex<double>>() * x).normalized();
  }
  return out;
}

}  // namespace maupertuis

#include "kernel/dense/linear_solver.hpp"

#include <cmath>
#include <eigen3/Eigen/Cholesky>
#include <eigen3/Eigen/LU>
#include <limits>
#include <vector>

namespace maupertuis::dense {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// The power of two next to 1/√x.
double scale_for(double x) { return x > 0 ? std::ldexp(1.0, -std::ilogb(x) / 2) : 1.0; }

}  // namespace

struct LinearSolver::Impl {
  Impl(std::size_t n, bool symmetric) : size(n), may_be_symmetric(symmetric), m(n * n), scale(n) {}

  double& at(std::size_t i, std::size_t j) { return m[i * size + j]; }
  double at(std::size_t i, std::size_t j) const { return m[i * size + j]; }
  Eigen::Map<Matrix> view() { return {m.data(), static_cast<Index>(size), static_cast<Index>(size)}; }

  void scale_to_unit_diagonal();
  bool is_symmetric() const;
  bool is_positive_definite();
  std::optional<std::size_t> full_lu();

  std::size_t size;
  bool may_be_symmetric;
  std::vector<double> m;      // [n × n]
  std::vector<double> scale;  // [n]
  bool has_cholesky = false;  // else LU
  Eigen::LLT<Matrix> cholesky;
  Eigen::FullPivLU<Matrix> lu;
  mutable Vector scratch;
};

void LinearSolver::Impl::scale_to_unit_diagonal() {
  for (std::size_t i = 0; i < size; ++i) {
    double largest = std::abs(at(i, i));
    if (largest == 0)
      for (std::size_t j = 0; j < size; ++j) largest = std::max(largest, std::abs(at(i, j)));
    scale[i] = scale_for(largest);
  }
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < size; ++j) at(i, j) *= scale[i] * scale[j];
}

bool LinearSolver::Impl::is_symmetric() const {
  const double tolerance = 64 * epsilon;
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (std::abs(at(i, j) - at(j, i)) > tolerance * (1 + std::abs(at(i, j)))) return false;
  return true;
}

/// No pivot vanishes to rounding.
bool LinearSolver::Impl::is_positive_definite() {
  cholesky.compute(view());
  const auto roots = cholesky.matrixLLT().diagonal();
  const double least = roots.minCoeff();
  return cholesky.info() == Eigen::Success && least * least > 4 * epsilon * static_cast<double>(size);
}

std::optional<std::size_t> LinearSolver::Impl::full_lu() {
  lu.setThreshold(8 * epsilon * static_cast<double>(size));
  lu.compute(view());
  if (lu.isInvertible()) return std::nullopt;
  // The largest component of a null vector, in the user's own units of q̈.
  const Vector null = lu.kernel().col(0);
  std::size_t worst = 0;
  for (std::size_t i = 1; i < size; ++i)
    if (std::abs(null[static_cast<Index>(i)]) > std::abs(null[static_cast<Index>(worst)])) worst = i;
  return worst;
}

LinearSolver::LinearSolver(std::size_t size, bool may_be_symmetric)
    : impl_(std::make_unique<Impl>(size, may_be_symmetric)) {}
LinearSolver::~LinearSolver() = default;
LinearSolver::LinearSolver(LinearSolver&&) noexcept = default;
std::span<double> LinearSolver::matrix() { return impl_->m; }

std::optional<std::size_t> LinearSolver::factor() {
  Impl& s = *impl_;
  if (s.size == 0) return std::nullopt;
  s.scale_to_unit_diagonal();
  s.has_cholesky = s.may_be_symmetric && s.is_symmetric() && s.is_positive_definite();
  return s.has_cholesky ? std::nullopt : s.full_lu();
}

void LinearSolver::solve(std::span<double> b) const {
  const Impl& s = *impl_;
  for (std::size_t i = 0; i < s.size; ++i) b[i] *= s.scale[i];
  Eigen::Map<Vector> x(b.data(), static_cast<Index>(s.size));
  if (s.has_cholesky) {
    s.cholesky.solveInPlace(x);
  } else {
    s.scratch = s.lu.solve(x);
    x = s.scratch;
  }
  for (std::size_t i = 0; i < s.size; ++i) b[i] *= s.scale[i];
}

}  // namespace maupertuis::dense

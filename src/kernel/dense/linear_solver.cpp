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
/// Below this a plain loop beats a library call.
constexpr std::size_t small = 8;

/// The power of two next to 1/√x.
double scale_for(double x) { return x > 0 ? std::ldexp(1.0, -std::ilogb(x) / 2) : 1.0; }

}  // namespace

struct LinearSolver::Impl {
  Impl(std::size_t n, bool symmetric) : size(n), may_be_symmetric(symmetric), m(n * n), scale(n), inverse_pivot(n) {}

  double& at(std::size_t i, std::size_t j) { return m[i * size + j]; }
  double at(std::size_t i, std::size_t j) const { return m[i * size + j]; }
  Eigen::Map<Matrix> view() { return {m.data(), static_cast<Index>(size), static_cast<Index>(size)}; }

  void scale_to_unit_diagonal();
  bool is_symmetric() const;
  bool plain_cholesky();
  std::optional<std::size_t> full_lu();
  void plain_solve(std::span<double> b) const;

  std::size_t size;
  bool may_be_symmetric;
  std::vector<double> m;              // [n × n]; after plain_cholesky its lower triangle is L
  std::vector<double> scale;          // [n]
  std::vector<double> inverse_pivot;  // [n]
  enum class Method { Plain, Cholesky, Lu } method = Method::Plain;
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

/// False where a pivot vanishes to rounding: not positive definite. Leaves the upper triangle as it was.
bool LinearSolver::Impl::plain_cholesky() {
  const double least = 4 * epsilon * static_cast<double>(size);
  for (std::size_t j = 0; j < size; ++j) {
    double pivot = at(j, j);
    const double diagonal = pivot;
    for (std::size_t k = 0; k < j; ++k) pivot -= at(j, k) * at(j, k);
    if (!(pivot > least * diagonal)) return false;
    const double root = std::sqrt(pivot);
    inverse_pivot[j] = 1 / root;
    for (std::size_t i = j + 1; i < size; ++i) {
      double sum = at(i, j);
      for (std::size_t k = 0; k < j; ++k) sum -= at(i, k) * at(j, k);
      at(i, j) = sum * inverse_pivot[j];
    }
  }
  return true;
}

std::optional<std::size_t> LinearSolver::Impl::full_lu() {
  lu.setThreshold(8 * epsilon * static_cast<double>(size));
  lu.compute(view());
  method = Method::Lu;
  if (lu.isInvertible()) return std::nullopt;
  // The largest component of a null vector, in the user's own units of q̈.
  const Vector null = lu.kernel().col(0);
  std::size_t worst = 0;
  for (std::size_t i = 1; i < size; ++i)
    if (std::abs(null[static_cast<Index>(i)]) > std::abs(null[static_cast<Index>(worst)])) worst = i;
  return worst;
}

void LinearSolver::Impl::plain_solve(std::span<double> b) const {
  for (std::size_t i = 0; i < size; ++i) {
    double sum = b[i];
    for (std::size_t k = 0; k < i; ++k) sum -= at(i, k) * b[k];
    b[i] = sum * inverse_pivot[i];
  }
  for (std::size_t i = size; i-- > 0;) {
    double sum = b[i];
    for (std::size_t k = i + 1; k < size; ++k) sum -= at(k, i) * b[k];
    b[i] = sum * inverse_pivot[i];
  }
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
  if (!s.may_be_symmetric || !s.is_symmetric()) return s.full_lu();
  if (s.size > small) {
    s.cholesky.compute(s.view());
    s.method = Impl::Method::Cholesky;
    const auto pivots = s.cholesky.matrixLLT().diagonal();
    const bool definite = s.cholesky.info() == Eigen::Success &&
                          pivots.minCoeff() * pivots.minCoeff() > 4 * epsilon * static_cast<double>(s.size);
    return definite ? std::nullopt : s.full_lu();
  }
  s.method = Impl::Method::Plain;
  if (s.plain_cholesky()) return std::nullopt;
  // What the attempt overwrote is still in the other triangle; the diagonal was left alone.
  for (std::size_t i = 0; i < s.size; ++i)
    for (std::size_t j = 0; j < i; ++j) s.at(i, j) = s.at(j, i);
  return s.full_lu();
}

void LinearSolver::solve(std::span<double> b) const {
  const Impl& s = *impl_;
  for (std::size_t i = 0; i < s.size; ++i) b[i] *= s.scale[i];
  if (s.method == Impl::Method::Plain) {
    s.plain_solve(b);
  } else {
    Eigen::Map<Vector> x(b.data(), static_cast<Index>(s.size));
    if (s.method == Impl::Method::Cholesky) {
      s.cholesky.solveInPlace(x);
    } else {
      s.scratch = s.lu.solve(x);
      x = s.scratch;
    }
  }
  for (std::size_t i = 0; i < s.size; ++i) b[i] *= s.scale[i];
}

}  // namespace maupertuis::dense

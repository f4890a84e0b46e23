#include "analysis/tangent/point_functions.hpp"
#include "linear_algebra/dense.hpp"
#include "linear_algebra/products.hpp"

#include <maupertuis/expression_lock.hpp>
#include <maupertuis/tangent.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

using tangent::PointFunctions;
using Matrix = Eigen::MatrixXd;
using Index = Eigen::Index;

/// Of the largest row of A, each row at unit length: what is below is a row that depends on others.
constexpr double least_rank_pivot = 1e-10;

/// An orthonormal basis of the null space of C, a row each.
Matrix null_space(Matrix c) {
  const Index n = c.cols();
  for (Index i = 0; i < c.rows(); ++i)
    if (const double size = c.row(i).norm(); size > 0) c.row(i) /= size;
  Eigen::ColPivHouseholderQR<Matrix> qr(c.transpose());
  qr.setThreshold(least_rank_pivot);
  const Matrix q = columns_of_q(qr, n);
  return q.rightCols(n - qr.rank()).transpose();
}

bool holds_multipliers(std::span<const Expr> expressions) {
  const auto symbols = symbols_of(expressions);
  return std::any_of(symbols.begin(), symbols.end(), [](const Expr& e) { return e.role() == Role::Multiplier; });
}

bool all_zero(std::span<const Expr> expressions) {
  return std::all_of(expressions.begin(), expressions.end(), [](const Expr& e) { return e.is_zero(); });
}

}  // namespace

struct TangentGeometry::Impl {
  explicit Impl(const EquationsOfMotion& equations) : n(static_cast<Index>(equations.system->coordinates.size())) {
    const MechanicalSystem& system = *equations.system;
    ExprVector forces;
    for (std::size_t i = 0; i < system.coordinates.size(); ++i)
      forces.push_back(equations.generalized_forces[i] - equations.dissipative_terms[i]);
    for (std::size_t i = 0; i < system.constraints.size(); ++i) {
      const bool position = system.constraints[i].level == Constraint::Level::Position;
      holonomic &= position;
      if (position) positions.push_back(system.constraints[i].value);
    }
    lagrangian_alone = holonomic && all_zero(forces);
    momenta.emplace(system, equations.momenta);
    if (!holds_multipliers(forces)) force_slopes.emplace(system, forces);
    if (!positions.empty()) position_rows.emplace(system, positions);
    if (system.constrained()) rate_rows.emplace(system, equations.constraint_rates);
  }

  /// Directions of q alone that the constraints allow, a row each.
  Matrix configuration_directions(const MotionState& state) const {
    if (!position_rows) return Matrix::Identity(n, n);
    return null_space(position_rows->slopes(state).leftCols(n));
  }

  Index n;
  bool holonomic = true, lagrangian_alone = false;
  ExprVector positions;
  std::optional<PointFunctions> momenta, force_slopes, position_rows, rate_rows;
};

TangentGeometry::TangentGeometry(const EquationsOfMotion& equations) {
  const ExpressionLock lock(*equations.system->context);
  impl_ = std::make_unique<Impl>(equations);
}
TangentGeometry::~TangentGeometry() = default;
TangentGeometry::TangentGeometry(TangentGeometry&&) noexcept = default;

bool TangentGeometry::symplectic() const { return impl_->lagrangian_alone; }

std::vector<double> TangentGeometry::basis(const MotionState& state) const {
  const Impl& s = *impl_;
  Matrix rows = Matrix::Identity(2 * s.n, 2 * s.n);
  if (s.rate_rows) {
    const Matrix rates = s.rate_rows->slopes(state);
    const Matrix positions = s.position_rows ? s.position_rows->slopes(state) : Matrix(0, 2 * s.n);
    Matrix all(positions.rows() + rates.rows(), 2 * s.n);
    all << positions, rates;
    rows = null_space(all);
  }
  std::vector<double> out;
  for (Index i = 0; i < rows.rows(); ++i)
    for (Index j = 0; j < rows.cols(); ++j) out.push_back(rows(i, j));
  return out;
}

std::vector<double> TangentGeometry::symplectic_products(const TangentPoint& point) const {
  const Impl& s = *impl_;
  const Matrix slopes = s.momenta->slopes(point.state);
  const auto columns = static_cast<Index>(point.columns());
  // Of directions that have grown, products are large and nearly cancel: their own rounding must not hide what is left.
  using Wide = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const Wide y = Eigen::Map<const Matrix>(point.directions.data(), 2 * s.n, columns).cast<long double>();
  const Wide q = y.topRows(s.n), p = slopes.cast<long double>() * y;
  const Wide products = q.transpose() * p - p.transpose() * q;
  std::vector<double> out;
  for (Index i = 0; i < columns; ++i)
    for (Index j = 0; j < columns; ++j) out.push_back(static_cast<double>(products(i, j)));
  return out;
}

std::vector<double> TangentGeometry::symplectic_sizes(const TangentPoint& point, std::span<const double> sizes) const {
  const Impl& s = *impl_;
  const Matrix slopes = s.momenta->slopes(point.state);
  const auto columns = static_cast<Index>(point.columns());
  const Matrix y = Eigen::Map<const Matrix>(point.directions.data(), 2 * s.n, columns);
  Matrix q = y.topRows(s.n), p = product(slopes, y);
  const Eigen::VectorXd size = Eigen::Map<const Eigen::VectorXd>(sizes.data(), 2 * s.n),
                        momentum = slopes.cwiseAbs() * size;
  for (Index k = 0; k < s.n; ++k) {
    const double w = momentum[k] > 0 ? std::sqrt(momentum[k] / size[k]) : 1.0;
    q.row(k) *= w;
    p.row(k) /= w;
  }
  const Eigen::VectorXd norms = (q.colwise().squaredNorm() + p.colwise().squaredNorm()).cwiseSqrt().transpose();
  const Matrix out = norms * norms.transpose();
  return {out.data(), out.data() + out.size()};
}

std::optional<double> TangentGeometry::divergence(const MotionState& state) const {
  const Impl& s = *impl_;
  if (!s.holonomic || !s.force_slopes) return std::nullopt;
  const Matrix z = s.configuration_directions(state);
  const Matrix mass = product_transposed(product(z, s.momenta->slopes(state).rightCols(s.n)), z);
  const Matrix slopes = product_transposed(product(z, s.force_slopes->slopes(state).rightCols(s.n)), z);
  return mass.partialPivLu().solve(slopes).trace();
}

}  // namespace maupertuis

#include "analysis/linearization/dense.hpp"
#include "analysis/linearization/point_equations.hpp"

#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

/// Translations that are symmetries: the null space of ∂(R, φ, ψ)/∂q, common to random points.
namespace maupertuis {
namespace {

constexpr int points_sampled = 3, points_tried = 40;
constexpr double no_change = 1e-9;
constexpr int most_parts = 12;                   // of a fraction that an entry may be
constexpr double rounding_of_stiffness = 1e-12;  // of the largest at a point

/// Rows at one random point, each divided by its length, columns by typical sizes; no rows where one has no value
/// there.
Matrix sampled_rows(PointEquations::Impl& e, const Vector& sizes, std::uint64_t seed) {
  const OperatingPoint point = random_point(e, seed);
  std::vector<Vector> rows;
  for (auto* family : {&e.balance, &e.positions, &e.velocities}) {
    const RowsAtPoint at = e.at(*family, point);
    for (Index i = 0; i < at.by_q.rows(); ++i) {
      const Vector by_q = at.by_q.row(i).transpose().cwiseProduct(sizes);
      const double length = by_q.norm() + at.by_v.row(i).norm() + at.by_a.row(i).norm();
      if (!std::isfinite(length)) return Matrix(0, sizes.size());
      if (length > 0) rows.push_back(by_q / length);
    }
  }
  Matrix out(static_cast<Index>(rows.size()), sizes.size());
  for (std::size_t i = 0; i < rows.size(); ++i) out.row(static_cast<Index>(i)) = rows[i].transpose();
  return out;
}

/// Stiffnesses ∂R/∂q at a random point at rest, without forces of constraint: beside inertias, in SI, those of a motion
/// that takes days would pass for none. Each row has length 1, but for those that are rounding of others.
Matrix sampled_stiffness(PointEquations::Impl& e, const Vector& sizes, std::uint64_t seed) {
  OperatingPoint point = random_point(e, seed);
  for (auto* part : {&point.v, &point.a, &point.multipliers}) std::fill(part->begin(), part->end(), 0);
  const Matrix works = sizes.asDiagonal() * e.at(e.balance, point).by_q * sizes.asDiagonal();
  Matrix out(works.rows(), sizes.size());
  if (!works.allFinite()) return Matrix(0, sizes.size());
  const double largest = works.size() == 0 ? 0 : works.cwiseAbs().maxCoeff();
  Index rows = 0;
  for (Index i = 0; i < works.rows(); ++i) {
    const double length = works.row(i).stableNorm();
    if (length > rounding_of_stiffness * largest) out.row(rows++) = works.row(i) / length;
  }
  return out.topRows(rows);
}

/// Of the rows at some points where all have values; nothing is claimed where there are no such points.
Matrix common_null_space(PointEquations::Impl& e, const Vector& sizes) {
  const Index n = sizes.size();
  Matrix all(0, n);
  int good = 0;
  for (int attempt = 0; attempt < points_tried && good < points_sampled; ++attempt) {
    const std::uint64_t seed = 271 + static_cast<std::uint64_t>(attempt);
    const Matrix more = sampled_rows(e, sizes, seed);
    if (more.rows() == 0) continue;
    ++good;
    const Matrix stiffness = sampled_stiffness(e, sizes, seed);
    Matrix both(all.rows() + more.rows() + stiffness.rows(), n);
    both.topRows(all.rows()) = all;
    both.middleRows(all.rows(), more.rows()) = more;
    both.bottomRows(stiffness.rows()) = stiffness;
    // The triangular factor has the same null space.
    all = both.rows() <= n ? both : triangular_factor(both);
  }
  if (good < points_sampled) return Matrix(n, 0);
  const KernelFirst split = kernel_first(all, no_change);
  return split.basis.leftCols(split.kernel);
}

/// The basis in reduced echelon form by rows of coordinates: column k is 1 at its pivot, 0 at the others. Pivots are
/// the largest entries among preferred coordinates, then among all.
std::vector<std::size_t> reduce_to_pivots(Matrix& basis, const std::vector<bool>& preferred) {
  std::vector<std::size_t> pivots;
  for (Index k = 0; k < basis.cols(); ++k) {
    Index row = -1, column = k;
    for (const bool only_preferred : {true, false}) {
      double best = 1e-6;
      for (Index i = 0; i < basis.rows(); ++i) {
        if (only_preferred && (preferred.empty() || !preferred[static_cast<std::size_t>(i)])) continue;
        if (std::find(pivots.begin(), pivots.end(), static_cast<std::size_t>(i)) != pivots.end()) continue;
        for (Index j = k; j < basis.cols(); ++j)
          if (std::abs(basis(i, j)) > best * (1 + 1e-9)) best = std::abs(basis(i, j)), row = i, column = j;
      }
      if (row >= 0) break;
    }
    basis.col(k).swap(basis.col(column));
    basis.col(k) /= basis(row, k);
    for (Index j = 0; j < basis.cols(); ++j)
      if (j != k) basis.col(j) -= basis(row, j) * basis.col(k);
    pivots.push_back(static_cast<std::size_t>(row));
  }
  return pivots;
}

/// Small whole numbers and their quotients, where an entry is one up to rounding.
void clean(Matrix& basis) {
  for (Index i = 0; i < basis.size(); ++i) {
    double& x = basis.data()[i];
    for (int q = 1; q <= most_parts; ++q)
      if (std::abs(x * q - std::round(x * q)) < 1e-9) {
        x = std::round(x * q) / q;
        break;
      }
  }
}

/// Whether the derivative of all rows along a direction of small fractions is 0, exactly: beside a stiffness that is
/// 1e14 times larger another one is rounding. Other directions (a radius of 0.3 in them) are known by their numbers
/// alone.
bool keeps_rows(const PointEquations::Impl& e, const Vector& direction) {
  Context& context = *e.system->context;
  ExprVector ways, along;
  std::vector<Expr> weights;
  for (Index i = 0; i < direction.size(); ++i) {
    if (direction[i] == 0) continue;
    int q = 1;
    while (q <= most_parts && direction[i] * q != std::round(direction[i] * q)) ++q;
    if (q > most_parts) return true;
    ways.push_back(e.system->coordinates[static_cast<std::size_t>(i)].q);
    weights.push_back(context.number(Rational(static_cast<std::int64_t>(direction[i] * q), q)));
  }
  for (const ExprVector* rows : {&e.balance_rows, &e.kept_rows})
    for (const Expr& row : *rows) {
      const std::vector<Expr> slopes = gradient(row, ways);
      Expr sum = context.number(0);
      for (std::size_t k = 0; k < slopes.size(); ++k) sum = sum + weights[k] * slopes[k];
      if (!sum.is_zero()) along.push_back(sum);
    }
  return along.empty() || zero_test(substitute(along, exact_parameters(e))).verdict != Verdict::Nonzero;
}

/// d·R vanishes in every uniform motion along the translations: no force acts along d. What constraints of velocities
/// do there counts as a force, and so does an input that changes with time. `held`: [k] the values of those that do
/// not. Points at which something has no value say nothing, as r < 0 under a root.
bool is_conserved(PointEquations::Impl& e, const Vector& direction, const std::vector<std::optional<double>>& held) {
  int good = 0;
  for (int attempt = 0; attempt < points_tried && good < points_sampled; ++attempt) {
    OperatingPoint point = random_point(e, 577 + static_cast<std::uint64_t>(attempt));
    std::fill(point.a.begin(), point.a.end(), 0);
    for (std::size_t i = 0; i < held.size(); ++i) point.inputs[i] = held[i].value_or(point.inputs[i]);
    const Vector r = e.value(e.balance, point);
    const Matrix by_q = e.at(e.momenta, point).by_q;
    const Vector v = to_eigen(point.v), p = by_q * v;  // d/dt p at a = 0, without explicit time
    const double rate = direction.dot(r - p);
    const Vector terms = by_q.cwiseAbs() * v.cwiseAbs();  // which may cancel
    const double size = direction.cwiseAbs().dot(r.cwiseAbs() + terms);
    if (!std::isfinite(rate)) continue;
    if (std::abs(rate) > no_change * size) return false;
    ++good;
  }
  return good == points_sampled;
}

/// [k] the values of the inputs that are constant.
std::vector<std::optional<double>> constant_inputs(const PointEquations& equations) {
  const MechanicalSystem& system = equations.system();
  const std::vector<double> values = equations.inputs_at(0);
  std::vector<std::optional<double>> out(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    if (differentiate(system.inputs[i].formula, system.context->time()).is_zero()) out[i] = values[i];
  return out;
}

}  // namespace

std::vector<Translation> PointEquations::translations(const std::vector<bool>& preferred) const {
  const Vector sizes = to_eigen(typical_sizes(system(), {}));
  Matrix basis = common_null_space(*impl_, sizes);
  basis = sizes.asDiagonal() * basis;
  const std::vector<std::size_t> pivots = reduce_to_pivots(basis, preferred);
  clean(basis);
  const std::vector<std::optional<double>> held = constant_inputs(*this);
  std::vector<Translation> out;
  for (Index k = 0; k < basis.cols(); ++k) {
    const Vector d = basis.col(k);
    if (!keeps_rows(*impl_, d)) continue;
    out.push_back({to_list(d), pivots[static_cast<std::size_t>(k)], is_conserved(*impl_, d, held)});
  }
  std::sort(out.begin(), out.end(), [](const Translation& x, const Translation& y) { return x.pivot < y.pivot; });
  return out;
}

}  // namespace maupertuis

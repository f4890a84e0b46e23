#include "kernel/dense/bordered_solver.hpp"

#include "kernel/dense/linear_solver.hpp"

#include <algorithm>
#include <cmath>
#include <eigen3/Eigen/LU>
#include <eigen3/Eigen/QR>
#include <vector>

namespace maupertuis::dense {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

/// Of the equilibrated matrix: what lies below is taken to be rounding.
constexpr double least_pivot = 1e-13;
constexpr double least_rank_pivot = 1e-10;
constexpr double least_share = 1e-8;

}  // namespace

struct BorderedSolver::Impl {
  Impl(std::size_t freedoms, std::size_t constraints, bool may_be_symmetric)
      : n(freedoms),
        m(constraints),
        size(n + m),
        plain(m == 0 ? n : 0, may_be_symmetric),
        entries(m == 0 ? 0 : size * size),
        scale(size, 1.0),
        kept(m, true),
        determined(m, true) {}

  Eigen::Map<Matrix> view() { return {entries.data(), static_cast<Index>(size), static_cast<Index>(size)}; }

  void scale_by_mass();
  void equilibrate();
  bool factor_whole();
  void choose_rows();
  void find_dependences(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr);
  bool factor_independent();
  std::size_t undetermined_coordinate();

  std::size_t n, m, size;
  LinearSolver plain;                  // without constraints
  std::vector<double> entries;         // [size × size], equilibrated by factor()
  std::vector<double> as_given;        // [size × size]
  std::vector<double> scale;           // [size]
  std::vector<bool> kept, determined;  // [m]
  std::vector<Index> rows;             // of the factored system, when rows were dropped
  bool whole = true;
  Eigen::PartialPivLU<Matrix> lu;
  mutable Vector scratch;
  mutable Matrix inverse;
};

/// A second way, where the masses are small against A: coordinates by their inertia, constraints by their rows in that
/// measure, coordinates without inertia by their columns: so that neither the units nor the size of the masses against
/// that of A decide what counts as singular.
void BorderedSolver::Impl::scale_by_mass() {
  const auto scale_for = [](double size) {
    return size > 0 && std::isfinite(size) ? std::ldexp(1.0, -std::ilogb(size)) : 1.0;
  };
  const auto row = [&](std::size_t k, std::size_t i) { return std::abs(entries[(n + k) * size + i]); };
  for (std::size_t i = 0; i < n; ++i) {
    const double mass = std::abs(entries[i * size + i]);
    scale[i] = mass > 0 ? std::ldexp(1.0, -std::ilogb(mass) / 2) : 0.0;
  }
  for (std::size_t k = 0; k < m; ++k) {
    double largest = 0, any = 0;
    for (std::size_t i = 0; i < n; ++i)
      largest = std::max(largest, row(k, i) * scale[i]), any = std::max(any, row(k, i));
    scale[n + k] = scale_for(largest > 0 ? largest : any);
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (scale[i] > 0) continue;
    double largest = 0;
    for (std::size_t k = 0; k < m; ++k) largest = std::max(largest, row(k, i) * scale[n + k]);
    scale[i] = scale_for(largest);
  }
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < size; ++j) entries[i * size + j] *= scale[i] * scale[j];
}

/// Ruiz, A scaling algorithm to equilibrate both rows and columns norms in matrices (2001), symmetric.
void BorderedSolver::Impl::equilibrate() {
  std::vector<double> step(size);
  for (int sweep = 0; sweep < 3; ++sweep) {
    std::fill(step.begin(), step.end(), 0.0);  // first the largest entry of row and column
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t j = 0; j < size; ++j) {
        const double entry = std::abs(entries[i * size + j]);
        step[i] = std::max(step[i], entry);
        step[j] = std::max(step[j], entry);
      }
    bool done = true;
    for (double& s : step) {
      s = s > 0 ? std::ldexp(1.0, -std::ilogb(s) / 2) : 1.0;
      done &= s == 1.0;
    }
    if (done) return;
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t j = 0; j < size; ++j) entries[i * size + j] *= step[i] * step[j];
    for (std::size_t i = 0; i < size; ++i) scale[i] *= step[i];
  }
}

namespace {

double ratio_of_pivots(const Eigen::PartialPivLU<Matrix>& lu) {
  const auto pivots = lu.matrixLU().diagonal().cwiseAbs();
  return pivots.minCoeff() / pivots.maxCoeff();
}

bool has_good_pivots(const Eigen::PartialPivLU<Matrix>& lu) { return ratio_of_pivots(lu) > least_pivot; }

}  // namespace

bool BorderedSolver::Impl::factor_whole() {
  lu.compute(view());
  whole = true;
  std::fill(kept.begin(), kept.end(), true);
  std::fill(determined.begin(), determined.end(), true);
  return has_good_pivots(lu);
}

/// The rows of A that QR with pivoting takes first are independent; the others depend on them.
void BorderedSolver::Impl::choose_rows() {
  const Eigen::MatrixXd transposed = view().bottomLeftCorner(static_cast<Index>(m), static_cast<Index>(n)).transpose();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(transposed);
  qr.setThreshold(least_rank_pivot);
  std::fill(kept.begin(), kept.end(), false);
  for (Index i = 0; i < qr.rank(); ++i) kept[static_cast<std::size_t>(qr.colsPermutation().indices()[i])] = true;
  find_dependences(qr);
  rows.clear();
  for (std::size_t i = 0; i < n; ++i) rows.push_back(static_cast<Index>(i));
  for (std::size_t j = 0; j < m; ++j)
    if (kept[j]) rows.push_back(static_cast<Index>(n + j));
}

/// A dropped row is a combination of kept ones, R₁₁⁻¹ R₁₂: all that take part in it share its force in an unknown way.
void BorderedSolver::Impl::find_dependences(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr) {
  const Index rank = qr.rank(), dropped = static_cast<Index>(m) - rank;
  std::fill(determined.begin(), determined.end(), true);
  if (dropped == 0) return;
  const auto r = qr.matrixR();
  const auto& place = qr.colsPermutation().indices();
  const Eigen::MatrixXd shares = r.topLeftCorner(rank, rank)
                                     .template triangularView<Eigen::Upper>()
                                     .solve(Eigen::MatrixXd(r.block(0, rank, rank, dropped)));
  for (Index d = 0; d < dropped; ++d) {
    determined[static_cast<std::size_t>(place[rank + d])] = false;
    for (Index i = 0; i < rank; ++i)
      if (std::abs(shares(i, d)) > least_share) determined[static_cast<std::size_t>(place[i])] = false;
  }
}

bool BorderedSolver::Impl::factor_independent() {
  choose_rows();
  const Index count = static_cast<Index>(rows.size());
  Matrix reduced(count, count);
  const auto full = view();
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j < count; ++j)
      reduced(i, j) = full(rows[static_cast<std::size_t>(i)], rows[static_cast<std::size_t>(j)]);
  lu.compute(reduced);
  whole = false;
  return has_good_pivots(lu);
}

/// The largest component of a null vector, in the user's own units of q̈.
std::size_t BorderedSolver::Impl::undetermined_coordinate() {
  Eigen::FullPivLU<Matrix> full(view());
  full.setThreshold(least_pivot);
  const Vector null = full.kernel().col(0);
  std::size_t worst = 0;
  const auto size_of = [&](std::size_t i) { return std::abs(null[static_cast<Index>(i)] * scale[i]); };
  for (std::size_t i = 1; i < n; ++i)
    if (size_of(i) > size_of(worst)) worst = i;
  return worst;
}

BorderedSolver::BorderedSolver(std::size_t freedoms, std::size_t constraints, bool may_be_symmetric)
    : impl_(std::make_unique<Impl>(freedoms, constraints, may_be_symmetric)) {}
BorderedSolver::~BorderedSolver() = default;
BorderedSolver::BorderedSolver(BorderedSolver&&) noexcept = default;

std::span<double> BorderedSolver::matrix() {
  return impl_->m == 0 ? impl_->plain.matrix() : std::span<double>(impl_->entries);
}

std::optional<std::size_t> BorderedSolver::factor() {
  Impl& s = *impl_;
  if (s.m == 0) return s.plain.factor();
  s.as_given = s.entries;
  std::fill(s.scale.begin(), s.scale.end(), 1.0);
  s.equilibrate();
  if (s.factor_whole() || s.factor_independent()) return std::nullopt;
  s.entries = s.as_given;
  s.scale_by_mass();
  s.equilibrate();
  if (s.factor_whole() || s.factor_independent()) return std::nullopt;
  return s.undetermined_coordinate();
}

void BorderedSolver::solve(std::span<double> b) const {
  const Impl& s = *impl_;
  if (s.m == 0) return s.plain.solve(b);
  for (std::size_t i = 0; i < s.size; ++i) b[i] *= s.scale[i];
  Eigen::Map<Vector> all(b.data(), static_cast<Index>(s.size));
  if (s.whole) {
    s.scratch = s.lu.solve(all);
    all = s.scratch;
  } else {
    Vector part(static_cast<Index>(s.rows.size()));
    for (std::size_t i = 0; i < s.rows.size(); ++i) part[static_cast<Index>(i)] = all[s.rows[i]];
    s.scratch = s.lu.solve(part);
    all.setZero();
    for (std::size_t i = 0; i < s.rows.size(); ++i) all[s.rows[i]] = s.scratch[static_cast<Index>(i)];
  }
  for (std::size_t i = 0; i < s.size; ++i) b[i] *= s.scale[i];
}

bool BorderedSolver::negative_inverse(double* inverse, std::size_t stride) const {
  constexpr double least_ratio = 1e-4;
  const Impl& s = *impl_;
  if (s.m == 0 || !s.whole || pivot_ratio() < least_ratio) return false;
  s.inverse.noalias() = s.lu.inverse();
  for (std::size_t d = 0; d < s.size; ++d)
    for (std::size_t i = 0; i < s.size; ++i)
      inverse[d * stride + i] = -s.scale[i] * s.scale[d] * s.inverse(static_cast<Index>(i), static_cast<Index>(d));
  return true;
}

double BorderedSolver::pivot_ratio() const { return impl_->m == 0 ? 1.0 : ratio_of_pivots(impl_->lu); }
bool BorderedSolver::keeps(std::size_t constraint) const { return impl_->kept[constraint]; }
bool BorderedSolver::determines(std::size_t constraint) const { return impl_->determined[constraint]; }

}  // namespace maupertuis::dense

#include "equations/sparse_step.hpp"

#include <eigen3/Eigen/SparseCholesky>
#include <eigen3/Eigen/SparseLU>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

using Vector = Eigen::VectorXd;
using Index = Eigen::Index;
using Sparse = Eigen::SparseMatrix<double>;

constexpr double softness = 1e-12;  // ε: rows come with length 1, columns with kinetic energy 1

bool is_definite(const std::vector<Eigen::Triplet<double>>& entries, Index n) {
  Sparse m(n, n);
  m.setFromTriplets(entries.begin(), entries.end());
  return Eigen::SimplicialLLT<Sparse>(m).info() == Eigen::Success;
}

}  // namespace

Vector positive_diagonal(const std::vector<MatrixEntry>& mass, std::size_t n) {
  Vector out = Vector::Ones(static_cast<Index>(n));
  for (const MatrixEntry& e : mass)
    if (e.row == e.column && std::isfinite(e.value) && e.value > 0) out[static_cast<Index>(e.row)] = e.value;
  return out;
}

SparseStep::SparseStep(std::size_t n, const std::vector<Index>& free) : n_(n), free_(free), place_(n, -1) {
  for (std::size_t k = 0; k < free.size(); ++k) place_[static_cast<std::size_t>(free[k])] = static_cast<Index>(k);
}

Vector SparseStep::set_rows(const std::vector<MatrixEntry>& a, const std::vector<std::size_t>& chosen) {
  rows_ = static_cast<Index>(chosen.size());
  std::size_t last = 0;
  for (const std::size_t i : chosen) last = std::max(last, i + 1);
  std::vector<Index> row_of(last, -1);
  for (std::size_t k = 0; k < chosen.size(); ++k) row_of[chosen[k]] = static_cast<Index>(k);
  Vector lengths = Vector::Zero(rows_);
  for (const MatrixEntry& e : a)
    if (e.row < last && row_of[e.row] >= 0) lengths[row_of[e.row]] += e.value * e.value;
  Vector weight = Vector::Ones(rows_);
  for (Index k = 0; k < rows_; ++k)
    if (lengths[k] > 0) weight[k] = 1 / std::sqrt(lengths[k]);
  a_.clear();
  for (const MatrixEntry& e : a)
    if (e.row < last && row_of[e.row] >= 0 && place_[e.column] >= 0)
      a_.emplace_back(row_of[e.row], place_[e.column], weight[row_of[e.row]] * e.value);
  return weight;
}

void SparseStep::set_metric(const std::vector<MatrixEntry>& mass) {
  metric_.clear();
  for (const MatrixEntry& e : mass)
    if (place_[e.row] >= 0 && place_[e.column] >= 0) metric_.emplace_back(place_[e.row], place_[e.column], e.value);
  const auto n = static_cast<Index>(free_.size());
  const bool finite =
      std::all_of(metric_.begin(), metric_.end(), [](const auto& e) { return std::isfinite(e.value()); });
  if (!metric_.empty() && finite && is_definite(metric_, n)) return;
  const Vector diagonal = positive_diagonal(mass, n_);
  metric_.clear();
  for (Index k = 0; k < n; ++k) metric_.emplace_back(k, k, diagonal[free_[static_cast<std::size_t>(k)]]);
}

Vector SparseStep::solve(const Vector& error) const {
  const auto n = static_cast<Index>(free_.size());
  Vector scale = Vector::Ones(n);
  for (const auto& e : metric_)
    if (e.row() == e.col()) scale[e.row()] = 1 / std::sqrt(e.value());
  // Rows are brought to length 1 once more, in units of the metric.
  Vector lengths = Vector::Zero(rows_), rows = Vector::Ones(rows_);
  for (const auto& e : a_) lengths[e.row()] += std::pow(e.value() * scale[e.col()], 2);
  for (Index k = 0; k < rows_; ++k)
    if (lengths[k] > 0) rows[k] = 1 / std::sqrt(lengths[k]);
  Entries entries;
  for (const auto& e : metric_) entries.emplace_back(e.row(), e.col(), e.value() * scale[e.row()] * scale[e.col()]);
  for (const auto& e : a_) {
    const double value = e.value() * scale[e.col()] * rows[e.row()];
    entries.emplace_back(n + e.row(), e.col(), value);
    entries.emplace_back(e.col(), n + e.row(), value);
  }
  for (Index k = 0; k < rows_; ++k) entries.emplace_back(n + k, n + k, -softness);
  Sparse system(n + rows_, n + rows_);
  system.setFromTriplets(entries.begin(), entries.end());
  Vector right = Vector::Zero(n + rows_);
  right.tail(rows_) = -error.cwiseProduct(rows);
  Eigen::SparseLU<Sparse> solver(system);
  Vector out = Vector::Zero(static_cast<Index>(n_));
  if (solver.info() != Eigen::Success) return out;
  const Vector solution = solver.solve(right);
  for (Index k = 0; k < n; ++k) out[free_[static_cast<std::size_t>(k)]] = scale[k] * solution[k];
  return out;
}

}  // namespace maupertuis

#include "linear_algebra/complementarity.hpp"

#include "linear_algebra/equilibrated.hpp"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace maupertuis {
namespace {

using Eigen::Index;

/// The tableau of w − W z − d z₀ = q. Columns: w [n], z [n], z₀, right side.
class Tableau {
 public:
  Tableau(const Eigen::MatrixXd& w, const Eigen::VectorXd& q, const Eigen::VectorXd& d)
      : n_(q.size()), t_(n_, 2 * n_ + 2), basis_(rows()), d_(d) {
    t_.setZero();
    for (Index i = 0; i < n_; ++i) {
      t_(i, i) = 1;
      for (Index j = 0; j < n_; ++j) t_(i, n_ + j) = -w(i, j);
      t_(i, 2 * n_) = -d(i);
      t_(i, 2 * n_ + 1) = q(i);
      basis_[static_cast<std::size_t>(i)] = i;
    }
  }

  std::optional<Eigen::VectorXd> solve() {
    Index leaving = most_negative();
    if (leaving < 0) return Eigen::VectorXd::Zero(n_);
    Index entering = pivot(leaving, 2 * n_);  // z₀ comes in; what left is driven
    for (Index turn = 0; turn < 100 * n_ + 1000; ++turn) {
      const Index driven = complement(entering);
      leaving = leaving_row(driven);
      if (leaving < 0) return std::nullopt;
      entering = pivot(leaving, driven);
      if (entering == 2 * n_) return solution();
    }
    return std::nullopt;
  }

 private:
  std::size_t rows() const { return static_cast<std::size_t>(n_); }
  Index complement(Index column) const { return column < n_ ? column + n_ : column - n_; }

  Index most_negative() const {
    Index row = -1;
    for (Index i = 0; i < n_; ++i)
      if (t_(i, 2 * n_ + 1) < 0 && (row < 0 || t_(i, 2 * n_ + 1) * d_(row) < t_(row, 2 * n_ + 1) * d_(i))) row = i;
    return row;
  }

  /// The variable of the column enters the basis in this row; the one that leaves is returned.
  Index pivot(Index row, Index column) {
    t_.row(row) /= t_(row, column);
    for (Index i = 0; i < n_; ++i) {
      const double factor = t_(i, column);
      if (i != row && factor != 0) t_.row(i) -= factor * t_.row(row);
    }
    return std::exchange(basis_[static_cast<std::size_t>(row)], column);
  }

  /// The lexicographically smallest ratio (right side, then the columns of w) / entry among positive entries; z₀ leaves
  /// as soon as it may.
  Index leaving_row(Index column) const {
    Index best = -1;
    constexpr double least = 1e-13;
    for (Index i = 0; i < n_; ++i) {
      if (!(t_(i, column) > least)) continue;
      if (best < 0 || precedes(i, best, column)) best = i;
    }
    return best;
  }

  bool precedes(Index a, Index b, Index column) const {
    const auto ratio = [&](Index row, Index k) { return t_(row, k) / t_(row, column); };
    const double tie = 1e-14 * (std::abs(ratio(a, 2 * n_ + 1)) + std::abs(ratio(b, 2 * n_ + 1)));
    const double first = ratio(a, 2 * n_ + 1) - ratio(b, 2 * n_ + 1);
    if (std::abs(first) > tie) return first < 0;
    if (basis_[static_cast<std::size_t>(a)] == 2 * n_) return true;
    if (basis_[static_cast<std::size_t>(b)] == 2 * n_) return false;
    for (Index k = 0; k < n_; ++k)
      if (const double next = ratio(a, k) - ratio(b, k); next != 0) return next < 0;
    return false;
  }

  Eigen::VectorXd solution() const {
    Eigen::VectorXd z = Eigen::VectorXd::Zero(n_);
    for (Index i = 0; i < n_; ++i)
      if (const Index variable = basis_[static_cast<std::size_t>(i)]; variable >= n_ && variable < 2 * n_)
        z(variable - n_) = std::max(0.0, t_(i, 2 * n_ + 1));
    return z;
  }

  Index n_;
  Eigen::MatrixXd t_;
  std::vector<Index> basis_;
  Eigen::VectorXd d_;
};

/// The z that vanish stay so; the others are solved for anew with W itself.
Eigen::VectorXd refined(const Eigen::MatrixXd& w, const Eigen::VectorXd& q, const Eigen::VectorXd& z) {
  std::vector<Index> in;
  for (Index i = 0; i < z.size(); ++i)
    if (z(i) > 0) in.push_back(i);
  const auto count = static_cast<Index>(in.size());
  Eigen::MatrixXd part(count, count);
  Eigen::VectorXd right(count);
  for (Index a = 0; a < count; ++a) {
    right(a) =
        -q(in[static_cast<std::size_t>(a)]) - w.row(in[static_cast<std::size_t>(a)]).dot(z);  // what is still missing
    for (Index b = 0; b < count; ++b) part(a, b) = w(in[static_cast<std::size_t>(a)], in[static_cast<std::size_t>(b)]);
  }
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(part);
  const Eigen::VectorXd more = solver.solve(right);
  Eigen::VectorXd out = z;
  for (Index a = 0; a < count; ++a) {
    double& entry = out(in[static_cast<std::size_t>(a)]);
    entry = std::max(0.0, entry + more(a));
  }
  return out;
}

}  // namespace

std::optional<Eigen::VectorXd> linear_complementarity(const Eigen::MatrixXd& w, const Eigen::VectorXd& q) {
  if (q.size() == 0) return Eigen::VectorXd();
  // W = R⁻¹ W' C⁻¹, q = R⁻¹ q', z = C z': the same pivots, told from rounding in units of their own.
  const Equilibrated own(w);
  const Eigen::VectorXd own_q = own.rows.cwiseProduct(q);
  const auto solves = [&](const Eigen::VectorXd& z) {
    constexpr double allowed = 1e-9;
    const Eigen::VectorXd slack = own_q + own.matrix * z;
    const double most = allowed * own_q.cwiseAbs().maxCoeff(), some = allowed * z.maxCoeff();
    for (Index i = 0; i < z.size(); ++i)
      if (!(slack(i) >= -most) || (z(i) > some && slack(i) > most)) return false;
    return true;
  };
  const auto in_given_units = [&](const std::optional<Eigen::VectorXd>& z) {
    return z ? std::optional<Eigen::VectorXd>(own.columns.cwiseProduct(*z)) : z;
  };
  const auto direct = Tableau(own.matrix, own_q, own.rows).solve();
  if (direct && solves(*direct)) return in_given_units(direct);
  // Redundant rows make pivots of rounding alone: a little on the diagonal tells them apart.
  constexpr double little = 1e-11;
  const auto z = Tableau(own.matrix + little * Eigen::MatrixXd::Identity(w.rows(), w.cols()), own_q, own.rows).solve();
  if (!z) return in_given_units(direct);
  const Eigen::VectorXd out = refined(own.matrix, own_q, *z);
  return in_given_units(solves(out) ? std::optional(out) : direct);
}

}  // namespace maupertuis

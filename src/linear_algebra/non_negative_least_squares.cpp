#include "linear_algebra/non_negative_least_squares.hpp"

#include <algorithm>
#include <vector>

namespace maupertuis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double rounding = 1e-14;

/// u ≥ 0 for which |E u − f| is least: columns come into play one by one, the steepest first, and leave where their
/// part would be negative.
class NonNegativeLeastSquares {
 public:
  NonNegativeLeastSquares(const MatrixXd& e, const VectorXd& f) : e_(e), f_(f), u_(VectorXd::Zero(e.cols())) {}

  VectorXd solve() {
    const Index most_turns = 30 + 10 * e_.cols();
    for (Index turn = 0; turn < most_turns; ++turn) {
      const Index next = steepest();
      if (next < 0) break;
      in_play_.push_back(next);
      if (!settle(next)) break;
    }
    return u_;
  }

 private:
  /// The column along which the residual falls, or −1.
  Index steepest() const {
    const VectorXd slopes = e_.transpose() * (f_ - e_ * u_);
    Index best = -1;
    for (Index k = 0; k < slopes.size(); ++k) {
      const bool is_idle = std::find(in_play_.begin(), in_play_.end(), k) == in_play_.end();
      if (is_idle && slopes(k) > rounding * e_.col(k).norm() && (best < 0 || slopes(k) > slopes(best))) best = k;
    }
    return best;
  }

  /// The least squares of the columns in play, without those whose part would be negative. False where the one that
  /// came last goes at once: rounding alone had called it.
  bool settle(Index last) {
    while (!in_play_.empty()) {
      const VectorXd parts = MatrixXd(e_(Eigen::all, in_play_)).colPivHouseholderQr().solve(f_);
      double way = 1;
      for (std::size_t k = 0; k < in_play_.size(); ++k) {
        const double u = u_(in_play_[k]), part = parts(static_cast<Index>(k));
        if (part <= 0) way = std::min(way, u > 0 ? u / (u - part) : 0);
      }
      for (std::size_t k = 0; k < in_play_.size(); ++k)
        u_(in_play_[k]) += way * (parts(static_cast<Index>(k)) - u_(in_play_[k]));
      if (way == 1 && parts.minCoeff() > 0) return true;
      const bool leaves = way == 0 && u_(last) <= 0;
      std::erase_if(in_play_, [&](Index k) { return u_(k) <= rounding * u_.maxCoeff() && (u_(k) = 0, true); });
      if (leaves) return false;
    }
    return true;
  }

  const MatrixXd& e_;
  const VectorXd& f_;
  VectorXd u_;
  std::vector<Index> in_play_;
};

}  // namespace

VectorXd non_negative_least_squares(const MatrixXd& e, const VectorXd& f) {
  return NonNegativeLeastSquares(e, f).solve();
}

}  // namespace maupertuis

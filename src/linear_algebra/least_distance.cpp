#include "linear_algebra/least_distance.hpp"

#include "linear_algebra/non_negative_least_squares.hpp"

#include <algorithm>

namespace maupertuis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double rounding = 1e-14;

}  // namespace

std::optional<VectorXd> least_distance(const MatrixXd& g, const VectorXd& h) {
  const Index n = g.cols();
  const double size = std::max(h.cwiseAbs().maxCoeff(), 1e-300);
  MatrixXd e(n + 1, g.rows());
  e.topRows(n) = g.transpose();
  e.row(n) = h.transpose() / size;
  const VectorXd f = VectorXd::Unit(n + 1, n);
  const VectorXd rest = e * non_negative_least_squares(e, f) - f;
  if (!(rest(n) < -rounding)) return std::nullopt;
  // Where the inequalities exclude each other the rest is what rounding leaves of large parts.
  constexpr double digits = 1e-12;
  const VectorXd x = -size * rest.head(n) / rest(n);
  return (g * x - h).minCoeff() >= -digits * (size + x.norm()) ? std::optional(x) : std::nullopt;
}

}  // namespace maupertuis

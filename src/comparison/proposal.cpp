#include "comparison/parametrization.hpp"
#include "linear_algebra/dense.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::comparison {

std::vector<std::size_t> dependent_coordinates(const EquationsOfMotion& equations, const MotionState& start) {
  const MechanicalSystem& system = *equations.system;
  const std::size_t n = system.coordinates.size();
  const ConstraintManifold manifold(equations);
  const std::vector<double> a = manifold.matrix(start), m = manifold.mass(start);
  Eigen::MatrixXd rows(0, static_cast<Eigen::Index>(n));
  for (std::size_t k = 0; k < system.constraints.size(); ++k) {
    if (system.constraints[k].level != Constraint::Level::Position) continue;
    Eigen::VectorXd row(static_cast<Eigen::Index>(n));
    for (std::size_t j = 0; j < n; ++j)
      row[static_cast<Eigen::Index>(j)] = a[k * n + j] / (m[j * n + j] > 0 ? std::sqrt(m[j * n + j]) : 1);
    rows.conservativeResize(rows.rows() + 1, Eigen::NoChange);
    rows.row(rows.rows() - 1) = row.norm() > 0 ? Eigen::VectorXd(row / row.norm()) : row;
  }
  if (rows.rows() == 0) return {};
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(rows);
  qr.setThreshold(1e-9);
  std::vector<std::size_t> out;
  for (Eigen::Index k = 0; k < qr.rank(); ++k)
    out.push_back(static_cast<std::size_t>(qr.colsPermutation().indices()[k]));
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace maupertuis::comparison

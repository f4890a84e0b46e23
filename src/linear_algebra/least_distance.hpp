#pragma once
#include "linear_algebra/dense.hpp"

#include <optional>

namespace maupertuis {

/// The shortest x with G x ≥ h; nothing where there is none. By non-negative least squares (C. L. Lawson and R. J.
/// Hanson, Solving Least Squares Problems, 1974, ch. 23: LDP and NNLS). Inequalities that depend on each other are
/// tolerated. G: [m × n] of rows that are not much longer than 1. Cost: some n solutions of a least-squares problem [(n
/// + 1) × n].
std::optional<Eigen::VectorXd> least_distance(const Eigen::MatrixXd& g, const Eigen::VectorXd& h);

}  // namespace maupertuis

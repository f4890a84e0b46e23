#pragma once
#include "linear_algebra/dense.hpp"

#include <optional>

namespace maupertuis {

/// z with 0 ≤ z ⟂ q + W z ≥ 0, by Lemke's pivoting with the lexicographic rule against cycling (Cottle, Pang, Stone,
/// The Linear Complementarity Problem, 4.4). For positive semidefinite W it finds a solution wherever there is one;
/// nothing where the path ends in a ray: then there is none for such W, and none is known for others.
/// W: [n × n], need not be symmetric. Cost: O(n³), for n pivots.
std::optional<Eigen::VectorXd> linear_complementarity(const Eigen::MatrixXd& w, const Eigen::VectorXd& q);

}  // namespace maupertuis

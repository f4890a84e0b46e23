#pragma once
#include "linear_algebra/dense.hpp"

namespace maupertuis {

/// u ≥ 0 for which |E u − f| is least (C. L. Lawson and R. J. Hanson, Solving Least Squares Problems, 1974, ch. 23).
/// Of a basic solution: where E u = f can be met, no more parts are positive than E has independent rows.
/// Cost: some [columns] solutions of a least-squares problem of the columns that are in play.
Eigen::VectorXd non_negative_least_squares(const Eigen::MatrixXd& e, const Eigen::VectorXd& f);

}  // namespace maupertuis

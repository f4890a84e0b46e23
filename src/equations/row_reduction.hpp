#pragma once
#include <maupertuis/evaluate.hpp>
#include <maupertuis/mechanical_system.hpp>

#include <eigen3/Eigen/Core>

#include <utility>
#include <vector>

namespace maupertuis {

/// Singular values above this part of the largest count; the rows come scaled.
constexpr double rank_tolerance = 1e-9;

std::size_t numerical_rank(const Eigen::MatrixXd& m);

/// x of the smallest |m x − b|.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& m, const Eigen::VectorXd& b);

/// The rows, in their order, that are no combination of the chosen ones before them.
std::vector<std::size_t> independent_rows(const Eigen::MatrixXd& m);

/// Gauss-Jordan elimination with `count` pivots in the first `columns` columns, chosen by their size at `point` and
/// constants first. Entries that vanish identically become 0. Returns (row, column) of the pivots, which become 1.
std::vector<std::pair<std::size_t, std::size_t>> reduce_rows(ExprMatrix& m, std::size_t columns, std::size_t count,
                                                             const Bindings& point);

}  // namespace maupertuis

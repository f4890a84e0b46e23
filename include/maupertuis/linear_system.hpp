#pragma once
#include <maupertuis/mechanical_system.hpp>

#include <cstddef>
#include <optional>
#include <vector>

/// Linear systems whose coefficients are expressions: M and what couples its rows.
namespace maupertuis {

/// x of N x = c for the augmented matrix [N | c], by Gaussian elimination with division: a shared DAG, nothing
/// expanded. Nothing where N is singular as a function of its symbols. Cost O(n³) nodes; a pivot is told by its value
/// at one point, and by a zero test where that is small.
std::optional<ExprVector> solve_linear(ExprMatrix augmented);

/// Groups of rows that a symmetric matrix couples, directly or through others; each group ascending. Entries must show
/// that they vanish: `fourier_form` makes it visible.
std::vector<std::vector<std::size_t>> coupled_rows(const ExprMatrix& symmetric);

}  // namespace maupertuis

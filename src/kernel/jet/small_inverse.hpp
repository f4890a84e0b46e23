#pragma once
#include <cstddef>
#include <span>

namespace maupertuis::jet {

/// −M⁻¹ of a symmetric, positive definite matrix of a few rows, by LDLᵀ: a product with it takes part in few dependences,
/// where a substitution waits for each of its rows.
///   matrix   row by row [n × n]; its lower triangle counts
///   inverse  [n × stride] rows, written up to n
/// False if M, scaled to a unit diagonal, has a pivot below 1e-10, is not positive, not finite or not symmetric: then nothing is
/// written, and a solver that pivots has to decide.
bool negative_inverse(std::span<const double> matrix, std::size_t n, double* inverse, std::size_t stride);

}  // namespace maupertuis::jet

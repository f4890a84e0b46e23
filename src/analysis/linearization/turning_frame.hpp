#pragma once
#include "analysis/linearization/point_equations.hpp"

/// Rows of equations beside a motion q₀(t) = exp(Ξ t) q₀, seen in the frame that turns along: δq = exp(Ξ t) ξ, so that
///
///     δq̇ has ξ̇ + Ξ ξ,   δq̈ has ξ̈ + 2 Ξ ξ̇ + Ξ² ξ
///
/// Ξ [n × n]; without rows: no frame, and everything stays as it is.
namespace maupertuis {

/// Rows by (ξ, ξ̇, ξ̈).
RowsAtPoint in_frame(RowsAtPoint rows, const Matrix& turning);

/// (ξ, ξ̇) and ξ̈ as δq, δq̇ and δq̈ at the instant of the point.
void out_of_frame(const Matrix& turning, Matrix& motion, Matrix& answer);

/// How large the parts of a row by ξ and by ξ̇ are, which cancel along symmetries.
struct SizesInFrame {
  Matrix by_q, by_v;
};
SizesInFrame sizes_in_frame(const RowsAtPoint& rows, const Matrix& turning);

/// Entries that are rounding beside the largest sum of sizes in a row become 0, both in `typical` sizes of the
/// coordinates [rows].
void clear_rounding(Matrix& part, const Matrix& sizes, const Vector& typical);

/// The same in A of ẋ = A x, beside what turns with the frame by itself, in typical sizes of coordinates [n].
void clear_rounding_of_states(Matrix& a, const Linearization& l, const Vector& sizes);

}  // namespace maupertuis

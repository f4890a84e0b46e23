#include "analysis/linearization/turning_frame.hpp"

#include "linear_algebra/products.hpp"

#include <cmath>

namespace maupertuis {
namespace {

constexpr double rest = 1e-13;  // as far as Newton's method has settled the motion

}  // namespace

RowsAtPoint in_frame(RowsAtPoint rows, const Matrix& turning) {
  if (turning.size() == 0) return rows;
  const Matrix by_v = rows.by_v + 2 * product(rows.by_a, turning);
  rows.by_q += product(product(rows.by_a, turning) + rows.by_v, turning);
  rows.by_v = by_v;
  return rows;
}

void out_of_frame(const Matrix& turning, Matrix& motion, Matrix& answer) {
  if (turning.size() == 0) return;
  const Index n = turning.rows();
  const Matrix xi = motion.topRows(n), rate = motion.bottomRows(n);
  motion.bottomRows(n) += product(turning, xi);
  answer.topRows(n) += product(turning, 2 * rate + product(turning, xi));
}

SizesInFrame sizes_in_frame(const RowsAtPoint& rows, const Matrix& turning) {
  const Matrix by = turning.cwiseAbs(), mass = rows.by_a.cwiseAbs(), velocity = rows.by_v.cwiseAbs();
  return {rows.by_q.cwiseAbs() + product(product(mass, by) + velocity, by), velocity + 2 * product(mass, by)};
}

void clear_rounding(Matrix& part, const Matrix& sizes, const Vector& typical) {
  if (part.size() == 0) return;
  const double largest = typical.cwiseProduct(sizes * typical).maxCoeff();  // a work, or a power times a time
  for (Index i = 0; i < part.rows(); ++i)
    for (Index j = 0; j < part.cols(); ++j)
      if (std::abs(part(i, j)) * typical[i] * typical[j] <= rest * largest) part(i, j) = 0;
}

void clear_rounding_of_states(Matrix& a, const Linearization& l, const Vector& sizes) {
  const double turning = to_eigen(l.point.turning).norm();
  const auto f = static_cast<Index>(l.independent.size());
  const auto scale = [&](Index i) {
    const bool position = i < f;
    const std::size_t of = position ? l.independent[static_cast<std::size_t>(i)]
                                    : l.independent_velocities[static_cast<std::size_t>(i - f)];
    return sizes[static_cast<Index>(of)] * (position ? 1 : turning);
  };
  for (Index i = 0; i < a.rows(); ++i)
    for (Index j = 0; j < a.cols(); ++j)
      if (std::abs(a(i, j)) <= rest * turning * scale(i) / scale(j)) a(i, j) = 0;
}

}  // namespace maupertuis

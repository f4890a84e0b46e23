#include "analysis/action/inertia.hpp"

#include "analysis/action/newton.hpp"
#include "linear_algebra/dense.hpp"
#include "linear_algebra/products.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace maupertuis::action {
namespace {

constexpr double zero_level = 1e-9;  // of an eigenvalue: those of the discretized second variation err by less

/// One symmetric block that is eliminated: its negative eigenvalues, and what it leaves.
struct Pivot {
  Index negative = 0;
  Matrix solved;  // P⁻¹ R
};
Pivot eliminate(const Matrix& block, const Matrix& right) {
  if (block.rows() == 0) return {0, right};
  if (const Eigen::LLT<Matrix> llt(block); llt.info() == Eigen::Success) return {0, llt.solve(right)};
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(block);
  const Vector& values = eigen.eigenvalues();
  return {(values.array() < 0).count(),
          product(eigen.eigenvectors(),
                  values.cwiseInverse().asDiagonal() * transposed_product(eigen.eigenvectors(), right))};
}

/// The same inertia (Sylvester) with every unknown in a unit of its own: where a coordinate's sizes are far below those
/// of another, its zeros would be lost in the rounding of that one.
Matrix in_own_units(const Matrix& all) {
  Vector unit(all.rows());
  for (Index i = 0; i < all.rows(); ++i) {
    const double own = std::abs(all(i, i)), size = own > 0 ? own : all.row(i).cwiseAbs().maxCoeff();
    unit[i] = size > 0 ? 1 / std::sqrt(size) : 1;
  }
  return unit.asDiagonal() * all * unit.asDiagonal();
}

/// The same where p (q' − v) borders the matrix: diagonals of p and q are rounding there, and units are found by turns,
/// until the largest entry of each row is 1 (Ruiz).
Matrix in_balanced_units(const Matrix& all) {
  constexpr int turns = 24;
  Matrix out = all;
  for (int turn = 0; turn < turns; ++turn) {
    const Vector largest = out.cwiseAbs().rowwise().maxCoeff();
    const Vector unit = (largest.array() > 0).select(largest.cwiseSqrt().cwiseInverse(), 1.0);
    out = Matrix(unit.asDiagonal() * out * unit.asDiagonal());
  }
  return out;
}

/// Negative eigenvalues of a symmetric matrix whose rows couple to near ones only, but for the last `border` ones: by
/// elimination in pieces.
Index negatives_of(const Matrix& in_units, Index border) {
  constexpr Index whole = 600, piece = 96;
  Matrix all = in_units;
  Index out = 0, first = 0;
  for (; all.rows() - first > whole + border; first += piece) {
    std::vector<Index> coupled;
    for (Index c = first + piece; c < all.cols(); ++c)
      if (!all.col(c).segment(first, piece).isZero(0)) coupled.push_back(c);
    const Matrix right = all(Eigen::seqN(first, piece), coupled);
    const Pivot pivot = eliminate(all.block(first, first, piece, piece), right);
    out += pivot.negative;
    const Matrix less = transposed_product(right, pivot.solved);
    all(coupled, coupled) -= less;
  }
  const Matrix rest = all.bottomRightCorner(all.rows() - first, all.cols() - first);
  if (rest.rows() == 0) return out;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(rest, Eigen::EigenvaluesOnly);
  return out + (eigen.eigenvalues().array() < 0).count();
}

class Counter {
 public:
  Counter(Functional& functional, const Trial& trial, const FixedEnds& fixed, const Matrix& scale)
      : trial_(trial),
        k_(functional.integrals()),
        higher_(functional.orders().higher()),
        a_(assemble(functional, trial, 2)),
        directions_(directions_of(functional, trial, fixed, scale, a_.gradient)) {
    for (Index c = 0; c < k_; ++c) columns_.push_back(directions_.reduce(a_.integral_gradients.col(c)));
    for (Index e = 0; e < trial.mesh.elements(); ++e) {
      const auto at = static_cast<std::size_t>(e);
      hessians_.push_back(reduced_element(trial, a_.hessians[at], directions_, e));
      norms_.push_back(reduced_element(trial, a_.kinetic[at] + a_.displacement[at], directions_, e));
      add_curvature(functional, e);
    }
    number_breaks();
  }

  bool usable() const { return a_.finite; }

  /// Eigenvalues below `shift`.
  Index below(double shift) const {
    Matrix rest = Matrix::Zero(breaks_ + k_, breaks_ + k_);
    Index out = 0;
    for (Index e = 0; e < trial_.mesh.elements(); ++e) out += add_element(e, shift, rest);
    return out + negatives_of(higher_ ? in_balanced_units(rest) : in_own_units(rest), k_) - k_;
  }

 private:
  Index width(Index e, Index j) const {
    return directions_.basis[static_cast<std::size_t>(trial_.mesh.node(e, j))].cols();
  }

  /// Each node's own curvature once: the first node of an element is left to the one before, if there is one.
  void add_curvature(Functional& functional, Index e) {
    Index offset = 0;
    for (Index j = 0; j <= trial_.mesh.rule->degree; ++j) {
      const Index d = width(e, j);
      const bool mine = j > 0 || (e == 0 && !trial_.mesh.closed);
      if (mine)
        hessians_.back().block(offset, offset, d, d) +=
            node_curvature(functional, trial_, directions_, trial_.mesh.node(e, j));
      offset += d;
    }
  }

  void number_breaks() {
    const Index p = trial_.mesh.rule->degree, count = trial_.mesh.elements() + (trial_.mesh.closed ? 0 : 1);
    for (Index b = 0; b < count; ++b) {
      first_.push_back(breaks_);
      breaks_ += directions_.basis[static_cast<std::size_t>(b * p)].cols();
    }
  }

  Index add_element(Index e, double shift, Matrix& rest) const {
    const auto at = static_cast<std::size_t>(e);
    const Matrix all = hessians_[at] - shift * norms_[at];
    const Index p = trial_.mesh.rule->degree, left = width(e, 0), right = width(e, p),
                inner = all.rows() - left - right;
    // Outer: the left break, the right break, the integral constraints.
    const Index outer = left + right + k_;
    Matrix coupling(inner, outer), own = Matrix::Zero(outer, outer);
    coupling.leftCols(left) = all.block(left, 0, inner, left);
    coupling.middleCols(left, right) = all.block(left, left + inner, inner, right);
    for (Index c = 0; c < k_; ++c)
      coupling.col(left + right + c) =
          columns_[static_cast<std::size_t>(c)].segment(directions_.first[static_cast<std::size_t>(e * p + 1)], inner);
    own.topLeftCorner(left, left) = all.topLeftCorner(left, left);
    own.block(left, left, right, right) = all.bottomRightCorner(right, right);
    own.block(0, left, left, right) = all.topRightCorner(left, right);
    own.block(left, 0, right, left) = all.bottomLeftCorner(right, left);
    const Pivot pivot = eliminate(all.block(left, left, inner, inner), coupling);
    own -= transposed_product(coupling, pivot.solved);
    scatter(e, left, right, own, rest);
    return pivot.negative;
  }

  void scatter(Index e, Index left, Index right, const Matrix& own, Matrix& rest) const {
    const auto next = static_cast<std::size_t>(trial_.mesh.wraps(e, trial_.mesh.rule->degree) ? 0 : e + 1);
    std::vector<Index> places;
    for (Index i = 0; i < left; ++i) places.push_back(first_[static_cast<std::size_t>(e)] + i);
    for (Index i = 0; i < right; ++i) places.push_back(first_[next] + i);
    for (Index c = 0; c < k_; ++c) places.push_back(breaks_ + c);
    for (std::size_t a = 0; a < places.size(); ++a)
      for (std::size_t b = 0; b < places.size(); ++b)
        rest(places[a], places[b]) += own(static_cast<Index>(a), static_cast<Index>(b));
    // The part of the integral constraints that stands at the breaks themselves, once.
    for (Index c = 0; c < k_; ++c) {
      const Vector& column = columns_[static_cast<std::size_t>(c)];
      const auto add = [&](std::size_t which, Index node, Index count) {
        for (Index i = 0; i < count; ++i) {
          const double value = column[directions_.first[static_cast<std::size_t>(node)] + i];
          rest(first_[which] + i, breaks_ + c) += value;
          rest(breaks_ + c, first_[which] + i) += value;
        }
      };
      if (e == 0) add(0, 0, left);
      if (next != 0) add(next, trial_.mesh.node(e, trial_.mesh.rule->degree), right);
    }
  }

  const Trial& trial_;
  Index k_;
  bool higher_;
  Assembly a_;
  Directions directions_;
  std::vector<Vector> columns_;
  std::vector<Matrix> hessians_, norms_;
  std::vector<Index> first_;  // where the unknowns of a break begin
  Index breaks_ = 0;
};

}  // namespace

Inertia inertia_of(Functional& functional, const Trial& trial, const FixedEnds& fixed, const Vector& least) {
  const Counter counter(functional, trial, fixed, even_scale(trial, least));
  Inertia out;
  // p (q' − v) borders the matrix as integral constraints do: each p at a node takes one negative eigenvalue of it
  // away.
  const Index border = static_cast<Index>(functional.orders().momenta.size()) * trial.mesh.nodes();
  const auto below = [&](double shift) { return counter.below(shift) - border; };
  const Index inside = below(-zero_level), with_zero = below(zero_level);
  out.negative = static_cast<std::size_t>(std::max<Index>(0, inside));
  out.nullity = static_cast<std::size_t>(std::max<Index>(0, with_zero - inside));
  for (double width = 1e-8; width < 0.5; width *= 10) {
    if (below(-width) != inside || below(width) != with_zero) break;
    out.nearest = width;
  }
  return out;
}

bool convex_along(Functional& functional, const Trial& trial) {
  const Index n = trial.q.rows(), p = trial.mesh.rule->degree;
  Density density;
  Vector values;
  Matrix rows;
  for (Index e = 0; e < trial.mesh.elements(); ++e) {
    const Matrix nodes = trial.element(e);
    for (const Index g : {Index(0), p / 2, p + 1}) {
      const Place at = place_of(trial.mesh, e, g);
      const Vector q = nodes * at.value, v = nodes * at.slope;
      functional.evaluate(at.t, q.data(), v.data(), trial.multipliers, 2, density);
      if (!density.finite) return false;
      functional.constraints_at(at.t, q, values, rows);
      const std::vector<Index>& tops = functional.orders().tops;
      const Matrix mass = density.hessian.bottomRightCorner(n, n)(tops, tops);
      rows = Matrix(rows(Eigen::all, tops));
      const Vector size =
          mass.diagonal().cwiseAbs().cwiseMax(1e-12 * mass.diagonal().cwiseAbs().maxCoeff()).cwiseSqrt().cwiseInverse();
      const Matrix z = null_basis(rows * size.asDiagonal(), size.size());
      const Matrix reduced = quadratic_form(z, size.asDiagonal() * mass * size.asDiagonal());
      if (reduced.rows() == 0) continue;
      const Eigen::SelfAdjointEigenSolver<Matrix> eigen(reduced, Eigen::EigenvaluesOnly);
      if (!(eigen.eigenvalues()[0] > 1e-10 * eigen.eigenvalues().tail(1)[0])) return false;
    }
  }
  return true;
}

}  // namespace maupertuis::action

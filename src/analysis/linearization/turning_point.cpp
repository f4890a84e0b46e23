#include "analysis/linearization/turning_point.hpp"

#include "linear_algebra/dense.hpp"

#include <algorithm>
#include <cmath>

/// The rests are a curve F(z) = 0 of z = (q, λ, τ, p): balance, constraints, and no way along the translations, whose
/// forces τ vanish. With the tangent t, J t = 0, as a further row the matrix stays regular where the curve turns back,
/// though ∂F/∂q is singular there; where another branch crosses, its determinant changes sign.
namespace maupertuis {
namespace {

constexpr double longest = 0.05, first_step = 1e-3, shortest = 1e-9;  // of a step, in typical sizes
constexpr int most_steps = 2000, most_corrections = 10, most_halvings = 80;
constexpr double straight = 0.9;      // cosine of the turn in one step
constexpr double converged = 1e-13;   // of a correction: the next one is rounding
constexpr double at_rounding = 1e-9;  // of one that does not shrink any more
constexpr double level = 1e-6;        // of the tangent's part along the parameter: else the curve has a corner there
constexpr double apart = 1e-5;        // of the way between two values of the parameter, for the derivative by it

struct OnCurve {
  Vector z, tangent;
  bool regular_side = false;  // the sign of the determinant
};

class RestCurve {
 public:
  RestCurve(PointEquations::Impl& equations, const BranchEnd& end)
      : e_(equations),
        end_(end),
        n_(static_cast<Index>(equations.n)),
        m_(static_cast<Index>(equations.m)),
        pins_(static_cast<Index>(end.translations.size())),
        size_(n_ + m_ + pins_ + 1) {}

  std::optional<TurningPoint> turning() {
    auto here = begin();
    double step = first_step;
    for (int k = 0; here && k < most_steps && step > shortest; ++k) {
      const auto next = ahead(*here, step);
      if (!next || next->tangent.dot(weighed(here->tangent)) < straight) {
        step /= 2;
        continue;
      }
      if (next->tangent[size_ - 1] < 0) return located(*here, *next, step);
      if (next->z[size_ - 1] >= 1) return std::nullopt;
      here = next;
      step = std::min(2 * step, longest);
    }
    return std::nullopt;
  }

 private:
  /// The parameter runs from 0 to 1 on the way to where the branch is no more.
  std::optional<OnCurve> begin() {
    Vector z = Vector::Zero(size_);
    for (Index i = 0; i < n_; ++i) z[i] = end_.rest.q[static_cast<std::size_t>(i)] / size_of(i);
    for (Index i = 0; i < m_; ++i) z[n_ + i] = end_.rest.multipliers[static_cast<std::size_t>(i)];
    return with_tangent(z, Vector::Unit(size_, size_ - 1));
  }

  double size_of(Index i) const { return end_.sizes[static_cast<std::size_t>(i)]; }
  double value_of(const Vector& z) const { return end_.value + z[size_ - 1] * (end_.beyond - end_.value); }

  OperatingPoint rest_of(const Vector& z) const {
    OperatingPoint out = end_.rest;
    for (Index i = 0; i < n_; ++i) out.q[static_cast<std::size_t>(i)] = z[i] * size_of(i);
    for (Index i = 0; i < m_; ++i) out.multipliers[static_cast<std::size_t>(i)] = z[n_ + i];
    return out;
  }

  void set_parameter(double value) {
    e_.parameters[end_.parameter] = value;
    for (PointEquations::Impl::Rows* rows : {&e_.resting, &e_.positions}) {
      rows->values.set_parameters(e_.parameters);
      rows->entries.set_parameters(e_.parameters);
    }
  }

  /// F at a place, in units of nothing in particular.
  Vector forces(const Vector& z) {
    set_parameter(value_of(z));
    const OperatingPoint at = rest_of(z);
    Vector out = Vector::Zero(size_ - 1);
    out.head(n_) = e_.value(e_.resting, at);
    out.segment(n_, m_) = e_.value(e_.positions, at);
    for (Index k = 0; k < pins_; ++k) {
      const Vector d = direction(k);
      out.head(n_) += z[n_ + m_ + k] * d;
      for (Index i = 0; i < n_; ++i)
        out[n_ + m_ + k] += d[i] * (z[i] - end_.rest.q[static_cast<std::size_t>(i)] / size_of(i));
    }
    return out;
  }

  Vector direction(Index k) const { return to_eigen(end_.translations[static_cast<std::size_t>(k)].direction); }

  Matrix jacobian(const Vector& z) {
    Matrix out = Matrix::Zero(size_ - 1, size_);
    const Vector step = apart * Vector::Unit(size_, size_ - 1);
    out.rightCols(1) = (forces(z + step) - forces(z - step)) / (2 * apart);
    set_parameter(value_of(z));
    const OperatingPoint at = rest_of(z);
    const RowsAtPoint balance = e_.at(e_.resting, at), positions = e_.at(e_.positions, at);
    for (Index i = 0; i < n_; ++i) {
      out.block(0, i, n_, 1) = size_of(i) * balance.by_q.col(i);
      out.block(n_, i, m_, 1) = size_of(i) * positions.by_q.col(i);
    }
    out.block(0, n_, n_, m_) = balance.by_multipliers;
    for (Index k = 0; k < pins_; ++k) {
      out.block(0, n_ + m_ + k, n_, 1) = direction(k);
      out.block(n_ + m_ + k, 0, 1, n_) = direction(k).transpose();
    }
    return out;
  }

  /// Multipliers have no size of their own: how far two places are apart is a matter of q and p.
  Vector weighed(Vector z) const {
    z.segment(n_, size_ - 1 - n_).setZero();
    return z;
  }

  /// Rows of one size, the last of them across the curve.
  struct Bordered {
    Eigen::PartialPivLU<Matrix> lu;
    Vector rows;
  };
  std::optional<Bordered> bordered(const Vector& z, const Vector& across) {
    Matrix all(size_, size_);
    all << jacobian(z), across.transpose();
    if (!all.allFinite()) return std::nullopt;
    const Vector largest = all.cwiseAbs().rowwise().maxCoeff();
    const Vector rows = (largest.array() > 0).select(largest.cwiseInverse(), 1.0);
    return Bordered{Eigen::PartialPivLU<Matrix>(Matrix(rows.asDiagonal() * all)), rows};
  }

  static bool is_positive(const Bordered& b) {
    const Vector pivots = b.lu.matrixLU().diagonal();
    return ((pivots.array() < 0).count() % 2 == 0) == (b.lu.permutationP().determinant() > 0);
  }

  std::optional<OnCurve> with_tangent(const Vector& z, const Vector& across) {
    const auto b = bordered(z, across);
    if (!b) return std::nullopt;
    Vector t = b->lu.solve(Vector(b->rows[size_ - 1] * Vector::Unit(size_, size_ - 1)));
    t /= weighed(t).norm();
    if (!t.allFinite()) return std::nullopt;
    const auto own = bordered(z, weighed(t));
    return own ? std::optional(OnCurve{z, t, is_positive(*own)}) : std::nullopt;
  }

  /// The place of the curve so far along the tangent.
  std::optional<OnCurve> ahead(const OnCurve& from, double step) {
    const Vector across = weighed(from.tangent);
    Vector z = from.z + step * from.tangent;
    double before = HUGE_VAL;
    for (int k = 0; k < most_corrections; ++k) {
      const auto b = bordered(z, across);
      if (!b) return std::nullopt;
      Vector off(size_);
      off << forces(z), across.dot(z - from.z) - step;
      const Vector move = b->lu.solve(Vector(b->rows.cwiseProduct(off)));
      const double length = weighed(move).norm();
      if (!(length < before || length < at_rounding)) return std::nullopt;
      z -= move;
      if (length < converged || (length < at_rounding && length > before / 4)) return with_tangent(z, across);
      before = length;
    }
    return std::nullopt;
  }

  /// The tangent has a part along the parameter at `from`, and one against it a step ahead.
  std::optional<TurningPoint> located(const OnCurve& from, const OnCurve& next, double step) {
    if (from.regular_side != next.regular_side) return std::nullopt;
    double low = 0, high = step;
    OnCurve at = next;
    for (int k = 0; k < most_halvings && high - low > 1e-16 * step; ++k) {
      const auto middle = ahead(from, (low + high) / 2);
      if (!middle) return std::nullopt;
      at = *middle;
      (at.tangent[size_ - 1] > 0 ? low : high) = (low + high) / 2;
    }
    if (std::abs(at.tangent[size_ - 1]) > level) return std::nullopt;
    for (Index i = 0; i < n_; ++i)
      if (std::abs(at.z[i]) < converged) at.z[i] = 0;
    return TurningPoint{value_of(at.z), rest_of(at.z)};
  }

  PointEquations::Impl& e_;
  const BranchEnd& end_;
  Index n_, m_, pins_, size_;
};

}  // namespace

std::optional<TurningPoint> turning_point(PointEquations::Impl& equations, const BranchEnd& end) {
  const bool is_plain = equations.holonomic == equations.m && equations.relations.kernel.size() == 0;
  return is_plain ? RestCurve(equations, end).turning() : std::nullopt;
}

}  // namespace maupertuis

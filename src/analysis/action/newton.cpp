#include "analysis/action/newton.hpp"

#include <eigen3/Eigen/SparseLU>

#include <algorithm>
#include <cmath>

namespace maupertuis::action {
namespace {

constexpr double converged_to = 1e-12;   // of a correction: the next one would be at rounding
constexpr double rounding_level = 1e-9;  // a correction that does not shrink any more, below which it is rounding
constexpr double balanced = 2e-14;       // of the gradient against its terms: nothing is left but rounding
constexpr double only_rounding = 4e-15;  // of the gradient against what it is the sum of: S tells nothing more
constexpr double shift =
    1e-12;  // of the kinetic norm: a direction in which S does not change gets no step from rounding alone
constexpr double short_step = 1e-3;   // of the scale: a correction that short is judged by the gradient as well
constexpr double much_better = 1e-2;  // of the gradient that was left
constexpr double least_damping = 1e-4;
constexpr double longest_step = 3;  // in units of the scale, to begin with
constexpr double as_linear = 0.9,
                 wider = 4;  // a step after which so much of its share is gone allows one so much longer

struct Iteration {
  Functional& functional;
  Trial& trial;
  const FixedEnds& fixed;
  Matrix scale;
  Eigen::SparseLU<Sparse> lu;
  Directions directions;
  Vector step;         // [n nodes]
  Vector multipliers;  // [k] change of λ
  Vector reduced;      // the unknowns of the step
  Vector row_sizes;    // of the matrix: what a gradient is measured against
  double imbalance = 0;
  bool is_rounding = false;  // the gradient, of plain paths: a large p that is all but constant leaves nothing else

  Index k() const { return functional.integrals(); }

  bool factor_and_solve() {
    const Assembly a = assemble(functional, trial, 2);
    is_rounding = false;
    if (!a.finite) return false;
    directions = directions_of(functional, trial, fixed, scale, a.gradient);
    Assembly shifted = a;
    for (std::size_t e = 0; e < a.hessians.size(); ++e) shifted.hessians[e] += shift * a.kinetic[e];
    const Sparse matrix = reduced_matrix(functional, trial, shifted, directions);
    row_sizes = Vector::Zero(matrix.rows());
    for (int c = 0; c < matrix.outerSize(); ++c)
      for (Sparse::InnerIterator entry(matrix, c); entry; ++entry) row_sizes[entry.row()] += std::abs(entry.value());
    const bool plain = functional.constraints() == 0 && k() == 0 && !functional.orders().higher();
    is_rounding = plain && is_rounding_of(a);
    lu.compute(matrix);
    if (lu.info() != Eigen::Success) return false;
    Vector gradient = a.gradient;
    if (functional.constraints() > 0) gradient += hessian_times(a, directions.normal);
    if (!solve(gradient, a.integrals + a.integral_gradients.transpose() * directions.normal, directions.normal))
      return false;
    widen_scale();
    return true;
  }

  /// Of p in its sum, or of the nodes in p.
  bool is_rounding_of(const Assembly& a) const {
    for (Index node = 0; node < directions.nodes(); ++node) {
      const Matrix& z = directions.basis[static_cast<std::size_t>(node)];
      const Vector left = z.transpose() * a.gradient.segment(node * z.rows(), z.rows()),
                   terms = z.cwiseAbs().transpose() * a.gradient_terms.segment(node * z.rows(), z.rows()),
                   rows = row_sizes.segment(directions.first[static_cast<std::size_t>(node)], z.cols());
      if ((left.cwiseAbs().array() > only_rounding * terms.array() + balanced * rows.array()).any()) return false;
    }
    return true;
  }

  /// v and p of L with q'' follow from q, so that they are as large as a step makes them, whatever they were before.
  void widen_scale() {
    const Eigen::Map<const Matrix> moved(step.data(), scale.rows(), scale.cols());
    for (const std::vector<Index>* rows : {&functional.orders().rates_of_others, &functional.orders().momenta})
      for (const Index i : *rows) {
        const double largest = (trial.q.row(i) + moved.row(i)).cwiseAbs().maxCoeff();
        scale.row(i) = scale.row(i).cwiseMax(largest);
      }
  }

  /// The Hessian of S + Σ μ φ times a vector over all nodes.
  Vector hessian_times(const Assembly& a, const Vector& x) {
    Vector out = Vector::Zero(x.size());
    const Index n = trial.q.rows(), p = trial.mesh.rule->degree;
    for (Index e = 0; e < trial.mesh.elements(); ++e)
      for (Index j = 0; j <= p; ++j)
        for (Index l = 0; l <= p; ++l)
          out.segment(trial.mesh.node(e, j) * n, n) +=
              a.hessians[static_cast<std::size_t>(e)].block(j * n, l * n, n, n) *
              x.segment(trial.mesh.node(e, l) * n, n);
    for (Index node = 0; node < trial.mesh.nodes(); ++node)
      out.segment(node * n, n) += functional.constraint_curvature(trial.mesh.time(node), trial.q.col(node),
                                                                  directions.mu[static_cast<std::size_t>(node)]) *
                                  x.segment(node * n, n);
    return out;
  }

  bool solve(const Vector& gradient, const Vector& integrals, const Vector& normal) {
    const Vector right = -directions.reduce(gradient);
    Vector all(right.size() + k());
    all << right, functional.wanted() - integrals;
    imbalance = 0;
    for (Index i = 0; i < all.size(); ++i)
      imbalance = std::max(imbalance, std::abs(all[i]) / std::max(row_sizes[i], 1e-300));
    const Vector out = all.size() > 0 ? Vector(lu.solve(all)) : all;
    if (!out.allFinite()) return false;
    reduced = out.head(right.size());
    multipliers = out.tail(k());
    step = normal + directions.expand(reduced);
    return true;
  }

  double length() const {
    double out = 0;
    for (Index i = 0; i < step.size(); ++i) out = std::max(out, std::abs(step[i]) / scale.data()[i]);
    return out;
  }
  /// Root mean square: what the monotonicity test compares.
  double norm() const {
    return std::sqrt(step.cwiseQuotient(Eigen::Map<const Vector>(scale.data(), scale.size())).squaredNorm() /
                     static_cast<double>(std::max<Index>(1, step.size())));
  }

  /// The correction that the old factorization gives at the path as it is now.
  bool simplified() {
    const Assembly a = assemble(functional, trial, 1);
    if (!a.finite) return false;
    Vector gradient = a.gradient;
    Vector normal = Vector::Zero(gradient.size());
    if (functional.constraints() > 0) {
      const Directions here = directions_of(functional, trial, fixed, scale, a.gradient);
      gradient = with_reactions(functional, trial, here, gradient);
      normal = here.normal;
    }
    return solve(gradient, a.integrals, normal);
  }
};

}  // namespace

Matrix even_scale(const Trial& trial, const Vector& least) {
  Vector size = trial.q.rowwise().maxCoeff() - trial.q.rowwise().minCoeff();
  size = size.cwiseMax(least);
  return size.replicate(1, trial.q.cols());
}

Matrix scale_of_found(const Trial& trial, const Vector& least, const OrderOfCoordinates& orders) {
  Matrix out = even_scale(trial, least);
  for (const Index p : orders.momenta) out.row(p) = out.row(p).cwiseMax(trial.q.row(p).cwiseAbs().maxCoeff());
  return out;
}

Matrix path_scale(const Trial& trial, const Vector& least) {
  Matrix out = even_scale(trial, least);
  const auto limit = [&](Index end) {
    for (Index k = 0; k < trial.q.cols(); ++k)
      for (Index i = 0; i < trial.q.rows(); ++i) {
        const double distance = std::abs(trial.q(i, k) - trial.q(i, end));
        if (k != end && distance > 0) out(i, k) = std::min(out(i, k), distance);
      }
  };
  const Pace pace = trial.mesh.pace;
  if (pace == Pace::SlowStart || pace == Pace::SlowEnds) limit(0);
  if (pace == Pace::SlowEnd || pace == Pace::SlowEnds) limit(trial.q.cols() - 1);
  return out;
}

NewtonResult solve_stationarity(Functional& functional, Trial& trial, const FixedEnds& fixed, const Matrix& scale,
                                const NewtonOptions& options) {
  NewtonResult out;
  Iteration it{functional, trial, fixed, scale, {}, {}, {}, {}, {}, {}, 0};
  double damping = 1, before = HUGE_VAL, longest = longest_step;
  for (out.iterations = 0; out.iterations < options.most_iterations; ++out.iterations) {
    if (options.interrupt && options.interrupt->load()) return out;
    if (!it.factor_and_solve()) return out.converged = it.is_rounding, out;
    const Vector step = it.step, multipliers = it.multipliers;
    const double length = it.length(), norm = it.norm(), imbalance = it.imbalance;
    const Matrix q = trial.q;
    const Vector lambda = trial.multipliers;
    const auto move = [&](double by) {
      trial.q = q + by * Eigen::Map<const Matrix>(step.data(), q.rows(), q.cols());
      trial.multipliers = lambda + by * multipliers;
    };
    out.correction = length;
    if (length <= rounding_level && length >= 0.25 * before) return out.converged = true, out;
    // Stationary, and degenerate: the step is rounding. Off the constraints the gradient along them tells nothing.
    if (it.imbalance <= balanced && it.directions.off <= rounding_level && length > rounding_level) {
      out.correction = it.imbalance;
      return out.converged = true, out;
    }
    // Where p hardly depends on q', as at speeds near that of light, any path looks stationary to S in 16 digits: the
    // motion that is carried along it is what tells.
    if (it.is_rounding && length > rounding_level) {
      out.correction = 0;
      return out.converged = true, out;
    }
    if (length <= converged_to) {
      move(1);
      return out.converged = true, out;
    }
    damping = std::min({1.0, 4 * damping, longest / length});
    for (;; damping /= 2) {
      if (damping < least_damping) return out;
      move(damping);
      if (!it.simplified()) continue;
      if (it.norm() <= (1 - damping / 4) * norm || (damping == 1 && length < rounding_level)) break;
      // Where S is nearly flat along a direction, as along shifts of a kink, rounding of the gradient is a correction
      // that does not shrink.
      if (damping == 1 && length < short_step && it.imbalance <= much_better * imbalance) break;
    }
    if (it.norm() <= (1 - as_linear * damping) * norm) longest *= wider;
    before = damping == 1 ? length : HUGE_VAL;
  }
  return out;
}

}  // namespace maupertuis::action

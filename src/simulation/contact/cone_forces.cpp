#include "simulation/contact/cone_forces.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double converged = 1e-10;

/// Projections in place of inclusions: λ_n = [λ_n − ρ a_n]₊ and λ_t = P(λ_t − ρ a_t), P onto the disk of radius μ λ_n.
class Projections {
 public:
  explicit Projections(const ConeProblem& p) : p_(p) {
    Index next = 0;
    for (const auto& c : p.contacts) {
      first_.push_back(next);
      next += 1 + c.tangents;
    }
    for (std::size_t c = 0; c < p.contacts.size(); ++c) {
      double largest = 0;
      for (Index i = first_[c]; i <= first_[c] + p.contacts[c].tangents; ++i)
        largest = std::max(largest, p.response(i, i));
      step_.push_back(largest > 0 ? 1 / largest : 1);
    }
  }

  /// x less its projections: 0 at a solution.
  VectorXd residual(const VectorXd& x) const {
    const VectorXd a = p_.free + p_.response * x;
    VectorXd out(x.size());
    for (std::size_t c = 0; c < first_.size(); ++c) out.segment(first_[c], 1 + p_.contacts[c].tangents) = off(c, x, a);
    return out;
  }

  /// One contact after the other, the others as they are.
  VectorXd gauss_seidel(int turns) const {
    VectorXd x = VectorXd::Zero(p_.free.size());
    for (int turn = 0; turn < turns; ++turn)
      for (std::size_t c = 0; c < first_.size(); ++c)
        for (int inner = 0; inner < 4; ++inner)
          x.segment(first_[c], 1 + p_.contacts[c].tangents) -= off(c, x, p_.free + p_.response * x);
    return x;
  }

  /// The slope of the residual, one of those that it has at a kink.
  MatrixXd slope(const VectorXd& x) const {
    const VectorXd a = p_.free + p_.response * x;
    MatrixXd out = MatrixXd::Zero(x.size(), x.size());
    for (std::size_t c = 0; c < first_.size(); ++c) slope(c, x, a, out);
    return out;
  }

 private:
  VectorXd off(std::size_t c, const VectorXd& x, const VectorXd& a) const {
    const Index n = first_[c], count = p_.contacts[c].tangents;
    const double normal = std::max(0.0, x(n) - step_[c] * a(n)), most = p_.contacts[c].friction * normal;
    VectorXd t = x.segment(n + 1, count) - step_[c] * a.segment(n + 1, count);
    const double size = t.norm();
    if (size > most) t *= most / size;
    VectorXd out(1 + count);
    out(0) = x(n) - normal;
    out.tail(count) = x.segment(n + 1, count) - t;
    return out;
  }

  void slope(std::size_t c, const VectorXd& x, const VectorXd& a, MatrixXd& out) const {
    const Index n = first_[c], count = p_.contacts[c].tangents, all = x.size();
    const double rho = step_[c], mu = p_.contacts[c].friction;
    Eigen::RowVectorXd normal = Eigen::RowVectorXd::Zero(all);  // of [λ_n − ρ a_n]₊
    if (x(n) - rho * a(n) > 0) {
      normal = -rho * p_.response.row(n);
      normal(n) += 1;
    }
    out.row(n) = -normal;
    out(n, n) += 1;
    if (count == 0) return;
    const VectorXd t = x.segment(n + 1, count) - rho * a.segment(n + 1, count);
    MatrixXd t_slope = -rho * p_.response.middleRows(n + 1, count);
    for (Index k = 0; k < count; ++k) t_slope(k, n + 1 + k) += 1;
    const double most = mu * std::max(0.0, x(n) - rho * a(n)), size = t.norm();
    MatrixXd projected = t_slope;
    if (size > most) {
      const VectorXd along = t / size;
      projected = mu * along * normal + most / size * (t_slope - along * (along.transpose() * t_slope));
    }
    out.middleRows(n + 1, count) = -projected;
    for (Index k = 0; k < count; ++k) out(n + 1 + k, n + 1 + k) += 1;
  }

  const ConeProblem& p_;
  std::vector<Index> first_;  // [contacts] where each begins
  std::vector<double> step_;  // [contacts] ρ
};

}  // namespace

namespace {

/// The best of the points that Newton's steps come to, each step halved until the residual falls (`damped`) or whole:
/// next to forces at the limit of friction that nothing determines along it, steps that must descend are too short.
VectorXd newton(const Projections& projections, VectorXd x, bool damped) {
  constexpr int turns = 60, most_halvings = 30;
  VectorXd off = projections.residual(x), best = x;
  double least = off.norm();
  for (int turn = 0; turn < turns && least > 1e-15 * (1e-300 + x.norm()); ++turn) {
    VectorXd change = Eigen::CompleteOrthogonalDecomposition<MatrixXd>(projections.slope(x)).solve(off);
    VectorXd next = x - change, next_off = projections.residual(next);
    for (int halving = 1; damped && halving < most_halvings && !(next_off.norm() < off.norm()); ++halving) {
      change *= 0.5;
      next = x - change;
      next_off = projections.residual(next);
    }
    if (!next_off.allFinite() || (damped && !(next_off.norm() < off.norm()))) break;
    x = next, off = next_off;
    if (off.norm() < least) best = x, least = off.norm();
  }
  return best;
}

double residual_of(const Projections& projections, const VectorXd& x) {
  const double size = x.cwiseAbs().maxCoeff(), off = projections.residual(x).cwiseAbs().maxCoeff();
  return size > 0 ? off / size : off;
}

}  // namespace

std::optional<ConeForces> cone_forces(const ConeProblem& problem) {
  const Projections projections(problem);
  constexpr int first_turns = 60;
  const VectorXd begin = projections.gauss_seidel(first_turns);
  VectorXd x = newton(projections, begin, true);
  if (!(residual_of(projections, x) <= converged)) x = newton(projections, begin, false);
  ConeForces out;
  out.forces = x;
  out.accelerations = problem.free + problem.response * x;
  out.residual = residual_of(projections, x);
  if (!(out.residual <= converged)) return std::nullopt;
  return out;
}

}  // namespace maupertuis

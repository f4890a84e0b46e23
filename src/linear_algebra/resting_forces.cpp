#include "linear_algebra/resting_forces.hpp"

#include "linear_algebra/least_distance.hpp"
#include "linear_algebra/non_negative_least_squares.hpp"
#include "linear_algebra/products.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double dependent = 1e-10;
constexpr double rounding_of_forces = 1e-13;
constexpr Index few = 24;  // forces, of which the ones next to the least are sought

/// Forces of an undetermined rest: λ = λ_0 + N c with the solutions N of W N = 0.
class UndeterminedRest {
 public:
  explicit UndeterminedRest(const ConeProblem& p) : p_(p) {
    Index n = 0;
    for (const auto& c : p.contacts) first_.push_back(n), n += 1 + c.tangents;
    limited_ = n;
    n = p.free.size();
    solver_.setThreshold(dependent);
    solver_.compute(p.response);
    least_ = solver_.solve(VectorXd(-p.free));
    const MatrixXd basis = columns_of_q(solver_, solver_.rank());
    few_rows_ = {transposed_product(basis, p.response), -(basis.transpose() * p.free)};
  }

  /// Whether nothing accelerates under some forces, be they in their cones or not.
  bool exists() const {
    const VectorXd off = p_.free + p_.response * least_;
    return off.cwiseAbs().maxCoeff() <= dependent * p_.free.cwiseAbs().maxCoeff();
  }

  /// In the plane cones have two edges: forces are sums of parts along these that are not negative.
  bool has_edges() const {
    return std::all_of(p_.contacts.begin(), p_.contacts.end(), [](const auto& c) { return c.tangents < 2; });
  }
  bool is_large() const { return p_.free.size() > few; }

  std::optional<VectorXd> along_edges(double margin) const;
  std::optional<VectorXd> shortest_in_cones(double margin) const;
  std::optional<VectorXd> between_planes(double margin);

 private:
  struct Plane {
    Index normal;    // of the force that limits it; −1: a limit of its own
    Index first;     // of the friction
    double limit;    // μ, or that limit
    VectorXd along;  // [tangents] u; empty: λ_n ≥ 0
  };
  void begin_planes();
  void touch(std::size_t contact, const VectorXd& along) {
    planes_.push_back({first_[contact], first_[contact] + 1, p_.contacts[contact].friction, along});
  }
  std::optional<VectorXd> shortest(double part) const;

  const ConeProblem& p_;
  struct Rows {
    MatrixXd b;  // B [rank × forces]
    VectorXd right;
  } few_rows_;  // B λ = right says what W λ = −free does
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver_;
  VectorXd least_;
  MatrixXd free_;             // N
  std::vector<Index> first_;  // [contacts] where each begins
  Index limited_ = 0;         // where frictions without contacts begin
  std::vector<Plane> planes_;
};

/// Σ_k α_k r_k with α ≥ 0, r_k = e_n ± μ e_t for each contact, and ±L e_t with α₊ + α₋ + rest = 1 for each limit, that
/// meets the independent rows of W λ = −free. Non-negative least squares takes no more edges than there are rows.
std::optional<VectorXd> UndeterminedRest::along_edges(double margin) const {
  struct Edge {
    Index normal, along;  // −1: none
    double force;
    Index limit;  // −1: none
  };
  std::vector<Edge> edges;
  for (std::size_t c = 0; c < first_.size(); ++c) {
    const Index n = first_[c];
    const double most = (1 - margin) * p_.contacts[c].friction;
    if (p_.contacts[c].tangents == 0 || most == 0) edges.push_back({n, -1, 0, -1});
    if (p_.contacts[c].tangents == 0 || most == 0) continue;
    for (const double side : {1.0, -1.0}) edges.push_back({n, n + 1, side * most, -1});
  }
  const Index limits = p_.free.size() - limited_;
  for (Index k = 0; k < limits; ++k) {
    const double most = (1 - margin) * p_.limits[static_cast<std::size_t>(k)];
    for (const double side : {1.0, -1.0}) edges.push_back({-1, limited_ + k, side * most, k});
    edges.push_back({-1, -1, 0, k});
  }
  const auto& [rows, right] = few_rows_;
  const Index rank = rows.rows();
  const double size = std::max(right.norm(), 1e-300);
  MatrixXd columns = MatrixXd::Zero(rank + limits, static_cast<Index>(edges.size()));
  VectorXd wanted = VectorXd::Zero(rank + limits), scale(columns.cols());
  wanted.head(rank) = right / size;
  wanted.tail(limits).setOnes();
  for (Index k = 0; k < columns.cols(); ++k) {
    const Edge& e = edges[static_cast<std::size_t>(k)];
    auto column = columns.col(k);
    if (e.normal >= 0) column.head(rank) += rows.col(e.normal);
    if (e.along >= 0) column.head(rank) += e.force * rows.col(e.along);
    if (e.limit >= 0) column(rank + e.limit) = size;
    column /= size;
    scale(k) = column.norm() > 0 ? column.norm() : 1;
    column /= scale(k);
  }
  const VectorXd parts = non_negative_least_squares(columns, wanted);
  if (!((columns * parts - wanted).cwiseAbs().maxCoeff() <= rounding_of_forces)) return std::nullopt;
  VectorXd out = VectorXd::Zero(p_.free.size());
  for (Index k = 0; k < columns.cols(); ++k) {
    const Edge& e = edges[static_cast<std::size_t>(k)];
    if (e.normal >= 0) out(e.normal) += parts(k) / scale(k);
    if (e.along >= 0) out(e.along) += e.force * parts(k) / scale(k);
  }
  return out;
}

/// The point of a convex set next to z, and the slope of that.
struct Projection {
  VectorXd point;
  MatrixXd slope;  // of the same size as z, blocks on its diagonal
};

/// Of z onto the cones and limits in the plane, friction with the part `part` of its limits.
Projection project(const ConeProblem& p, const VectorXd& z, double part) {
  Projection out{VectorXd::Zero(z.size()), MatrixXd::Zero(z.size(), z.size())};
  const auto onto = [&](Index first, const VectorXd& along) {  // a ray
    const double share = along.dot(z.segment(first, along.size())) / along.squaredNorm();
    if (!(share > 0)) return;
    out.point.segment(first, along.size()) = share * along;
    out.slope.block(first, first, along.size(), along.size()) = along * along.transpose() / along.squaredNorm();
  };
  Index n = 0;
  for (const auto& c : p.contacts) {
    const double most = part * c.friction;
    if (c.tangents == 0 || most == 0) {
      onto(n, VectorXd::Ones(1));
    } else if (std::abs(z(n + 1)) <= most * z(n)) {
      out.point.segment(n, 2) = z.segment(n, 2);
      out.slope.block(n, n, 2, 2).setIdentity();
    } else {
      onto(n, Eigen::Vector2d(1, std::copysign(most, z(n + 1))));
    }
    n += 1 + c.tangents;
  }
  for (const double limit : p.limits) {
    out.point(n) = std::clamp(z(n), -part * limit, part * limit);
    out.slope(n, n) = std::abs(z(n)) < part * limit ? 1 : 0;
    ++n;
  }
  return out;
}

/// The least forces in the plane: with as many unknowns y as W has independent rows B, B λ = b, they are the point of
/// the cones next to Bᵀ y for the y at which z·λ − ½ λ² − b·y is least, a convex function. By Newton's steps, which end
/// where no force changes its side any more; nothing where they do not.
std::optional<VectorXd> UndeterminedRest::shortest_in_cones(double margin) const {
  constexpr int most_turns = 100, most_halvings = 40;
  // No structured binding: clang 14 refuses those in lambdas.
  const MatrixXd& rows = few_rows_.b;
  const VectorXd& right = few_rows_.right;
  const auto value = [&](const VectorXd& z, const VectorXd& point, const VectorXd& y) {
    return z.dot(point) - 0.5 * point.squaredNorm() - right.dot(y);
  };
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver;
  VectorXd y = solver.compute(product_transposed(rows, rows)).solve(right);
  Projection now = project(p_, rows.transpose() * y, 1 - margin);
  for (int turn = 0; turn < most_turns; ++turn) {
    const VectorXd off = rows * now.point - right;
    if (off.norm() <= rounding_of_forces * right.norm()) return now.point;
    VectorXd by = solver.compute(product_transposed(product(rows, now.slope), rows)).solve(VectorXd(-off));
    const double here = value(rows.transpose() * y, now.point, y), falls = off.dot(by);
    if (!(falls < 0)) return std::nullopt;
    for (int halving = 0; halving < most_halvings; ++halving, by *= 0.5) {
      const VectorXd z = rows.transpose() * (y + by);
      now = project(p_, z, 1 - margin);
      if (value(z, now.point, y + by) <= here + 1e-4 * off.dot(by)) break;
    }
    y += by;
  }
  return std::nullopt;
}

void UndeterminedRest::begin_planes() {
  free_ = null_space(solver_);
  for (std::size_t c = 0; c < first_.size(); ++c) {
    const Index tangents = p_.contacts[c].tangents;
    touch(c, VectorXd());
    for (Index k = 0; k < tangents; ++k)
      for (const double side : {1.0, -1.0}) touch(c, side * VectorXd::Unit(tangents, k));
  }
  for (std::size_t k = 0; k < p_.limits.size(); ++k)
    for (const double side : {1.0, -1.0})
      planes_.push_back({-1, limited_ + static_cast<Index>(k), p_.limits[k], VectorXd::Constant(1, side)});
}

/// c is the shortest that keeps planes. A cone is told by planes that touch it, λ_n ≥ 0 and part μ λ_n ≥ u·λ_t for unit
/// vectors u, more of them where a solution lies outside (J. E. Kelley, J. Soc. Ind. Appl. Math. 8 (1960) 703).
std::optional<VectorXd> UndeterminedRest::between_planes(double margin) {
  constexpr int most_turns = 30;
  if (planes_.empty()) begin_planes();
  for (int turn = 0; turn < most_turns; ++turn) {
    const auto x = shortest(1 - margin);
    if (!x) return std::nullopt;
    bool is_inside = true;
    for (std::size_t c = 0; c < first_.size(); ++c) {
      const VectorXd t = x->segment(first_[c] + 1, p_.contacts[c].tangents);
      const double most = (1 - 0.9 * margin) * p_.contacts[c].friction * (*x)(first_[c]);
      if (!(t.norm() > most + rounding_of_forces * x->cwiseAbs().maxCoeff()))
        continue;                                             // all may be at the tip of a cone
      if (p_.contacts[c].tangents == 1) return std::nullopt;  // its planes are there: rounding
      is_inside = false;
      touch(c, t.normalized());
    }
    if (is_inside) return x;
  }
  return std::nullopt;
}

std::optional<VectorXd> UndeterminedRest::shortest(double part) const {
  MatrixXd rows = MatrixXd::Zero(static_cast<Index>(planes_.size()), p_.free.size());
  VectorXd least = VectorXd::Zero(rows.rows());
  for (Index k = 0; k < rows.rows(); ++k) {
    const Plane& plane = planes_[static_cast<std::size_t>(k)];
    const bool is_normal = plane.along.size() == 0;
    if (plane.normal >= 0)
      rows(k, plane.normal) = is_normal ? 1 : part * plane.limit;
    else
      least(k) = -part * plane.limit;
    rows.row(k).segment(plane.first, plane.along.size()) = -plane.along.transpose();
    const double size = rows.row(k).norm();
    rows.row(k) /= size;
    least(k) /= size;
  }
  const auto c = least_distance(rows * free_, least - rows * least_);
  return c ? std::optional(VectorXd(least_ + free_ * *c)) : std::nullopt;
}

/// Of many contacts in the plane: half of the margin is left to what the forces next to the least ones need.
std::optional<VectorXd> many_forces(const UndeterminedRest& rest, double margin) {
  const auto found = rest.along_edges(margin);
  if (!found) return std::nullopt;
  const auto least = rest.shortest_in_cones(0.5 * margin);
  return least ? least : found;
}

}  // namespace

std::optional<VectorXd> resting_forces(const ConeProblem& problem, double least_margin) {
  if (problem.free.size() == 0) return std::nullopt;
  UndeterminedRest rest(problem);
  if (!rest.exists()) return std::nullopt;
  const bool are_many = rest.is_large() && rest.has_edges();
  for (double margin = 0.5; margin >= least_margin; margin *= 0.25)
    if (auto found = are_many ? many_forces(rest, margin) : rest.between_planes(margin)) return found;
  return std::nullopt;
}

}  // namespace maupertuis

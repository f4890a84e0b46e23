#include "simulation/contact/impact_derivative.hpp"

#include "linear_algebra/plane_impulse.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/transform.hpp>

#include <cmath>
#include <memory>

namespace maupertuis {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Functions of q, q̇, t in numbers with their derivatives by all of these.
struct ImpactDerivative::Compiled {
  Compiled(const MechanicalSystem& system, std::span<const double> parameters, const ExprVector& outputs)
      : kernel(build_differentiable(function_of_motion(system, outputs))), work(kernel.values_and_entries) {
    work.set_parameters(parameters);
    out.resize(kernel.values_and_entries.outputs());
  }

  void evaluate(const At& at) {
    std::vector<double> point(at.q.begin(), at.q.end());
    point.insert(point.end(), at.v.begin(), at.v.end());
    point.push_back(at.t);
    work.evaluate(point, out);
  }
  double value(Index row) const { return out[static_cast<std::size_t>(row)]; }
  /// ∂ outputs / ∂(q, q̇, t)
  MatrixXd slopes() const {
    MatrixXd found = MatrixXd::Zero(static_cast<Index>(kernel.size()), static_cast<Index>(kernel.values.inputs()));
    for (std::size_t k = 0; k < kernel.entries.size(); ++k)
      found(static_cast<Index>(kernel.entries[k].row), static_cast<Index>(kernel.entries[k].column)) =
          out[kernel.size() + k];
    return found;
  }

  DifferentiableKernel kernel;
  FunctionWorkspace work;
  std::vector<double> out;
};

/// K = [M Aᵀ; A 0], factored, and its change along each direction.
struct ImpactDerivative::Parts {
  Eigen::FullPivLU<MatrixXd> bordered;
  std::vector<MatrixXd> slopes;  // [2n + 1]; empty where K does not change along it
};

/// x of M x = row, A x = 0, and its change along each direction.
struct ImpactDerivative::Response {
  VectorXd x;       // [n]
  MatrixXd slopes;  // [n × (2n + 1)]
};

struct ImpactDerivative::ContactParts {
  VectorXd normal, tangent;                // ∂g/∂q, ∂v_t/∂q̇
  MatrixXd normal_slopes, tangent_slopes;  // [n × (2n + 1)]
  std::vector<Dual> drive, slip_rest, e, friction,
      static_friction;  // [2n + 1], each with its change along that direction
};

namespace {

/// G [n], ∂g/∂t, e; then ∂v_t/∂q̇ [n], what v_t has besides ∂v_t/∂q̇ q̇, μ, μ_s.
ExprVector functions_of_impact(const MechanicalSystem& system, const Contact& contact) {
  const auto plain = [&](Expr e) { return expand_time_derivatives(in_terms_of_motion(system, {&e, 1})).front(); };
  const Friction& f = contact.friction;
  ExprVector out;
  const Expr gap = plain(contact.gap);
  for (const Coordinate& c : system.coordinates) out.push_back(differentiate(gap, c.q));
  out.push_back(differentiate(gap, system.context->time()));
  out.push_back(plain(contact.restitution));
  if (!f.present()) return out;
  const Expr slip = plain(f.slip[0]);
  ExprMap at_rest;
  for (const Coordinate& c : system.coordinates) at_rest.emplace(c.velocity, system.context->number(0));
  for (const Coordinate& c : system.coordinates) out.push_back(differentiate(slip, c.velocity));
  out.push_back(substitute(slip, at_rest));
  out.push_back(plain(f.kinetic));
  out.push_back(plain(f.static_));
  return out;
}

std::vector<Dual> duals(double value, const MatrixXd& slopes, Index row) {
  std::vector<Dual> out;
  for (Index j = 0; j < slopes.cols(); ++j) out.emplace_back(value, slopes(row, j));
  return out;
}

Dual dual_product(const VectorXd& a, const VectorXd& a_slope, const VectorXd& b, const VectorXd& b_slope) {
  return {a.dot(b), a_slope.dot(b) + a.dot(b_slope)};
}

VectorXd column_of(std::span<const double> x) {
  return Eigen::Map<const VectorXd>(x.data(), static_cast<Index>(x.size()));
}

/// The change of q̇ itself along a direction.
VectorXd unit_velocity(Index n, Index direction) {
  VectorXd out = VectorXd::Zero(n);
  if (direction >= n && direction < 2 * n) out(direction - n) = 1;
  return out;
}

}  // namespace

ImpactDerivative::ImpactDerivative(const EquationsOfMotion& equations, std::span<const double> parameters)
    : equations_(equations),
      parameters_(parameters.begin(), parameters.end()),
      n_(static_cast<Index>(equations.system->coordinates.size())),
      m_(static_cast<Index>(equations.system->constraints.size())) {
  const MechanicalSystem& system = *equations.system;
  ExprVector entries = mass_matrix(equations).entries;
  const ExprMatrix a = constraint_matrix(equations);
  entries.insert(entries.end(), a.entries.begin(), a.entries.end());
  matrices_ = std::make_unique<Compiled>(system, parameters_, entries);
}

ImpactDerivative::~ImpactDerivative() = default;

const ImpactDerivative::Parts& ImpactDerivative::matrices_at(const At& at) {
  matrices_->evaluate(at);
  const MatrixXd slopes = matrices_->slopes();
  const auto bordered = [&](const auto& entry) {
    MatrixXd k = MatrixXd::Zero(n_ + m_, n_ + m_);
    for (Index i = 0; i < n_; ++i)
      for (Index j = 0; j < n_; ++j) k(i, j) = entry(i * n_ + j);
    for (Index c = 0; c < m_; ++c)
      for (Index j = 0; j < n_; ++j) k(n_ + c, j) = k(j, n_ + c) = entry((n_ + c) * n_ + j);
    return k;
  };
  parts_ = std::make_unique<Parts>(
      Parts{Eigen::FullPivLU<MatrixXd>(bordered([&](Index k) { return matrices_->value(k); })), {}});
  for (Index j = 0; j < slopes.cols(); ++j)
    parts_->slopes.push_back(slopes.col(j).isZero(0) ? MatrixXd() : bordered([&](Index k) { return slopes(k, j); }));
  return *parts_;
}

ImpactDerivative::ContactParts ImpactDerivative::parts_at(std::size_t contact, const At& at) {
  const MechanicalSystem& system = *equations_.system;
  std::unique_ptr<Compiled>& compiled = contacts_[contact];
  if (!compiled)
    compiled = std::make_unique<Compiled>(system, parameters_, functions_of_impact(system, system.contacts[contact]));
  Compiled& c = *compiled;
  c.evaluate(at);
  const MatrixXd slopes = c.slopes();
  const bool rubs = slopes.rows() > n_ + 2;
  const auto vector = [&](Index first) {
    VectorXd out(n_);
    for (Index i = 0; i < n_; ++i) out(i) = c.value(first + i);
    return out;
  };
  ContactParts out;
  out.normal = vector(0);
  out.normal_slopes = slopes.topRows(n_);
  out.drive = duals(c.value(n_), slopes, n_);
  out.e =
      at.plastic ? std::vector<Dual>(static_cast<std::size_t>(slopes.cols())) : duals(c.value(n_ + 1), slopes, n_ + 1);
  if (!rubs) return out;
  out.tangent = vector(n_ + 2);
  out.tangent_slopes = slopes.middleRows(n_ + 2, n_);
  out.slip_rest = duals(c.value(2 * n_ + 2), slopes, 2 * n_ + 2);
  out.friction = duals(c.value(2 * n_ + 3), slopes, 2 * n_ + 3);
  out.static_friction = duals(c.value(2 * n_ + 4), slopes, 2 * n_ + 4);
  return out;
}

ImpactDerivative::Response ImpactDerivative::response(const Parts& matrices, const VectorXd& row,
                                                      const MatrixXd& row_slopes) const {
  VectorXd right = VectorXd::Zero(n_ + m_);
  right.head(n_) = row;
  const VectorXd x = matrices.bordered.solve(right);
  MatrixXd changes = MatrixXd::Zero(n_ + m_, row_slopes.cols());
  changes.topRows(n_) = row_slopes;
  for (Index j = 0; j < row_slopes.cols(); ++j)
    if (const MatrixXd& k = matrices.slopes[static_cast<std::size_t>(j)]; k.size() > 0) changes.col(j) -= k * x;
  const MatrixXd slopes = matrices.bordered.solve(changes);
  return {x.head(n_), slopes.topRows(n_)};
}

std::optional<MatrixXd> ImpactDerivative::one_impulse(std::size_t contact, const At& at) {
  const Parts& matrices = matrices_at(at);
  const ContactParts c = parts_at(contact, at);
  const Friction& friction = equations_.system->contacts[contact].friction;
  const bool rubs = c.tangent.size() > 0 &&
                    (friction.sticking || c.friction.front().value > 0 || c.static_friction.front().value > 0);
  const VectorXd v = column_of(at.v);
  const Response normal = response(matrices, c.normal, c.normal_slopes);
  const Response tangent = rubs ? response(matrices, c.tangent, c.tangent_slopes) : Response{};
  bool sticks = friction.sticking;
  if (rubs && !sticks) {
    double size = std::abs(c.slip_rest.front().value);
    for (Index i = 0; i < n_; ++i) size += std::abs(c.tangent(i) * v(i));
    const double slip = c.tangent.dot(v) + c.slip_rest.front().value;
    if (std::abs(slip) <= 1e-13 * size) {  // at rest: it holds, or neighbours part
      const double w_nt = c.normal.dot(tangent.x), w_tt = c.tangent.dot(tangent.x), w_nn = c.normal.dot(normal.x);
      if (!(std::abs(w_nt) <= 1e-13 * std::sqrt(w_nn * w_tt))) return std::nullopt;
      sticks = true;
    }
  }
  MatrixXd out(n_, 2 * n_ + 1);
  for (Index j = 0; j < out.cols(); ++j) {
    const auto k = static_cast<std::size_t>(j);
    const VectorXd dv = unit_velocity(n_, j), dg = c.normal_slopes.col(j), dx = normal.slopes.col(j);
    const Dual rate = dual_product(c.normal, dg, v, dv) + c.drive[k];
    const Dual w_nn = dual_product(c.normal, dg, normal.x, dx);
    if (!rubs) {
      const Dual impulse = -(Dual(1) + c.e[k]) * rate / w_nn;
      out.col(j) = dv + impulse.slope * normal.x + impulse.value * dx;
      continue;
    }
    const VectorXd dt = c.tangent_slopes.col(j), dy = tangent.slopes.col(j);
    const Dual slip = dual_product(c.tangent, dt, v, dv) + c.slip_rest[k];
    ImpulseCourse<Dual> course{w_nn,
                               dual_product(c.normal, dg, tangent.x, dy),
                               dual_product(c.tangent, dt, tangent.x, dy),
                               c.friction[k],
                               c.static_friction[k],
                               sticks,
                               rate,
                               slip};
    const ImpulseOf<Dual> impulse = impulse_in_plane(course, c.e[k]);
    out.col(j) = dv + impulse.normal.slope * normal.x + impulse.normal.value * dx +
                 impulse.tangential.slope * tangent.x + impulse.tangential.value * dy;
  }
  return out;
}

MatrixXd ImpactDerivative::at_once(std::span<const std::size_t> pressing, const At& at) {
  const Parts& matrices = matrices_at(at);
  const auto count = static_cast<Index>(pressing.size());
  const VectorXd v = column_of(at.v);
  std::vector<ContactParts> parts;
  std::vector<Response> responses;
  for (const std::size_t i : pressing) {
    parts.push_back(parts_at(i, at));
    responses.push_back(response(matrices, parts.back().normal, parts.back().normal_slopes));
  }
  const auto of = [](auto& list, Index i) -> auto& { return list[static_cast<std::size_t>(i)]; };
  MatrixXd w(count, count);
  VectorXd target(count);  // W Λ = −(1 + e) ġ⁻
  for (Index a = 0; a < count; ++a) {
    for (Index b = 0; b < count; ++b) w(a, b) = of(parts, a).normal.dot(of(responses, b).x);
    const double rate = of(parts, a).normal.dot(v) + of(parts, a).drive.front().value;
    target(a) = -(1 + (rate > 0 ? 0 : of(parts, a).e.front().value)) * rate;
  }
  const Eigen::FullPivLU<MatrixXd> lu(w);
  const VectorXd impulses = lu.solve(target);
  MatrixXd out(n_, 2 * n_ + 1);
  for (Index j = 0; j < out.cols(); ++j) {
    const auto k = static_cast<std::size_t>(j);
    const VectorXd dv = unit_velocity(n_, j);
    VectorXd change(count);
    for (Index a = 0; a < count; ++a) {
      const ContactParts& c = of(parts, a);
      const Dual rate = dual_product(c.normal, c.normal_slopes.col(j), v, dv) + c.drive[k];
      const Dual e = rate.value > 0 ? Dual(0) : c.e[k];
      change(a) = (-(Dual(1) + e) * rate).slope;
      for (Index b = 0; b < count; ++b)
        change(a) -=
            impulses(b) *
            dual_product(c.normal, c.normal_slopes.col(j), of(responses, b).x, of(responses, b).slopes.col(j)).slope;
    }
    const VectorXd d_impulses = lu.solve(change);
    out.col(j) = dv;
    for (Index a = 0; a < count; ++a)
      out.col(j) += d_impulses(a) * of(responses, a).x + impulses(a) * of(responses, a).slopes.col(j);
  }
  return out;
}

}  // namespace maupertuis

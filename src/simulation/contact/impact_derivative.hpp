#pragma once
#include "linear_algebra/dense.hpp"
#include "simulation/contact/impact.hpp"

#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/function_kernel.hpp>

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace maupertuis {

/// How q̇⁺ after impulses changes with what was before: ∂q̇⁺/∂(q, q̇, t) [n × (2n + 1)], exact. Gradients of gaps and slip
/// velocities and those of M and A are compiled from their expressions; the law of the impact is carried out with
/// numbers that know their change along a direction.
class ImpactDerivative {
 public:
  /// `equations`: of the system with its contacts, none of them in force. Cost: symbolic derivatives of M and A by q.
  ImpactDerivative(const EquationsOfMotion& equations, std::span<const double> parameters);
  ~ImpactDerivative();

  struct At {
    double t = 0;
    std::span<const double> q, v;  // v: just before the impulse
    bool plastic = false;          // e = 0
  };
  /// Of one impulse of a sequence. Nothing where friction holds or starts at a slip that is 0 before it, in a way that
  /// differs for neighbours that slide this way and that.
  std::optional<Eigen::MatrixXd> one_impulse(std::size_t contact, const At& at);
  /// Of impulses that share an impact by complementarity: `pressing` are the contacts whose impulse is not 0.
  Eigen::MatrixXd at_once(std::span<const std::size_t> pressing, const At& at);

 private:
  struct Parts;
  struct Response;
  struct ContactParts;
  const Parts& matrices_at(const At& at);
  ContactParts parts_at(std::size_t contact, const At& at);
  Response response(const Parts& matrices, const Eigen::VectorXd& row, const Eigen::MatrixXd& row_slopes) const;

  const EquationsOfMotion& equations_;
  std::vector<double> parameters_;
  Eigen::Index n_, m_;
  struct Compiled;
  std::map<std::size_t, std::unique_ptr<Compiled>> contacts_;
  std::unique_ptr<Compiled> matrices_;
  std::unique_ptr<Parts> parts_;
};

}  // namespace maupertuis

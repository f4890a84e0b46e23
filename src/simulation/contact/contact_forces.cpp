#include "simulation/contact/contact_forces.hpp"

#include "linear_algebra/complementarity.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

using Eigen::Index;

/// The unknowns: λ of each contact; then for each that may stick λ_f, λ_b ≥ 0 with λ_t = λ_f − λ_b, and the size σ of
/// its slip acceleration.
///
///     g̈ = b + W λ + …              ⟂ λ
///     v̇_t + σ                      ⟂ λ_f      pushes forwards where it begins to slide backwards
///     −v̇_t + σ                     ⟂ λ_b
///     μ_s λ − λ_f − λ_b             ⟂ σ
class Problem {
 public:
  explicit Problem(const ContactForceProblem& p) : p_(p), count_(p.contacts.size()) {
    for (std::size_t i = 0; i < count_; ++i)
      if (!p.contacts[i].tangent.empty() && p.contacts[i].sliding == 0) may_stick_.push_back(i);
    const Index size = at(count_ + 3 * may_stick_.size());
    w_.setZero(size, size);
    b_.setZero(size);
    for (std::size_t i = 0; i < count_; ++i) fill(at(i), p.contacts[i].normal, p.contacts[i].gap_acceleration, 1);
    for (std::size_t k = 0; k < may_stick_.size(); ++k) {
      const auto& c = p.contacts[may_stick_[k]];
      const Index forwards = at(count_ + 3 * k), backwards = forwards + 1, size_of_slip = forwards + 2;
      fill(forwards, c.tangent, c.slip_acceleration, 1);
      fill(backwards, c.tangent, c.slip_acceleration, -1);
      w_(forwards, size_of_slip) = w_(backwards, size_of_slip) = 1;
      w_(size_of_slip, at(may_stick_[k])) = c.friction;
      w_(size_of_slip, forwards) = w_(size_of_slip, backwards) = -1;
    }
  }

  std::optional<ContactForces> solve() const {
    const auto z = linear_complementarity(w_, b_);
    if (!z) return std::nullopt;
    const Eigen::VectorXd slack = b_ + w_ * *z;
    ContactForces out;
    for (std::size_t i = 0; i < count_; ++i) {
      out.normal.push_back((*z)(at(i)));
      out.acceleration.push_back(slack(at(i)));
      const auto& c = p_.contacts[i];
      out.friction.push_back(c.tangent.empty() ? FrictionState::None
                             : c.sliding == 0  ? FrictionState::Stick
                             : c.sliding > 0   ? FrictionState::Forward
                                               : FrictionState::Backward);
    }
    for (std::size_t k = 0; k < may_stick_.size(); ++k) {
      const Index forwards = at(count_ + 3 * k);
      if (!((*z)(forwards + 2) > 0)) continue;
      out.friction[may_stick_[k]] =
          (*z)(forwards) > (*z)(forwards + 1) ? FrictionState::Backward : FrictionState::Forward;
    }
    return out;
  }

 private:
  /// ±(free + row · M⁻¹ (all forces)).
  void fill(Index row, const SparseRow& direction, double free, double sign) {
    b_(row) = sign * free;
    for (std::size_t j = 0; j < count_; ++j) {
      const auto& c = p_.contacts[j];
      double w = dot(direction, p_.response.col(at(j)));
      if (c.sliding != 0) w -= c.sliding * c.friction * dot(direction, p_.tangent_response.col(at(j)));
      w_(row, at(j)) = sign * w;
    }
    for (std::size_t k = 0; k < may_stick_.size(); ++k) {
      const double w = dot(direction, p_.tangent_response.col(at(may_stick_[k])));
      w_(row, at(count_ + 3 * k)) = sign * w;
      w_(row, at(count_ + 3 * k + 1)) = -sign * w;
    }
  }

  const ContactForceProblem& p_;
  std::size_t count_;
  std::vector<std::size_t> may_stick_;
  Eigen::MatrixXd w_;
  Eigen::VectorXd b_;
};

}  // namespace

std::optional<ContactForces> contact_forces(const ContactForceProblem& problem) { return Problem(problem).solve(); }

}  // namespace maupertuis

#pragma once
#include "kernel/extended/workspace.hpp"

#include <algorithm>
#include <vector>

namespace maupertuis::extended {

/// Sizes of a motion that are known from its course so far, [n] each or empty.
template <class T>
struct UsualSizes {
  std::vector<T> q, v, a;  // of q, q̇, q̈
};

/// How far the point of a workspace is from the constraints: integrator/taylor/constraint_error over T.
template <class T>
class ConstraintError {
 public:
  /// h: the length of a step, or 0.
  ConstraintError(const Workspace<T>& work, const T& h, const UsualSizes<T>& usual)
      : work_(work), n_(work.program().freedoms), h_(h), usual_(usual) {}

  /// The largest of φ, and of dφ/dt or ψ, each divided by the sizes of its terms and by how far they change in a step
  /// or in a motion of the usual sizes, so that a constraint such as y = 0 has a measure too.
  T largest() const {
    T out = T(0);
    for (std::size_t j = 0; n_ + j < work_.program().unknowns; ++j) out = std::max(out, of_constraint(j));
    return out;
  }

 private:
  T of_constraint(std::size_t j) const {
    const T speeds = rate_bound(j) + along(j, usual_.v), position = work_.constraint_scale(j);
    const T place = position + h_ * speeds + along(j, usual_.q), motion = work_.constraint_rate_scale(j) + speeds;
    // A rate that moves φ by less than its rounding within the step does not count, and what rounding leaves of forces
    // that balance is no motion.
    const T unseen = h_ > 0 ? T(rounding() * (position + along_coordinates(j)) / h_) : T(0);
    const T left = rounding() * h_ * std::max(along(j, usual_.a), held(j));
    return std::max(ratio(beyond(work_.constraint_value(j), h_ * left), place),
                    ratio(beyond(work_.constraint_rate(j), std::max(unseen, left)), motion));
  }

  static T rounding() { return 64 * epsilon<T>(); }
  static T ratio(const T& value, const T& scale) { return value == 0 ? T(0) : T(value / scale); }
  static T beyond(const T& value, const T& threshold) { return std::max(T(0), T(abs(value) - threshold)); }

  T along(std::size_t j, const std::vector<T>& sizes) const {
    T sum = T(0);
    for (std::size_t i = 0; i < sizes.size(); ++i) sum += abs(work_.constraint_matrix(j, i)) * sizes[i];
    return sum;
  }
  /// A q̈ for the accelerations that the forces of constraints would give alone, by the first two terms of λ.
  T held(std::size_t j) const {
    T sum = T(0);
    for (std::size_t i = 0; i < n_; ++i) {
      if (!(work_.mass(i, i) > 0) || work_.constraint_matrix(j, i) == 0) continue;
      T force = T(0);
      for (std::size_t l = 0; n_ + l < work_.program().unknowns; ++l)
        force += abs(work_.constraint_matrix(l, i)) *
                 std::max(T(2 * abs(work_.coordinate(2)[n_ + l])), T(6 * h_ * abs(work_.coordinate(3)[n_ + l])));
      sum += abs(work_.constraint_matrix(j, i)) * force / work_.mass(i, i);
    }
    return sum;
  }
  T along_coordinates(std::size_t j) const {
    T sum = T(0);
    for (std::size_t i = 0; i < n_; ++i) sum += abs(work_.constraint_matrix(j, i) * work_.coordinate(0)[i]);
    return sum;
  }

  /// A bound of |A q̇| over the step, by Cauchy and Schwarz in the metric of the diagonal of M, so that a motion along
  /// the constraint counts; coordinates without inertia count by themselves.
  T rate_bound(std::size_t j) const {
    T motion = T(0), gradient = T(0), rest = T(0);
    for (std::size_t i = 0; i < n_; ++i) {
      const T a = work_.constraint_matrix(j, i), mass = work_.mass(i, i);
      const T speed = abs(work_.coordinate(1)[i]) + h_ * abs(work_.acceleration(i));
      if (mass > 0)
        motion += mass * speed * speed, gradient += a * a / mass;
      else
        rest += abs(a) * speed;
    }
    return sqrt(motion * gradient) + rest;
  }

  const Workspace<T>& work_;
  std::size_t n_;
  T h_;
  const UsualSizes<T>& usual_;
};

}  // namespace maupertuis::extended

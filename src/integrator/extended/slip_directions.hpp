#pragma once
#include "kernel/extended/linear_solver.hpp"
#include "kernel/extended/workspace.hpp"
#include "linear_algebra/slip_series.hpp"

#include <span>
#include <utility>
#include <vector>

/// How slips in space begin, in numbers of more digits than double (slip_series.hpp).
namespace maupertuis::extended {

/// The motion with friction along given directions, and its slips.
template <class T>
class DirectedSlips {
 public:
  /// `kernel`: ExtendedProgram::slips.
  DirectedSlips(const Kernel& kernel, int degree, std::span<const T> parameters, const T& t, std::span<const T> q,
                std::span<const T> v)
      : degree_(static_cast<std::size_t>(degree)),
        work_(kernel, degree + 1),
        parameters_(parameters.begin(), parameters.end()),
        t_(t),
        q_(q),
        v_(v) {}

  std::size_t degree() const { return degree_; }

  /// φ of each contact; coefficients up to τ^orders of the slips are found.
  bool follow(const std::vector<TimeSeries<T>>& angles, std::size_t orders) {
    directions_.clear();
    for (const TimeSeries<T>& phi : angles) directions_.push_back(cosine_and_sine<T>(phi));
    return expand(orders);
  }
  /// Without friction.
  bool let_go(std::size_t contacts) {
    const TimeSeries<T> none(degree_ + 1, T(0));
    directions_.assign(contacts, {none, none});
    return expand(1);
  }

  T component(std::size_t c, std::size_t which, std::size_t k) const {
    return work_.event(2 * c + which, static_cast<int>(k));
  }
  T across(std::size_t c, std::size_t k) const { return parts(c, k).across; }
  T along(std::size_t c, std::size_t k) const { return parts(c, k).along; }
  /// Of the parameters that a mode has after those of the model.
  std::vector<T> given() const { return {all_.begin() + static_cast<std::ptrdiff_t>(parameters_.size()), all_.end()}; }

 private:
  bool expand(std::size_t orders) {
    all_ = parameters_;
    for (const auto& [cosine, sine] : directions_) {
      all_.push_back(t_);
      all_.insert(all_.end(), cosine.begin(), cosine.end());
      all_.insert(all_.end(), sine.begin(), sine.end());
    }
    work_.set_parameters(all_);
    return work_.expand_to(static_cast<int>(orders), t_, q_, v_) == KernelStatus::Ok;
  }

  AlongAndAcross<T> parts(std::size_t c, std::size_t k) const {
    return {directions_[c], k, [&](std::size_t which, std::size_t j) { return component(c, which, j); }};
  }

  std::size_t degree_;
  Workspace<T> work_;
  std::vector<T> parameters_, all_;
  T t_;
  std::span<const T> q_, v_;
  std::vector<std::pair<TimeSeries<T>, TimeSeries<T>>> directions_;
};

/// The directions of slips that begin together.
template <class T>
class SlipDirections {
 public:
  SlipDirections(DirectedSlips<T>& slips, std::size_t contacts)
      : slips_(slips),
        series_(slips, slips.degree(), std::vector<T>(contacts, T(0)),
                {epsilon<T>(), T(8 * epsilon<T>()), negligible(), epsilon_to<T>(0.3), 40}) {}

  /// False where none are found: slips that are bound to each other, as those of two feet of a bar along it, leave the
  /// differences of their directions open.
  bool find() {
    return guess() && series_.find([&](std::size_t k, const std::vector<T>& slope, std::vector<T>& across) {
      const std::size_t n = across.size();
      LinearSolver<T> solver;
      solver.factor(slope, n, T(1e-9));
      if (solver.rank() < n) return false;
      solver.solve(across);
      for (std::size_t c = 0; c < n; ++c) series_.angles()[c][k] -= across[c];
      return true;
    });
  }

  /// How long from the beginning on they are right to rounding, and the slips grow, at most `most`.
  T length(const T& most) const { return series_.length(most); }

 private:
  /// Where the slips go without friction, turned as friction along them turns them.
  bool guess() {
    std::vector<TimeSeries<T>>& angles = series_.angles();
    if (!slips_.let_go(angles.size())) return false;
    std::vector<T> pulls;
    for (std::size_t c = 0; c < angles.size(); ++c) {
      const T x = slips_.component(c, 0, 1), y = slips_.component(c, 1, 1);
      angles[c][0] = atan2(y, x);
      pulls.push_back(hypot_of(x, y));
    }
    constexpr int most_turns = 400;
    const T part = T(0.25), near = epsilon_to<T>(0.2);
    T turned = T(1);
    for (int turn = 0; turn < most_turns && turned > near; ++turn) {
      if (!slips_.follow(angles, 1)) return false;
      turned = T(0);
      for (std::size_t c = 0; c < angles.size(); ++c) {
        const T x = slips_.along(c, 1), y = slips_.across(c, 1);
        if (!(hypot_of(x, y) > negligible() * pulls[c])) continue;  // it comes to its limit
        const T by = part * atan2(y, x);
        angles[c][0] += by;
        turned = std::max(turned, T(abs(by)));
      }
    }
    return true;
  }
  static T hypot_of(const T& x, const T& y) { return sqrt(T(x * x + y * y)); }
  static T negligible() { return epsilon_to<T>(0.55); }

  DirectedSlips<T>& slips_;
  SlipSeries<T, DirectedSlips<T>> series_;
};

}  // namespace maupertuis::extended

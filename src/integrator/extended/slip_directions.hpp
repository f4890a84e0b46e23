#pragma once
#include "kernel/extended/linear_solver.hpp"
#include "kernel/extended/workspace.hpp"

#include <limits>
#include <span>
#include <utility>
#include <vector>

/// How slips in space begin (hybrid_beginnings.cpp of simulation, over T): the direction d(τ) = (cos φ, sin φ) of each,
/// φ = Σ φ_k τ^k, so that the slip goes along it with friction −μ N d(τ). The coefficient v_{k+1} of the slip depends
/// on φ_0, …, φ_k, on the last of them linearly, and what it has across to d vanishes order by order.
namespace maupertuis::extended {

/// The motion with friction along given directions, and its slips.
template <class T>
class DirectedSlips {
 public:
  using Series = std::vector<T>;  // coefficients of powers of τ

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
  bool follow(const std::vector<Series>& angles, std::size_t orders) {
    directions_.clear();
    for (const Series& phi : angles) directions_.push_back(cosine_and_sine(phi));
    return expand(orders);
  }
  /// Without friction.
  bool let_go(std::size_t contacts) {
    directions_.assign(contacts, {Series(degree_ + 1, T(0)), Series(degree_ + 1, T(0))});
    return expand(1);
  }

  T component(std::size_t c, std::size_t which, int k) const { return work_.event(2 * c + which, k); }
  /// Coefficient k ≥ 1 of what the slip of contact c has across to d, and along it; what is there at the beginning is
  /// rounding.
  T across(std::size_t c, std::size_t k) const {
    return sum(c, k, [](const T& x, const T& y, const T& cosine, const T& sine) { return T(y * cosine - x * sine); });
  }
  T along(std::size_t c, std::size_t k) const {
    return sum(c, k, [](const T& x, const T& y, const T& cosine, const T& sine) { return T(x * cosine + y * sine); });
  }
  /// Of the parameters that a mode has after those of the model.
  std::vector<T> given() const { return {all_.begin() + static_cast<std::ptrdiff_t>(parameters_.size()), all_.end()}; }

 private:
  /// c' = −s φ', s' = c φ'.
  std::pair<Series, Series> cosine_and_sine(const Series& phi) const {
    Series c(degree_ + 1, T(0)), s(degree_ + 1, T(0));
    c[0] = cos(phi[0]), s[0] = sin(phi[0]);
    for (std::size_t k = 1; k <= degree_; ++k) {
      for (std::size_t j = 1; j <= k; ++j) {
        c[k] -= j * phi[j] * s[k - j];
        s[k] += j * phi[j] * c[k - j];
      }
      c[k] /= k, s[k] /= k;
    }
    return {c, s};
  }

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

  template <class Product>
  T sum(std::size_t c, std::size_t k, Product&& product) const {
    const auto& [cosine, sine] = directions_[c];
    T out = T(0);
    for (std::size_t j = k > degree_ ? k - degree_ : 1; j <= k; ++j)
      out += product(component(c, 0, static_cast<int>(j)), component(c, 1, static_cast<int>(j)), cosine[k - j],
                     sine[k - j]);
    return out;
  }

  std::size_t degree_;
  Workspace<T> work_;
  std::vector<T> parameters_, all_;
  T t_;
  std::span<const T> q_, v_;
  std::vector<std::pair<Series, Series>> directions_;
};

/// The directions of slips that begin together, one order after the other.
template <class T>
class SlipDirections {
 public:
  using Series = typename DirectedSlips<T>::Series;

  SlipDirections(DirectedSlips<T>& slips, std::size_t contacts)
      : slips_(slips), degree_(slips.degree()), angles_(contacts, Series(slips.degree() + 1, T(0))) {}

  /// False where none are found: slips that are bound to each other, as those of two feet of a bar along it, leave the
  /// differences of their directions open.
  bool find() {
    if (!guess() || !find_sizes()) return false;
    constexpr int most_sweeps = 40;
    T before = T(std::numeric_limits<double>::max());
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      const std::vector<Series> last = angles_;
      if (!improve_all()) return false;
      T moved = T(0);
      for (std::size_t c = 0; c < angles_.size(); ++c) moved = std::max(moved, T(abs(angles_[c][0] - last[c][0])));
      if (moved <= 8 * epsilon<T>() || !(moved < T(0.9) * before)) break;
      before = moved;
    }
    return slips_.follow(angles_, degree_ + 1);
  }

  /// How long from the beginning on they are right to rounding, and the slips grow, at most `most`.
  T length(const T& most) const {
    constexpr std::size_t last = 6;
    T out = most;
    for (std::size_t c = 0; c < angles_.size(); ++c) {
      for (std::size_t k = degree_ - last + 1; k <= degree_; ++k)
        if (angles_[c][k] != 0) out = std::min(out, T(pow(T(epsilon<T>() / abs(angles_[c][k])), T(1) / k)));
      out = std::min(out, growth(c));
    }
    return out;
  }

 private:
  /// Where the slips go without friction, turned as friction along them turns them.
  bool guess() {
    if (!slips_.let_go(angles_.size())) return false;
    std::vector<T> pulls;
    for (std::size_t c = 0; c < angles_.size(); ++c) {
      const T x = slips_.component(c, 0, 1), y = slips_.component(c, 1, 1);
      angles_[c][0] = atan2(y, x);
      pulls.push_back(hypot_of(x, y));
    }
    constexpr int most_turns = 400;
    const T part = T(0.25), near = epsilon_to<T>(0.2);
    T turned = T(1);
    for (int turn = 0; turn < most_turns && turned > near; ++turn) {
      if (!slips_.follow(angles_, 1)) return false;
      turned = T(0);
      for (std::size_t c = 0; c < angles_.size(); ++c) {
        const T x = slips_.along(c, 1), y = slips_.across(c, 1);
        if (!(hypot_of(x, y) > negligible() * pulls[c])) continue;  // it comes to its limit
        const T by = part * atan2(y, x);
        angles_[c][0] += by;
        turned = std::max(turned, T(abs(by)));
      }
    }
    return true;
  }
  static T hypot_of(const T& x, const T& y) { return sqrt(T(x * x + y * y)); }
  static T negligible() { return epsilon_to<T>(0.55); }

  bool improve_all() {
    constexpr int most_turns = 8;
    for (int turn = 0; turn < most_turns; ++turn)
      if (!improve(0)) return false;
    for (std::size_t k = 1; k <= degree_; ++k)
      if (!improve(k)) return false;
    return true;
  }

  /// What friction does to v̇_t: half of what changes where it is turned round.
  bool find_sizes() {
    sizes_.assign(angles_.size(), T(0));
    const T half_turn = 4 * atan(T(1));
    for (const T& turned : {T(0), half_turn}) {
      for (Series& phi : angles_) phi[0] += turned;
      const bool moves = slips_.follow(angles_, 1);
      for (Series& phi : angles_) phi[0] -= turned;
      if (!moves) return false;
      for (std::size_t c = 0; c < angles_.size(); ++c) sizes_[c] += slips_.along(c, 1) / 2;
    }
    for (T& size : sizes_) size = abs(size);
    return true;
  }

  bool across(std::size_t k, std::vector<T>& out) {
    if (!slips_.follow(angles_, k + 1)) return false;
    out.clear();
    for (std::size_t c = 0; c < angles_.size(); ++c) out.push_back(slips_.across(c, k + 1));
    return true;
  }

  /// φ_k from the coefficient k + 1 of what the slips have across, which is linear in it for k ≥ 1.
  bool improve(std::size_t k) {
    const std::size_t n = angles_.size();
    std::vector<T> here, there;
    if (!across(k, here)) return false;
    if (k <= 1) {  // later slopes are known from this one
      slope_.assign(n * n, T(0));
      const T by = k == 0 ? epsilon_to<T>(0.3) : T(1);
      for (std::size_t c = 0; c < n; ++c) {
        angles_[c][k] += by;
        const bool moves = across(k, there);
        angles_[c][k] -= by;
        if (!moves) return false;
        for (std::size_t i = 0; i < n; ++i) slope_[i * n + c] = (there[i] - here[i]) / by;
      }
      along_.clear();
      for (std::size_t c = 0; c < n; ++c) along_.push_back(slips_.along(c, 1));
    }
    std::vector<T> slope = slope_;
    for (std::size_t c = 0; c < n && k > 1; ++c) slope[c * n + c] += along_[c];
    if (k > 1)  // ∂v̇_t/∂d goes with 1/(k + 1), what turns the slip itself does not
      for (T& x : slope) x = x * 2 / (k + 1);
    for (std::size_t c = 0; c < n && k > 1; ++c) slope[c * n + c] -= along_[c];
    LinearSolver<T> solver;
    solver.factor(slope, n, T(1e-9));
    if (solver.rank() < n) return false;
    solver.solve(here);
    for (std::size_t c = 0; c < n; ++c) angles_[c][k] -= here[c];
    return true;
  }

  /// Until the later powers of a slip may have taken half of what its first one is: those that add to it do not.
  T growth(std::size_t c) const {
    const std::size_t first = abs(slips_.along(c, 1)) > negligible() * sizes_[c] ? 1 : 2;
    const T leads = first * slips_.along(c, first);
    if (!(leads > 0)) return T(0);
    T most = T(std::numeric_limits<double>::max());
    for (std::size_t k = first + 1; k <= degree_ + 1; ++k)
      if (const T x = -(k * slips_.along(c, k)); x > 0)
        most = std::min(most, T(pow(T(leads / (2 * x)), T(1) / (k - first))));
    return most / 2;
  }

  DirectedSlips<T>& slips_;
  std::size_t degree_;
  std::vector<Series> angles_;
  std::vector<T> sizes_;  // of v̇_t, by what friction does there
  std::vector<T> slope_;  // of v_{t,2} across by φ_1 [contacts²]
  std::vector<T> along_;  // v_{t,1}
};

}  // namespace maupertuis::extended

#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

/// How slips in space begin, for double and for numbers of more digits. At the first instant v_t/|v_t| has no value,
/// and next to it the equations are as stiff as can be: what is across to the force that pulls is braked at the rate μ
/// N/(m |v_t|). The direction d(τ) that the slip has from its beginning on is sought as a polynomial of time, so that
/// v_t(τ) with friction −μ N d(τ) goes along d(τ):
///
///     v_t = τ (v_1 + v_2 τ + …) where friction jumps from μ_s to μ, or is too weak from the beginning
///     v_t = τ² (v_2 + v_3 τ + …) where a force grows beyond what it holds
///
/// With d = (cos φ, sin φ), φ = Σ φ_k τ^k, the coefficient v_{k+1} of the slip depends on φ_0, …, φ_k, on the last of
/// them linearly, and what v_t has across to d vanishes order by order. In the second case the series is an asymptotic
/// one (the origin is an irregular singular point of φ' = …/|v_t|): it is cut where its last terms are rounding.
namespace maupertuis {

template <class T>
using TimeSeries = std::vector<T>;  // coefficients of powers of τ

/// cos φ and sin φ: c' = −s φ', s' = c φ'.
template <class T>
std::pair<TimeSeries<T>, TimeSeries<T>> cosine_and_sine(const TimeSeries<T>& phi) {
  using std::cos, std::sin;
  TimeSeries<T> c(phi.size(), T(0)), s(phi.size(), T(0));
  c[0] = cos(phi[0]), s[0] = sin(phi[0]);
  for (std::size_t k = 1; k < phi.size(); ++k) {
    for (std::size_t j = 1; j <= k; ++j) {
      c[k] -= j * phi[j] * s[k - j];
      s[k] += j * phi[j] * c[k - j];
    }
    c[k] /= k, s[k] /= k;
  }
  return {c, s};
}

/// Coefficient k ≥ 1 of what a slip has along d and across to it; what is there at the beginning is rounding.
/// `component(which, j)`: coefficient j of its two components.
template <class T>
struct AlongAndAcross {
  T along = T(0), across = T(0);

  template <class Component>
  AlongAndAcross(const std::pair<TimeSeries<T>, TimeSeries<T>>& direction, std::size_t k, Component component) {
    const auto& [cosine, sine] = direction;
    const std::size_t degree = cosine.size() - 1;
    for (std::size_t j = k > degree ? k - degree : 1; j <= k; ++j) {
      const T x = component(0, j), y = component(1, j);
      along += x * cosine[k - j] + y * sine[k - j];
      across += y * cosine[k - j] - x * sine[k - j];
    }
  }
};

/// The directions of slips that begin together, one order after the other. Slips: the motion with friction along given
/// directions, `follow(angles, orders)`, and then `along(c, k)`, `across(c, k)` as above.
template <class T, class Slips>
class SlipSeries {
 public:
  struct Limits {
    T rounding;    // of an angle
    T settled;     // of φ_0 from sweep to sweep
    T negligible;  // of what friction does to v̇_t
    T small_turn;  // of φ_0, for slopes
    int sweeps;    // at most
  };

  /// `towards`: φ_0 of each, to begin with.
  SlipSeries(Slips& slips, std::size_t degree, const std::vector<T>& towards, Limits limits)
      : slips_(slips), degree_(degree), limits_(std::move(limits)) {
    for (const T& angle : towards) angles_.emplace_back(degree + 1, T(0)), angles_.back()[0] = angle;
  }

  std::vector<TimeSeries<T>>& angles() { return angles_; }
  /// Of v̇_t, by what friction does there: after find() began.
  const std::vector<T>& sizes() const { return sizes_; }

  /// `correct(k, slope, across)` takes from angles() what v_{k+1} has across to the directions [slips], where a change
  /// of φ_k changes it by `slope` [slips × slips, by rows]; false where that cannot be solved.
  template <class Correct>
  bool find(Correct correct) {
    using std::abs;
    if (!find_sizes()) return false;
    T before = T(std::numeric_limits<double>::max());
    for (int sweep = 0; sweep < limits_.sweeps; ++sweep) {
      const std::vector<TimeSeries<T>> last = angles_;
      if (!improve_all(correct)) return false;
      T moved = T(0);
      for (std::size_t c = 0; c < angles_.size(); ++c) moved = std::max(moved, T(abs(angles_[c][0] - last[c][0])));
      if (moved <= limits_.settled || !(moved < T(0.9) * before)) break;
      before = moved;
    }
    return slips_.follow(angles_, degree_ + 1);
  }

  /// How long from the beginning on they are right to rounding, and the slips grow, at most `most`.
  T length(const T& most) const {
    using std::abs, std::pow;
    constexpr std::size_t last = 6;
    T out = most;
    for (std::size_t c = 0; c < angles_.size(); ++c) {
      for (std::size_t k = degree_ - last + 1; k <= degree_; ++k)
        if (angles_[c][k] != 0) out = std::min(out, T(pow(T(limits_.rounding / abs(angles_[c][k])), T(1) / k)));
      out = std::min(out, growth(c));
    }
    return out;
  }

 private:
  template <class Correct>
  bool improve_all(Correct& correct) {
    constexpr int most_turns = 8;
    for (int turn = 0; turn < most_turns; ++turn)
      if (!improve(0, correct)) return false;
    for (std::size_t k = 1; k <= degree_; ++k)
      if (!improve(k, correct)) return false;
    return true;
  }

  /// What friction does to v̇_t: half of what changes where it is turned round.
  bool find_sizes() {
    using std::abs, std::atan;
    sizes_.assign(angles_.size(), T(0));
    const T half_turn = 4 * atan(T(1));
    for (const T& turned : {T(0), half_turn}) {
      for (TimeSeries<T>& phi : angles_) phi[0] += turned;
      const bool moves = slips_.follow(angles_, 1);
      for (TimeSeries<T>& phi : angles_) phi[0] -= turned;
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

  /// What the coefficients have across by φ_k, by differences: later slopes are known from that of φ_1.
  bool find_slope(std::size_t k, const std::vector<T>& here) {
    const std::size_t n = angles_.size();
    std::vector<T> there;
    slope_.assign(n * n, T(0));
    const T by = k == 0 ? limits_.small_turn : T(1);
    for (std::size_t c = 0; c < n; ++c) {
      angles_[c][k] += by;
      const bool moves = across(k, there);
      angles_[c][k] -= by;
      if (!moves) return false;
      for (std::size_t i = 0; i < n; ++i) slope_[i * n + c] = (there[i] - here[i]) / by;
    }
    along_.clear();
    for (std::size_t c = 0; c < n; ++c) along_.push_back(slips_.along(c, 1));
    return true;
  }

  /// φ_k from the coefficient k + 1 of what the slips have across, which is linear in it for k ≥ 1.
  template <class Correct>
  bool improve(std::size_t k, Correct& correct) {
    const std::size_t n = angles_.size();
    std::vector<T> here;
    if (!across(k, here) || (k <= 1 && !find_slope(k, here))) return false;
    std::vector<T> slope = slope_;
    if (k > 1) {  // ∂v̇_t/∂d goes with 1/(k + 1), what turns the slip itself does not
      for (std::size_t c = 0; c < n; ++c) slope[c * n + c] += along_[c];
      for (T& x : slope) x *= T(2) / (k + 1);
      for (std::size_t c = 0; c < n; ++c) slope[c * n + c] -= along_[c];
    }
    return correct(k, slope, here);
  }

  /// Until the later powers of a slip may have taken half of what its first one is: those that add to it do not.
  T growth(std::size_t c) const {
    using std::abs, std::pow;
    const std::size_t first = abs(slips_.along(c, 1)) > limits_.negligible * sizes_[c] ? 1 : 2;
    const T leads = first * slips_.along(c, first);
    if (!(leads > 0)) return T(0);
    T most = T(std::numeric_limits<double>::max());
    for (std::size_t k = first + 1; k <= degree_ + 1; ++k)
      if (const T x = -(k * slips_.along(c, k)); x > 0)
        most = std::min(most, T(pow(T(leads / (2 * x)), T(1) / (k - first))));
    return most / 2;
  }

  Slips& slips_;
  std::size_t degree_;
  Limits limits_;
  std::vector<TimeSeries<T>> angles_;
  std::vector<T> sizes_;
  std::vector<T> slope_;  // of v_{t,2} across by φ_1 [slips²]
  std::vector<T> along_;  // v_{t,1}
};

}  // namespace maupertuis

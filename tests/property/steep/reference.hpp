#pragma once
#include "law.hpp"

#include <optional>
#include <type_traits>
#include <utility>

/// The motion by the extrapolation of Gragg, Bulirsch and Stoer, with steps far inside each feature and a restart at
/// each switch. Nothing of it is shared with the program under test.
namespace steep {

struct Resolution {
  double tolerance = 1e-22;  // of a step
  double share = 1;          // of the longest step that the law allows
  int columns = 10;          // of the extrapolation, at most; its order is twice that
};

template <class Real>
class Reference {
 public:
  using Vector = typename Law<Real>::Vector;

  Reference(const Law<Real>& law, const Resolution& resolution)
      : law_(law), resolution_(resolution), columns_(resolution.columns), n_(law.description().n), s_(law.start()) {
    const auto& terms = law.description().terms;
    bits_.resize(terms.size());
    for (std::size_t term = 0; term < terms.size(); ++term)
      for (int k = 0; k < switches_of(terms[term].shape); ++k) {
        const Real g = law.switch_at(term, k, s_);
        bits_[term][static_cast<std::size_t>(k)] = g > 0 || (g == 0 && law.switch_rate(term, k, s_) >= 0);
      }
  }

  /// The state at the end of the run; nothing if it takes too many steps.
  std::optional<State<Real>> run() {
    const Real end = parse<Real>(law_.description().duration.text);
    double h = 1;
    for (int count = 0; s_.t < end; ++count) {
      if (count > most_steps) return std::nullopt;
      begin_ = law_.acceleration(s_, bits_);
      const double longest = std::min(h, resolution_.share * law_.longest_step(s_, begin_));
      const Real left = end - s_.t;
      const bool last = left <= Real(longest);
      const Real step = last ? left : Real(longest);
      double error = 0;
      State<Real> next = advanced(step, &error);
      const double ratio = error / resolution_.tolerance;
      const double factor = ratio < 1e300 ? 0.9 * std::pow(std::max(ratio, 1e-30), -1.0 / (2 * columns_ - 1)) : 0.1;
      h = static_cast<double>(step) * std::clamp(factor, 0.1, 4.0);
      // Where features, not errors, limit the steps, a lower order is enough.
      const bool enough = ratio < 1e-4 && columns_ > 4;
      columns_ = ratio > 1e-1 ? std::min(columns_ + 1, resolution_.columns) : enough ? columns_ - 1 : columns_;
      if (!(ratio <= 1)) continue;
      if (last) next.t = end;
      if (!cross_a_switch(step, next)) s_ = next;
    }
    return s_;
  }

  int switches() const { return switches_; }

 private:
  static constexpr int most_steps = 20000;

  /// The state a time h after the present one, on the present branches; and the error, by the last two extrapolations.
  State<Real> advanced(const Real& h, double* error = nullptr) const {
    std::array<State<Real>, 16> column;
    const auto columns = static_cast<std::size_t>(columns_);
    for (std::size_t j = 0; j < columns; ++j) column[j] = midpoint(h, 2 * static_cast<int>(j + 1));
    State<Real> less;
    for (std::size_t k = 1; k < columns; ++k) {
      less = column[columns - 1];
      for (std::size_t j = columns - 1; j >= k; --j) {
        const Real ratio = Real(j + 1) / Real(j + 1 - k), divisor = ratio * ratio - 1;
        for (int i = 0; i < n_; ++i) {
          column[j].q[i] += (column[j].q[i] - column[j - 1].q[i]) / divisor;
          column[j].v[i] += (column[j].v[i] - column[j - 1].v[i]) / divisor;
        }
      }
    }
    State<Real> out = column[columns - 1];
    out.t = s_.t + h;
    for (int i = 0; error && i < n_; ++i) {
      const auto part = [](const Real& a, const Real& b) {
        return static_cast<double>(fabs(a - b)) / std::max(0.01, static_cast<double>(fabs(a)));
      };
      *error = std::max({*error, part(out.q[i], less.q[i]), part(out.v[i], less.v[i])});
      if (!(part(out.v[i], less.v[i]) < 1e300)) *error = HUGE_VAL;
    }
    return out;
  }

  /// Only the time passes: what a switch of time alone needs.
  State<Real> later(const Real& h) const {
    State<Real> out = s_;
    out.t += h;
    return out;
  }

  /// Gragg's modified midpoint rule.
  State<Real> midpoint(const Real& h, int parts) const {
    const Real d = h / parts, twice = 2 * d;
    State<Real> before = s_, now = s_;
    Vector a = begin_;
    for (int i = 0; i < n_; ++i) now.q[i] += d * s_.v[i], now.v[i] += d * a[i];
    for (int m = 1; m < parts; ++m) {
      now.t = s_.t + d * m;
      a = law_.acceleration(now, bits_);
      for (int i = 0; i < n_; ++i) {
        std::swap(before.q[i], now.q[i]), std::swap(before.v[i], now.v[i]);
        now.q[i] += twice * before.v[i], now.v[i] += twice * a[i];
      }
    }
    now.t = s_.t + h;
    return now;
  }

  /// The distance of a switch function from its switch: positive on the present branch.
  Real room(std::size_t term, int k, const State<Real>& s) const {
    const Real g = law_.switch_at(term, k, s);
    return bits_[term][static_cast<std::size_t>(k)] ? g : Real(-g);
  }
  Real room_rate(std::size_t term, int k, const State<Real>& s) const {
    const Real rate = law_.switch_rate(term, k, s);
    return bits_[term][static_cast<std::size_t>(k)] ? rate : Real(-rate);
  }

  /// Where `of` falls through zero between low (positive) and high (negative): bisection with Newton's steps inside it.
  template <class After, class Function, class Rate>
  Real root(Real low, Real high, After state_after, Function of, Rate rate_of) const {
    const Real resolution = high * Real(std::is_same_v<Real, Quad> ? 1e-33 : 1e-19);
    Real at = (low + high) / 2;
    for (int turn = 0; turn < 200 && high - low > resolution; ++turn) {
      const State<Real> s = state_after(at);
      const Real g = of(s);
      (g > 0 ? low : high) = at;
      const Real rate = rate_of(s), newton = rate == 0 ? low : Real(at - g / rate);
      const bool inside = newton > low && newton < high;
      if (inside && fabs(newton - at) <= resolution) return newton;
      at = inside && turn % 8 != 7 ? newton : Real((low + high) / 2);
    }
    return high;
  }

  /// The time of the step at which a switch function leaves its branch, grazing ones included: between its ends it has
  /// at most one extremum, for that steps are short enough.
  std::optional<Real> exit(std::size_t term, int k, const Real& h, const State<Real>& next) const {
    const auto away = [&](const State<Real>& s) { return room(term, k, s); };
    const auto rate = [&](const State<Real>& s) { return room_rate(term, k, s); };
    const auto after = [&](const Real& at) { return law_.of_time(term) ? later(at) : advanced(at); };
    if (room(term, k, s_) < 0 && room_rate(term, k, s_) < 0) return Real(0);  // two switches at one time
    if (room(term, k, next) < 0) return root(0, h, after, away, rate);
    if (!(room_rate(term, k, s_) < 0 && room_rate(term, k, next) > 0)) return std::nullopt;
    const Real lowest = lowest_room(term, k, h, after);
    if (!(room(term, k, after(lowest)) < 0)) return std::nullopt;
    return root(0, lowest, after, away, rate);
  }

  template <class After>
  Real lowest_room(std::size_t term, int k, const Real& h, After state_after) const {
    Real low = 0, high = h;
    for (int turn = 0; turn < 40; ++turn) {
      const Real middle = (low + high) / 2;
      (room_rate(term, k, state_after(middle)) < 0 ? low : high) = middle;
    }
    return low;
  }

  /// Goes to the first switch in the step, if there is one, and takes the other branch there.
  bool cross_a_switch(const Real& h, const State<Real>& next) {
    std::optional<Real> first;
    std::size_t which = 0;
    int number = 0;
    const auto& terms = law_.description().terms;
    for (std::size_t term = 0; term < terms.size(); ++term)
      for (int k = 0; k < switches_of(terms[term].shape); ++k)
        if (const auto at = exit(term, k, h, next); at && (!first || *at < *first))
          first = at, which = term, number = k;
    if (!first) return false;
    s_ = advanced(*first);
    auto& bit = bits_[which][static_cast<std::size_t>(number)];
    bit = !bit;
    ++switches_;
    return true;
  }

  const Law<Real>& law_;
  Resolution resolution_;
  int columns_;  // at present
  int n_;
  State<Real> s_;
  Vector begin_{};  // accelerations of s_
  typename Law<Real>::Bits bits_;
  int switches_ = 0;
};

}  // namespace steep

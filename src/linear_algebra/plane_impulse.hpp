#pragma once
#include <array>
#include <cmath>
#include <limits>
#include <utility>

/// The impulse of one contact in the plane, and how a slip in space leaves 0 in it: for double, for numbers of more
/// digits, and for numbers with their change along a direction.
namespace maupertuis {

/// A number, and its change along one direction. Comparisons are those of the numbers.
struct Dual {
  double value = 0, slope = 0;
  Dual() = default;
  Dual(double number) : value(number) {}  // a constant
  Dual(double number, double change) : value(number), slope(change) {}
};

inline Dual operator-(Dual a) { return {-a.value, -a.slope}; }
inline Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.slope + b.slope}; }
inline Dual operator-(Dual a, Dual b) { return {a.value - b.value, a.slope - b.slope}; }
inline Dual operator*(Dual a, Dual b) { return {a.value * b.value, a.slope * b.value + a.value * b.slope}; }
inline Dual operator/(Dual a, Dual b) {
  const double quotient = a.value / b.value;
  return {quotient, (a.slope - quotient * b.slope) / b.value};
}
inline Dual& operator+=(Dual& a, Dual b) { return a = a + b; }
inline Dual& operator-=(Dual& a, Dual b) { return a = a - b; }
inline Dual root(Dual a) {
  const double r = std::sqrt(a.value);
  return {r, r > 0 ? a.slope / (2 * r) : 0};
}
template <class T>
T root(const T& a) {
  using std::sqrt;
  return sqrt(a);
}
inline double number(Dual a) { return a.value; }
template <class T>
const T& number(const T& a) {
  return a;
}
/// Whether it is 0 and stays so along the direction.
inline bool stays_zero(Dual a) { return a.value == 0 && a.slope == 0; }
template <class T>
bool stays_zero(const T& a) {
  return a == 0;
}
template <class T>
T size_of_number(const T& a) {
  using std::abs;
  return abs(a);
}

/// The course of an impact over the normal impulse p: v_n, v_t and the work of the normal force are piecewise simple.
///
///     v_n │╲                 ╱ restitution until its work is e² times that of compression
///         │ ╲ compression   ╱
///       0 ┼──╲─────────────╱──── p
template <class Number>
struct ImpulseCourse {
  Number w_nn, w_nt, w_tt, friction, static_friction;
  bool sticking = false;
  Number v_n, v_t, p = 0, p_t = 0, work = 0;

  /// dp_t/dp while it slides in a direction, or sticks.
  Number slope() const {
    if (number(v_t) != 0 && !sticking) return number(v_t) > 0 ? -friction : friction;
    const Number hold = number(w_tt) > 0 ? -w_nt / w_tt : Number(0);  // keeps v_t = 0
    if (sticking || size_of_number(number(hold)) <= number(static_friction)) return hold;
    return number(hold) > 0 ? friction : -friction;  // as near to holding as friction goes: v_t moves the other way
  }
  Number normal_slope(Number f) const { return w_nn + w_nt * f; }
  Number slip_slope(Number f) const { return w_nt + w_tt * f; }

  void advance(Number dp, Number f) {
    work += (v_n + Number(0.5) * normal_slope(f) * dp) * dp;
    v_n += normal_slope(f) * dp;
    v_t += slip_slope(f) * dp;
    p += dp;
    p_t += f * dp;
  }
  /// Impulse until the slip stops in this phase; infinite if it does not.
  Number until_stop(Number f) const {
    const Number s = slip_slope(f);
    return number(v_t) != 0 && number(s) * number(v_t) < 0 ? -v_t / s : Number(HUGE_VAL);
  }
};

template <class Number>
struct ImpulseOf {
  Number normal = 0, tangential = 0;
};

/// w = [W_nn, W_nt, W_tt] gives what normal and tangential impulse change in (v_n, v_t); v_n < 0. Sliding, sticking and
/// reversal follow each other while the normal impulse grows (Stronge, Impact Mechanics, 3.4).
template <class Number>
ImpulseOf<Number> impulse_in_plane(ImpulseCourse<Number> c, Number restitution) {
  if (c.sticking &&
      !stays_zero(c.v_t)) {  // what never slides takes the slip at once, in proportion to the normal impulse
    const Number total = c.w_nn * c.w_tt - c.w_nt * c.w_nt;
    const Number n = (-(Number(1) + restitution) * c.v_n * c.w_tt + c.v_t * c.w_nt) / total;
    return {n, -(c.v_t + c.w_nt * n) / c.w_tt};
  }
  constexpr int most_phases = 8;
  for (int phase = 0; phase < most_phases && number(c.v_n) < 0; ++phase) {  // compression
    const Number f = c.slope(), stop = c.until_stop(f), slope = c.normal_slope(f);
    const Number end = number(slope) > 0 ? -c.v_n / slope : Number(HUGE_VAL);
    const bool stops = number(stop) <= number(end), ends = number(end) <= number(stop);
    if (!(number(stops ? stop : end) < HUGE_VAL)) return {};  // jammed: friction presses more than it gives way
    c.advance(number(end) < number(stop) ? end : stop, f);
    if (stops) c.v_t = 0;
    if (ends) c.v_n = 0;
  }
  Number give_back = -restitution * restitution * c.work;
  c.work = 0;
  for (int phase = 0; phase < most_phases && number(give_back) > 0; ++phase) {  // restitution
    const Number f = c.slope(), stop = c.until_stop(f), slope = c.normal_slope(f);
    if (!(number(slope) > 0)) break;
    // v_n dp + ½ slope dp² = give_back
    const Number end = (root(c.v_n * c.v_n + Number(2) * slope * give_back) - c.v_n) / slope;
    const Number before = c.work;
    c.advance(number(end) < number(stop) ? end : stop, f);
    give_back -= c.work - before;
    if (number(end) <= number(stop)) break;
    c.v_t = 0;
  }
  return {c.p, c.p_t};
}

/// Where friction −μ d does not hold a slip of 0 in space it leaves along d, |d| = 1, with W_tn − μ W_tt d = c d and
/// c > 0: d = (μ W_tt + c)⁻¹ W_tn. As |d| falls with c there is one such c, to which Newton's steps for 1/|d| rise from
/// 0 (J. J. Moré and D. C. Sorensen, SIAM J. Sci. Stat. Comput. 4 (1983) 553). `tt`: [W_xx, W_xy, W_yy].
template <class Number>
std::array<Number, 2> direction_of_leaving(const std::array<Number, 2>& tn, const std::array<Number, 3>& tt,
                                           const Number& friction) {
  using std::sqrt;
  const auto length = [](const std::array<Number, 2>& x) { return Number(sqrt(Number(x[0] * x[0] + x[1] * x[1]))); };
  std::array<Number, 2> d = tn;
  Number c = 16 * std::numeric_limits<Number>::epsilon() * friction * (tt[0] + tt[2]);
  constexpr int most_turns = 200;
  for (int turn = 0; turn < most_turns && friction > 0; ++turn) {
    const Number xx = friction * tt[0] + c, xy = friction * tt[1], yy = friction * tt[2] + c, det = xx * yy - xy * xy;
    const auto solved = [&](const std::array<Number, 2>& b) {
      return std::array<Number, 2>{Number((yy * b[0] - xy * b[1]) / det), Number((xx * b[1] - xy * b[0]) / det)};
    };
    d = solved(tn);
    const std::array<Number, 2> e = solved(d);
    const Number size = length(d), next = c + size * size / (d[0] * e[0] + d[1] * e[1]) * (size - 1);
    if (!(next > c)) break;
    c = next;
  }
  const Number size = length(d);
  return {Number(d[0] / size), Number(d[1] / size)};
}

}  // namespace maupertuis

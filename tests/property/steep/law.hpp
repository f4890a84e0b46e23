#pragma once
#include "shapes.hpp"

#include <algorithm>
#include <random>

/// The right-hand side of a description, in numbers of one type.
namespace steep {

template <class Real>
struct State {
  Real t = 0;
  std::array<Real, most> q{}, v{};
};

template <class Real>
class Law {
 public:
  using Bits = std::vector<std::array<bool, most_switches>>;
  using Vector = std::array<Real, most>;

  /// Every constant is changed by up to this fraction of itself, at random: what a rounding does to the motion.
  explicit Law(const Description& d, double perturbation = 0) : d_(d), random_(17), perturbation_(perturbation) {
    for (const Term& term : d.terms) {
      Constants c;
      c.amplitude = number(term.amplitude), c.offset = number(term.offset), c.extra = parse<Real>(term.extra.text);
      c.rate = number(term.width);
      if (!term.width_multiplies) c.rate = 1 / c.rate;
      for (int i = 0; i < most; ++i) c.centre[i] = number(term.centre[i]);
      constants_.push_back(c);
    }
    for (int i = 0; i < d.n; ++i) mass_[i] = number(d.mass[i]);
    coupled_ = number(d.coupled);
    const MovingPivot& p = d.pivot;
    if (d.pivot_moves)
      length_ = number(p.length), gravity_ = number(p.gravity), way_ = number(p.way), time_ = number(p.time),
      width_ = number(p.width);
    for (int i = 0; i < d.n; ++i) start_.q[i] = number(d.q[i]), start_.v[i] = number(d.v[i]);
  }

  const Description& description() const { return d_; }
  const State<Real>& start() const { return start_; }

  /// u (or ρ) of a term.
  Real argument(std::size_t k, const State<Real>& s) const {
    const Term& term = d_.terms[k];
    const Constants& c = constants_[k];
    Real w = 0;
    if (round(term.shape)) {
      for (int i = 0; i < d_.n; ++i) {
        if (!term.of_q[i] && !term.of_v[i]) continue;
        const Real x = ((term.of_v[i] ? s.v[i] : s.q[i]) - c.centre[i]) * c.rate;
        w += x * x;
      }
      return w;
    }
    for (int i = 0; i < d_.n; ++i) {
      if (term.of_q[i]) w += term.of_q[i] * s.q[i];
      if (term.of_v[i]) w += term.of_v[i] * s.v[i];
    }
    if (term.of_t) w += term.of_t * s.t;
    return (w - c.offset) * c.rate;
  }

  Vector acceleration(const State<Real>& s, const Bits& bits) const {
    if (d_.pivot_moves) return pivot(s);
    Vector f{};
    for (std::size_t k = 0; k < d_.terms.size(); ++k) {
      const Term& term = d_.terms[k];
      const Constants& c = constants_[k];
      const Real u = argument(k, s);
      if (term.role == Role::Force) {
        f[term.target] += c.amplitude * value(term.shape, u, c.extra, bits[k].data());
        continue;
      }
      const Real by_u = c.amplitude * slope(term.shape, u, c.extra, bits[k].data());
      for (int i = 0; i < d_.n; ++i) {
        const int factor = term.of_q[i] + term.of_v[i];
        if (!factor) continue;
        if (round(term.shape))
          f[i] -= by_u * 2 * ((term.of_v[i] ? s.v[i] : s.q[i]) - c.centre[i]) * c.rate * c.rate;
        else
          f[i] -= by_u * factor * c.rate;
      }
    }
    return solved(s, f);
  }

  bool of_time(std::size_t k) const {
    const Term& term = d_.terms[k];
    return std::all_of(term.of_q.begin(), term.of_q.end(), [](int factor) { return factor == 0; }) && term.of_t != 0;
  }
  /// Switch function k of a term, and its rate.
  Real switch_at(std::size_t term, int k, const State<Real>& s) const {
    return switch_value(d_.terms[term].shape, k, argument(term, s), constants_[term].extra);
  }
  Real switch_rate(std::size_t k, int which, const State<Real>& s) const {
    const Term& term = d_.terms[k];
    const Constants& c = constants_[k];
    Real w = 0;
    if (round(term.shape)) {
      for (int i = 0; i < d_.n; ++i)
        if (term.of_q[i]) w += 2 * (s.q[i] - c.centre[i]) * s.v[i] * c.rate * c.rate;
      return w;
    }
    for (int i = 0; i < d_.n; ++i) w += term.of_q[i] * s.v[i];
    return (w + term.of_t) * c.rate * switch_slope(term.shape, which, argument(k, s));
  }

  /// The longest step from here, by what each term allows.
  double longest_step(const State<Real>& s, const Vector& a) const {
    if (d_.pivot_moves) {
      const double u = static_cast<double>((s.t - time_) / width_);
      return std::min(0.1, spacing(Shape::TanhStep, u, 0) * static_cast<double>(width_));
    }
    double h = 1e300;
    for (std::size_t k = 0; k < d_.terms.size(); ++k) {
      const Term& term = d_.terms[k];
      const double rate = static_cast<double>(constants_[k].rate), extra = static_cast<double>(constants_[k].extra);
      double u = static_cast<double>(argument(k, s)), speed = std::abs(term.of_t * rate), gain = 0;
      if (round(term.shape)) u = std::sqrt(u);
      for (int i = 0; i < d_.n; ++i) {
        const double v = static_cast<double>(s.v[i]), acceleration = static_cast<double>(a[i]);
        speed += std::abs((term.of_q[i] * v + term.of_v[i] * acceleration) * rate);
        gain += std::abs(term.of_q[i] * acceleration * rate);
      }
      // speed·h + gain·h²/2 = room
      const double room = spacing(term.shape, u, extra);
      if (room > 1e200) continue;
      h = std::min(h, gain * room > 1e-12 * speed * speed ? (std::sqrt(speed * speed + 2 * gain * room) - speed) / gain
                                                          : room / std::max(speed, 1e-300));
    }
    return h;
  }

 private:
  struct Constants {
    Real amplitude, offset, rate, extra;
    std::array<Real, most> centre;
  };

  Real number(const Number& x) {
    const Real value = parse<Real>(x.text);
    return perturbation_ == 0
               ? value
               : value * (1 + Real(perturbation_) * Real(std::uniform_real_distribution<double>(-1, 1)(random_)));
  }

  /// M a = f.
  Vector solved(const State<Real>& s, Vector f) const {
    if (d_.coupling == Coupling::None) {
      for (int i = 0; i < d_.n; ++i) f[i] /= mass_[i];
      return f;
    }
    Real c = coupled_;
    if (d_.coupling == Coupling::Swinging) {
      const Real difference = s.q[0] - s.q[1], sine = sin(difference);
      f[0] -= coupled_ * s.v[1] * s.v[1] * sine;
      f[1] += coupled_ * s.v[0] * s.v[0] * sine;
      c = coupled_ * cos(difference);
    }
    const Real determinant = mass_[0] * mass_[1] - c * c;
    Vector a{};
    a[0] = (mass_[1] * f[0] - c * f[1]) / determinant;
    a[1] = (mass_[0] * f[1] - c * f[0]) / determinant;
    for (int i = 2; i < d_.n; ++i) a[i] = f[i] / mass_[i];
    return a;
  }

  /// l x'' = −g sin x − X'' cos x,  X'' = (a/w²) tanh''.
  Vector pivot(const State<Real>& s) const {
    const Real u = (s.t - time_) / width_;
    Real jerk = 0;
    if (fabs(u) < 60) {
      const Real c = cosh(u);
      jerk = -2 * tanh(u) / (c * c) * way_ / (width_ * width_);
    }
    Vector a{};
    a[0] = -(gravity_ * sin(s.q[0]) + jerk * cos(s.q[0])) / length_;
    return a;
  }

  const Description& d_;
  std::mt19937_64 random_;
  double perturbation_;
  std::vector<Constants> constants_;
  std::array<Real, most> mass_{};
  Real coupled_ = 0, length_ = 1, gravity_ = 0, way_ = 0, time_ = 0, width_ = 1;
  State<Real> start_;
};

}  // namespace steep

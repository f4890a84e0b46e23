#pragma once
#include "description.hpp"
#include "real.hpp"

#include <stdexcept>

/// Values and slopes of the shapes, by hand. Switches: a shape has up to four functions whose signs (the bits) choose
/// its branch; a branch goes on beyond its switch, so that a step can look there.
namespace steep {

inline constexpr int most_switches = 6;

inline int switches_of(Shape shape) {
  switch (shape) {
    case Shape::Ramp:
    case Shape::RampSquare:
    case Shape::Abs:
    case Shape::Jump:
    case Shape::Square:
    case Shape::Pwm:
    case Shape::Rectified:
    case Shape::Gate:
    case Shape::RoundPen:
      return 1;
    case Shape::Saturation:
    case Shape::Window:
    case Shape::Clip:
      return 2;
    case Shape::Nested:
      return 4;
    default:
      return 0;
  }
}

/// Switch function k at u, and its slope.
template <class Real>
Real switch_value(Shape shape, int k, const Real& u, const Real& extra) {
  switch (shape) {
    case Shape::Ramp:
    case Shape::RampSquare:
    case Shape::Abs:
    case Shape::Jump:
      return u;
    case Shape::RoundPen:
      return u - 1;
    case Shape::Saturation:
      return k == 0 ? Real(u + 1) : Real(u - 1);
    case Shape::Window:
      return k == 0 ? u : Real(u - 1);
    case Shape::Square:
    case Shape::Rectified:
      return sin(u);
    case Shape::Pwm:
      return sin(u) - extra;
    case Shape::Clip:
      return k == 0 ? Real(3 * sin(u) + 1) : Real(3 * sin(u) - 1);
    case Shape::Gate:
      return exp(-u * u) - Real(0.5);
    case Shape::Nested:
      return k == 0 ? Real(u - 2) : k == 1 ? Real(u - 5) : k == 2 ? sin(3 * u) : cos(5 * u);
    default:
      throw std::logic_error("a shape without switches");
  }
}

template <class Real>
Real switch_slope(Shape shape, int k, const Real& u) {
  switch (shape) {
    case Shape::Square:
    case Shape::Rectified:
    case Shape::Pwm:
      return cos(u);
    case Shape::Clip:
      return 3 * cos(u);
    case Shape::Gate:
      return -2 * u * exp(-u * u);
    case Shape::Nested:
      return k < 2 ? Real(1) : k == 2 ? Real(3 * cos(3 * u)) : Real(-5 * sin(5 * u));
    default:
      return 1;
  }
}

/// f(u) for forces. What is below e^-100 counts as nothing.
template <class Real>
Real value(Shape shape, const Real& u, const Real& extra, const bool* bit) {
  const double near = static_cast<double>(u);
  switch (shape) {
    case Shape::One:
      return 1;
    case Shape::Cosine:
      return 1 - cos(u);
    case Shape::Gauss:
      return near * near > 100 ? Real(0) : exp(-u * u);
    case Shape::Sech2: {
      if (std::abs(near) > 50) return 0;
      const Real c = cosh(u);
      return 1 / (c * c);
    }
    case Shape::TanhStep:
      return near > 60 ? Real(1) : near < -60 ? Real(0) : Real((1 + tanh(u)) / 2);
    case Shape::Logistic:
      return near > 100 ? Real(1) : near < -100 ? Real(0) : Real(1 / (1 + exp(-u)));
    case Shape::Lorentz:
      return 1 / (1 + u * u);
    case Shape::Comb:
      return static_cast<double>(extra) * (1 - std::cos(near)) > 100 ? Real(0) : exp(extra * (cos(u) - 1));
    case Shape::Tanh:
      return std::abs(near) > 60 ? Real(near > 0 ? 1 : -1) : tanh(u);
    case Shape::Stribeck: {
      const Real bump = near * near > 1e4 ? Real(0) : Real(extra * exp(-u * u / 100));
      return (1 + bump) * (std::abs(near) > 60 ? Real(near > 0 ? 1 : -1) : tanh(u));
    }
    case Shape::Coulomb:
      return u / sqrt(u * u + 1);
    case Shape::Ramp:
      return bit[0] ? u : Real(0);
    case Shape::Jump:
      return bit[0] ? 1 : 0;
    case Shape::Saturation:
      return bit[1] ? Real(1) : bit[0] ? u : Real(-1);
    case Shape::Window:
      return bit[0] && !bit[1] ? 1 : 0;
    case Shape::Square:
      return bit[0] ? 1 : -1;
    case Shape::Pwm:
      return bit[0] ? 1 : 0;
    case Shape::Clip:
      return bit[1] ? Real(1) : bit[0] ? Real(3 * sin(u)) : Real(-1);
    case Shape::Rectified:
      return bit[0] ? sin(u) : Real(-sin(u));
    case Shape::Gate:
      return bit[0] ? 1 : 0;
    case Shape::Nested:
      return !bit[0] ? Real(bit[2] ? 1 : -1) : !bit[1] ? Real(bit[3] ? 2 : -2) : Real(Real(3) / 10);
    default:
      throw std::logic_error("a shape that is no force");
  }
}

/// f'(u) for energies and dissipation; for shapes of ρ, df/dρ.
template <class Real>
Real slope(Shape shape, const Real& u, const Real& extra, const bool* bit) {
  const double near = static_cast<double>(u);
  switch (shape) {
    case Shape::Harmonic:
      return u;
    case Shape::Cosine:
      return sin(u);
    case Shape::Exp:
      return near < -100 ? Real(0) : exp(u);
    case Shape::Gauss:
      return near * near > 100 ? Real(0) : Real(-2 * u * exp(-u * u));
    case Shape::TanhStep: {
      if (std::abs(near) > 50) return 0;
      const Real c = cosh(u);
      return 1 / (2 * c * c);
    }
    case Shape::Lorentz: {
      const Real d = 1 + u * u;
      return -2 * u / (d * d);
    }
    case Shape::Comb:
      return static_cast<double>(extra) * (1 - std::cos(near)) > 100
                 ? Real(0)
                 : Real(-extra * sin(u) * exp(extra * (cos(u) - 1)));
    case Shape::Power: {
      const int n = static_cast<int>(std::lround(static_cast<double>(extra)));
      return n * power(u, n - 1);
    }
    case Shape::LennardJones: {
      const Real a = 1 / u, a2 = a * a, a6 = a2 * a2 * a2;
      return 4 * (-12 * a6 * a6 * a + 6 * a6 * a);
    }
    case Shape::LogCosh:
      return std::abs(near) > 60 ? Real(near > 0 ? 1 : -1) : tanh(u);
    case Shape::Root:
      return u / sqrt(u * u + 1);
    case Shape::RampSquare:
      return bit[0] ? Real(2 * u) : Real(0);
    case Shape::Abs:
      return bit[0] ? 1 : -1;
    case Shape::RoundGauss:
      return near > 100 ? Real(0) : Real(-exp(-u));
    case Shape::Plummer: {
      const Real r = sqrt(u + 1);
      return 1 / (2 * r * r * r);
    }
    case Shape::RoundRoot:
      return 1 / (2 * sqrt(u + 1));
    case Shape::RoundPen:
      return bit[0] ? Real(1 - 1 / sqrt(u)) : Real(0);
    case Shape::Core: {
      const int halves = static_cast<int>(std::lround(2 * static_cast<double>(extra)));
      return -extra / (power(u, halves / 2 + 1) * (halves % 2 == 0 ? Real(1) : Real(sqrt(u))));
    }
    default:
      throw std::logic_error("a shape that is no energy");
  }
}

/// How far u may move within one step of the reference (for shapes of ρ: √ρ): well inside each feature, and towards one
/// from afar by a part of the distance.
inline double spacing(Shape shape, double u, double extra) {
  constexpr double far = 1e300, pi = 3.14159265358979323846;
  const double distance = std::abs(u);
  switch (shape) {
    case Shape::One:
    case Shape::Harmonic:
    case Shape::Window:
    case Shape::Ramp:
    case Shape::RampSquare:
    case Shape::Abs:
    case Shape::Jump:
    case Shape::Saturation:
      return far;
    case Shape::Exp:
      return u < 0 ? std::max(0.5, 0.25 * distance) : 0.5;
    case Shape::Power:
      return std::max(0.5 / extra, 0.25 * (1 - distance));
    case Shape::LennardJones:
    case Shape::Core:
      return 0.15 * distance;
    case Shape::Comb: {
      const double to_peak = std::abs(std::remainder(u, 2 * pi));
      return std::max(0.4 / std::sqrt(extra), 0.25 * to_peak);
    }
    case Shape::Cosine:
      return 1;
    case Shape::Square:
    case Shape::Pwm:
    case Shape::Clip:
    case Shape::Rectified:
      return 0.4;
    case Shape::Nested:
      return 0.1;
    case Shape::RoundPen:
      return 0.25;
    case Shape::Stribeck:
      return std::max(0.4, 0.25 * distance);
    default:
      return std::max(0.4, 0.25 * distance);
  }
}

}  // namespace steep

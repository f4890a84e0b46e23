#include <maupertuis/slopes.hpp>

#include <maupertuis/kinds.hpp>
#include <maupertuis/lambert_w.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double half_pi = 1.5707963267948966;

double inverse(double x) { return x > 0 ? 1 / x : infinity; }
double positive(double x) { return std::max(0.0, x); }
/// The product of the distances of the disk from the branch points ±1.
double from_ones(double w, double d) { return positive(std::abs(1 - w) - d) * positive(std::abs(1 + w) - d); }

}  // namespace

double largest_slope(Kind function, double w, double d, double low) {
  const double size = std::abs(w);
  switch (function) {
    case Kind::Exp:
      return std::exp(w + d);
    case Kind::Log:
      return inverse(low);
    case Kind::Tan: {  // 1/cos²
      const double cosh = std::cosh(d), sinh = std::sinh(d), c = std::abs(std::cos(w)), s = std::abs(std::sin(w));
      const double least = positive(c - (c * (cosh - 1) + s * sinh));
      return inverse(least * least);
    }
    case Kind::Asin:
    case Kind::Acos:
      return inverse(std::sqrt(from_ones(w, d)));
    case Kind::Atan: {
      const double least = positive(std::hypot(1.0, w) - d);
      return inverse(least * least);
    }
    case Kind::Tanh: {  // |cosh w| ≥ sinh |Re w|, and ≥ cos |Im w|
      const double least = std::max(d < half_pi ? std::cos(d) : 0.0, size > d ? std::sinh(size - d) : 0.0);
      return inverse(least * least);
    }
    case Kind::Asinh:
      return inverse(positive(std::hypot(1.0, w) - d));
    case Kind::Acosh:
      return inverse(std::sqrt(positive(w - 1 - d) * positive(w + 1 - d)));
    case Kind::Atanh:
      return inverse(from_ones(w, d));
    case Kind::Erf: {  // |exp(−w²)| = exp(−Re w²), largest on the rim: in front of the centre, or beside it
      const double real = size <= 2 * d ? 0.5 * size * size - d * d : (size - d) * (size - d);
      return 1.1283791670955126 * std::exp(-real);
    }
    case Kind::LambertW: {  // W = ∫ z/(z + t) dσ(t) over t ≥ 1/e with dσ ≥ 0, so that |W′(z)| ≤ W′(Re z)
      const double next = w - d;  // towards the branch point −1/e
      return next > -0.367879441171 ? inverse(next + std::exp(lambert_w(next))) : infinity;
    }
    case Kind::Number:
    case Kind::Pi:
    case Kind::Symbol:
    case Kind::Sum:
    case Kind::Product:
    case Kind::Power:
    case Kind::TimeDerivative:
    case Kind::Sin:
    case Kind::Cos:
    case Kind::Sinh:
    case Kind::Cosh:
    case Kind::Abs:
    case Kind::Sign:
    case Kind::Step:
    case Kind::Min:
    case Kind::Max:
    case Kind::Atan2:
    case Kind::Piecewise:
    case Kind::Less:
    case Kind::LessEqual:
    case Kind::And:
    case Kind::Or:
      break;
  }
  throw unknown_kind(function, "the bounds on disks");
}

}  // namespace maupertuis

#include "disks/rules.hpp"

#include <maupertuis/slopes.hpp>

#include <algorithm>

namespace maupertuis::disk_rules {
namespace {

double power_of(double base, double exponent) { return exponent == 0 ? 1.0 : std::pow(base, exponent); }

}  // namespace

/// f′ = c w^{c−1}, largest where |w| is largest or smallest; a disk about 0 is one of whole positive powers alone.
/// Others have a branch point there: values of bounded modulus, but no series, whatever they are multiplied by.
Bounds<double> power(const Bounds<double>& a, double c, double value) {
  if (c == 0) return {0, 0, 1, 1};
  const bool is_whole = c > 0 && c == std::nearbyint(c);
  if (!(a.low > 0) && !is_whole) return unbounded<double>();
  const double slope = std::abs(c) * power_of(c >= 1 ? a.high : a.low, c - 1);
  const double at_low = power_of(a.low, c), at_high = power_of(a.high, c);
  const double low = std::min(at_low, at_high), high = std::max(at_low, at_high);
  const double reach = a.reach == 0 ? 0.0 : smaller(slope * a.reach, high + value);
  return {reach, reach, low, high};
}

/// sin w − sin w₀ = sin w₀ (cos z − 1) + cos w₀ sin z with |z| ≤ δ; cos likewise, with s and c exchanged.
Bounds<double> sine(const Bounds<double>& a, double s, double c) {
  const double d = a.reach;
  // cosh 1 = 1.54308
  const double cosh = d <= 1 ? 1 + 0.5431 * d * d : std::cosh(d), sinh = d <= 1 ? d * cosh : std::sinh(d);
  const double reach = s * (0.5 * d * sinh) + c * sinh;  // cosh − 1 ≤ ½ d sinh
  return {reach, reach, 0, cosh};
}

/// |sinh w| and |cosh w| lie between sinh and cosh of |Re w|.
Bounds<double> hyperbolic(const Bounds<double>& a, double w, double value) {
  const double d = a.reach, most = std::cosh(w + d), least = w > d ? std::sinh(w - d) : 0.0;
  const double reach = smaller(d * most, most + value);
  return {reach, reach, least, most};
}

/// The reach of f(w) from the largest |f′| on the disk of w.
Bounds<double> function(Kind f, const Bounds<double>& a, const Bounds<double>* b, double w, double v, double value) {
  const double d = a.reach;
  if (d == 0 && (!b || b->reach == 0)) return {0, 0, value, value};
  if (!(d < infinity)) return unbounded<double>();
  if (f == Kind::Exp) {
    const double high = std::exp(w + d), reach = high * std::min(1.0, d);
    return {reach, reach, std::exp(w - d), high};
  }
  if (f == Kind::Atan2) {  // |dφ| ≤ (|dx| + |dy|)/|x ± iy|
    const double both = d + b->reach, far = std::hypot(w, v) - both;
    const double reach = far > 0 ? both / far : infinity;
    return {reach, reach, 0, infinity};
  }
  const double slope = largest_slope(f, w, d, a.low);
  const double reach = slope >= 0 ? slope * d : infinity;
  return {reach, reach, 0, infinity};
}

}  // namespace maupertuis::disk_rules

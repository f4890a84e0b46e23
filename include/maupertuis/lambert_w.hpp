#pragma once
#include <cmath>
#include <limits>

namespace maupertuis {

/// W(x), the root w ≥ −1 of w eʷ = x; NaN for x < −1/e. Right to 2 units in the last place, near −1/e too.
double lambert_w(double x);

/// The root of w eʷ = x near `w`, which may not be 0.
/// Source: F. N. Fritsch, R. E. Shafer, W. P. Crowley, CACM 16 (1973), algorithm 443: a pass makes four times as many
/// digits.
template <class Real>
Real lambert_w_near(Real w, const Real& x) {
  using std::abs, std::log;
  const Real enough = std::numeric_limits<Real>::epsilon() * 8;
  for (int pass = 0; pass < 40; ++pass) {
    const Real up = 1 + w;
    if (!(up > 0)) return Real(-1);
    const Real z = log(x / w) - w, q = 2 * up * (up + 2 * z / 3);
    const Real change = z / up * (q - z) / (q - 2 * z);
    w += w * change;
    if (!(abs(change) * up > enough)) break;
  }
  return w;
}

/// W(x) of a real type of more digits than double. Towards x = −1/e, where W' grows without bound, the value is that of
/// an argument off by a few units in its last place.
template <class Real>
Real lambert_w(const Real& x) {
  using std::abs, std::exp, std::log, std::sqrt;
  if (abs(x) < std::numeric_limits<Real>::epsilon() / 2) return x * (1 - x);  // x − x² + …
  if (x > 1e300) return x > std::numeric_limits<Real>::max() ? x : lambert_w_near(Real(log(x)), x);
  if (!(x < -0.3678)) return lambert_w_near(Real(lambert_w(static_cast<double>(x))), x);  // also NaN
  const Real square = 2 * (exp(Real(1)) * x + 1);
  if (square < 0) return std::numeric_limits<Real>::quiet_NaN();
  const Real p = sqrt(square);
  return p == 0 ? Real(-1) : lambert_w_near(Real(p - square / 3 - 1), x);
}

}  // namespace maupertuis

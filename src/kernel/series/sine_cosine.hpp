#pragma once
#include "kernel/series/vector.hpp"

/// sin x and cos x of all lanes with an error below one unit in the last place.
///
/// x − n π/2 is found in twice the precision, with π/2 as a sum of three doubles: exact to 2⁻¹⁰⁰ for |x| < 2²⁰, beyond
/// which a lane is left to the standard library. On |r| ≤ π/4 the minimax polynomials of fdlibm (k_sin.c, k_cos.c;
/// Sun Microsystems 1993) with the lower half of r as a correction.
namespace maupertuis::series {

/// Those of the standard library, in a file of their own (see vector.hpp).
double standard_sine(double x);
double standard_cosine(double x);

namespace {

template <int W>
struct SineCosine {
  using V = Vec<W>;
  V sine, cosine;

  explicit SineCosine(const V& x) {
    constexpr double shifter = 0x1.8p52;  // adding it rounds to a whole number, whose last bits it then ends with
    const V shifted = fma(x, 0x1.45f306dc9c883p-1, V::all(shifter));
    const V n = shifted - shifter;
    reduce(x, n);
    polynomials();
    to_quadrant(shifted);
    const Mask<W> inside = absolute(x) < V::all(0x1p20);
    if (!holds_everywhere(inside)) replace_outside(x);
  }

 private:
  /// (high, low) = x − n π/2; the first difference is exact.
  void reduce(const V& x, const V& n) {
    const V first = exact_fma(n, -0x1.921fb54442d18p0, x);
    const V product = n * 0x1.1a62633145c07p-54;
    const V error = exact_fma(n, 0x1.1a62633145c07p-54, -product);
    high_ = first - product;
    const V back = high_ - first;
    const V lost = (first - (high_ - back)) - (product + back);
    low_ = lost - fma(n, -0x1.f1976b7ed8fbcp-110, error);
    const V sum = high_ + low_;
    low_ = low_ - (sum - high_);
    high_ = sum;
  }

  void polynomials() {
    const V z = high_ * high_;
    V s = fma(z, 1.58969099521155010221e-10, V::all(-2.50507602534068634195e-08));
    s = fma(s, z, V::all(2.75573137070700676789e-06));
    s = fma(s, z, V::all(-1.98412698298579493134e-04));
    s = fma(s, z, V::all(8.33333333332248946124e-03));
    const V v = z * high_;
    // r − ((z (low/2 − v s) − low) − v S₁)
    const V inner = z * fma(-v, s, low_ * 0.5) - low_;
    sine = high_ - fma(v, 1.66666666666666324348e-01, inner);

    V c = fma(z, -1.13596475577881948265e-11, V::all(2.08757232129817482790e-09));
    c = fma(c, z, V::all(-2.75573143513906633035e-07));
    c = fma(c, z, V::all(2.48015872894767294178e-05));
    c = fma(c, z, V::all(-1.38888888888741095749e-03));
    c = fma(c, z, V::all(4.16666666666666019037e-02));
    const V half = z * 0.5, one = V::all(1), w = one - half;
    const V rest = fma(z * z, c, -(high_ * low_));
    cosine = w + (((one - w) - half) + rest);
  }

  void to_quadrant(const V& shifted) {
    for (int i = 0; i < V::parts; ++i) {
      using I = typename V::Integers;
      I n;
      __builtin_memcpy(&n, &shifted.part[i], sizeof n);
      const auto odd = (n & 1) != 0;
      const auto s = odd ? cosine.part[i] : sine.part[i], c = odd ? sine.part[i] : cosine.part[i];
      sine.part[i] = (n & 2) != 0 ? -s : s;
      cosine.part[i] = ((n + 1) & 2) != 0 ? -c : c;
    }
  }

  void replace_outside(const V& x) {
    alignas(64) double value[W], s[W], c[W];
    x.store(value), sine.store(s), cosine.store(c);
    for (int lane = 0; lane < W; ++lane) {
      if (value[lane] > -0x1p20 && value[lane] < 0x1p20) continue;
      s[lane] = standard_sine(value[lane]);
      c[lane] = standard_cosine(value[lane]);
    }
    sine = V::load(s), cosine = V::load(c);
  }

  V high_, low_;
};

}  // namespace
}  // namespace maupertuis::series

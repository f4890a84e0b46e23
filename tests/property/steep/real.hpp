#pragma once
#include <quadmath.h>

#include <cmath>
#include <string>

/// The two number types of the reference: 113 bits for its values, 64 bits for the second, coarser run that confirms
/// them.
namespace steep {

__extension__ typedef __float128 Quad;
using Long = long double;

inline Quad exp(Quad x) { return expq(x); }
inline Quad sin(Quad x) { return sinq(x); }
inline Quad cos(Quad x) { return cosq(x); }
inline Quad tanh(Quad x) { return tanhq(x); }
inline Quad cosh(Quad x) { return coshq(x); }
inline Quad sqrt(Quad x) { return sqrtq(x); }
inline Quad fabs(Quad x) { return fabsq(x); }
using std::cos, std::cosh, std::exp, std::fabs, std::sin, std::sqrt, std::tanh;

template <class Real>
Real power(Real x, int n) {
  Real out = 1;
  for (int left = n; left > 0; left >>= 1, x *= x)
    if (left & 1) out *= x;
  return out;
}

/// The number that is written, rounded once.
template <class Real>
Real parse(const std::string& text);
template <>
inline Quad parse<Quad>(const std::string& text) {
  return strtoflt128(text.c_str(), nullptr);
}
template <>
inline Long parse<Long>(const std::string& text) {
  return std::strtold(text.c_str(), nullptr);
}

}  // namespace steep

#pragma once
#include <cstdint>

/// Logarithms and powers for step lengths, which need no more than three digits. V: double or a vector of doubles, I:
/// 64-bit integers of the same number. Of low degree and by Estrin's scheme, since much waits for a step length.
/// Compiled for one instruction set, hence the unnamed namespace.
namespace maupertuis {
namespace {

/// log₂ x for x > 0 to 6.4·10⁻⁴: minimax on the mantissa.
template <class V, class I>
V rough_log2(V x) {
  I bits;
  __builtin_memcpy(&bits, &x, sizeof bits);
  const I whole = ((bits >> 52) & 0x7ff) | 0x4330000000000000;  // 2⁵² + exponent
  const I fraction = (bits & 0x000fffffffffffff) | 0x3ff0000000000000;
  V e, f;
  __builtin_memcpy(&e, &whole, sizeof e);
  __builtin_memcpy(&f, &fraction, sizeof f);
  e = e - (0x1p52 + 1023);
  f = f - 1;
  return (e + (f * 1.4188802113925905 + 0.0006371172847411266)) +
         (f * f) * (f * 0.15824870276503722 - 0.5771289141576275);
}

/// 2^x to 7.5·10⁻⁵ of it between 2⁻¹⁰²⁰ and 2¹⁰²⁰, beyond which it stays.
template <class V, class I>
V rough_exp2(V x) {
  x = x < V{} + 1020 ? x : V{} + 1020;
  x = x > V{} - 1020 ? x : V{} - 1020;
  const V shifted = x + 0x1.8p52, f = x - (shifted - 0x1.8p52);
  V sum = (f * 0.6932609854573358 + 0.9999280735404955) + (f * f) * (f * 0.05517166907486526 + 0.242611122194331);
  I n, bits;
  __builtin_memcpy(&n, &shifted, sizeof n);
  __builtin_memcpy(&bits, &sum, sizeof bits);
  bits = bits + (n << 52);
  __builtin_memcpy(&sum, &bits, sizeof sum);
  return sum;
}

}  // namespace
}  // namespace maupertuis

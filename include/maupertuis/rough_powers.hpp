#pragma once
#include <cstdint>

/// Logarithms and powers for step lengths, which need no more than a few digits. V: double or a vector of doubles, I: 64-bit integers of
/// the same number. By Estrin's scheme, since much waits for a step length. Compiled for one instruction set, hence the unnamed namespace.
namespace maupertuis {
namespace {

/// log₂ x for x > 0 to 3·10⁻⁶: minimax on the mantissa.
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
  const V square = f * f;
  const V low = (f * 1.4424535262106073 + 2.4434387202040227e-06) + square * (f * 0.4545084921997887 - 0.7173127802648969);
  const V high = (f * 0.11761308406665116 - 0.2726975648528732) - square * 0.02456853474529919;
  return (e + low) + (square * square) * high;
}

/// 2^x to 10⁻⁷ between 2⁻¹⁰²⁰ and 2¹⁰²⁰, beyond which it stays.
template <class V, class I>
V rough_exp2(V x) {
  x = x < V{} + 1020 ? x : V{} + 1020;
  x = x > V{} - 1020 ? x : V{} - 1020;
  const V shifted = x + 0x1.8p52, f = x - (shifted - 0x1.8p52);
  const V square = f * f;
  const V low = (f * 0.6931471880262288 + 1.0000000754548972) + square * (f * 0.05550357114219078 + 0.2402210748530834);
  V sum = low + (square * square) * (f * 0.0013390863364671234 + 0.009676031918322054);
  I n, bits;
  __builtin_memcpy(&n, &shifted, sizeof n);
  __builtin_memcpy(&bits, &sum, sizeof bits);
  bits = bits + (n << 52);
  __builtin_memcpy(&sum, &bits, sizeof sum);
  return sum;
}

}  // namespace
}  // namespace maupertuis

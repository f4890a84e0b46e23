#pragma once
#include <optional>
#include <span>
#include <type_traits>

namespace maupertuis::taylor {

/// The first x in [0, 1] where the polynomial Σ p_k x^k leaves its side of zero: where side · p goes from ≥ 0 to below
/// its rounding error. A touch without crossing, to within that error, is none. No pair of close roots is missed:
/// intervals are excluded only when all Bernstein coefficients of the polynomial say so, and halved until they do or
/// one root is left. Cost: that of a comparison of coefficients when the polynomial stays clear of zero.
///
/// The rounding error at x is taken to be unit · (scale + Σ_{k≥1} |p_k| x^k).
///
/// Precondition: side is +1 or −1.
template <class T>
std::optional<T> first_crossing(std::span<const T> p, int side, const std::type_identity_t<T>& unit,
                                const std::type_identity_t<T>& scale);
inline std::optional<double> first_crossing(std::span<const double> p, int side, double unit, double scale) {
  return first_crossing<double>(p, side, unit, scale);
}

}  // namespace maupertuis::taylor

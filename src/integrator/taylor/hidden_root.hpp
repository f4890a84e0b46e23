#pragma once
#include "integrator/taylor/switches_code.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

/// What rounding hides about a root of higher order.
namespace maupertuis::taylor {

/// The stretch about a root in which a polynomial is not told from zero: wide where its slope vanishes with it.
template <class T>
struct HiddenRoot {
  T low, high;             // in [0, 1]
  std::uint8_t order = 1;  // of the first power, odd, that makes the polynomial what it is at the ends

  T middle() const { return T(0.5) * (low + high); }
  T half_width() const { return T(0.5) * (high - low); }
};

namespace hiding {

/// From the root to one side: as far as rounding hides the polynomial, to a thousandth of the way.
template <class T>
T edge(const ScaledPolynomialOf<T>& polynomial, const T& root, int towards) {
  using std::abs;
  constexpr int clear = 4;  // rounding errors: a root may have been found where the first of them is left
  const T most = towards > 0 ? T(1) - root : root;
  const auto is_told = [&](const T& way) {
    const T x = root + towards * way;
    return abs(crossings::value(std::span<const T>(polynomial.p), x)) > T(clear) * polynomial.error_up_to(x);
  };
  T hidden = T(0), told = std::min(most, T(std::numeric_limits<T>::epsilon()));
  while (told < most && !is_told(told)) hidden = told, told = std::min(most, T(2 * told));
  for (int turn = 0; turn < 10; ++turn) {
    const T middle = T(0.5) * (hidden + told);
    (is_told(middle) ? told : hidden) = middle;
  }
  return root + towards * told;
}

}  // namespace hiding

/// How far rounding moves a root of this slope, at least.
template <class T>
T hidden_by_slope(const ScaledPolynomialOf<T>& polynomial, const T& root) {
  using std::abs;
  T slope = T(0);
  for (std::size_t k = polynomial.p.size(); k-- > 1;) slope = slope * root + T(k) * polynomial.p[k];
  return polynomial.error_up_to(root) / abs(slope);
}

template <class T>
HiddenRoot<T> hidden_about(const ScaledPolynomialOf<T>& polynomial, const T& root) {
  using std::abs;
  constexpr double weighs = 0.1;  // beside the largest term
  HiddenRoot<T> out{hiding::edge(polynomial, root, -1), hiding::edge(polynomial, root, 1)};
  std::vector<T> p = polynomial.p;  // about the middle, in units of the half width
  const T x = out.middle();
  T power = T(1), largest = T(0);
  for (std::size_t done = 0; done < p.size(); ++done, power *= out.half_width()) {
    for (std::size_t k = p.size() - 1; k-- > done;) p[k] += x * p[k + 1];
    p[done] = abs(p[done]) * power;
    if (done > 0) largest = std::max(largest, p[done]);
  }
  for (std::size_t k = 1; largest > 0 && k < p.size(); k += 2)
    if (p[k] >= T(weighs) * largest) out.order = static_cast<std::uint8_t>(k);
  return out;
}

template <class T>
ScaledPolynomialOf<T> slope_of(const ScaledPolynomialOf<T>& polynomial) {
  using std::abs;
  ScaledPolynomialOf<T> out{{}, polynomial.scale, polynomial.scale};
  for (std::size_t k = 1; k < polynomial.p.size(); ++k) {
    out.p.push_back(T(k) * polynomial.p[k]);
    if (k > 1) out.reach += abs(out.p.back());
  }
  return out;
}

}  // namespace maupertuis::taylor

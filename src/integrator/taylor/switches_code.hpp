#pragma once
#include "integrator/taylor/crossing_code.hpp"
#include "integrator/taylor/switches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace maupertuis::taylor {
namespace watching {

template <class T>
std::int8_t sign(const T& x) {
  return static_cast<std::int8_t>((x > 0) - (x < 0));
}

/// Roundings that a coefficient has gone through are some tens; its tolerance is counted in those.
template <class T>
T unit() {
  return 16 * std::numeric_limits<T>::epsilon();
}

/// Whether a value is nothing but rounding of its terms; at a pole both are infinite.
template <class T>
bool is_zero(const T& value, const T& scale) {
  using std::abs;
  return abs(value) <= unit<T>() * scale && abs(value) <= std::numeric_limits<T>::max();
}

template <class T, class Coefficient>
ScaledPolynomialOf<T> scaled(int degree, const T& h, const T& scale, Coefficient&& coefficient) {
  using std::abs;
  ScaledPolynomialOf<T> result;
  T power = T(1);
  result.scale = result.reach = scale;
  result.p.reserve(static_cast<std::size_t>(degree) + 1);
  for (int k = 0; k <= degree; ++k, power *= h) {
    result.p.push_back(coefficient(k) * power);
    if (k > 0) result.reach += abs(result.p.back());
  }
  return result;
}

}  // namespace watching

template <class T>
T ScaledPolynomialOf<T>::error_up_to(const T& x) const {
  using std::abs;
  T sum = T(0);
  for (std::size_t k = p.size(); k-- > 1;) sum = (sum + abs(p[k])) * x;
  return watching::unit<T>() * (scale + sum);
}

template <class T>
std::size_t ScaledPolynomialOf<T>::leading(std::size_t from) const {
  using std::abs;
  for (std::size_t k = from; k < p.size(); ++k)
    if (abs(p[k]) > watching::unit<T>() * reach) return k;
  return 0;
}

template <class T>
bool ScaledPolynomialOf<T>::begins_at_zero() const {
  return watching::is_zero(p[0], scale);
}

template <class T>
std::int8_t ScaledPolynomialOf<T>::direction(std::size_t from) const {
  const std::size_t k = leading(from);
  return k == 0 ? std::int8_t{0} : watching::sign(p[k]);
}

template <class T>
ScaledPolynomialOf<T> judged(const ScaledPolynomialOf<T>& whole) {
  ScaledPolynomialOf<T> polynomial = whole;
  using std::abs;
  constexpr std::size_t early = 4;
  constexpr int most_halvings = 200;
  for (int turn = 0; turn < most_halvings; ++turn) {
    T first = T(0), later = T(0), power = T(1);
    for (std::size_t k = 1; k < polynomial.p.size(); ++k) (k <= early ? first : later) += abs(polynomial.p[k]);
    if (later <= first / 16) break;
    for (T& c : polynomial.p) c *= power, power *= T(0.5);
    polynomial.reach = polynomial.scale;
    for (std::size_t k = 1; k < polynomial.p.size(); ++k) polynomial.reach += abs(polynomial.p[k]);
  }
  return polynomial.direction() == 0 ? whole : polynomial;  // its first terms are rounding
}

template <class Work, class T>
ScaledPolynomialOf<T> switch_polynomial(const Work& work, std::size_t index, const std::type_identity_t<T>& h) {
  return watching::scaled<T>(work.order() + 1, h, work.switch_scale(index),
                             [&](int k) { return work.switch_function(index, k); });
}

template <class Work, class T>
ScaledPolynomialOf<T> event_polynomial(const Work& work, std::size_t index, const std::type_identity_t<T>& h) {
  return watching::scaled<T>(work.order() + 1, h, work.event_scale(index), [&](int k) { return work.event(index, k); });
}

namespace watching {

/// Newton on the whole polynomial: a zero that was divided out is zero to rounding only, and what rounding left there
/// must not be counted twice.
template <class T>
T polished(std::span<const T> p, T x) {
  using std::abs;
  for (int turn = 0; turn < 2; ++turn) {
    T value = T(0), slope = T(0);
    for (std::size_t k = p.size(); k-- > 0;) {
      slope = slope * x + value;
      value = value * x + p[k];
    }
    const T better = x - value / slope;
    if (!(abs(better - x) < T(1e-10) * x)) break;
    x = better;
  }
  return x;
}

}  // namespace watching

template <class T>
std::optional<T> crossing(const ScaledPolynomialOf<T>& polynomial, const Watched& watched) {
  const T unit = watching::unit<T>();
  if (watched.side == 0) return std::nullopt;
  const std::span<const T> p = polynomial.p;
  if (!watched.at_zero && !polynomial.begins_at_zero()) return first_crossing(p, watched.side, unit, polynomial.scale);
  const std::size_t k = polynomial.leading(watched.order);
  if (k == 0) return std::nullopt;
  const auto x = first_crossing(p.subspan(k), watched.side, unit, T(0));
  return x ? std::optional<T>(std::min(T(1), watching::polished(p, *x))) : x;
}

namespace watching {

/// Over [low, high], from left to right through halves.
template <class T>
std::optional<T> first_unclear(const ScaledPolynomialOf<T>& polynomial, const T& low, const T& high, std::vector<T> b) {
  constexpr double clear = 4, close = 1e-9;  // in rounding errors; of the place itself
  if (*std::min_element(b.begin(), b.end()) > T(clear) * polynomial.error_up_to(high)) return std::nullopt;
  if (high - low <= T(close) * high || high <= 64 * std::numeric_limits<T>::epsilon()) return low;
  const T middle = T(0.5) * (low + high);
  std::vector<T> right = crossings::split(b);
  if (const auto left = first_unclear(polynomial, low, middle, std::move(b))) return left;
  return first_unclear(polynomial, middle, high, std::move(right));
}

}  // namespace watching

template <class T>
std::optional<T> first_unclear(const ScaledPolynomialOf<T>& polynomial, const Watched& watched,
                               const std::type_identity_t<T>& until) {
  const auto search = [&](const ScaledPolynomialOf<T>& over) {
    std::vector<T> p = over.p;
    T power = T(1);
    for (T& c : p) c *= power, power *= until;
    return watching::first_unclear<T>(over, T(0), until, crossings::to_bernstein(std::move(p), watched.side));
  };
  if (!watched.at_zero && !polynomial.begins_at_zero()) return search(polynomial);
  const std::size_t k = polynomial.leading(watched.order);  // a zero that is known is divided out
  if (k == 0) return std::nullopt;
  ScaledPolynomialOf<T> over = polynomial;
  over.p.erase(over.p.begin(), over.p.begin() + static_cast<std::ptrdiff_t>(k));
  over.scale = T(0);
  return search(over);
}

template <class Work>
std::vector<std::int8_t> SideChooserOf<Work>::sides() const {
  std::vector<std::int8_t> result;
  for (const Watched& w : watched_) result.push_back(w.side);
  return result;
}

template <class Work>
void SideChooserOf<Work>::adopt(const std::vector<std::int8_t>& sides) {
  for (std::size_t i = 0; i < sides.size(); ++i) watched_[i].side = sides[i];
}

/// Finds the functions at a zero; the others take their sign. True if that changed a side.
template <class Work>
bool SideChooserOf<Work>::collect() {
  bool changed = false;
  at_zero_.clear();
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    const T here = work_.switch_function(i, 0);
    if (watched_[i].at_zero || watching::is_zero(here, work_.switch_scale(i))) {
      at_zero_.push_back(i);
      watched_[i].at_zero = true;
    } else if (const std::int8_t side = watching::sign(here); side != watched_[i].side) {
      watched_[i].side = side;
      changed = true;
    }
  }
  return changed;
}

/// Whether every function at a zero goes to the side that was assumed.
template <class Work>
bool SideChooserOf<Work>::confirms(const T& h) const {
  for (const std::size_t i : at_zero_)
    if (judged(switch_polynomial(work_, i, h)).direction() != watched_[i].side) return false;
  return true;
}

template <class Work>
std::optional<bool> SideChooserOf<Work>::tries(const std::vector<std::int8_t>& sides) {
  adopt(sides);
  const auto h = expand_(sides);
  if (!h) return std::nullopt;
  return confirms(*h);
}

template <class Work>
typename SideChooserOf<Work>::Outcome SideChooserOf<Work>::decide(T h) {
  if (collect()) {
    const auto again = expand_(sides());
    if (!again) return Outcome::Failed;
    h = *again;
  }
  if (at_zero_.empty()) return Outcome::Decided;
  const bool known = watched_[at_zero_[0]].side != 0;
  if ((known || at_zero_.size() > 1) && confirms(h)) return Outcome::Decided;
  sliding_ = at_zero_[0];
  return at_zero_.size() == 1 ? alone(at_zero_[0]) : together();
}

/// One function at a zero. Both sides confirmed: the motion is not unique, and stays where it is if it can (at rest on
/// top of a roof). None confirmed: it slides, unless the function vanishes whatever the side.
template <class Work>
typename SideChooserOf<Work>::Outcome SideChooserOf<Work>::alone(std::size_t index) {
  auto trial = sides();
  const bool was_zero = trial[index] == 0;
  const std::int8_t first = was_zero ? std::int8_t{1} : trial[index];
  std::optional<bool> confirmed[2];
  bool vanishes = true;
  for (int turn = 0; turn < 2; ++turn) {
    trial[index] = static_cast<std::int8_t>(turn == 0 ? first : -first);
    adopt(trial);
    const auto h = expand_(trial);
    if (!h) return Outcome::Failed;
    confirmed[turn] = confirms(*h);
    vanishes = vanishes && judged(switch_polynomial(work_, index, *h)).direction() == 0;
    if (*confirmed[turn] && !was_zero) return Outcome::Decided;
  }
  const bool both = *confirmed[0] && *confirmed[1];
  if (vanishes || both) {
    trial[index] = 0;
    const auto stays = tries(trial);
    if (!stays) return Outcome::Failed;
    if (*stays) return Outcome::Decided;
  }
  if (!*confirmed[0] && !*confirmed[1]) return Outcome::Sliding;
  trial[index] = static_cast<std::int8_t>(*confirmed[0] ? first : -first);
  const auto good = tries(trial);
  return good ? Outcome::Decided : Outcome::Failed;
}

/// Several functions at a zero: all choices of sides in order, the present one first, zeros last.
template <class Work>
typename SideChooserOf<Work>::Outcome SideChooserOf<Work>::together() {
  const auto start = sides();
  constexpr std::size_t most = 6;  // 3^6 trials
  const std::size_t count = std::min(at_zero_.size(), most);
  std::size_t trials = 1;
  for (std::size_t i = 0; i < count; ++i) trials *= 3;
  for (std::size_t number = 0; number < trials; ++number) {
    auto trial = start;
    std::size_t digits = number;
    for (std::size_t i = 0; i < count; ++i, digits /= 3) {
      std::int8_t& side = trial[at_zero_[i]];
      const std::int8_t first = side == 0 ? std::int8_t{1} : side;
      side = digits % 3 == 0 ? first : digits % 3 == 1 ? static_cast<std::int8_t>(-first) : std::int8_t{0};
    }
    const auto confirmed = tries(trial);
    if (!confirmed) return Outcome::Failed;
    if (*confirmed) return Outcome::Decided;
  }
  return Outcome::Sliding;
}

}  // namespace maupertuis::taylor

#pragma once
#include "integrator/taylor/root_gap_code.hpp"
#include "integrator/taylor/root_place_code.hpp"
#include "integrator/taylor/roots.hpp"
#include "integrator/taylor/switches_code.hpp"
#include "integrator/taylor/touches_code.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::taylor {

/// A function whose reach on the disk over the window is less than its value has no root there. Where many functions
/// come near zero, those of a shorter window may be few: it begins with twice the last one.
template <class T>
void RootSearchOf<T>::find_near() {
  using std::abs;
  constexpr std::size_t many = 12;
  constexpr double shortest = 1e-4;  // in a shorter part nothing is told from rounding
  place_.known = expanded_ = false;
  near_before_ = near_;
  if (all_end() && slots_.size() <= many) {  // polynomials that are known wholly tell it themselves
    std::fill(clear_.begin(), clear_.end(), std::int8_t{0});
    note_near();
    window_ = T(1);
    if (near_ != near_before_) narrow();
    return;
  }
  const bool derives = all_disks_.needs_larger_disk();
  retrace_.values_about(T(0), derives ? 2 : 0);
  const double length = static_cast<double>(abs(h_));
  all_disks_.begin(rows_.of(retrace_.row(0), retrace_.stride(), retrace_.order(), std::ilogb(length)));
  if (derives) all_disks_.evaluate(1.5 * length, Disks::Depth::Derivatives);
  const bool may_shorten = slots_.size() > 4 * many;
  double window = may_shorten && last_window_ > 0 ? std::clamp(2 * last_window_ / length, shortest, 1.0) : 1;
  find_clear(window * length);
  while (may_shorten && near_.size() > many && window > 2 * shortest) {
    window *= 0.5;
    find_clear(window * length);
  }
  last_window_ = near_.size() > many ? length : window * length;
  if (window < 1 && near_.size() > many) {
    all_disks_.begin(rows_.of(retrace_.row(0), retrace_.stride(), retrace_.order(), std::ilogb(length)));
    if (derives) all_disks_.evaluate(1.5 * length, Disks::Depth::Derivatives);
    find_clear(length);
    window = 1;
  }
  window_ = T(window);
  if (near_ != near_before_) narrow();
}

template <class T>
void RootSearchOf<T>::find_clear(double radius) {
  all_disks_.evaluate(radius, Disks::Depth::Rules);
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    const double here = static_cast<double>(retrace_.row(0)[slots_[i]]);
    clear_[i] = std::abs(here) > all_disks_.reach(slots_[i]) * (1 + 1e-9) ? watching::sign(here) : std::int8_t{0};
  }
  note_near();
}

template <class T>
void RootSearchOf<T>::note_near() {
  near_.clear();
  for (std::size_t i = 0; i < slots_.size(); ++i)
    if (clear_[i] == 0) near_.push_back(i);
}

template <class T>
void RootSearchOf<T>::narrow() {
  std::vector<Slot> wanted;
  for (const std::size_t i : near_) wanted.push_back(slots_[i]);
  retrace_.want(wanted);
  disks_.bound_only(wanted);
}

template <class T>
T RootSearchOf<T>::value(std::size_t index, const T& x) {
  expanded_ = false;
  retrace_.evaluate(T(h_ * x), all_disks_.needs_larger_disk());
  return retrace_.row(0)[slots_[index]];
}

/// Those that are 0 but for rounding of their terms, and those that come to 0 within what rounding leaves of x: |x|
/// where x changes its sign has terms of 1e-17, and a slope.
template <class T>
std::vector<bool> RootSearchOf<T>::vanishing_at(const T& x) {
  using std::abs;
  std::vector<bool> out(slots_.size(), false);
  if (near_.empty()) return out;
  std::vector<T> beside(slots_.size(), T(0));
  value(near_[0], T(x - resolution_));  // of all that come near zero
  for (const std::size_t i : near_) beside[i] = retrace_.row(0)[slots_[i]];
  value(near_[0], x);
  for (const std::size_t i : near_) {
    const T here = retrace_.row(0)[slots_[i]];
    out[i] = !(abs(here) > std::max(T(watching::unit<T>() * retrace_.scale(slots_[i])), T(abs(here - beside[i]))));
  }
  return out;
}

template <class T>
bool RootSearchOf<T>::keeps_sides(std::span<const Watched> watched, std::size_t except) {
  if (window_ < 1) return false;
  const std::vector<bool> vanishes = vanishing_at(origin_);
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (i == except) continue;
    const std::int8_t side = is_clear(i) ? clear_[i] : watching::sign(retrace_.row(0)[slots_[i]]);
    if (vanishes[i] || side != watched[i].side) return false;
  }
  return true;
}

template <class T>
void RootSearchOf<T>::expand() {
  if (expanded_ || (place_.x == T(0) && start_.rows)) return;
  retrace_.expand_about(T(h_ * place_.x));
  expanded_ = true;
}

template <class T>
void RootSearchOf<T>::go_to(const T& x, const T& most) {
  using std::abs;
  if (place_.known && place_.x == x && place_.most == most) return;
  place_ = {true, x, most, std::move(place_.coefficients), std::move(place_.scales), {}, {}};
  const double length = static_cast<double>(abs(h_) * most);
  if (x == T(0) && start_.rows) {
    place_.coefficients = start_.coefficients;
    place_.scales = start_.scales;
    disks_.begin(rows_.of(start_.rows, start_.stride, retrace_.order(), std::ilogb(length)));
    return;
  }
  expanded_ = false;
  expand();
  const std::size_t orders = static_cast<std::size_t>(retrace_.order()) + 2;
  place_.coefficients.resize(near_.size() * orders);
  place_.scales.resize(near_.size());
  for (std::size_t i = 0; i < near_.size(); ++i) {
    const Slot slot = slots_[near_[i]];
    for (std::size_t k = 0; k < orders; ++k)
      place_.coefficients[i * orders + k] = retrace_.row(static_cast<int>(k))[slot];
    place_.scales[i] = retrace_.scale(slot);
  }
  disks_.begin(rows_.of(retrace_.row(0), retrace_.stride(), retrace_.order(), std::ilogb(length)));
}

/// What the step leaves out of a function on the disk number `disk`: their radii fall by a third, from 8 lengths on, or
/// from somewhat more than the one of the piece before.
template <class T>
double RootSearchOf<T>::tail(std::size_t disk, std::size_t near) {
  using std::abs;
  while (place_.tails.size() <= disk) {
    expand();
    const double first = std::min(8 * static_cast<double>(abs(h_) * place_.most), 20 * last_radius_);
    const double radius = place_.radii.empty() ? first : place_.radii.back() / 1.5;
    disks_.evaluate(radius);
    place_.radii.push_back(radius);
    place_.tails.emplace_back();
    for (const std::size_t i : near_) place_.tails.back().push_back(disks_.tail(slots_[i]));
  }
  return place_.tails[disk][near];
}

/// As long as the remainder stays below the rounding error, over the best of all disks.
template <class T>
typename RootSearchOf<T>::Piece RootSearchOf<T>::piece(std::size_t index, const T& x, const T& most) {
  using std::abs;
  go_to(x, most);
  const auto near = static_cast<std::size_t>(std::lower_bound(near_.begin(), near_.end(), index) - near_.begin());
  const std::size_t orders = static_cast<std::size_t>(retrace_.order()) + 2;
  const T* const coefficients = place_.coefficients.data() + near * orders;
  const double length = static_cast<double>(abs(h_) * most);
  const int last = retrace_.order() + 1, known = disks_.last_order(slots_[index]);
  const T unit = watching::unit<T>();
  const auto polynomial_over = [&](double part) {  // of `most`
    return watching::scaled<T>(std::min(last, known), T(h_ * most * T(part)), place_.scales[near],
                               [&](int k) { return coefficients[k]; });
  };
  constexpr double most_of_radius = 0.45, least_of_radius = 0.02;
  double best = 0;
  T remainder = T(0);
  Piece result{{}, T(0)};
  const double least = static_cast<double>(resolution_ / most);
  double best_radius = last_radius_;
  if (ends_[index]) best = 1, result.polynomial = polynomial_over(1);
  for (std::size_t i = 0; i < 200 && best < 1; ++i) {
    const double left = tail(i, near), radius = place_.radii[i];
    if (!(most_of_radius * radius > std::max(best, least) * length)) break;
    if (!(left < std::numeric_limits<double>::infinity())) continue;
    for (double part = std::min(1.0, most_of_radius * radius / length);
         part > best && part * length > least_of_radius * radius; part *= 0.75) {
      const double ratio = part * length / radius;
      const T left_out = left == 0 ? T(0) : T(left) * T(std::pow(ratio, known + 1) / (1 - ratio));
      auto polynomial = polynomial_over(part);
      if (!(left_out <= unit * polynomial.reach)) continue;
      best = part, remainder = left_out, best_radius = radius;
      result.polynomial = std::move(polynomial);
      break;
    }
  }
  if (!(best > least)) return {{}, T(0)};
  last_radius_ = best_radius;
  result.width = T(best) * most;
  result.polynomial.scale += remainder / unit;
  result.polynomial.reach += remainder / unit;
  for (const T& c : result.polynomial.p)
    if (!(abs(c) <= std::numeric_limits<T>::max())) return {{}, T(0)};
  return result;
}

/// The beginning of a piece.
template <class T>
typename RootSearchOf<T>::Piece RootSearchOf<T>::up_to(Piece piece, const T& width) {
  using std::abs;
  if (!(width < piece.width)) return piece;
  piece.polynomial = touches::up_to(std::move(piece.polynomial), std::optional<T>(width / piece.width));
  piece.polynomial.reach = piece.polynomial.scale;
  for (std::size_t k = 1; k < piece.polynomial.p.size(); ++k) piece.polynomial.reach += abs(piece.polynomial.p[k]);
  piece.width = width;
  return piece;
}

/// What rounding of the motion, and of the formula's own values, makes of the function there: no expansion knows it
/// better.
template <class T>
T RootSearchOf<T>::rounding_at(std::size_t index, const T& x) {
  using std::abs;
  const T here = value(index, x);
  T out = rounding_of_formula(index);
  for (const bool by_turns : {false, true}) {
    retrace_.evaluate_beside(T(h_ * x), watching::unit<T>(), by_turns);
    out = std::max(out, T(abs(retrace_.row(0)[slots_[index]] - here)));
  }
  return out;
}

/// Where the values are those of the last place that was asked for.
template <class T>
T RootSearchOf<T>::rounding_of_formula(std::size_t index) {
  using std::abs;
  const double length = static_cast<double>(abs(h_));
  all_disks_.begin(rows_.of(retrace_.row(0), retrace_.stride(), retrace_.order(), std::ilogb(length)));
  return T(all_disks_.rounding(slots_[index], length)) * std::numeric_limits<T>::epsilon();
}

/// Where to go on with smaller terms: at the first place that is not told from zero, or here, over less, where the
/// length of the piece hides what it begins with. Nothing where nothing is hidden, no place is nearer, or what is
/// hidden is the rounding of the motion itself, as of (t − 1)² in the place of x.
template <class T>
std::optional<typename RootSearchOf<T>::Nearer> RootSearchOf<T>::nearer(std::size_t index, const Piece& piece,
                                                                        const T& x, const Watched& watched,
                                                                        const std::optional<T>& root) {
  using std::abs, std::pow;
  constexpr double alone =
      1e-9;                  // of its place: so near to a root the polynomial is clear of zero if it is a simple one
  constexpr int beyond = 8;  // distances, of which a root of order k is about k away
  constexpr double shorter = 0.25;
  if (watched.side == 0) return std::nullopt;
  const bool begins_hidden = !watched.at_zero && piece.polynomial.begins_at_zero();
  const auto place = begins_hidden ? std::optional<T>(T(0))
                                   : first_unclear(piece.polynomial, watched, root ? T(*root * T(1 - alone)) : T(1));
  if (!place) return std::nullopt;
  const bool is_here = !(*place * piece.width > resolution_);
  if (is_here && watched.at_zero) return std::nullopt;
  std::vector<T> p = piece.polynomial.p;  // about the place
  for (std::size_t done = 0; !is_here && done < p.size(); ++done)
    for (std::size_t k = p.size() - 1; k-- > done;) p[k] += *place * p[k + 1];
  T distance = T(1);
  for (std::size_t k = 1; k < p.size(); ++k)
    if (p[k] != 0) distance = std::min(distance, T(pow(T(abs(p[0] / p[k])), T(1) / T(k))));
  const T most = T(beyond * distance) * piece.width;
  if (!(most > 16 * resolution_) || (is_here && !(most < T(shorter) * piece.width))) return std::nullopt;
  constexpr double better = 1000;  // what is worth it: a touch is not told from a miss by a few roundings
  const T begin = is_here ? x : T(x + piece.width * *place);
  if (!(piece.polynomial.error_up_to(*place) > T(better) * rounding_at(index, begin))) return std::nullopt;
  return Nearer{begin, most};
}

/// Times are rounded, the parts of a step are not: a function of t is looked at where t + h x is a number of the type,
/// so that its root is known better than t is. Steps of a few roundings of t have no such places.
template <class T>
T RootSearchOf<T>::at_a_time(const T& x) const {
  using std::abs;
  constexpr double most = 1e-6;  // of the step
  const T time = t_.hi + (t_.lo + h_ * x);
  const T near = ((time - t_.hi) - t_.lo) / h_;
  return abs(near - x) <= T(most) ? near : x;
}

/// Whether it is nothing but what rounding of its own values leaves of a function that vanishes, as of max(x, c) − c
/// where x < c.
template <class T>
bool RootSearchOf<T>::is_flat_zero(std::size_t index, const ScaledPolynomialOf<T>& polynomial, const T& x) {
  using std::abs;
  constexpr double small = 1e-3;  // of its terms: none that is worth a look is larger
  if (!(abs(polynomial.p[0]) <= T(small) * polynomial.scale) || polynomial.leading() != 0) return false;
  value(index, x);
  return abs(polynomial.p[0]) <= 4 * rounding_of_formula(index);
}

/// Rounding of the values within a formula, as of 3 + x in log(3 + x), whose own terms are small where it vanishes.
template <class T>
void RootSearchOf<T>::add_rounding_within(std::size_t index, const T& x, ScaledPolynomialOf<T>& polynomial) {
  value(index, x);
  const T floor = rounding_of_formula(index) / watching::unit<T>();
  polynomial.scale += floor, polynomial.reach += floor;
}

/// Whether its first term outweighs all others, with their rounding.
template <class T>
bool stays_clear(const ScaledPolynomialOf<T>& polynomial, std::int8_t side) {
  constexpr int clear = 4;  // rounding errors
  return side * polynomial.p[0] >
         polynomial.reach - polynomial.scale + T(clear) * watching::unit<T>() * polynomial.reach;
}

template <class T>
std::optional<RootOf<T>> RootSearchOf<T>::first(std::size_t index, Watched& watched, const T& from, const T& until,
                                                bool wants_touching, bool wants_jumps) {
  lost_.reset(), exhausted_.reset();
  if (is_clear(index)) {
    const bool wrong = watched.side == -clear_[index] && wants_jumps;
    watched = {clear_[index], false};
    return wrong ? std::optional<RootOf<T>>({from, RootKind::Jump, clear_[index]}) : std::nullopt;
  }
  last_radius_ = std::numeric_limits<double>::infinity();
  constexpr int most_nearer = 32;
  constexpr double wide = 1e-6;  // of the step: over less any function that comes to zero is rounding
  T x = from, most = window_;    // most: of the piece to come
  int turns = 0;                 // nearer to one place
  // Over what rounding does not tell from the end no further piece tells anything; the step to come does.
  while (x < until && (x == origin_ || until - x > resolution_)) {
    if (++used_[index] > allowed_) return exhausted_ = x, std::nullopt;
    Piece now = x == origin_ && turns == 0 ? up_to(piece(index, x, T(window_ - x)), T(until - x))
                                           : piece(index, x, std::min(most, T(until - x)));
    if (now.width == 0) {
      const Gap beyond = gap(index, x, until, watched.side);
      if (!beyond.is_point) return lost_ = x, std::nullopt;
      watched.at_zero = false;
      if (beyond.root && (beyond.root->kind == RootKind::Crossing || wants_jumps)) return beyond.root;
      watched = {beyond.side, false};
      x = beyond.end;
      continue;
    }
    if (watched.side == 0) {
      const bool is_zero = watched.at_zero || now.polynomial.begins_at_zero();  // it may vanish, but for rounding
      watched.side = is_zero ? now.polynomial.direction(watched.order) : watching::sign(now.polynomial.p[0]);
    }
    if (now.width > T(wide) && is_flat_zero(index, now.polynomial, x)) watched = {0, false};
    if (!watched.at_zero && stays_clear(now.polynomial, watched.side)) {
      turns = 0, most = window_;
      x += now.width;
      continue;
    }
    add_rounding_within(index, x, now.polynomial);
    const auto root = crossing(now.polynomial, watched);
    const auto closer = turns < most_nearer ? nearer(index, now, x, watched, root) : std::nullopt;
    if (watched.at_zero) touches::take_out_zero(now.polynomial, watched.order);
    watched.at_zero = false, watched.order = 1;  // the step goes on from it, wherever it ends
    if (closer) {
      x = closer->begin, most = closer->most;
      ++turns;
      continue;
    }
    turns = 0, most = window_;
    if (wants_touching) {
      const auto touch = touching(touches::up_to(now.polynomial, root), watched.side, root.has_value());
      const T end = root ? *root : T(1);
      if (touch && (!root || *touch < T(0.999)))
        if (auto found = touch_at(index, now, x, T(end * *touch), watched.side)) {
          if (found->x > until + std::max(resolution_, found->hidden)) return std::nullopt;  // in the next step
          return found;
        }
    }
    if (root) {
      RootOf<T> found = crossing_at(index, now, x, *root);
      found.x = std::min(until, found.x);
      return found;
    }
    x += now.width;
  }
  return std::nullopt;
}

}  // namespace maupertuis::taylor

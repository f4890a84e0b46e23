#pragma once
#include "disks/retrace.hpp"
#include "disks/scaled_rows.hpp"
#include "integrator/taylor/polynomial_motion.hpp"
#include "integrator/taylor/switches.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace maupertuis::taylor {

enum class RootKind {
  Crossing,  // the function goes through zero
  Touching,  // it comes to zero, up to rounding, and goes back
  Jump,      // its sign changes where it has no zero, at a pole, or it ceases or begins to have a value
};

/// Where in a step: x = s/h in [0, 1].
template <class T>
struct RootOf {
  T x;
  RootKind kind;
  std::int8_t after = 0;   // of a jump: the side beyond it; 0: the function has no value there
  std::uint8_t order = 1;  // of the root, as far as rounding tells it
  T hidden = T(0);         // at a root of higher order: by how much rounding may have moved it
};

/// Roots of functions along a step whose motion is a known polynomial.
///
/// A function may vary faster than the motion: then it is followed in pieces, each as long as its own disk allows,
/// without shortening the step:
///
///     0 ├──────┼────┼──┼·┤ gap ├·┼──┼────┼─────────┤ h        pieces become short on both sides of a point where the
///     function is not
///                        pole                                  analytic; what is left of it is a gap of the size of
///                        rounding
///
/// In a piece the function is a polynomial with a remainder; all its roots are found by Bernstein coefficients, never
/// by sampling, and each is refined on the function itself. Where the polynomial comes so near to zero that its
/// rounding hides what it does there, the search goes on from the place where it is still clear of zero: (x − 300)²
/// about x = 0 has terms of 9·10⁴, about x = 299.999 of 10⁻⁶. Functions that a disk about the beginning of the step
/// keeps clear of zero are not expanded at all. Where a function has no value (√ of what is negative), the gap reaches
/// to the border of its domain.
template <class T>
class RootSearchOf {
 public:
  /// The functions are numbered as their slots are. The program must outlive this.
  RootSearchOf(const Program& program, int order, std::span<const Slot> slots)
      : slots_(slots.begin(), slots.end()),
        order_(order),
        ends_(functions_that_end(program, order, slots)),
        retrace_(program, all_end() ? order : std::max(order, least_order), slots),
        none_(program.unknowns, T(0)),
        all_disks_(program, slots),
        disks_(program, slots),
        clear_(slots.size(), 0) {
    all_disks_.bound_only(slots_);
    disks_.bound_only(slots_);
    for (std::size_t i = 0; i < slots_.size(); ++i) near_.push_back(i);
  }

  /// Functions of which it is enough to know where their polynomials come to zero. [slots]
  void leave_rough(std::vector<bool> functions) { is_rough_ = std::move(functions); }
  /// [program.constants], under the sides in force.
  void set_constants(std::span<const T> constants) {
    if (std::equal(constants.begin(), constants.end(), constants_.begin(), constants_.end())) return;
    retrace_.set_constants(constants.data());
    adopt(constants);
  }
  /// The time at which a step begins, hi + lo.
  struct Time {
    T hi = T(0), lo = T(0);
  };
  /// row(k): the k-th coefficients of all unknowns about t; h: length of the step, not 0.
  template <class Row>
  void begin(const Time& time, const T& h, Row&& row) {
    begin_with(time, h, row);
    start_ = {};
  }
  /// The same where `work` holds the expansion about t: it gives the function `index` by coefficient(index, k) and its
  /// scale(index), and has rows() of all that it is made of, so that nothing is expanded twice.
  template <class Row, class Expansion>
  void begin(const Time& time, const T& h, Row&& row, const Expansion& work) {
    begin_with(time, h, row);
    start_ = {};
    if (retrace_.order() != order_) return;
    const int orders = retrace_.order() + 2;
    start_.coefficients.resize(near_.size() * static_cast<std::size_t>(orders));
    start_.scales.resize(near_.size());
    for (std::size_t i = 0; i < near_.size(); ++i) {
      T* const coefficients = start_.coefficients.data() + i * static_cast<std::size_t>(orders);
      for (int k = orders; k-- > 0;) coefficients[k] = work.coefficient(near_[i], k);
      start_.scales[i] = work.scale(near_[i]);
    }
    start_.rows = work.rows();
    start_.stride = work.stride();
  }
  /// From x on the functions are those of other sides, along the same motion: the search goes on there.
  void go_on(const T& x, std::span<const std::int8_t> sides) {
    retrace_.set_sides(sides);
    adopt({retrace_.constants(), constants_.size()});
    start_ = {};
    origin_ = x;
    find_near();
  }
  /// Whether all functions but one are on their sides there, clear of zero.
  bool keeps_sides(std::span<const Watched> watched, std::size_t except);
  /// Functions that are not told from zero at x, the root of another function, which is known to rounding. [slots]
  std::vector<bool> vanishing_at(const T& x);
  /// Such a zero: its order, and by how much rounding may have moved it.
  RootOf<T> zero_at(std::size_t index, const T& x) { return told_by_values(index, x, T(0)); }
  /// The part of the step, from its beginning, in which roots can be searched: 1, or less where the functions that come
  /// near zero would be many.
  const T& window() const { return window_; }
  /// Where first() came to a stretch in which the function has values, but no series, as cosh u beyond the range of
  /// numbers: it ended there, without knowing of roots.
  const std::optional<T>& lost() const { return lost_; }
  /// No function is followed through more pieces than this in a step: one that swings a billion times in it would keep
  /// the search from ever coming back.
  void allow(std::size_t pieces) { allowed_ = pieces; }
  /// Where first() came to the last of the pieces, without knowing of roots beyond.
  const std::optional<T>& exhausted() const { return exhausted_; }
  /// Whether a function stays clear of zero within the window.
  bool is_clear(std::size_t index) const { return clear_[index] != 0; }
  std::int8_t side_of_clear(std::size_t index) const { return clear_[index]; }

  /// The first root in (from, until]; `watched` begins as the motion is at `from` and ends as the search does: with the
  /// side that the function has there. Precondition: until ≤ window().
  std::optional<RootOf<T>> first(std::size_t index, Watched& watched, const T& from, const T& until,
                                 bool wants_touching, bool wants_jumps);

 private:
  struct Piece {
    ScaledPolynomialOf<T> polynomial;  // in [0, 1] over the piece; its scale covers the remainder
    T width;                           // of [0, 1] over the step; 0: the function is not analytic here
  };

  /// The expansion at the beginning of the step, where it is known from elsewhere.
  struct Start {
    std::vector<T> coefficients, scales;  // [near][order + 2], [near]
    const T* rows = nullptr;              // of all slots that the disks of near ones read; null: it is not known
    std::size_t stride = 0;
  };

  /// What all pieces about one place share: the expansion there, and disks about it, each smaller than the one before.
  struct Place {
    bool known = false;
    T x = T(0), most = T(0);                 // pieces from x, at most so long
    std::vector<T> coefficients, scales;     // [near][order + 2], [near]
    std::vector<double> radii;               // of the disks so far
    std::vector<std::vector<double>> tails;  // [disks][near]
  };

  void adopt(std::span<const T> constants) {
    constants_.assign(constants.begin(), constants.end());
    rough_.clear();
    for (const T& c : constants) rough_.push_back(static_cast<double>(c));
    all_disks_.set_constants(rough_.data());
    disks_.set_constants(rough_.data());
  }
  template <class Row>
  void begin_with(const Time& time, const T& h, Row&& row) {
    retrace_.set_motion(time.hi, time.lo, [&](int k) -> const T* { return k <= order_ + 1 ? row(k) : none_.data(); });
    t_ = time;
    h_ = h;
    origin_ = T(0);
    used_.assign(slots_.size(), 0);
    const T& t = time.hi;
    // Below it two times are the same, or nearly so.
    using std::abs;
    resolution_ =
        std::max(T(64 * std::numeric_limits<T>::epsilon()), T(4 * std::numeric_limits<T>::epsilon() * abs(t) / abs(h)));
    find_near();
  }
  void find_near();
  void find_clear(double radius);
  void note_near();
  void narrow();
  void go_to(const T& x, const T& most);
  void expand();
  double tail(std::size_t disk, std::size_t near);
  Piece piece(std::size_t index, const T& x, const T& most);
  static Piece up_to(Piece piece, const T& width);
  struct Nearer {
    T begin;  // in the step
    T most;   // how long a piece from there is: some distances to the zero
  };
  std::optional<Nearer> nearer(std::size_t index, const Piece& piece, const T& x, const Watched& watched,
                               const std::optional<T>& root);
  T rounding_at(std::size_t index, const T& x);
  T rounding_of_formula(std::size_t index);
  std::int8_t told_side(std::size_t index, const T& x);
  bool is_flat_zero(std::size_t index, const ScaledPolynomialOf<T>& polynomial, const T& x);
  T sign_change(std::size_t index, T low, T high);
  void add_rounding_within(std::size_t index, const T& x, ScaledPolynomialOf<T>& polynomial);
  bool stays_clear_of_zero(std::size_t index, std::int8_t side, const T& x);
  struct Lowest {
    T x;
    bool is_crossed;  // the function is on the other side beyond x
  };
  Lowest lowest_about(std::size_t index, std::int8_t side, const T& x, T step);
  T value(std::size_t index, const T& x);
  T at_a_time(const T& x) const;
  T refined(std::size_t index, const Piece& piece, const T& begin, const T& root);
  RootOf<T> crossing_at(std::size_t index, const Piece& piece, const T& begin, const T& root);
  std::optional<RootOf<T>> touch_at(std::size_t index, const Piece& piece, const T& begin, const T& root,
                                    std::int8_t side);
  struct Gap {
    T end;             // where the function is analytic again
    std::int8_t side;  // that it has there; 0: it has no value any more
    std::optional<RootOf<T>> root;
    bool is_point = true;  // or the function has no values in it
  };
  Gap gap(std::size_t index, const T& x, const T& until, std::int8_t side);
  bool has_value(std::size_t index, const T& x);
  T border(std::size_t index, T without, T with);
  struct Beyond {
    T last, place;  // the last place that was looked at before, and this one
  };
  Beyond analytic_beyond(std::size_t index, const T& x, const T& until);
  RootOf<T> told_by_values(std::size_t index, const T& root, const T& least);
  std::optional<RootOf<T>> change_of_sign(std::size_t index, T low, T high, std::int8_t side, const T& end);

  /// A step of low order is long where the motion is a polynomial, in which a function of it may still swing: its
  /// pieces would be no longer than (their rounding)^{1/order} of a period.
  static constexpr int least_order = 10;

  bool all_end() const { return std::find(ends_.begin(), ends_.end(), false) == ends_.end(); }

  std::vector<Slot> slots_;
  int order_;               // of the step
  std::vector<bool> ends_;  // [slots] nothing is left out of its polynomial
  std::vector<bool> is_rough_ = std::vector<bool>(slots_.size(), false);
  Retrace<T> retrace_;
  std::vector<T> none_;      // [unknowns] 0: coefficients beyond those of the step
  Disks all_disks_, disks_;  // of all functions; of those that come near zero
  ScaledRows<T> rows_;
  std::vector<std::int8_t> clear_;               // [slots] side on which it stays; 0: it may come to zero
  std::vector<std::size_t> near_, near_before_;  // the others
  Start start_;
  Place place_;
  bool expanded_ = false;  // the rows are those of the place
  Time t_;
  T h_ = T(1), resolution_ = T(0), window_ = T(1);
  std::optional<T> lost_, exhausted_;
  std::size_t allowed_ = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> used_;                                 // [slots] pieces of this step
  T origin_ = T(0);                                               // where the search begins
  double last_radius_ = std::numeric_limits<double>::infinity();  // of the disk of the piece before, in time
  double last_window_ = 0;                                        // in time; 0: there was none
  std::vector<T> constants_;                                      // those that are set
  std::vector<double> rough_;                                     // the same
};

using RootSearch = RootSearchOf<double>;

/// Where side · p, which does not go below its rounding error, comes down to it after having been clear of it; nothing
/// if it does not. `ends_at_root`: what it does at x = 1 is known to be no touch.
template <class T>
std::optional<T> touching(const ScaledPolynomialOf<T>& polynomial, std::int8_t side, bool ends_at_root = false);

}  // namespace maupertuis::taylor

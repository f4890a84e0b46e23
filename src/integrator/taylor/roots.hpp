#pragma once
#include "integrator/taylor/switches.hpp"
#include "kernel/disks/retrace.hpp"
#include "kernel/disks/scaled_rows.hpp"

#include <optional>
#include <span>
#include <vector>

namespace maupertuis::taylor {

enum class RootKind {
  Crossing,  // the function goes through zero
  Touching,  // it comes to zero, up to rounding, and goes back
  Jump,      // its sign changes where it has no zero: at a pole, or at the cut of atan2
};

/// Where in a step: x = s/h in [0, 1].
template <class T>
struct RootOf {
  T x;
  RootKind kind;
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
/// by sampling, and each is refined on the function itself.
template <class T>
class RootSearchOf {
 public:
  /// The program must outlive this.
  RootSearchOf(const Program& program, int order, std::span<const Slot> slots)
      : retrace_(program, order, slots), disks_(program, slots) {}

  /// [program.constants], under the sides in force.
  void set_constants(const T* constants, const double* rough) {
    retrace_.set_constants(constants);
    disks_.set_constants(rough);
  }
  /// The time at which a step begins, hi + lo.
  struct Time {
    T hi = T(0), lo = T(0);
  };
  /// row(k): the k-th coefficients of all unknowns about t; h: length of the step, not 0.
  template <class Row>
  void begin(const Time& time, const T& h, Row&& row) {
    retrace_.set_motion(time.hi, time.lo, row);
    t_ = time;
    h_ = h;
    const T& t = time.hi;
    // Below it two times are the same, or nearly so.
    using std::abs;
    resolution_ =
        std::max(T(64 * std::numeric_limits<T>::epsilon()), T(4 * std::numeric_limits<T>::epsilon() * abs(t) / abs(h)));
  }

  /// The first root in (0, until]; `watched` begins as the step does and ends as the search does: with the side that
  /// the function has there.
  std::optional<RootOf<T>> first(Slot slot, Watched& watched, const T& until, bool wants_touching, bool wants_jumps);

 private:
  struct Piece {
    ScaledPolynomialOf<T> polynomial;  // in [0, 1] over the piece; its scale covers the remainder
    T width;                           // of [0, 1] over the step; 0: the function is not analytic here
  };

  Piece piece(Slot slot, const T& x, const T& most);
  T value(Slot slot, const T& x) {
    retrace_.evaluate(T(h_ * x));
    return retrace_.row(0)[slot];
  }
  T at_a_time(const T& x) const;
  T refined(Slot slot, const Piece& piece, const T& begin, const T& root);
  struct Gap {
    T end;             // where the function is analytic again
    std::int8_t side;  // that it has there; 0: it has no value any more
    std::optional<RootOf<T>> root;
  };
  Gap gap(Slot slot, const T& x, const T& until, std::int8_t side);

  Retrace<T> retrace_;
  Disks disks_;
  ScaledRows<T> rows_;
  Time t_;
  T h_ = T(1), resolution_ = T(0);
};

using RootSearch = RootSearchOf<double>;

/// Where side · p, which does not go below its rounding error, comes down to it after having been clear of it; nothing
/// if it does not.
template <class T>
std::optional<T> touching(const ScaledPolynomialOf<T>& polynomial, std::int8_t side);

}  // namespace maupertuis::taylor

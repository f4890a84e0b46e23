#pragma once
#include <maupertuis/mechanical_system.hpp>

namespace maupertuis::elaboration {

/// What a formula of the text means: an expression, or a vector of them, in SI base units, and its dimension.
struct Value {
  ExprVector parts;  // one, or the components of a vector
  bool is_vector = false;
  Dimension dimension;
  bool fits_any = false;    // the literal 0 fits every dimension
  bool poisoned = false;    // a mistake in it was reported: whatever is made of it stays silent
  bool is_literal = false;  // a bare number of the text
  bool hertz = false;       // a frequency in Hz stands in it as a factor ...
  bool has_pi = false;      // ... and has not met its 2 pi
  int order = -1;           // highest time derivative of a coordinate in it; -1: no coordinate
  bool anchored = false;    // a vector in world axes; else its components belong to the axes it is read in
  Expr weight;              // how many points are summed in it: `A` 1, `A - B` 0; empty: 0

  Expr scalar() const { return parts.front(); }

  static Value poison() {
    Value v;
    v.poisoned = true;
    return v;
  }
  static Value of(Expr e, const Dimension& dimension, int order = -1) {
    Value v;
    v.parts = {e};
    v.dimension = dimension;
    v.order = order;
    return v;
  }
};

/// "an energy (J)", "a bare number", "a quantity in kg m^3": for messages.
std::string describe(const Dimension& dimension);
/// The dimension without the angle where something else than the angle is in it.
Dimension without_angle(Dimension dimension);

}  // namespace maupertuis::elaboration

#pragma once
#include <maupertuis/fields.hpp>

namespace maupertuis {

/// An expression with the formulas of given fields in the place of their jets, and definitions written out. Jets of a
/// given field without a formula stay.
Expr with_given_fields(const FieldSystem& system, Expr e);

}  // namespace maupertuis

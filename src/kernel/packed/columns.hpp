#pragma once
#include "kernel/packed/layout.hpp"

namespace maupertuis::packed {

struct ReadColumn {
  Column column;
  std::vector<ConstantId> coefficients;  // of its lanes
};

/// The linear terms of each lane, with slots of `program`.
using Sums = std::vector<std::vector<Term>>;

/// The terms of eight sums, one sum a lane, as columns: one operand or one vector of operands with a coefficient for
/// each lane. Three arrangements are tried, and that with the fewest loads is taken:
///
///     by operand   a number that several sums read is loaded once, for all lanes
///     by place     the first terms of all sums, then the second ones, …: one gather a place
///     by vector    whole vectors of operands; lanes that do not read theirs have the coefficient 0 (`holes`)
std::vector<ReadColumn> columns_of(const Program& program, const Sums& sums, ConstantId zero, bool holes);

/// One column a place, whatever the sums hold there: a lane whose sum is shorter reads its own operand times 0. Terms
/// of the leaf 1 stand apart, since they vanish beyond order 0.
std::vector<ReadColumn> aligned_columns_of(const Program& program, const Sums& sums, ConstantId zero);

}  // namespace maupertuis::packed

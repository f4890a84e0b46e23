#pragma once
#include "kernel/packed/layout.hpp"

namespace maupertuis::packed {

struct ReadColumn {
  Column column;
  std::vector<ConstantId> coefficients;  // of its lanes
};

/// The linear terms of each lane, with slots of `program`.
using Sums = std::vector<std::vector<Term>>;

/// By operand (one load serves all lanes), by place in the sums (one gather each), or, where `holes` are allowed, by
/// vectors of which some lanes are multiplied by 0: what takes fewer loads.
std::vector<ReadColumn> columns_of(const Program& program, const Sums& sums, ConstantId zero, bool holes);

/// One column a place, whatever the sums hold there: a lane whose sum is shorter reads its own operand times 0. Terms
/// of the leaf 1 stand apart, since they vanish beyond order 0.
std::vector<ReadColumn> aligned_columns_of(const Program& program, const Sums& sums, ConstantId zero);

}  // namespace maupertuis::packed

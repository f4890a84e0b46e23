#include "kernel/workspace/tangents.hpp"

#include <algorithm>

namespace maupertuis::workspace {

Tangents::Tangents(const Expansion& x, ExpansionInCode& in_code)
    : x_(x),
      in_code_(in_code),
      are_of_each_(x.unknowns <= most_of_each),
      values_(are_of_each_ ? x.unknowns * x.memory.stride : x.memory.stride, 0.0),
      matrix_{values_.data(), x.memory.stride, x.unknowns, static_cast<Slot>(x.padded_unknowns()), {}} {
  std::copy_n(x.program.stored_end.begin(), matrix_.end.size(), matrix_.end.begin());
  for (std::size_t d = 0; are_of_each_ && d < x.unknowns; ++d) values_[d * x.memory.stride + d] = 1;
}

void Tangents::find(std::size_t directions) {
  const auto compiled = in_code_.code.tangents;
  const std::size_t stride = x_.memory.stride;
  if (!compiled) return x_.engine.tangents(x_.tables, values_.data(), stride, directions);
  for (std::size_t d = 0; d < directions; ++d) compiled(&in_code_.arguments, values_.data() + d * stride);
}

void Tangents::find_along(std::span<const double> unknowns) {
  std::copy(unknowns.begin(), unknowns.end(), values_.begin());
  find(1);
}

void Tangents::correct_along(int stage, const double* direction, double weight) {
  packed::TangentMatrix matrix = matrix_;
  matrix.values = direction;
  matrix.directions = 1;
  x_.engine.correct(x_.tables, stage, matrix, &weight);
}

}  // namespace maupertuis::workspace

#pragma once
#include "kernel/reference/reference.hpp"

namespace maupertuis::reference {

/// At order 0 the highest derivative of q in a slot of lag ℓ enters linearly through those operands alone that have
/// lag ℓ themselves; the others hold lower derivatives and are constants here.
template <int Width, class T>
void tangents(const MemoryOf<T>& memory, T* tangent, std::span<const sparse::Edge> edges) {
  for (std::size_t i = 0; i < edges.size();) {
    T sum[Width] = {};
    const Slot out = edges[i].out;
    for (; i < edges.size() && edges[i].out == out; ++i) {
      const sparse::Edge& edge = edges[i];
      const T factor = sparse::factor_at(edge, memory.program.terms.data(), memory.constants.data(), memory.row(0));
      if (edge.rule == sparse::Rule::Choice && factor == 0) continue;  // what is not chosen may be undefined
      const T* const from = tangent + static_cast<std::size_t>(edge.operand) * Width;
      for (int d = 0; d < Width; ++d) sum[d] += factor * from[d];
    }
    for (int d = 0; d < Width; ++d) tangent[static_cast<std::size_t>(out) * Width + d] = sum[d];
  }
}

}  // namespace maupertuis::reference

#pragma once
#include "kernel/program/program.hpp"
#include "kernel/series/rules.hpp"
#include "kernel/sparse/tangent_graph.hpp"

#include <boost/align/aligned_allocator.hpp>
#include <span>
#include <type_traits>
#include <vector>

/// The reference backend: one instruction after the other, one order after the other. A backend offers these
/// operations on the arrays of a workspace and nothing else. T is the number type: double, or one of more digits
/// (kernel/extended); the *_code.hpp files hold the definitions, for those who instantiate them.
namespace maupertuis::reference {

/// A linear term ready for use: coefficient · factor of the shift · row[offset].
template <class T>
struct LinearTermOf {
  T coefficient;
  std::uint32_t offset;  // from the row of the result's order: slot + shift · stride
  std::uint32_t shift;
};

/// Aligned to cache lines, so that packs of slots are too.
template <class T>
using Aligned = std::vector<T, boost::alignment::aligned_allocator<T, 64>>;
using Doubles = Aligned<double>;

/// What the operations work on. `cells`: numbers of a row, at least the slots of the program.
template <class T>
struct MemoryOf {
  MemoryOf(const Program& program, int orders, std::size_t cells);

  T* row(int order) { return rows.data() + static_cast<std::size_t>(order) * stride; }
  const T* row(int order) const { return rows.data() + static_cast<std::size_t>(order) * stride; }
  series::Column<T> column(Slot slot) const { return {rows.data() + slot, stride}; }

  const Program& program;
  std::size_t stride;
  std::vector<T> constants;             // [constants]
  std::vector<T> coefficients;          // [terms], from the constants
  std::vector<LinearTermOf<T>> linear;  // [terms], the same made ready
  std::vector<T> shift_factors;         // [orders × 3]: 1, k + 1, (k + 1)(k + 2)
  Aligned<T> rows;                      // [orders × stride]: coefficient k of slot s at [k · stride + s]
};

using Memory = MemoryOf<double>;

/// Fills constants and coefficients.
template <class T>
void compute_constants(MemoryOf<T>& memory, std::span<const std::type_identity_t<T>> parameters,
                       std::span<const std::int8_t> sides);

/// Fills coefficients alone.
template <class T>
void prepare_terms(MemoryOf<T>& memory);

/// Sets the leaves but the coordinates at all orders.
template <class T>
void set_leaves(MemoryOf<T>& memory, const std::type_identity_t<T>& t, int orders);

/// One instruction at one order.
template <class T>
void run_instruction(MemoryOf<T>& memory, std::uint32_t index, int order);

/// A run of them.
template <class T>
void run_instructions(MemoryOf<T>& memory, const Run& run, int order);

/// Every instruction of a section at the order that belongs to the stage.
template <class T>
void run_section(MemoryOf<T>& memory, Section section, int stage);

/// Directional derivatives of slots of Dynamics at order 0, `Width` directions at once: for a slot of lag ℓ, ∂/∂q^(ℓ)
/// applied to the directions. In: those of the coordinates, and 0 for slots that q̈ has no influence on; out: those of
/// the results of the edges, which follow their operands. [slots × Width]
template <int Width, class T>
void tangents(const MemoryOf<T>& memory, T* tangent, std::span<const sparse::Edge> edges);

/// Sum of the sizes of the terms of a slot at order 0; its own size where it is no sum.
template <class T>
T term_size(const MemoryOf<T>& memory, const Instruction* producer, Slot slot);

}  // namespace maupertuis::reference

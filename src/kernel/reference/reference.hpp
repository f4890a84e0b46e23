#pragma once
#include "kernel/program/program.hpp"
#include "kernel/series/elementary.hpp"
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

// Vectors bring their own (kernel/lanes).
using series::add_product, series::chosen, series::elementary, series::sine_cosine;

/// Aligned to cache lines, so that packs of slots are too.
template <class T>
using Aligned = std::vector<T, boost::alignment::aligned_allocator<T, 64>>;
using Doubles = Aligned<double>;

/// What instructions work on, as plain pointers.
template <class T>
struct Rows {
  const Instruction* instructions;
  const Term* terms;
  const T* constants;
  T* first;  // [orders × stride]: coefficient k of slot s at [k · stride + s]
  std::size_t stride;
};

/// What the operations work on. `cells`: numbers of a row, at least the slots of the program.
template <class T>
struct MemoryOf {
  MemoryOf(const Program& program, int orders, std::size_t cells);

  T* row(int order) { return rows.data() + static_cast<std::size_t>(order) * stride; }
  const T* row(int order) const { return rows.data() + static_cast<std::size_t>(order) * stride; }
  Rows<T> view() { return {program.instructions.data(), program.terms.data(), constants.data(), rows.data(), stride}; }

  const Program& program;
  std::size_t stride;
  std::vector<T> constants;  // [constants]
  Aligned<T> rows;           // [orders × stride], see Rows
};

using Memory = MemoryOf<double>;

/// A constant of a program, of those before it. `operands`: scratch.
template <class T>
T compute_constant(const Program& program, std::size_t index, std::span<const std::type_identity_t<T>> parameters,
                   std::span<const std::int8_t> sides, std::span<const T> constants, std::vector<T>& operands);
/// All of them. [constants]
template <class T>
void compute_constants(const Program& program, std::span<const std::type_identity_t<T>> parameters,
                       std::span<const std::int8_t> sides, std::span<T> constants);
template <class T>
void compute_constants(MemoryOf<T>& memory, std::span<const std::type_identity_t<T>> parameters,
                       std::span<const std::int8_t> sides) {
  compute_constants(memory.program, parameters, sides, std::span<T>(memory.constants));
}

/// Sets the leaves but the coordinates at all orders.
template <class T>
void set_leaves(MemoryOf<T>& memory, const std::type_identity_t<T>& t, int orders);

/// Where the interpreter meets an instruction that it has no rule for.
[[noreturn]] void throw_unknown(Op op);

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

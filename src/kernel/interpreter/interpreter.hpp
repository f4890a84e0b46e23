#pragma once
#include "kernel/jet/rules.hpp"
#include "kernel/program/program.hpp"

#include <boost/align/aligned_allocator.hpp>
#include <span>
#include <vector>

/// The reference backend: one instruction after the other, one order after the other. A backend offers these
/// operations on the arrays of a workspace and nothing else.
namespace maupertuis::interpreter {

/// A linear term ready for use: coefficient · factor of the shift · row[offset].
struct LinearTerm {
  double coefficient;
  std::uint32_t offset;  // from the row of the result's order: slot + shift · stride
  std::uint32_t shift;
};

/// Aligned to cache lines, so that packs of slots are too.
using Doubles = std::vector<double, boost::alignment::aligned_allocator<double, 64>>;

/// What the operations work on. `cells`: doubles of a row, at least the slots of the program.
struct Memory {
  Memory(const Program& program, int orders, std::size_t cells);

  double* row(int order) { return rows.data() + static_cast<std::size_t>(order) * stride; }
  const double* row(int order) const { return rows.data() + static_cast<std::size_t>(order) * stride; }
  jet::Column<double> column(Slot slot) const { return {rows.data() + slot, stride}; }

  const Program& program;
  std::size_t stride;
  std::vector<double> constants;     // [constants]
  std::vector<double> coefficients;  // [terms], from the constants
  std::vector<LinearTerm> linear;    // [terms], the same made ready
  std::vector<double> shift_factors; // [orders × 3]: 1, k + 1, (k + 1)(k + 2)
  Doubles rows;                      // [orders × stride]: coefficient k of slot s at [k · stride + s]
};

/// Fills constants and coefficients.
void compute_constants(Memory& memory, std::span<const double> parameters, std::span<const std::int8_t> sides);

/// Sets the leaves but the coordinates at all orders.
void set_leaves(Memory& memory, double t, int orders);

/// One instruction at one order.
void run_instruction(Memory& memory, std::uint32_t index, int order);

/// Every instruction of a section at the order that belongs to the stage.
void run_section(Memory& memory, Section section, int stage);

/// Directional derivatives of instructions of Dynamics at order 0, `Width` directions at once: for a slot of lag ℓ,
/// ∂/∂q^(ℓ) applied to the directions. In: those of the coordinates; out: those of the slots of the instructions, which
/// are named by index and in order. [slots × Width]
template <int Width>
void tangents(const Memory& memory, double* tangent, std::span<const std::uint32_t> instructions);

/// Every instruction of Dynamics that q has an influence on.
std::vector<std::uint32_t> moved_instructions(const Program& program);
/// Those of them that the derivatives of the residual by q̈ go through.
std::vector<std::uint32_t> instructions_of_mass(const Program& program);

/// Sum of the sizes of the terms of a slot at order 0; its own size where it is no sum.
double term_size(const Memory& memory, const Instruction* producer, Slot slot);

}  // namespace maupertuis::interpreter

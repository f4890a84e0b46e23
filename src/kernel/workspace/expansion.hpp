#pragma once
#include "kernel/packed/engine.hpp"
#include "kernel/reference/reference.hpp"
#include "kernel/sparse/parts.hpp"
#include "kernel/workspace/expansion_code.hpp"

#include <map>
#include <optional>
#include <vector>

namespace maupertuis::workspace {

using reference::Doubles;
using reference::Memory;

/// What is expanded: the program in packs, its rows of coefficients with the numbers of its constants, and what the
/// engine sees of both.
struct Expansion {
  Expansion(const Kernel& kernel, int order);
  Expansion(const Expansion&) = delete;

  /// In a system so large that solutions are sparse, packs follow the parts in which it is solved.
  static sparse::Strip strip_for(const Program& p) {
    return p.unknowns == p.freedoms && p.unknowns > packed::most_by_inverse ? sparse::strip_of(p) : sparse::Strip{};
  }

  std::size_t padded_unknowns() const { return packed::padded(unknowns); }
  /// Whether anything had changed.
  bool compute_constants();
  /// Up to the last stage that was run; beyond, 0.
  double coefficient(Slot slot, int k) const {
    return k <= last_stage + 2 - program.lags[slot] && k < orders ? memory.row(k)[slot] : 0.0;
  }
  double scale(Slot slot) const { return reference::term_size(memory, producer[slot], slot); }

  Kernel kernel;
  sparse::Strip strip;
  packed::PackedProgram packed;
  const Program& program;  // of `packed`
  int order, orders;
  Memory memory;
  const packed::Engine& engine = packed::engine();
  packed::Tables tables;
  std::vector<packed::Order> of_orders;  // those below 0, which nothing reads, then [orders]
  Doubles lane_coefficients;             // [packed.coefficients]
  std::map<std::uint32_t, std::vector<sparse::Edge>> edges_of_scalars;  // of instructions that stand alone
  std::vector<const Instruction*> producer;                             // [slots]
  std::vector<double> parameters;
  std::vector<std::int8_t> sides;
  bool stale = true;                                                        // constants to be computed
  std::map<std::vector<std::int8_t>, std::vector<double>> known_constants;  // of these parameters, by sides
  std::size_t unknowns;                                                     // n + m
  int last_stage = 0;

 private:
  void bind();
};

/// Machine code for the stages of an expansion, and what it works on.
struct ExpansionInCode {
  void adopt(ExpansionCode code, Expansion& x);

  ExpansionCode code;
  packed::CompiledArguments arguments;
  Doubles sums;                      // [convolutions × rolled_group × 8] of products, made for stages that follow
  Doubles tangent_row, passing_row;  // scratch
};

}  // namespace maupertuis::workspace

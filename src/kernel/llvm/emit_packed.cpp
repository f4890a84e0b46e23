#include "kernel/llvm/emit_packed.hpp"

#include "kernel/llvm/straight_emitter.hpp"

namespace maupertuis::llvm_backend {

using packed::Pack;
using packed::PackedProgram;

namespace {

constexpr std::size_t most_unknowns = 8;
constexpr std::size_t most_operations = 40'000;

/// Vector operations that the sums over orders take.
std::size_t operations(const PackedProgram& program, int order) {
  std::size_t convolutions = 0, others = 0;
  for (const Pack& pack : program.packs) {
    convolutions += pack.kind == Pack::Sum ? pack.last_product - pack.first_product : 1;
    others += 2 + pack.last_aligned - pack.first_aligned;
  }
  const auto p = static_cast<std::size_t>(order);
  return 3 * convolutions * p * p / 2 + others * p;
}

}  // namespace

bool can_emit_packed(const PackedProgram& program, int order) {
  const Program& p = program.program;
  const bool has_select = std::any_of(p.instructions.begin(), p.instructions.end(), [](const Instruction& i) { return i.op == Op::Select; });
  return p.unknowns == p.freedoms && p.unknowns <= most_unknowns && !has_select && operations(program, order) <= most_operations;
}

void emit_packed(llvm::Module& module, const PackedProgram& program, std::size_t stride, int order) {
  StraightEmitter(module, program, stride, order).run();
}

}  // namespace maupertuis::llvm_backend

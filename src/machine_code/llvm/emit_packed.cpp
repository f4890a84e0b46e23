#include "machine_code/llvm/emitters.hpp"
#include "machine_code/llvm/rolled_emitter.hpp"
#include "kernel/unrolled/unroll.hpp"

namespace maupertuis::llvm_backend {

using packed::Pack;
using packed::PackedProgram;

namespace {

/// Of unrolled code.
constexpr std::size_t most_solved = 16, most_operations = 40'000;
/// Of rolled code, whose compilation takes about 1 ms a pack: 64 bodies in space.
constexpr std::size_t most_packs = 8000;

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

/// Whether all stages can be written out one after the other.
bool can_be_unrolled(const PackedProgram& program, int order) {
  const Program& p = program.program;
  const bool has_select = std::any_of(p.instructions.begin(), p.instructions.end(),
                                      [](const Instruction& i) { return i.op == Op::Select; });
  return p.unknowns == p.freedoms && p.unknowns <= most_solved && !has_select &&
         operations(program, order) <= most_operations;
}

}  // namespace

void emit_packed(Emission& out, const machine_code::Request& request) {
  const auto& program = *static_cast<const PackedProgram*>(request.source);
  if (request.effort > 0 && can_be_unrolled(program, request.order)) {
    emit_as_one_function(out, unrolled::unroll(program, request.stride, request.order), "expand");
    return emit_step(out, program.program.unknowns, request.stride, request.order);
  }
  if (program.packs.size() > most_packs) throw Declined("the program is too large to be compiled");
  RolledEmitter(out, program, request.stride).run(request.effort > 0);
}

}  // namespace maupertuis::llvm_backend

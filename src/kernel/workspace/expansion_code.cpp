#include "kernel/workspace/expansion_code.hpp"

#include "kernel/program/code.hpp"

#include <type_traits>

namespace maupertuis::workspace {

std::pair<ExpansionCode, CompileReport> compile(const packed::PackedProgram& program, int order, std::size_t stride,
                                                const CompileOptions& options) {
  machine_code::Request request;
  request.emitter = machine_code::Emitter::Packed;
  request.source = &program;
  request.order = order;
  request.stride = stride;
  const machine_code::Compiled compiled = machine_code::compile(request, digest_of(program.program), options);
  ExpansionCode code;
  if (const auto& made = compiled.code) {
    const auto find = [&](auto& function, const char* name) {
      function = reinterpret_cast<std::decay_t<decltype(function)>>(made->find(name));
    };
    find(code.expand, "expand"), find(code.radius, "radius"), find(code.increments, "increments");
    find(code.accelerations, "accelerations"), find(code.sizes, "sizes");
    find(code.first, "first"), find(code.stage, "stage"), find(code.solve, "solve"), find(code.correct, "correct");
    find(code.ahead, "ahead"), find(code.later, "later"), find(code.tangents, "tangents");
    code.memory = made;
  }
  return {std::move(code), report_of(compiled)};
}

}  // namespace maupertuis::workspace

#include "kernel/interpreter/compiled.hpp"

#include "kernel/compiled/backend.hpp"

#include <optional>
#include <type_traits>

namespace maupertuis::interpreter {

std::pair<CompiledCode, CompileReport> compile(const packed::PackedProgram& program, int order, std::size_t stride,
                                               const CompileOptions& options) {
  const compiled::Digest digest = compiled::digest_of(program.program);
  compiled::Request request;
  request.emitter = compiled::Emitter::Packed;
  request.source = &program;
  request.source_digest[0] = digest.high, request.source_digest[1] = digest.low;
  request.order = order;
  request.stride = stride;
  request.effort = options.long_run ? 1 : 0;
  request.processor = options.processor.c_str();
  std::optional<compiled::ObjectCache> cache;
  if (options.cache) cache.emplace(compiled::ObjectCache::usual_folder());
  compiled::Compiled made = compiled::compile(request, cache ? &*cache : nullptr);
  CompiledCode code;
  if (made.code) {
    const auto find = [&](auto& function, const char* name) { function = reinterpret_cast<std::decay_t<decltype(function)>>(made.code->find(name)); };
    find(code.expand, "expand"), find(code.radius, "radius"), find(code.increments, "increments");
    find(code.first, "first"), find(code.stage, "stage"), find(code.solve, "solve"), find(code.correct, "correct");
    find(code.ahead, "ahead"), find(code.later, "later"), find(code.tangents, "tangents");
    code.memory = made.code;
  }
  return {std::move(code), {.compiled = made.code != nullptr, .trouble = std::move(made.trouble),
                            .cache_trouble = std::move(made.cache_trouble), .from_cache = made.from_cache, .seconds = made.seconds}};
}

}  // namespace maupertuis::interpreter

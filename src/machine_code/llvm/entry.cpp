#include "machine_code/llvm/emission.hpp"
#include "machine_code/llvm/emitters.hpp"

#include <llvm/Config/llvm-config.h>
#include <llvm/IR/Verifier.h>
#include <llvm/Support/raw_ostream.h>
#include <llvm/Target/TargetMachine.h>

#include <chrono>
#include <cstdlib>
#include <cstring>

/// The one symbol that the module shows. No exception leaves it.
namespace maupertuis::llvm_backend {
namespace {

using machine_code::Emitter;
using machine_code::Reply;
using machine_code::Request;
using Clock = std::chrono::steady_clock;

void emit(Emission& out, const Request& request) {
  switch (request.emitter) {
    case Emitter::SelfTest:
      return emit_self_test(out, request);
    case Emitter::Lanes:
      return emit_lanes(out, request);
    case Emitter::StraightLines:
      return emit_straight_lines(out, request);
    case Emitter::Packed:
      return emit_packed(out, request);
  }
  throw Declined("a kind of code that this module does not emit");
}

char* copy_of(const char* bytes, std::size_t size) {
  auto* const out = static_cast<char*>(std::malloc(size + 1));
  if (!out) throw std::bad_alloc();
  std::memcpy(out, bytes, size);
  out[size] = 0;
  return out;
}

#ifndef NDEBUG
void verify(const llvm::Module& module) {
  std::string text;
  llvm::raw_string_ostream stream(text);
  if (llvm::verifyModule(module, &stream))
    throw std::logic_error("wrong intermediate representation: " + text + "; please report");
}
#else
void verify(const llvm::Module&) {}
#endif

double seconds_between(Clock::time_point a, Clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

void answer(const Request& request, Reply& reply) {
  const auto begin = Clock::now();
  Target target(request.processor);
  Emission emission(target.machine(), target.features());
  emit(emission, request);
  verify(*emission.module);
  reply.instructions = emission.module->getInstructionCount();
  const auto emitted = Clock::now();
  const std::vector<char> object = target.compile(*emission.module, request.effort);
  reply.object = copy_of(object.data(), object.size());
  reply.size = object.size();
  reply.emit_seconds = seconds_between(begin, emitted);
  reply.compile_seconds = seconds_between(emitted, Clock::now());
}

void compile(const Request* request, Reply* reply) noexcept {
  *reply = {};
  try {
    answer(*request, *reply);
  } catch (const std::bad_alloc&) {
    reply->trouble = "no memory for the compilation";
  } catch (const std::exception& error) {
    static thread_local char trouble[512];
    std::strncpy(trouble, error.what(), sizeof trouble - 1);
    reply->trouble = trouble;
  }
}

void release(Reply* reply) noexcept {
  std::free(const_cast<char*>(reply->object));
  reply->object = nullptr;
}

const char* processor() { return host_processor().c_str(); }

constexpr machine_code::ModuleInterface interface {
  MAUPERTUIS_BUILD_TAG, LLVM_VERSION_STRING, &processor, &compile, &release
};

}  // namespace
}  // namespace maupertuis::llvm_backend

extern "C" __attribute__((visibility("default"))) const maupertuis::machine_code::ModuleInterface*
maupertuis_llvm_module() {
  return &maupertuis::llvm_backend::interface;
}

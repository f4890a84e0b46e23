#pragma once
#include <cstddef>
#include <cstdint>

/// The border between the program and the module machine_code/llvm: plain data and functions that do not throw. Both
/// sides are of one build, which the tag tells; so types of the project may be passed by address.
namespace maupertuis::machine_code {

/// Code calls a function of the table that SLEEF lacks by this and its name: double(double).
inline constexpr const char* program_function_prefix = "maup_";

/// What writes the code. Its number is part of the key of the cache.
enum class Emitter : std::uint32_t {
  /// source: none. `self_test`: void(const double* x, double* y), y_i = √(sin²x_i + x_i cos²x_i), [width] each
  SelfTest = 0,
  Packed = 1,         // source: packed::PackedProgram. `expand`: packed::CompiledExpand; or `stage` and `ahead`:
                      // packed::CompiledStage, `tangents`: packed::CompiledTangents
  Lanes = 2,          // source: Program. `expand`: lanes::Expand
  StraightLines = 3,  // source: std::vector<straight::StraightLine>. `line0`, `line1`, …: see straight::Code
};

struct Request {
  Emitter emitter = Emitter::SelfTest;
  const void* source = nullptr;
  std::uint64_t source_digest[2] = {0, 0};  // of the content of `source`
  std::int32_t width = 1;                   // lanes: 1, 2, 4, 8, 16; of Packed 1
  std::int32_t order = 20;                  // of the expansion
  std::uint64_t stride = 0;                 // Packed: doubles of a row
  std::uint32_t effort = 0;                 // 0: compiled soon; 1: runs long, so that longer code and more passes pay
                                            // 2: the code of 1 with fewer passes: a quarter of the time, equal results
  const char* processor = "";               // "": this one; else a name of LLVM's, such as x86-64-v3
};

/// Owned by the module until released.
struct Reply {
  const char* object = nullptr;  // relocatable ELF object; null: not compiled, see `trouble`
  std::size_t size = 0;
  const char* trouble = "";  // one sentence
  double emit_seconds = 0, compile_seconds = 0;
  std::size_t instructions = 0;  // of the intermediate representation
};

struct ModuleInterface {
  const char* tag;                                   // MAUPERTUIS_BUILD_TAG of the build
  const char* version;                               // "19.1.7"
  const char* (*processor)();                        // "sapphirerapids"
  void (*compile)(const Request*, Reply*) noexcept;  // any thread
  void (*release)(Reply*) noexcept;
};

inline constexpr char entry_name[] = "maupertuis_llvm_module";
using Entry = const ModuleInterface* (*)();

}  // namespace maupertuis::machine_code

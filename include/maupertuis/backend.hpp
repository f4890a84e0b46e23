#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

/// What carries kernels out: the interpreter, which is always there, or machine code from the module with LLVM.
namespace maupertuis {

/// What a run asks for. Automatic: compiled code where the expected work pays for it.
enum class Backend { Automatic, Interpreter, Compiled };

struct CompileOptions {
  bool cache = true;        // objects of earlier runs are read, new ones kept: ~/.cache/maupertuis
  bool long_run = false;    // the code will run long: longer code and more passes pay
  bool in_tiers = false;    // long code of a small program is compiled quickly, and anew in a thread when it ran long
  std::string processor{};  // empty: this one; else by LLVM's name, such as x86-64-v3
};

/// What this installation has. Opens the module.
struct BackendStatus {
  bool compiled = false;
  std::string trouble;       // why there is no compiled code; empty if there is
  std::string compiler;      // "LLVM 19.1.7"
  std::string processor;     // "sapphirerapids"
  std::string module;        // its file
  std::string cache_folder;  // empty: neither XDG_CACHE_HOME nor HOME is set
  std::size_t cache_files = 0;
  std::uintmax_t cache_bytes = 0;
};
BackendStatus backend_status();

}  // namespace maupertuis

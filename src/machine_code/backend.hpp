#pragma once
#include "machine_code/object_cache.hpp"
#include "machine_code/object_loader.hpp"
#include "machine_code/request.hpp"

#include <maupertuis/backend.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

namespace maupertuis::machine_code {

/// The module machine_code/llvm, or why there is none.
struct Module {
  const ModuleInterface* interface = nullptr;
  std::string path;
  std::string trouble;  // one sentence; empty where `interface` is set
};

/// Where the module is looked for: where the environment variable MAUPERTUIS_LLVM_MODULE says, if it is set; else in
/// ../lib/maupertuis from the program, then in the folder of the installation.
std::filesystem::path module_path();

/// Opens the module. It stays open until the process ends.
Module open_module(const std::filesystem::path& path);

/// The one of module_path(), opened at the first call. Any thread.
const Module& module();

/// Name, features and microcode-independent identity of this processor, as the key of the cache has it. No LLVM.
std::string processor_identity();

/// What a request gave. Code lives as long as the pointer.
struct Compiled {
  std::shared_ptr<const LoadedObject> code;  // null: `trouble` says why; the next backend has to do
  std::string trouble;
  std::string cache_trouble;  // the code is there, but could not be kept for the next run
  bool from_cache = false;
  double seconds = 0;  // all together
  double emit_seconds = 0, compile_seconds = 0;
  std::size_t instructions = 0, object_bytes = 0;
  bool is_final = true;  // no better code of the same results follows
};

/// Code for a request, from the cache if there is one and it has it; then LLVM is not opened. Any thread. Never throws
/// for what a system lacks: a run goes on with the next backend. `cache`: null: neither read nor written.
///
/// Cost: of a small program about 10 ms, the opening of LLVM (another 10 ms) at the first call; from the cache well
/// below 1 ms.
Compiled compile(const Request& request, const ObjectCache* cache);

/// The same from the cache alone; LLVM is not opened.
Compiled from_cache(const Request& request, const ObjectCache& cache);

/// The same of a source with this digest, with the usual cache if the options want one. In tiers: what the cache has of
/// effort 1, else code of effort 2.
Compiled compile(Request request, const Digest& source, const CompileOptions& options);

/// The key of a request in the cache: emitter, source, options, processor, and the identity of the module's file.
Digest key_of(const Request& request);

}  // namespace maupertuis::machine_code

#include "machine_code/backend.hpp"

#include "machine_code/processor.hpp"

#include <maupertuis/functions.hpp>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <vector>

#if defined(__linux__)
#include <dlfcn.h>
#include <sys/stat.h>
#endif
#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace maupertuis::machine_code {
namespace {

namespace fs = std::filesystem;

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

#if defined(__linux__)
fs::path program_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : program.parent_path();
}

/// SLEEF's functions, wherever code calls one; opened at the first.
void* sleef_function(const std::string& name) {
  static void* const library = dlopen("libsleef.so.3", RTLD_NOW | RTLD_LOCAL);
  return library ? dlsym(library, name.c_str()) : nullptr;
}

template <std::size_t I>
double row_value(double x) {
  return std::get<I>(functions::rows).value_of(x);
}

/// Of the table of functions, by name.
template <std::size_t... I>
void* program_function(std::string_view name, std::index_sequence<I...>) {
  void* found = nullptr;
  ((std::get<I>(functions::rows).name == name ? static_cast<void>(found = reinterpret_cast<void*>(&row_value<I>))
                                              : void()),
   ...);
  return found;
}

/// What the code of an emitter may call besides.
void* resolve(const std::string& name) {
  const std::string_view prefix = program_function_prefix;
  if (name.rfind(prefix, 0) == 0)
    return program_function(name.substr(prefix.size()), std::make_index_sequence<functions::count>());
  if (name.rfind("Sleef_", 0) == 0) return sleef_function(name);
  return name == "memset" || name == "memcpy" || name == "memmove" ? dlsym(RTLD_DEFAULT, name.c_str()) : nullptr;
}
#else
fs::path program_folder() { return {}; }
void* resolve(const std::string&) { return nullptr; }
#endif

const char* processor_of(const Request& request) { return *request.processor ? request.processor : code_processor(); }

struct ReplyHolder {
  const ModuleInterface* interface;
  Reply reply;
  ~ReplyHolder() { interface->release(&reply); }
};

/// Asks the module and fills all but the code. The object's bytes, empty if there are none.
std::vector<char> ask_module(const Request& request, Compiled& out) {
  const Module& m = module();
  if (!m.interface) {
    out.trouble = m.trouble;
    return {};
  }
  ReplyHolder holder{m.interface, {}};
  m.interface->compile(&request, &holder.reply);
  const Reply& reply = holder.reply;
  out.emit_seconds = reply.emit_seconds;
  out.compile_seconds = reply.compile_seconds;
  out.instructions = reply.instructions;
  if (!reply.object) {
    out.trouble = reply.trouble;
    return {};
  }
  return {reply.object, reply.object + reply.size};
}

}  // namespace

fs::path module_path() {
  if (const char* const named = std::getenv("MAUPERTUIS_LLVM_MODULE")) return named;
  std::error_code ignored;
  // As it was built, and as it was installed, wherever the whole of it has been moved since.
  for (const char* const folder : {"../lib/maupertuis", MAUPERTUIS_MODULE_FROM_PROGRAM}) {
    const fs::path beside = program_folder() / folder / MAUPERTUIS_LLVM_FILE;
    if (fs::exists(beside, ignored)) return beside.lexically_normal();
  }
  return fs::path(MAUPERTUIS_MODULE_FOLDER) / MAUPERTUIS_LLVM_FILE;
}

#if defined(__linux__)
Module open_module(const fs::path& path) {
  Module out;
  out.path = path.string();
  std::error_code ignored;
  if (path.empty() || !fs::exists(path, ignored)) {
    out.trouble = "the module " + (path.empty() ? std::string(MAUPERTUIS_LLVM_FILE) : out.path) + " is not here";
    return out;
  }
  void* const library = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (!library) {
    const char* const why = dlerror();
    out.trouble = why ? why : "the module cannot be opened";
    return out;
  }
  const auto entry = reinterpret_cast<Entry>(dlsym(library, entry_name));
  const ModuleInterface* const interface = entry ? entry() : nullptr;
  if (!interface || std::strcmp(interface->tag, MAUPERTUIS_BUILD_TAG) != 0)
    out.trouble = "the module " + out.path + " belongs to another build of this program";
  else
    out.interface = interface;
  return out;
}
#else
Module open_module(const fs::path& path) { return {nullptr, path.string(), "compiled kernels need Linux on x86-64"}; }
#endif

const Module& module() {
  static const Module opened = open_module(module_path());
  return opened;
}

std::string processor_identity() {
#if defined(__x86_64__)
  std::string out;
  const auto add = [&out](unsigned leaf, unsigned sub) {
    unsigned r[4] = {};
    __get_cpuid_count(leaf, sub, &r[0], &r[1], &r[2], &r[3]);
    if (leaf == 1) r[1] &= 0x00ffffffu;  // the number of the core that this thread happens to be on
    out.append(reinterpret_cast<const char*>(r), sizeof r);
  };
  for (const auto& [leaf, sub] : {std::pair{0u, 0u}, {1u, 0u}, {7u, 0u}, {7u, 1u}, {0x80000001u, 0u}}) add(leaf, sub);
  // The state that the system saves decides whether wide registers may be used.
  unsigned low = 0, high = 0;
  if (unsigned a, b, c = 0, d; __get_cpuid(1, &a, &b, &c, &d) && (c & bit_OSXSAVE))
    __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  out.append(reinterpret_cast<const char*>(&low), sizeof low);
  return out;
#else
  return {};
#endif
}

Digest key_of(const Request& request) {
  Digester d;
  d.add_text(MAUPERTUIS_BUILD_TAG);
  d.add_text(processor_identity());
  d.add_text(processor_of(request));
  for (const std::uint64_t part :
       {std::uint64_t(request.emitter), request.source_digest[0], request.source_digest[1],
        std::uint64_t(request.width), std::uint64_t(request.order), request.stride, std::uint64_t(request.effort)})
    d.add(part);
  // Another module may emit other code, though its tag is the same: its file tells.
  const fs::path path = module_path();
#if defined(__linux__)
  struct stat status {};
  if (stat(path.c_str(), &status) == 0)
    for (const std::uint64_t part :
         {std::uint64_t(status.st_size), std::uint64_t(status.st_mtim.tv_sec), std::uint64_t(status.st_mtim.tv_nsec)})
      d.add(part);
#endif
  return d.digest();
}

namespace {

void load(std::span<const char> object, Compiled& out) {
  out.object_bytes = object.size();
  out.code = LoadedObject::load(object, &resolve, out.trouble);
}

Compiled read(const Digest& key, const ObjectCache* cache) {
  const auto begin = std::chrono::steady_clock::now();
  Compiled out;
  if (cache)
    if (const auto object = cache->read(key)) load(*object, out);
  out.from_cache = out.code != nullptr;
  out.seconds = seconds_since(begin);
  return out;
}

Request for_processor(Request request) {
  request.processor = processor_of(request);
  return request;
}

}  // namespace

Compiled from_cache(const Request& request, const ObjectCache& cache) {
  return read(key_of(for_processor(request)), &cache);
}

Compiled compile(const Request& wanted, const ObjectCache* cache) {
  const auto begin = std::chrono::steady_clock::now();
  const Request request = for_processor(wanted);
  const Digest key = key_of(request);
  Compiled out = read(key, cache);
  if (!out.code) {
    out.trouble.clear();
    const std::vector<char> object = ask_module(request, out);
    if (!object.empty()) load(object, out);
    if (out.code && cache) out.cache_trouble = cache->write(key, object);
  }
  out.seconds = seconds_since(begin);
  return out;
}

Compiled compile(Request request, const Digest& source, const CompileOptions& options) {
  request.source_digest[0] = source.high, request.source_digest[1] = source.low;
  request.effort = options.long_run ? 1 : 0;
  request.processor = options.processor.c_str();
  std::optional<ObjectCache> cache;
  if (options.cache) cache.emplace(ObjectCache::usual_folder());
  Compiled made;
  if (options.in_tiers && cache) made = from_cache(request, *cache);
  if (!made.code) {
    if (options.in_tiers) request.effort = 2;
    made = compile(request, cache ? &*cache : nullptr);
  }
  made.is_final = request.effort != 2;
  return made;
}

}  // namespace maupertuis::machine_code

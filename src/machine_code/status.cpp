#include "machine_code/backend.hpp"
#include "machine_code/processor.hpp"

#include <maupertuis/backend.hpp>

#include <cmath>

namespace maupertuis {
namespace {

/// Code of the smallest kind, run: what an installation has is what works. Empty if it does.
std::string self_test() {
  machine_code::Request request;
  request.width = 2;
  const machine_code::Compiled made = machine_code::compile(request, nullptr);
  if (!made.code) return made.trouble;
  const auto f = reinterpret_cast<void (*)(const double*, double*)>(made.code->find("self_test"));
  alignas(64) const double x[2] = {0.5, 2};
  alignas(64) double y[2] = {};
  f(x, y);
  for (int i = 0; i < 2; ++i)
    if (!(std::abs(y[i] - std::sqrt(std::pow(std::sin(x[i]), 2) + x[i] * std::pow(std::cos(x[i]), 2))) < 1e-15))
      return "compiled code computes wrong numbers on this processor; please report";
  return {};
}

}  // namespace

BackendStatus backend_status() {
  BackendStatus out;
  const machine_code::Module& module = machine_code::module();
  out.trouble = module.interface ? self_test() : module.trouble;
  out.compiled = out.trouble.empty();
  out.module = module.path;
  if (module.interface) {
    out.compiler = std::string("LLVM ") + module.interface->version;
    out.processor = *code_processor() ? code_processor() : module.interface->processor();
  }
  const machine_code::ObjectCache cache(machine_code::ObjectCache::usual_folder());
  const auto usage = cache.usage();
  out.cache_folder = cache.folder().string();
  out.cache_files = usage.files;
  out.cache_bytes = usage.bytes;
  return out;
}

}  // namespace maupertuis

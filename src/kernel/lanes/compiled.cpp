#include "kernel/compiled/backend.hpp"
#include "kernel/lanes/lanes.hpp"

#include <maupertuis/lanes.hpp>
#include <maupertuis/require.hpp>

#include <optional>

namespace maupertuis {
namespace {

class LanesInCode final : public LaneExpansion {
 public:
  LanesInCode(int width, std::shared_ptr<const compiled::LoadedObject> code)
      : width_(width), code_(std::move(code)), expand_(reinterpret_cast<lanes::Expand>(code_->find("expand"))) {}

  int width() const override { return width_; }
  std::string_view backend() const override { return "compiled"; }
  void expand(double* rows, const double* constants, double* quality, double* scratch, int stages) const override {
    expand_(rows, constants, quality, scratch, stages);
  }

 private:
  int width_;
  std::shared_ptr<const compiled::LoadedObject> code_;
  lanes::Expand expand_;
};

}  // namespace

CompiledLanes compiled_lanes(const Kernel& kernel, int width, const CompileOptions& options) {
  MAUP_REQUIRE((width == 1 || width == 2 || width == 4 || width == 8 || width == 16) && fits_lanes(kernel));
  const compiled::Digest digest = compiled::digest_of(kernel.program());
  compiled::Request request;
  request.emitter = compiled::Emitter::Lanes;
  request.source = &kernel.program();
  request.source_digest[0] = digest.high, request.source_digest[1] = digest.low;
  request.width = width;
  request.effort = options.long_run ? 1 : 0;
  request.processor = options.processor.c_str();
  std::optional<compiled::ObjectCache> cache;
  if (options.cache) cache.emplace(compiled::ObjectCache::usual_folder());
  compiled::Compiled made = compiled::compile(request, cache ? &*cache : nullptr);
  CompiledLanes out;
  if (made.code) out.expansion = std::make_shared<LanesInCode>(width, made.code);
  out.trouble = std::move(made.trouble);
  out.cache_trouble = std::move(made.cache_trouble);
  out.seconds = made.seconds;
  out.from_cache = made.from_cache;
  return out;
}

}  // namespace maupertuis

#include "kernel/program/code.hpp"
#include "kernel/lanes/lanes.hpp"

#include <maupertuis/lanes.hpp>
#include <maupertuis/require.hpp>

namespace maupertuis {
namespace {

class LanesInCode final : public LaneExpansion {
 public:
  LanesInCode(int width, std::shared_ptr<const machine_code::LoadedObject> code)
      : width_(width), code_(std::move(code)), expand_(reinterpret_cast<lanes::Expand>(code_->find("expand"))) {}

  int width() const override { return width_; }
  std::string_view backend() const override { return "compiled"; }
  void expand(double* rows, const double* constants, double* quality, double* scratch, int stages) const override {
    expand_(rows, constants, quality, scratch, stages);
  }

 private:
  int width_;
  std::shared_ptr<const machine_code::LoadedObject> code_;
  lanes::Expand expand_;
};

}  // namespace

CompiledLanes compiled_lanes(const Kernel& kernel, int width, const CompileOptions& options) {
  MAUP_REQUIRE((width == 1 || width == 2 || width == 4 || width == 8 || width == 16) && fits_lanes(kernel));
  machine_code::Request request;
  request.emitter = machine_code::Emitter::Lanes;
  request.source = &kernel.program();
  request.width = width;
  machine_code::Compiled made = machine_code::compile(request, digest_of(kernel.program()), options);
  CompiledLanes out;
  if (made.code) out.expansion = std::make_shared<LanesInCode>(width, made.code);
  out.trouble = std::move(made.trouble);
  out.cache_trouble = std::move(made.cache_trouble);
  out.seconds = made.seconds;
  out.from_cache = made.from_cache;
  return out;
}

}  // namespace maupertuis

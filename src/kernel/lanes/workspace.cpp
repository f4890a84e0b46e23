#include "kernel/extended/close_constants.hpp"
#include "kernel/lanes/lanes.hpp"
#include "kernel/reference/reference.hpp"

#include <maupertuis/lanes.hpp>
#include <maupertuis/require.hpp>

namespace maupertuis {
namespace {

std::size_t orders_of(const Program& program, int order) {
  return static_cast<std::size_t>(order + 2 + (-2 - program.first_stage));
}

}  // namespace

struct LaneWorkspace::Impl {
  Impl(const Kernel& k, int p, std::shared_ptr<const LaneExpansion> e)
      : kernel(k),
        program(k.program()),
        expansion(std::move(e)),
        order(p),
        width(static_cast<std::size_t>(expansion->width())),
        row(lanes::row_stride(program) * width),
        rows(orders_of(program, p) * row),
        constants((program.constants.size() + 1) * width),
        quality(width),
        scratch(lanes::scratch_size(program) * width),
        unused_time(width) {
    for (std::size_t lane = 0; lane < width; ++lane) {
      if (program.one != no_slot) rows.data()[program.one * width + lane] = 1;
      if (program.time != no_slot && orders_of(program, p) > 1) rows.data()[row + program.time * width + lane] = 1;
    }
  }

  Kernel kernel;
  const Program& program;
  std::shared_ptr<const LaneExpansion> expansion;
  int order;
  std::size_t width, row;  // doubles of a row
  reference::Doubles rows, constants, quality, scratch, unused_time;
};

LaneWorkspace::LaneWorkspace(const Kernel& kernel, int order, std::shared_ptr<const LaneExpansion> expansion) {
  MAUP_REQUIRE(order >= 1 && fits_lanes(kernel));
  impl_ = std::make_unique<Impl>(kernel, order, std::move(expansion));
}
LaneWorkspace::~LaneWorkspace() = default;
LaneWorkspace::LaneWorkspace(LaneWorkspace&&) noexcept = default;

int LaneWorkspace::width() const { return static_cast<int>(impl_->width); }
int LaneWorkspace::order() const { return impl_->order; }

void LaneWorkspace::set_parameters(int lane, std::span<const double> values) {
  MAUP_REQUIRE(values.size() == impl_->program.parameters && lane >= 0 && lane < width());
  std::vector<double> constants(impl_->program.constants.size());
  extended::compute_close_constants(impl_->program, values, {}, constants);
  for (std::size_t i = 0; i < constants.size(); ++i) impl_->constants[i * impl_->width + lane] = constants[i];
}

std::vector<double> LaneWorkspace::constants(int lane) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < impl_->program.constants.size(); ++i)
    values.push_back(impl_->constants.data()[i * impl_->width + static_cast<std::size_t>(lane)]);
  return values;
}

double* LaneWorkspace::time() {
  const Slot slot = impl_->program.time;
  return slot == no_slot ? impl_->unused_time.data() : impl_->rows.data() + slot * impl_->width;
}
double* LaneWorkspace::coordinate(int k) { return impl_->rows.data() + static_cast<std::size_t>(k) * impl_->row; }
const double* LaneWorkspace::coordinate(int k) const {
  return impl_->rows.data() + static_cast<std::size_t>(k) * impl_->row;
}

void LaneWorkspace::expand() {
  Impl& s = *impl_;
  s.expansion->expand(s.rows.data(), s.constants.data(), s.quality.data(), s.scratch.data(), s.order);
}

const double* LaneWorkspace::quality() const { return impl_->quality.data(); }

}  // namespace maupertuis

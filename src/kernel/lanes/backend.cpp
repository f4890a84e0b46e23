#include "kernel/lanes/lanes.hpp"
#include "kernel/lanes/plan.hpp"
#include "machine_code/processor.hpp"
#include "kernel/series/elementary.hpp"

#include <maupertuis/lanes.hpp>
#include <maupertuis/require.hpp>

#include <cmath>

namespace maupertuis {
namespace lanes {

double elementary_function(Kind function, double x, double y) { return series::elementary<double>(function, x, y); }
double power_function(double x, double y) { return std::pow(x, y); }

}  // namespace lanes

namespace {

bool processor_has(InstructionSet set) {
  return vector_instructions() >= (set == InstructionSet::Avx2 ? VectorInstructions::Avx2 : VectorInstructions::Avx512);
}

lanes::Expanders expanders(InstructionSet set) {
  switch (set) {
    case InstructionSet::Avx2:
      return lanes::avx2_expanders();
    case InstructionSet::Avx512:
      return lanes::avx512_expanders();
    case InstructionSet::Best:
    case InstructionSet::Baseline:
      break;
  }
  return lanes::baseline_expanders();
}

InstructionSet best_instruction_set() {
  for (const InstructionSet set : {InstructionSet::Avx512, InstructionSet::Avx2})
    if (has_instruction_set(set)) return set;
  return InstructionSet::Baseline;
}

int index_of_width(int width) {
  for (int i = 0; i < 5; ++i)
    if (width == 1 << i) return i;
  return -1;
}

class InterpretedLanes final : public LaneExpansion {
 public:
  InterpretedLanes(const Kernel& kernel, int width, lanes::Expander expander)
      : kernel_(kernel), plan_(kernel.program()), view_(plan_.view()), width_(width), expander_(expander) {}

  int width() const override { return width_; }
  std::string_view backend() const override { return "interpreter"; }
  void expand(double* rows, const double* constants, double* quality, double* scratch, int stages) const override {
    expander_(view_, rows, constants, quality, scratch, stages);
  }

 private:
  Kernel kernel_;  // keeps the program alive
  lanes::Plan plan_;
  lanes::PlanView view_;
  int width_;
  lanes::Expander expander_;
};

}  // namespace

bool has_instruction_set(InstructionSet set) {
  if (set == InstructionSet::Best || set == InstructionSet::Baseline) return true;
  return processor_has(set) && expanders(set).of_width[0];
}

int best_lane_width() {
  switch (best_instruction_set()) {
    case InstructionSet::Avx512:
      return 8;
    case InstructionSet::Avx2:
      return 4;
    case InstructionSet::Best:
    case InstructionSet::Baseline:
      break;
  }
  return 2;
}

bool lanes_pay() {
#if defined(__FP_FAST_FMA)
  return true;
#else
  return has_instruction_set(InstructionSet::Avx2);
#endif
}

bool fits_lanes(const Kernel& kernel) {
  return kernel.freedoms() > 0 && kernel.constraints() == 0 && kernel.switches().empty() && kernel.events() == 0;
}

std::shared_ptr<const LaneExpansion> interpreted_lanes(const Kernel& kernel, int width, InstructionSet set) {
  const int index = index_of_width(width);
  MAUP_REQUIRE(index >= 0 && fits_lanes(kernel) && has_instruction_set(set));
  if (set == InstructionSet::Best) set = best_instruction_set();
  return std::make_shared<InterpretedLanes>(kernel, width, expanders(set).of_width[index]);
}

}  // namespace maupertuis

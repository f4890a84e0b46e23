#include <maupertuis/stiff.hpp>

#include <stdexcept>

/// A build without SUNDIALS: the method is named, and says that it is missing.
#ifndef MAUPERTUIS_SUNDIALS
namespace maupertuis {

struct StiffStepper::Impl {};

bool has_stiff_method() { return false; }

StiffStepper::StiffStepper(const MotionFunctions&, std::span<const double>, const StiffOptions&) {
  throw std::logic_error("this build has no stiff method; please report");
}
StiffStepper::~StiffStepper() = default;
StiffStepper::StiffStepper(StiffStepper&&) noexcept = default;
bool StiffStepper::fast_parts_die_out(double, std::span<const double>, std::span<const double>, double) {
  return false;
}
void StiffStepper::start(double, std::span<const double>, std::span<const double>) {}
Step StiffStepper::step(double) { return {}; }
double StiffStepper::time() const { return 0; }
std::span<const double> StiffStepper::q() const { return {}; }
std::span<const double> StiffStepper::v() const { return {}; }
std::size_t StiffStepper::steps() const { return 0; }
std::size_t StiffStepper::rejected() const { return 0; }
double StiffStepper::constraint_residual() const { return 0; }
bool StiffStepper::covers(double) const { return false; }
Sample StiffStepper::sample(double) const { return {}; }
void StiffStepper::state(double, std::span<double>, std::span<double>) const {}
const Sample& StiffStepper::step_start() const {
  throw std::logic_error("this build has no stiff method; please report");
}

}  // namespace maupertuis
#endif

#include "disks/parts.hpp"

/// One face for the parts that bound a program.
namespace maupertuis {

Disks::Disks(const Program& program, std::span<const std::uint32_t> slots)
    : parts_(std::make_unique<Parts>(program, slots)) {
  if (has_bases()) parts_->many = std::make_unique<ManyDisks>(program);
}
Disks::~Disks() = default;
Disks::Disks(Disks&&) noexcept = default;

void Disks::bound_only(std::span<const std::uint32_t> slots) {
  parts_->plan.bound_only(slots);
  parts_->many.reset();
}

void Disks::set_constants(const double* constants) {
  parts_->plan.set_constants(constants);
  if (parts_->many) parts_->many->set_constants(constants);
}

void Disks::begin(const SlotCoefficients& coefficients) {
  parts_->one.begin(coefficients);
  parts_->roundings.forget();
}

void Disks::evaluate(double radius, Depth depth) {
  DiskValues<double>& one = parts_->one;
  const DiskPlan& plan = parts_->plan;
  one.evaluate(radius, depth == Depth::Derivatives ? plan.derived : plan.needed, depth == Depth::Coefficients);
}

void Disks::begin_many(const SlotCoefficients& coefficients, const std::array<double, many>& radii) {
  begin(coefficients);
  parts_->many->begin(coefficients, radii);
}
bool Disks::ask_more() { return parts_->many->ask_more(); }
void Disks::find_left_out(double h) { parts_->many->find_left_out(h); }
double Disks::residual_left_out(std::size_t j) const { return parts_->many->left_out(j); }

double Disks::residual_tail(std::size_t j) const {
  const int node = parts_->plan.residual[j];
  return node < 0 ? 0.0 : tail(parts_->plan.nodes[static_cast<std::size_t>(node)].instruction.out);
}

double Disks::residual_rounding(std::size_t j, double length) {
  const int node = parts_->plan.residual[j];
  if (node < 0) return 0;
  const Slot slot = parts_->plan.nodes[static_cast<std::size_t>(node)].instruction.out;
  return parts_->roundings.of(slot, parts_->one.coefficients(), length);
}

double Disks::rounding(std::uint32_t slot, double length) {
  return parts_->roundings.of(slot, parts_->one.coefficients(), length);
}

bool Disks::residual_has_tails() const { return parts_->plan.residual_has_tails; }
bool Disks::needs_larger_disk() const { return !parts_->plan.derived.empty(); }
bool Disks::has_bases() const { return !parts_->plan.bases.empty(); }
std::span<const int> Disks::degrees() const { return parts_->plan.degree; }
std::size_t Disks::residuals() const { return parts_->plan.residual.size(); }
double Disks::tail(std::uint32_t slot) const { return parts_->one.of(slot).tail; }
double Disks::reach(std::uint32_t slot) const { return parts_->one.of(slot).reach; }
int Disks::last_order(std::uint32_t slot) const {
  return parts_->one.coefficients().order + 1 - parts_->plan.program.lags[slot];
}

}  // namespace maupertuis

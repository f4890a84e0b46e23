#include "disks/many_disks.hpp"

#include "machine_code/processor.hpp"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace maupertuis {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::unique_ptr<ManyDisks::Values> widest(const DiskPlan& plan) {
  if (vector_instructions() >= VectorInstructions::Avx512)
    if (auto values = avx512_disks(plan)) return values;
  if (vector_instructions() >= VectorInstructions::Avx2)
    if (auto values = avx2_disks(plan)) return values;
  return baseline_disks(plan);
}

/// The smallest of the numbers; ∞ where there is none. In pairs, since each comparison waits for its operands.
double smallest(const std::array<double, Disks::many>& x) {
  const auto smaller = [](double a, double b) { return a < b ? a : b; };
  const auto of_two = [&](std::size_t i) { return smaller(x[i], smaller(x[i + 1], infinity)); };
  return smaller(smaller(of_two(0), of_two(2)), smaller(of_two(4), of_two(6)));
}

}  // namespace

ManyDisks::ManyDisks(const Program& program) : ManyDisks(program, nullptr) { values_ = widest(plan_); }
ManyDisks::ManyDisks(const Program& program, std::unique_ptr<Values> values)
    : rows_(program),
      plan_(program, {}),
      values_(std::move(values)),
      tails_(rows_.terms().size()),
      least_(rows_.terms().size()),
      left_out_(rows_.rows()) {
  std::vector<Slot> slots;
  for (const ResidualTerms::Term& term : rows_.terms())
    for (const Slot slot : {term.a, term.b})
      if (slot != no_slot) slots.push_back(slot);
  plan_.bound_only(slots);
}

void ManyDisks::set_constants(const double* constants) {
  rows_.set_constants(constants);
  plan_.set_constants(constants);
}

void ManyDisks::begin(const SlotCoefficients& coefficients, const Radii& radii) {
  if (asked_ > 0) first_ = (first_ + asked_ - 1) % values_->passes();
  now_ = coefficients;
  radii_ = radii;
  asked_ = 0;
  for (Tails& tails : tails_) tails.fill(infinity);
}

bool ManyDisks::ask_more() {
  if (asked_ == values_->passes()) return false;
  values_->evaluate(now_, radii_, (first_ + asked_++) % values_->passes(), rows_.terms(), tails_.data());
  return true;
}

/// Of tails: x^p/(1 − x). Nothing on a disk that ends too near says nothing of what lies farther on: ∞ · 0 is no
/// number, and does not count. All disks at once in each loop.
std::array<double, Disks::many> ManyDisks::weights_for(double h) const {
  constexpr double most_of_radius = 0.5 * (1 + 1e-12);  // half of a radius, which is a rounded product
  std::array<double, Disks::many> x, square, weights;
  for (std::size_t disk = 0; disk < x.size(); ++disk) square[disk] = x[disk] = h / radii_[disk];
  weights.fill(1);
  for (int n = now_.order; n > 0; n /= 2) {
    if (n % 2 != 0)
      for (std::size_t disk = 0; disk < x.size(); ++disk) weights[disk] *= square[disk];
    for (std::size_t disk = 0; disk < x.size(); ++disk) square[disk] *= square[disk];
  }
  for (std::size_t disk = 0; disk < x.size(); ++disk) weights[disk] /= 1 - x[disk];
  for (std::size_t disk = 0; disk < x.size(); ++disk)
    if (!(x[disk] <= most_of_radius)) weights[disk] = infinity;
  return weights;
}

void ManyDisks::find_left_out(double h) {
  const std::array<double, Disks::many> weights = weights_for(h);
  std::array<double, Disks::many> left_out;
  for (std::size_t t = 0; t < tails_.size(); ++t) {
    for (std::size_t disk = 0; disk < weights.size(); ++disk) left_out[disk] = weights[disk] * tails_[t][disk];
    least_[t] = smallest(left_out);
  }
  rows_.add_up(least_, left_out_);
}

}  // namespace maupertuis

#include "integrator/taylor/passed_stretch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::taylor {
namespace {

std::vector<Slot> watched_slots(const Program& program) {
  std::vector<Slot> out = program.switch_slots;
  out.insert(out.end(), program.events.begin(), program.events.end());
  return out;
}

std::vector<Slot> with_residual(std::vector<Slot> slots, const Program& program) {
  for (const Slot slot : program.residual)
    if (slot != no_slot) slots.push_back(slot);
  return slots;
}

}  // namespace

PassedStretch::PassedStretch(const Program& program, int order, SafeLength& safe, double t, double rest,
                             std::span<const double> rows)
    : program_(program),
      safe_(safe),
      watched_(watched_slots(program)),
      retrace_(program, order, with_residual(watched_, program)),
      rows_(program),
      functions_(program, watched_),
      t_(t) {
  functions_.bound_only(watched_);
  retrace_.set_motion(t, rest, [&](int k) { return rows.data() + static_cast<std::size_t>(k) * program.unknowns; });
}

void PassedStretch::look_at(double s, const double* constants) {
  retrace_.set_constants(constants);
  rows_.set_constants(constants);
  functions_.set_constants(constants);
  if (safe_.is_needed()) safe_.set_constants(constants);
  now_ = t_ + s;
  retrace_.expand_about(s);
  rows_.begin(coefficients());
}

bool PassedStretch::holds(std::size_t j, double size) {
  constexpr double roundings = 64 * std::numeric_limits<double>::epsilon();
  const Slot slot = program_.residual[j];
  if (slot == no_slot) return true;
  return std::abs(retrace_.row(0)[slot]) <= size + roundings * (retrace_.scale(slot) + rows_.residual_rounding(j, 1));
}

bool PassedStretch::are_clear(double length) {
  functions_.evaluate(length, Disks::Depth::Rules);
  return std::all_of(watched_.begin(), watched_.end(), [&](Slot slot) {
    const double here = std::abs(retrace_.row(0)[slot]);
    return here > functions_.reach(slot) || (here == 0 && functions_.reach(slot) == 0);
  });
}

double PassedStretch::length(double most, double least) {
  double length = std::min(most, safe_.within(coefficients(), now_, most, most));
  if (watched_.empty()) return length >= least ? length : 0;
  functions_.begin(coefficients());
  if (functions_.needs_larger_disk()) functions_.evaluate(1.5 * length, Disks::Depth::Derivatives);
  while (length >= least && !are_clear(length)) length *= 0.5;
  return length >= least ? length : 0;
}

}  // namespace maupertuis::taylor

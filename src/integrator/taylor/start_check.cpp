#include "integrator/taylor/constraint_error.hpp"
#include "integrator/taylor/step_size.hpp"

#include <maupertuis/arguments.hpp>
#include <maupertuis/integrator.hpp>

#include <fmt/format.h>

#include <cmath>

namespace maupertuis {
namespace {

constexpr double allowed = 1e-9;  // numbers of ten digits are on the constraints

bool all_finite(std::span<const double> values) {
  for (const double x : values)
    if (!std::isfinite(x)) return false;
  return true;
}

/// The one that the point violates most, in units of the sizes of its terms.
std::size_t most_violated(const KernelWorkspace& work, std::size_t constraints) {
  std::size_t out = 0;
  double most = -1;
  for (std::size_t j = 0; j < constraints; ++j) {
    const double place = std::abs(work.constraint_value(j)) / (work.constraint_scale(j) + 1e-300),
                 rate = std::abs(work.constraint_rate(j)) / (work.constraint_rate_scale(j) + 1e-300);
    if (std::max(place, rate) > most) most = std::max(place, rate), out = j;
  }
  return out;
}

}  // namespace

std::string trouble_of_start(const Kernel& kernel, std::span<const double> parameters, double t,
                             std::span<const double> q, std::span<const double> v) {
  const std::size_t n = kernel.freedoms(), m = kernel.constraints();
  check_argument(q.size() == n && v.size() == n,
                 "trouble_of_start: q or v has another length than there are coordinates");
  if (!std::isfinite(t) || !all_finite(q) || !all_finite(v))
    return "The start holds a number that is infinite or undefined.";
  if (!all_finite(parameters)) return "A parameter is infinite or undefined.";
  if (m == 0) return {};
  const taylor::StepControl control = taylor::step_control(0, 0);
  KernelWorkspace work(kernel, control.order);
  work.set_parameters(parameters);
  if (!work.choose_branches(t, q, v) || work.expand(t, q, v) != KernelStatus::Ok) return {};  // the first step tells
  std::vector<double> dq(n), dv(n);
  work.corrections(dq, dv);
  const double h = taylor::step_size(work, n, control, 0), length = std::isfinite(h) ? h : 0;
  const double shift = taylor::start_shift(work, m, dq, dv, length);
  if (!(shift > allowed)) return {};
  return fmt::format(
      "The start is off the constraint {}: it would have to be moved by {:.2g} of its size. consistent_start and "
      "ConstraintManifold bring starts to the constraints.",
      kernel.constraint_name(most_violated(work, m)), shift);
}

}  // namespace maupertuis

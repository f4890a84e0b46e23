#include "simulation/hybrid_slips.hpp"

#include "simulation/hybrid_motions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::hybrid {
namespace {

constexpr double slow_slip = 1e-10;  // of the slips of the run: below, the direction of a slip is lost in rounding
/// The direction of a slip changes in a time of |v_t|/|v̇_t|, and coefficients of order k are beyond the range of
/// numbers where that is less than 10^(−308/k).
constexpr double largest_exponent = 270;

}  // namespace

void SpaceSlips::start() {
  const std::size_t contacts = problem_.system.contacts.size();
  begins_.assign(contacts, false);
  towards_.assign(contacts, 0);
}

void SpaceSlips::begin_instant(const ModeMotion& before, const Met& met) {
  const std::size_t contacts = problem_.system.contacts.size();
  begins_.assign(contacts, false);
  just_began_.assign(contacts, false);
  for (std::size_t i = 0; i < before.given.begins.size(); ++i)
    just_began_[i] = before.given.begins[i] && !met.ends(Watch::What::Slip, i);
}

double Given::preload(std::size_t constraint, double t) const {
  if (!is_preload) return 0;
  constexpr auto powers = static_cast<std::size_t>(preload_degree) + 1;
  double out = 0;
  for (std::size_t power = powers; power-- > 0;) out = out * (t - values[0]) + values[1 + constraint * powers + power];
  return out;
}

bool SpaceSlips::slides(std::size_t i, const ContactValues& values) const {
  return begins_[i] || slip_speed(i, values) > sizes_.rest_slip(i, values);
}

int order_beside_stops(const TaylorOptions& options) {
  constexpr int most = 24;
  const int order = options.order > 0 ? options.order : taylor_order(options.tolerance);
  return order <= most ? order : most - 3 + order % 4;
}

double SpaceSlips::stop_speed(std::size_t i) const {
  constexpr double above_rounding = 100, earlier = 10;
  const ContactValues& values = here_.values();
  const int steps_order = order_beside_stops(problem_.options);
  const double speed = std::max({slow_slip * sizes_.slip_in_space(i), above_rounding * sizes_.rest_slip(i, values),
                                 std::numeric_limits<double>::min()});
  const double coefficients_end = sizes_.slip_rate(i) * std::pow(10, -largest_exponent / (steps_order + 2));
  return (problem_.meets_late ? earlier : 1) *
         std::max(std::pow(10, std::floor(std::log10(speed))), std::pow(10, std::ceil(std::log10(coefficients_end))));
}

bool SpaceSlips::outgrow_stops(const ModeMotion& motion) const {
  if (motion.stops.empty()) return false;
  const ContactValues& values = here_.values();
  for (std::size_t i = 0; i < motion.stops.size(); ++i)
    if (motion.mode.friction[i] == FrictionState::Slide && motion.stops[i] < sizes_.rest_slip(i, values)) return true;
  return false;
}

double SpaceSlips::latest_end(const ModeMotion& motion) const {
  constexpr std::size_t many = 4000;
  double out = std::numeric_limits<double>::infinity();
  if (!problem_.in_space || motion.stepper->steps() < many) return out;
  const ContactValues& values = here_.values();
  const std::vector<double> a = motion.stepper->sample(here_.t).a;
  const std::span<const double> drifts = here_.drifts();
  const std::size_t contacts = values.gap.size(), seconds = drifts.size() - contacts;
  for (std::size_t i = 0; i < contacts; ++i) {
    if (motion.mode.friction[i] != FrictionState::Slide) continue;
    const double falls = -(values.slip[i] * (drifts[contacts + i] + product(values.tangent[i], a)) +
                           values.second_slip[i] * (drifts[seconds + i] + product(values.second_tangent[i], a)));
    if (falls > 0) out = std::min(out, here_.t + 2 * std::pow(slip_speed(i, values), 2) / falls);
  }
  return out;
}

SparseRow SpaceSlips::sliding_force(std::size_t i, const ContactValues& values) const {
  const double speed = slip_speed(i, values), mu = values.kinetic[i];
  const bool begins = begins_[i] && !(speed > sizes_.rest_slip(i, values));
  const double along = begins ? std::cos(towards_[i]) : values.slip[i] / speed;
  SparseRow out = sum_of(values.normal[i], values.tangent[i], -mu * along);
  if (values.second_tangent[i].empty()) return out;
  const double across = begins ? std::sin(towards_[i]) : values.second_slip[i] / speed;
  return sum_of(out, values.second_tangent[i], -mu * across);
}

std::optional<SpaceSlips::OwnResponse> SpaceSlips::own_response(std::size_t i, const ContactMode& mode,
                                                                const ContactValues& values) const {
  const FrictionState state = mode.friction[i];
  if (!mode.closed[i] || state == FrictionState::None || state == FrictionState::Stick) return std::nullopt;
  const double sign = state == FrictionState::Backward ? -1 : 1;
  const SparseRow forces[] = {state == FrictionState::Slide
                                  ? sliding_force(i, values)
                                  : sum_of(values.normal[i], values.tangent[i], -sign * values.kinetic[i]),
                              values.normal[i]};
  const Eigen::MatrixXd response = here_.response(forces);
  return OwnResponse{dot(values.normal[i], response.col(0)), dot(values.normal[i], response.col(1))};
}

std::vector<double> SpaceSlips::stop_speeds() const {
  std::vector<double> out;
  for (std::size_t i = 0; i < problem_.system.contacts.size(); ++i) out.push_back(stop_speed(i));
  return out;
}

}  // namespace maupertuis::hybrid

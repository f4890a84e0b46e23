#include "simulation/hybrid_sizes.hpp"

#include "simulation/hybrid_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::hybrid {
namespace {

/// The number of the first one with the same dimension.
template <class Item>
std::vector<std::size_t> kinds_by_dimension(const std::vector<Item>& items) {
  std::vector<std::size_t> out;
  for (const Item& item : items) {
    std::size_t k = 0;
    while (!(items[k].dimension == item.dimension)) ++k;
    out.push_back(k);
  }
  return out;
}

}  // namespace

UsualSizes::UsualSizes(const MechanicalSystem& system)
    : system_(system), kind_(kinds_by_dimension(system.coordinates)), gap_kind_(kinds_by_dimension(system.contacts)) {}

void UsualSizes::set_elsewhere(std::span<const double> q, std::span<const double> v) {
  elsewhere_q_.assign(q.begin(), q.end());
  elsewhere_v_.assign(v.begin(), v.end());
}

void UsualSizes::start() {
  const std::size_t contacts = system_.contacts.size();
  fastest_.assign(contacts, 0);
  fastest_slip_.assign(contacts + system_.frictions.size(), 0);
  widest_ = hardest_ = compliance_ = slip_scale_ = slip_rate_ = fastest_;
  holding_.assign(2 * contacts + system_.frictions.size(), 0);
  speed_.assign(kind_.size(), 0);
  acceleration_ = place_ = speed_;
  for (std::size_t i = 0; i < elsewhere_q_.size(); ++i) {
    place_[kind_[i]] = std::max(place_[kind_[i]], elsewhere_q_[i]);
    speed_[kind_[i]] = std::max(speed_[kind_[i]], elsewhere_v_[i]);
  }
}

double UsualSizes::acceleration_along(const SparseRow& row) const {
  double out = 0;
  for (const auto& [i, g] : row) out += std::abs(g) * acceleration_[kind_[i]];
  return out;
}

/// What a located instant leaves of a speed, in units of rounding: the rounding of t times an acceleration.
double UsualSizes::left_by_time(const SparseRow& row, double t) const {
  return 0.25 * std::abs(t) * acceleration_along(row);
}

double UsualSizes::rest_speed(std::size_t contact, const ContactValues& values) const {
  return rest_unit *
         (std::max(values.rate_scale[contact], fastest_[contact]) + left_by_time(values.normal[contact], values.t));
}

double UsualSizes::rest_slip(std::size_t friction, const ContactValues& values) const {
  return rest_unit * (std::max(values.slip_scale[friction], fastest_slip_[friction]) +
                      left_by_time(values.tangent[friction], values.t));
}

double UsualSizes::opening_rate(std::size_t contact, std::span<const double> accelerations, const State& here) const {
  const ContactValues& values = here.values();
  double sum = here.drifts()[contact], size = std::abs(sum);
  for (const auto& [k, g] : values.normal[contact]) {
    sum += g * accelerations[k];
    size += std::abs(g) * acceleration_[kind_[k]];
  }
  return sum / std::max(size, std::numeric_limits<double>::min());
}

double UsualSizes::gap(std::size_t contact, const ContactValues& values) const {
  double size = widest_[contact];
  for (const auto& [k, g] : values.normal[contact]) size = std::max(size, std::abs(g) * place_[kind_[k]]);
  return size;
}

std::vector<double> UsualSizes::accelerations() const {
  std::vector<double> out;
  for (const std::size_t k : kind_) out.push_back(acceleration_[k]);
  return out;
}

void UsualSizes::tell(TaylorStepper& stepper) const {
  std::vector<double> places, speeds;
  for (const std::size_t k : kind_) {
    places.push_back(place_[k]);
    speeds.push_back(speed_[k]);
  }
  stepper.set_usual_sizes(places, speeds, accelerations());
}

void UsualSizes::note(const State& here, const ContactValues& values) {
  for (std::size_t i = 0; i < here.v.size(); ++i) {
    place_[kind_[i]] = std::max(place_[kind_[i]], std::abs(here.q[i]));
    speed_[kind_[i]] = std::max(speed_[kind_[i]], std::abs(here.v[i]));
  }
  const auto size_along = [&](const SparseRow& row) {
    double sum = 0;
    for (const auto& [k, x] : row) sum += std::abs(x) * speed_[kind_[k]];
    return sum;
  };
  for (std::size_t i = 0; i < fastest_.size(); ++i)
    fastest_[i] = std::max({fastest_[i], values.rate_scale[i], size_along(values.normal[i])});
  note_gaps(values);
  for (std::size_t i = 0; i < fastest_slip_.size(); ++i)
    fastest_slip_[i] = std::max({fastest_slip_[i], values.slip_scale[i], size_along(values.tangent[i])});
  for (std::size_t i = 0; i < slip_scale_.size(); ++i) {  // of what the slip is made of, however fast others are
    double elsewhere = 0;
    for (const auto& [k, x] : values.tangent[i]) elsewhere += elsewhere_v_.empty() ? 0 : std::abs(x) * elsewhere_v_[k];
    slip_scale_[i] = std::max({slip_scale_[i], values.slip_scale[i], elsewhere});
  }
  note_slip_rates(values);
}

void UsualSizes::note_gaps(const ContactValues& values) {
  for (std::size_t i = 0; i < widest_.size(); ++i) {
    double& size = widest_[gap_kind_[i]];
    if (std::isfinite(values.gap_scale[i])) size = std::max(size, values.gap_scale[i]);
  }
  for (std::size_t i = 0; i < widest_.size(); ++i) widest_[i] = widest_[gap_kind_[i]];
}

void UsualSizes::note_gaps_elsewhere(const ContactValues& values) {
  if (elsewhere_q_.empty()) return;
  for (std::size_t i = 0; i < widest_.size(); ++i) {
    double size = 0;
    for (const auto& [k, g] : values.normal[i]) size += std::abs(g) * place_[kind_[k]];
    widest_[gap_kind_[i]] = std::max(widest_[gap_kind_[i]], size);
  }
  note_gaps(values);
}

void UsualSizes::note_accelerations(std::span<const double> a, const ContactValues& values) {
  for (std::size_t i = 0; i < a.size(); ++i) note_acceleration(i, std::abs(a[i]));
  for (std::size_t i = 0; i < hardest_.size(); ++i)
    if (compliance_[i] != 0) hardest_[i] = std::max(hardest_[i], acceleration_along(values.normal[i]) / compliance_[i]);
}

void UsualSizes::note_acceleration(std::size_t coordinate, double size) {
  double& known = acceleration_[kind_[coordinate]];
  known = std::max(known, size);
}

void UsualSizes::note_compliances(const std::vector<std::size_t>& contacts, const std::vector<SparseRow>& normals,
                                  const Eigen::MatrixXd& response) {
  for (std::size_t k = 0; k < contacts.size(); ++k)
    compliance_[contacts[k]] = std::abs(dot(normals[k], response.col(at(k))));
}

void UsualSizes::note_slip_in_space(std::size_t contact, double size) {
  slip_scale_[contact] = std::max(slip_scale_[contact], size);
}

void UsualSizes::note_slip_rates(const ContactValues& values) {
  for (std::size_t i = 0; i < slip_rate_.size(); ++i)
    slip_rate_[i] = std::max(slip_rate_[i], acceleration_along(values.tangent[i]));
}

bool UsualSizes::note_holding_forces(const ContactMode& mode, std::span<const double> multipliers, const State& here) {
  constexpr double grown = 2;
  const ContactValues& values = here.values();
  const std::size_t contacts = mode.closed.size();
  std::size_t k = 0;
  bool more = false;
  const auto note = [&](double& known, double force, const SparseRow& row) {
    if (!(force > grown * known) || !std::isfinite(force)) return;
    known = force;
    const Eigen::VectorXd alone = here.response({&row, 1}).col(0);
    for (std::size_t n = 0; n < kind_.size(); ++n) note_acceleration(n, force * std::abs(alone(at(n))));
    more = true;
  };
  for (std::size_t i = 0; i < contacts; ++i)
    if (mode.closed[i]) note(holding_[i], std::abs(multipliers[k++]), values.normal[i]);
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    if (mode.friction[i] != FrictionState::Stick) continue;
    double force = 0;
    for (std::size_t c = 0; c < friction_of(system_, i).slip.size(); ++c)
      force = std::max(force, std::abs(multipliers[k++]));
    note(holding_[contacts + i], force, values.tangent[i]);
  }
  return more;
}

bool UsualSizes::knows_holding_forces(const ContactMode& mode) const {
  const std::size_t contacts = mode.closed.size();
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    if (i < contacts && mode.closed[i] && !(holding_[i] > 0)) return false;
    if (mode.friction[i] == FrictionState::Stick && !(holding_[contacts + i] > 0)) return false;
  }
  return true;
}

}  // namespace maupertuis::hybrid

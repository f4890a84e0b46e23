#include "simulation/hybrid_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// What is rounding in a motion: measured by the largest that coordinates of one unit have done so far.
namespace maupertuis {

/// What a located instant leaves of a speed, in units of rounding: the rounding of t times an acceleration.
double HybridMotion::speed_left_by_time(const SparseRow& row) const {
  double acceleration = 0;
  for (const auto& [i, g] : row) acceleration += std::abs(g) * acceleration_[kind_[i]];
  return 0.25 * std::abs(t_) * acceleration;
}

/// ġ below this counts as 0.
double HybridMotion::rest_speed(std::size_t contact, const ContactValues& values) const {
  return rest_unit *
         (std::max(values.rate_scale[contact], fastest_[contact]) + speed_left_by_time(values.normal[contact]));
}

/// Of the terms of g so far, and of what rounding of its coordinates may make of it.
double HybridMotion::size_of_gap(std::size_t contact, const ContactValues& values) const {
  double size = widest_[contact];
  for (const auto& [k, g] : values.normal[contact]) size = std::max(size, std::abs(g) * place_[kind_[k]]);
  return size;
}

double HybridMotion::rest_slip(std::size_t friction, const ContactValues& values) const {
  return rest_unit * (std::max(values.slip_scale[friction], fastest_slip_[friction]) +
                      speed_left_by_time(values.tangent[friction]));
}

/// What a step shows of the sizes of the motion.
void HybridMotion::note_step() {
  const TaylorStepper& s = *now_->stepper;
  take_state();
  const ContactValues& values = functions_.at(t_, q_, v_);
  note_sizes(values);
  note_limits(values);
  const std::vector<double>& a = s.step_start().a;
  if (std::all_of(a.begin(), a.end(), [](double x) { return std::isfinite(x); })) note_accelerations(a, values);
  note_holding_forces(s.step_start());
}

/// Forces of closed contacts and of static friction that grow while all rests: what they balance is a measure of forces
/// too, of each coordinate that one of them would move alone. They come behind those of constraints.
void HybridMotion::note_holding_forces(const Sample& sample) {
  constexpr double grown = 2;
  const ContactMode& mode = now_->mode;
  const ContactValues& values = functions_.at(t_, q_, v_);
  const std::size_t contacts = mode.closed.size();
  std::size_t k = equations_.system->constraints.size();
  holding_.resize(contacts + mode.friction.size(), 0);
  bool more = false;
  const auto note = [&](double& known, double force, const SparseRow& row) {
    if (!(force > grown * known) || !std::isfinite(force)) return;
    known = force;
    const Eigen::VectorXd alone = functions_.response(t_, q_, v_, {&row, 1}).col(0);
    for (std::size_t n = 0; n < kind_.size(); ++n)
      acceleration_[kind_[n]] = std::max(acceleration_[kind_[n]], force * std::abs(alone(at(n))));
    more = true;
  };
  for (std::size_t i = 0; i < contacts; ++i)
    if (mode.closed[i]) note(holding_[i], std::abs(sample.multipliers.at(k++)), values.normal[i]);
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    if (mode.friction[i] != FrictionState::Stick) continue;
    double force = 0;
    for (std::size_t c = 0; c < friction_of(system_, i).slip.size(); ++c)
      force = std::max(force, std::abs(sample.multipliers.at(k++)));
    note(holding_[contacts + i], force, values.tangent[i]);
  }
  if (more) tell_usual_sizes(*now_->stepper);
}

/// A first step may be as long as the rest that it begins: it has to know of the forces that balance in it.
void HybridMotion::note_rest_that_begins() {
  const ContactMode& mode = now_->mode;
  const std::size_t contacts = mode.closed.size();
  holding_.resize(contacts + mode.friction.size(), 0);
  bool all_known = true;
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    if (i < contacts && mode.closed[i]) all_known = all_known && holding_[i] > 0;
    if (mode.friction[i] == FrictionState::Stick) all_known = all_known && holding_[contacts + i] > 0;
  }
  if (!all_known) note_holding_forces(now_->stepper->sample(t_));
}

/// A limit of friction below zero is none: the force would drive what it is to brake.
void HybridMotion::note_limits(const ContactValues& values) {
  const std::size_t contacts = system_.contacts.size();
  for (std::size_t i = 0; i < values.kinetic.size(); ++i)
    if (values.kinetic[i] < 0)
      remark(i < contacts
                 ? fmt::format("The coefficient of friction of the contact {} becomes negative: friction drives "
                               "the motion there, which none does.",
                               system_.contact_label(i))
                 : fmt::format("The friction along {} has a limit or a coefficient that becomes negative: it "
                               "drives the motion there, which no friction does.",
                               system_.frictions[i - contacts].name));
}

/// Motions of one kind of coordinates have one size: a pendulum that hangs still among others that swing is at rest to
/// rounding of their motion, not of its own.
void HybridMotion::note_sizes(const ContactValues& values) {
  for (std::size_t i = 0; i < v_.size(); ++i) {
    place_[kind_[i]] = std::max(place_[kind_[i]], std::abs(q_[i]));
    speed_[kind_[i]] = std::max(speed_[kind_[i]], std::abs(v_[i]));
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
    double usual = 0;
    for (const auto& [k, x] : values.tangent[i]) usual += usual_v_.empty() ? 0 : std::abs(x) * usual_v_[k];
    slip_scale_[i] = std::max({slip_scale_[i], values.slip_scale[i], usual});
  }
  note_slip_rates(values);
}

/// Not while a mode is sought: the speed at which a slip stops depends on it, and with it the motion of a mode.
void HybridMotion::note_slip_rates(const ContactValues& values) {
  for (std::size_t i = 0; i < slip_rate_.size(); ++i) {
    double rate = 0;
    for (const auto& [k, x] : values.tangent[i]) rate += std::abs(x) * acceleration_[kind_[k]];
    slip_rate_[i] = std::max(slip_rate_[i], rate);
  }
}

/// Gaps of one dimension have one size too.
void HybridMotion::note_gaps(const ContactValues& values) {
  for (std::size_t i = 0; i < widest_.size(); ++i) {
    double& size = widest_[gap_kind_[i]];
    if (std::isfinite(values.gap_scale[i])) size = std::max(size, values.gap_scale[i]);
  }
  for (std::size_t i = 0; i < widest_.size(); ++i) widest_[i] = widest_[gap_kind_[i]];
}

void HybridMotion::set_usual_sizes(std::span<const double> q, std::span<const double> v) {
  usual_q_.assign(q.begin(), q.end());
  usual_v_.assign(v.begin(), v.end());
}

void HybridMotion::tell_usual_sizes(TaylorStepper& stepper) const {
  std::vector<double> places, speeds, accelerations;
  for (const std::size_t k : kind_) {
    places.push_back(place_[k]);
    speeds.push_back(speed_[k]);
    accelerations.push_back(acceleration_[k]);
  }
  stepper.set_usual_sizes(places, speeds, accelerations);
}

/// Of a start whose coordinates have had other sizes elsewhere: what gaps are made of then.
void HybridMotion::note_usual_gaps(const ContactValues& values) {
  if (usual_q_.empty() || !pending_->begins) return;
  for (std::size_t i = 0; i < widest_.size(); ++i) {
    double size = 0;
    for (const auto& [k, g] : values.normal[i]) size += std::abs(g) * place_[kind_[k]];
    widest_[gap_kind_[i]] = std::max(widest_[gap_kind_[i]], size);
  }
  note_gaps(values);
}

void HybridMotion::note_accelerations(std::span<const double> a, const ContactValues& values) {
  for (std::size_t i = 0; i < a.size(); ++i)
    acceleration_[kind_[i]] = std::max(acceleration_[kind_[i]], std::abs(a[i]));
  for (std::size_t i = 0; i < hardest_.size(); ++i) {
    if (compliance_[i] == 0) continue;
    double size = 0;
    for (const auto& [k, g] : values.normal[i]) size += std::abs(g) * acceleration_[kind_[k]];
    hardest_[i] = std::max(hardest_[i], size / compliance_[i]);
  }
}

std::vector<double> HybridMotion::largest_accelerations() const {
  std::vector<double> out;
  for (const std::size_t k : kind_) out.push_back(acceleration_[k]);
  return out;
}

/// Rounding of an acceleration a moves what rests by ε a h² in a step of length h. What that does to potentials, and
/// the work of the forces that balance over it: twice the kinetic energy of a speed of √ε a h.
double HybridMotion::rounding_of_energy() {
  if (library_->sets().outputs() == 0) return 0;
  const std::vector<double> still(v_.size(), 0);
  const double here = energy_and_sets_at(t_, q_, still)[0];
  double out = 0;
  for (std::size_t i = 0; i < q_.size(); ++i) {
    const double speed = acceleration_[kind_[i]] * longest_step_;
    std::vector<double> q = q_, v = still;
    q[i] += rest_unit * speed * longest_step_;
    v[i] = std::sqrt(rest_unit) * speed;
    out += std::abs(energy_and_sets_at(t_, q, still)[0] - here) + 2 * std::abs(energy_and_sets_at(t_, q_, v)[0] - here);
  }
  return std::isfinite(out) ? out : 0;
}

void HybridMotion::note_compliance(const std::vector<std::size_t>& touching, const ContactValues& values) {
  std::vector<SparseRow> rows;
  for (const std::size_t i : touching) rows.push_back(values.normal[i]);
  const Eigen::MatrixXd response = functions_.response(t_, q_, v_, rows);
  for (std::size_t k = 0; k < touching.size(); ++k)
    compliance_[touching[k]] = std::abs(dot(rows[k], response.col(static_cast<Eigen::Index>(k))));
}

/// An impact has asked for the same: M does not depend on the velocities.
void HybridMotion::note_compliance(const ImpactProblem& p) {
  for (std::size_t k = 0; k < p.contacts.size(); ++k)
    compliance_[p.contacts[k]] = std::abs(dot(p.normal[k], p.response.col(static_cast<Eigen::Index>(k))));
  knows_compliance_ = true;
}

}  // namespace maupertuis

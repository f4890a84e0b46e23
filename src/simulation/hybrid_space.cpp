#include "simulation/contact/cone_forces.hpp"
#include "simulation/hybrid_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

/// Friction in the plane of a contact in space: which contacts stick, and which way others begin to slide.
namespace maupertuis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double slow_slip = 1e-10;  // of the slips of the run: below, the direction of a slip is lost in rounding
/// The direction of a slip changes in a time of |v_t|/|v̇_t|, and coefficients of order k are beyond the range of
/// numbers where that is less than 10^(−308/k).
constexpr double largest_exponent = 270;
constexpr double small = 1e-10;

double product(const SparseRow& row, std::span<const double> x) {
  double sum = 0;
  for (const auto& [k, value] : row) sum += value * x[k];
  return sum;
}

}  // namespace

SparseRow sum_of(const SparseRow& a, const SparseRow& b, double factor) {
  SparseRow out = a;
  for (const auto& [k, x] : b) {
    const auto same = std::find_if(out.begin(), out.end(), [&, k = k](const auto& e) { return e.first == k; });
    if (same == out.end())
      out.emplace_back(k, factor * x);
    else
      same->second += factor * x;
  }
  return out;
}

double HybridMotion::slip_speed_at(std::size_t i, const ContactValues& values) const {
  return i < values.second_slip.size() ? std::hypot(values.slip[i], values.second_slip[i]) : std::abs(values.slip[i]);
}

bool HybridMotion::slides_in_space(std::size_t i, const ContactValues& values) const {
  return begins_to_slide_[i] || slip_speed_at(i, values) > sizes_.rest_slip(i, values);
}

/// The order of steps while something slides in space: with larger ones coefficients of its direction leave the range
/// of numbers long before it stops. Orders that differ by less than 4 stay apart, as those of companions have to.
int HybridMotion::order_beside_stops() const {
  constexpr int most = 24;
  const int order = options_.order > 0 ? options_.order : taylor_order(options_.tolerance);
  return order <= most ? order : most - 3 + order % 4;
}

/// The speed at which a slip counts as stopped, well above what is rounding of it; in steps of ten so that the motion
/// of a mode serves many of them. Companions stop it earlier, so that their difference tells what the moment to the end
/// of the slip leaves open.
double HybridMotion::stop_slip(std::size_t i) {
  constexpr double above_rounding = 100, earlier = 10;
  const ContactValues& values = here_.values();
  const int steps_order = order_beside_stops();
  const double speed = std::max({slow_slip * sizes_.slip_in_space(i), above_rounding * sizes_.rest_slip(i, values),
                                 std::numeric_limits<double>::min()});
  const double coefficients_end = sizes_.slip_rate(i) * std::pow(10, -largest_exponent / (steps_order + 2));
  return (meets_late_ ? earlier : 1) *
         std::max(std::pow(10, std::floor(std::log10(speed))), std::pow(10, std::ceil(std::log10(coefficients_end))));
}

/// Whether a slip has become so fast since its mode began that the speed at which it was to stop is rounding.
bool HybridMotion::outgrows_stops() {
  if (now_->stops.empty()) return false;
  const ContactValues& values = here_.values();
  for (std::size_t i = 0; i < now_->stops.size(); ++i)
    if (now_->mode.friction[i] == FrictionState::Slide && now_->stops[i] < sizes_.rest_slip(i, values)) return true;
  return false;
}

/// Friction that barely stops a slip takes many steps, which shrink with it: they are to be seen to end, so that it is
/// not looked beyond twice the time at which the slips that fall would have stopped. Infinite where few steps were
/// made.
double HybridMotion::end_of_slips() {
  constexpr std::size_t many = 4000;
  double out = std::numeric_limits<double>::infinity();
  if (!in_space_ || now_->stepper->steps() < many) return out;
  const ContactValues& values = here_.values();
  const std::vector<double> a = now_->stepper->sample(here_.t).a;
  const std::span<const double> drifts = here_.drifts();
  const std::size_t contacts = values.gap.size(), seconds = drifts.size() - contacts;
  for (std::size_t i = 0; i < contacts; ++i) {
    if (now_->mode.friction[i] != FrictionState::Slide) continue;
    const double falls = -(values.slip[i] * (drifts[contacts + i] + product(values.tangent[i], a)) +
                           values.second_slip[i] * (drifts[seconds + i] + product(values.second_tangent[i], a)));
    if (falls > 0) out = std::min(out, here_.t + 2 * std::pow(slip_speed_at(i, values), 2) / falls);
  }
  return out;
}

/// ∂g/∂q − μ Σ_k d_k ∂v_tk/∂q̇: what a unit of the normal force does while it slides along d = v_t/|v_t|, or begins to
/// slide along d.
SparseRow HybridMotion::sliding_force(std::size_t i, const ContactValues& values) const {
  const double speed = slip_speed_at(i, values), mu = values.kinetic[i];
  const bool begins = begins_to_slide_[i] && !(speed > sizes_.rest_slip(i, values));
  const double along = begins ? std::cos(begins_towards_[i]) : values.slip[i] / speed;
  SparseRow out = sum_of(values.normal[i], values.tangent[i], -mu * along);
  if (values.second_tangent[i].empty()) return out;
  const double across = begins ? std::sin(begins_towards_[i]) : values.second_slip[i] / speed;
  return sum_of(out, values.second_tangent[i], -mu * across);
}

/// Contacts that touch and do not open, with the friction that they have here.
std::vector<HybridMotion::Pressed> HybridMotion::pressed_of(const std::vector<std::size_t>& touching,
                                                            const ContactValues& values) const {
  std::vector<Pressed> out;
  for (const std::size_t i : touching) {
    if (values.rate[i] > sizes_.rest_speed(i, values)) continue;
    const Friction& f = system_.contacts[i].friction;
    const bool slides =
        rubs(i, values) && !f.sticking &&
        (f.in_space() ? slides_in_space(i, values) : std::abs(values.slip[i]) > sizes_.rest_slip(i, values));
    out.push_back({i, slides ? std::optional(sliding_force(i, values)) : std::nullopt});
  }
  return out;
}

/// Closed contacts of a mode.
std::vector<HybridMotion::Pressed> HybridMotion::pressed_in(const ContactMode& mode,
                                                            const ContactValues& values) const {
  std::vector<Pressed> out;
  for (std::size_t i = 0; i < mode.closed.size(); ++i) {
    if (!mode.closed[i]) continue;
    const FrictionState state = mode.friction[i];
    out.push_back({i, std::nullopt});
    if (state == FrictionState::Slide) out.back().sliding = sliding_force(i, values);
    if (state == FrictionState::Forward || state == FrictionState::Backward)
      out.back().sliding =
          sum_of(values.normal[i], values.tangent[i], (state == FrictionState::Forward ? -1 : 1) * values.kinetic[i]);
  }
  return out;
}

HybridMotion::Cones HybridMotion::cones_of(const std::vector<Pressed>& pressed, const ContactValues& values,
                                           std::span<const double> accelerations) {
  return cones_of(pressed, {}, mode_without_contacts(choices({}, values)), values, accelerations);
}

/// `holding`: frictions of coordinates whose forces are sought too. Those that hold in the mode `base`, the one with
/// the given accelerations, are among what holds.
HybridMotion::Cones HybridMotion::cones_of(const std::vector<Pressed>& pressed, const std::vector<std::size_t>& holding,
                                           const ContactMode& base, const ContactValues& values,
                                           std::span<const double> accelerations) {
  const std::span<const double> drifts = here_.drifts();
  const std::size_t contacts = values.gap.size(), seconds = drifts.size() - contacts;
  Cones out;
  std::vector<double> free;
  const auto add = [&](const SparseRow& row, const SparseRow& force, double drift) {
    out.rows.push_back(row);
    out.forces.push_back(force);
    free.push_back(drift + product(row, accelerations));
  };
  for (const auto& [i, sliding] : pressed) {
    const Friction& f = system_.contacts[i].friction;
    out.contacts.push_back(i);
    out.slides.push_back(sliding.has_value());
    out.first.push_back(out.rows.size());
    add(values.normal[i], sliding ? *sliding : values.normal[i], drifts[i]);
    ConeProblem::Contact contact{0, 0};
    if (rubs(i, values) && !sliding) {
      contact = {f.in_space() ? 2 : 1, f.sticking ? held_fast : values.fixed[i]};
      add(values.tangent[i], values.tangent[i], drifts[contacts + i]);
      if (f.in_space()) add(values.second_tangent[i], values.second_tangent[i], drifts[seconds + i]);
    }
    out.problem.contacts.push_back(contact);
  }
  for (const std::size_t i : holding) {
    add(values.tangent[i], values.tangent[i], drifts[contacts + i]);
    out.problem.limits.push_back(values.fixed[i]);
  }
  for (std::size_t i = contacts; i < base.friction.size(); ++i)
    if (base.friction[i] == FrictionState::Stick) out.held.push_back(values.tangent[i]);
  out.response = here_.response(out.forces, out.held);
  const auto size = at(out.rows.size());
  out.problem.response.resize(size, size);
  for (Index r = 0; r < size; ++r)
    for (Index c = 0; c < size; ++c)
      out.problem.response(r, c) = dot(out.rows[static_cast<std::size_t>(r)], out.response.col(c));
  out.problem.free = Eigen::Map<const VectorXd>(free.data(), size);
  return out;
}

/// On by a moment with these accelerations: what they leave out are third powers of it, rounding.
void HybridMotion::move_on(double by, const VectorXd& accelerations) {
  const double before = energy_and_sets_at(here_.t, here_.q, here_.v)[0];
  for (std::size_t i = 0; i < here_.q.size(); ++i) {
    here_.q[i] += by * (here_.v[i] + 0.5 * by * accelerations(at(i)));
    here_.v[i] += by * accelerations(at(i));
  }
  moment_accelerations_.assign(accelerations.data(), accelerations.data() + accelerations.size());
  gap_begin_ = here_.t;
  just_moved_on_ = true;
  here_.t += by;
  here_.t_rest = 0;
  knows_compliance_ = false;
  book_rubbing(energy_and_sets_at(here_.t, here_.q, here_.v)[0] - before);
}

/// What a moment does to the energy is what contacts rub in it.
void HybridMotion::book_rubbing(double gained) {
  carried_[0] += gained;
  carried_[1] -= gained;
}

/// Accelerations of the motion without contact forces, and how far it is looked at; nothing where there is none.
std::optional<TaylorStepper::Outlook> HybridMotion::outlook_without_contacts(const ContactValues& values,
                                                                             double bound) {
  return outlook_in(mode_without_contacts(choices({}, values)), bound);
}

std::optional<TaylorStepper::Outlook> HybridMotion::outlook_in(const ContactMode& mode, double bound) {
  TaylorStepper& stepper = *motion_in(mode).stepper;
  stepper.start(here_.t, here_.q, here_.v, here_.t_rest);
  TaylorStepper::Outlook outlook = stepper.outlook(bound);
  if (outlook.ending != StepEnding::None) return std::nullopt;
  return outlook;
}

/// What the moment leaves of slips that stop: the least change of velocities that ends them and opens no contact.
/// Friction alone takes part in it, whose impulse is what ends a slip, however its direction turned meanwhile and
/// whenever in the moment it ended.
void HybridMotion::take_out_slips(const std::vector<std::size_t>& stopping, const std::vector<std::size_t>& touching) {
  const ContactValues values = here_.values();
  std::vector<SparseRow> rows;
  std::vector<double> rates;
  for (const std::size_t i : stopping) {
    rows.push_back(values.tangent[i]), rates.push_back(-values.slip[i]);
    if (!values.second_tangent[i].empty())
      rows.push_back(values.second_tangent[i]), rates.push_back(-values.second_slip[i]);
  }
  if (rows.empty()) return;
  for (const std::size_t i : touching)
    if (!(values.rate[i] > sizes_.rest_speed(i, values))) rows.push_back(values.normal[i]), rates.push_back(0);
  const Eigen::MatrixXd response = here_.response(rows);
  Eigen::MatrixXd w(at(rows.size()), at(rows.size()));
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (Index c = 0; c < w.cols(); ++c) w(at(r), c) = dot(rows[r], response.col(c));
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(1e-10);
  const VectorXd right = Eigen::Map<const VectorXd>(rates.data(), at(rates.size()));
  const VectorXd change = response * VectorXd(solver.compute(w).solve(right));
  const double before = in_space_ ? energy_and_sets_at(here_.t, here_.q, here_.v)[0] : 0;
  for (std::size_t i = 0; i < here_.v.size(); ++i) here_.v[i] += change(at(i));
  if (in_space_) book_rubbing(energy_and_sets_at(here_.t, here_.q, here_.v)[0] - before);  // else it is below rounding
}

/// Whether these slips, which are slow, have all stopped after so long: by one implicit step in which friction takes
/// what it can. The end of a slip is shorter than all else, and its direction may turn until then, in feet of one body
/// each in its own way.
bool HybridMotion::all_stop(const std::vector<std::size_t>& slow, const std::vector<std::size_t>& touching,
                            const ContactValues& values, std::span<const double> accelerations, double within) {
  const auto is_slow = [&](std::size_t i) { return std::find(slow.begin(), slow.end(), i) != slow.end(); };
  std::vector<Pressed> pressed = pressed_of(touching, values);
  for (Pressed& p : pressed)
    if (is_slow(p.contact)) p.sliding.reset();
  Cones cones = cones_of(pressed, values, accelerations);
  for (std::size_t c = 0; c < cones.contacts.size(); ++c) {
    const std::size_t i = cones.contacts[c];
    if (!is_slow(i)) continue;
    cones.problem.contacts[c].friction = values.kinetic[i];
    cones.problem.free(at(cones.first[c] + 1)) += values.slip[i] / within;
    cones.problem.free(at(cones.first[c] + 2)) += values.second_slip[i] / within;
  }
  const auto found = cone_forces(cones.problem);
  if (!found) return false;
  const VectorXd sizes = cones.problem.free.cwiseAbs() + cones.problem.response.cwiseAbs() * found->forces.cwiseAbs();
  for (std::size_t c = 0; c < cones.contacts.size(); ++c) {
    const Index k = at(cones.first[c] + 1);
    if (is_slow(cones.contacts[c]) && found->accelerations.segment(k, 2).norm() > small * sizes.segment(k, 2).norm())
      return false;
  }
  return true;
}

/// Slips whose beginning is over, and which nothing has stopped: however slow they are, they have just begun.
void HybridMotion::note_beginnings() {
  just_began_.assign(system_.contacts.size(), false);
  for (std::size_t i = 0; i < now_->given.begins.size(); ++i)
    just_began_[i] = now_->given.begins[i] && std::none_of(pending_->left.begin(), pending_->left.end(), [&](auto& w) {
                       return w.what == Watch::What::Slip && w.index == i;
                     });
}

/// A slip that is slow and falls comes to rest after v_t²/(−v_t·v̇_t): the motion moves on to there, where both
/// components are 0. One that grows has just begun.
void HybridMotion::come_to_rest(const std::vector<std::size_t>& touching, double bound) {
  if (!in_space_) return;
  const ContactValues values = here_.values();
  const auto is_slow = [&](std::size_t i) {
    const double speed = slip_speed_at(i, values);
    return system_.contacts[i].friction.in_space() && !system_.contacts[i].friction.sticking && rubs(i, values) &&
           !just_began_[i] && !(values.rate[i] > sizes_.rest_speed(i, values)) && speed > sizes_.rest_slip(i, values) &&
           speed <= stop_slip(i) + sizes_.rest_slip(i, values);
  };
  if (std::none_of(touching.begin(), touching.end(), is_slow)) return;
  const auto outlook = outlook_without_contacts(values, bound);
  if (!outlook) return;
  const Cones cones = cones_of(pressed_of(touching, values), values, outlook->accelerations);
  const auto found = cone_forces(cones.problem);
  if (!found) return;
  const VectorXd changes = cones.response * found->forces;
  const VectorXd a = Eigen::Map<const VectorXd>(outlook->accelerations.data(), changes.size()) + changes;
  const std::vector<double> drifts(here_.drifts().begin(), here_.drifts().end());
  const std::size_t contacts = values.gap.size(), seconds = drifts.size() - contacts;
  const auto time_to_stop = [&](std::size_t i) {  // 0: it does not
    const double speed = slip_speed_at(i, values);
    const double falls = -(values.slip[i] * (drifts[contacts + i] + dot(values.tangent[i], a)) +
                           values.second_slip[i] * (drifts[seconds + i] + dot(values.second_tangent[i], a)));
    return falls > 0 ? speed * speed / falls : 0;
  };
  double by = 0;
  std::vector<std::size_t> slow;  // and falling
  for (const std::size_t i : touching) {
    if (!is_slow(i)) continue;
    by = std::max(by, time_to_stop(i));
    if (time_to_stop(i) == 0)
      begins_to_slide_[i] = true;
    else
      slow.push_back(i);
  }
  if (!(by > 0)) return;
  std::vector<std::size_t> near, stopping;  // feet of one body stop together, though their slips are not equal
  constexpr double together = 0.05, as_slow = 1e3, longer = 4;
  double longest = by;
  for (const std::size_t i : touching)
    if (system_.contacts[i].friction.in_space() && rubs(i, values) &&
        slip_speed_at(i, values) > sizes_.rest_slip(i, values) && slip_speed_at(i, values) <= as_slow * stop_slip(i))
      near.push_back(i), longest = std::max(longest, time_to_stop(i));
  const bool all = near.size() > 1 && all_stop(near, touching, values, outlook->accelerations, longer * longest);
  std::copy_if(near.begin(), near.end(), std::back_inserter(stopping),
               [&](std::size_t i) { return all || std::abs(time_to_stop(i) - by) <= together * by; });
  move_on(forwards_ ? by : -by, a);
  constexpr double part = 0.1;  // of the speed at which others count as stopped
  const ContactValues after = here_.values();
  std::erase_if(stopping, [&](std::size_t i) {
    const bool ends = std::find(slow.begin(), slow.end(), i) != slow.end();
    return !all && !ends && slip_speed_at(i, after) > part * stop_slip(i);
  });
  take_out_slips(stopping, touching);
  for (std::size_t i = 0; i < here_.v.size(); ++i)  // what rounding leaves of all that stops is no motion
    if (std::abs(here_.v[i]) <= rest_unit * sizes_.speed(i)) here_.v[i] = 0;
}

/// Where contacts in space rest on friction: each sticks, or begins to slide against the force that the cones give.
/// `gives_way`: no forces hold the rest any more. False, and why, where the cones have no solution that is found.
bool HybridMotion::choose_slips(const std::vector<std::size_t>& touching, double bound, bool gives_way,
                                std::string& reason) {
  if (!in_space_) return true;
  const ContactValues values = here_.values();
  const auto may_begin = [&](std::size_t i) {
    const Friction& f = system_.contacts[i].friction;
    return f.in_space() && !f.sticking && rubs(i, values) && !(values.rate[i] > sizes_.rest_speed(i, values)) &&
           !slides_in_space(i, values);
  };
  if (std::none_of(touching.begin(), touching.end(), may_begin)) return true;
  const auto outlook = outlook_without_contacts(values, bound);
  if (!outlook) return true;
  Cones cones = cones_of(pressed_of(touching, values), values, outlook->accelerations);
  const auto reaches_limit = [&](std::size_t i) { return gives_way || (!now_->given.is_preload && comes_to_limit(i)); };
  std::vector<bool> slides(cones.contacts.size(), false);
  for (int pass = 0; pass < 2; ++pass) {  // with static friction, then with the kinetic one of those that slide
    for (std::size_t c = 0; c < cones.contacts.size(); ++c)
      if (slides[c] || (pass == 0 && reaches_limit(cones.contacts[c])))
        cones.problem.contacts[c].friction = values.kinetic[cones.contacts[c]];
    const auto found = cone_forces(cones.problem);
    if (!found) {
      reason =
          "The forces of contacts with friction in space were not found: their cones have no solution here, or the "
          "iteration does not converge to it.";
      return false;
    }
    cone_residual_ = std::max(cone_residual_, found->residual);
    const VectorXd sizes = cones.problem.free.cwiseAbs() + cones.problem.response.cwiseAbs() * found->forces.cwiseAbs();
    for (std::size_t c = 0; c < cones.contacts.size(); ++c) {
      const std::size_t i = cones.contacts[c];
      if (!may_begin(i)) continue;
      const Index n = at(cones.first[c]);
      const VectorXd force = found->forces.segment(n + 1, 2), slip = found->accelerations.segment(n + 1, 2);
      const double most = cones.problem.contacts[c].friction * found->forces(n);
      const bool is_at_limit = force.norm() >= most * (1 - small);
      slides[c] = found->forces(n) > 0 && is_at_limit &&
                  (reaches_limit(i) || slip.norm() > small * sizes.segment(n + 1, 2).norm());
      if (!slides[c] || pass == 0) continue;
      sizes_.note_slip_in_space(i, slip.norm() * outlook->length);
      begins_to_slide_[i] = true;
      begins_towards_[i] = std::atan2(-force(1), -force(0));
    }
  }
  return true;
}

}  // namespace maupertuis

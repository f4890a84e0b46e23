#include "simulation/hybrid_space.hpp"

#include "simulation/contact/cone_forces.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace maupertuis::hybrid {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double rounding_of_cones = 1e-10;

bool contains(const std::vector<std::size_t>& list, std::size_t x) {
  return std::find(list.begin(), list.end(), x) != list.end();
}

/// Of accelerations, by what forces do there alone.
VectorXd sizes_of(const ConeProblem& problem, const ConeForces& found) {
  return problem.free.cwiseAbs() + problem.response.cwiseAbs() * found.forces.cwiseAbs();
}

/// Whether the friction of a contact is at its limit, and its slip accelerates or is known to begin.
bool gives_way(const Cones& cones, const ConeForces& found, const VectorXd& sizes, std::size_t c, bool comes_to_limit) {
  const Index n = at(cones.first[c]);
  const VectorXd force = found.forces.segment(n + 1, 2), slip = found.accelerations.segment(n + 1, 2);
  const double most = cones.problem.contacts[c].friction * found.forces(n);
  const bool is_at_limit = force.norm() >= most * (1 - rounding_of_cones);
  return found.forces(n) > 0 && is_at_limit &&
         (comes_to_limit || slip.norm() > rounding_of_cones * sizes.segment(n + 1, 2).norm());
}

}  // namespace

/// Slips that slow down.
struct SpaceFriction::Slowing {
  std::vector<double> free;   // [n] accelerations without contacts
  VectorXd accelerations;     // [n]
  std::vector<double> times;  // [contacts] until they stop; 0: they do not
};

/// Those that stop together.
struct SpaceFriction::Stopping {
  std::vector<std::size_t> contacts;
  bool all = false;  // one implicit step stops all that are slow
};

bool SpaceFriction::is_slow(std::size_t i, const ContactValues& values) const {
  const Friction& f = problem_.system.contacts[i].friction;
  const double speed = slip_speed(i, values);
  return f.in_space() && !f.sticking && problem_.rubs(i, values) && !slips_.has_just_begun(i) &&
         !(values.rate[i] > sizes_.rest_speed(i, values)) && speed > sizes_.rest_slip(i, values) &&
         speed <= slips_.stop_speed(i) + sizes_.rest_slip(i, values);
}

void SpaceFriction::come_to_rest(const std::vector<std::size_t>& touching, double bound, bool forwards) {
  if (!problem_.in_space) return;
  const ContactValues values = here_.values();
  std::vector<std::size_t> slow;  // and falling
  std::copy_if(touching.begin(), touching.end(), std::back_inserter(slow),
               [&](std::size_t i) { return is_slow(i, values); });
  if (slow.empty()) return;
  const auto slowing = this->slowing(touching, values, bound);
  if (!slowing) return;
  double by = 0;
  for (const std::size_t i : slow) {
    by = std::max(by, slowing->times[i]);
    if (slowing->times[i] == 0) slips_.begin(i);
  }
  if (!(by > 0)) return;
  std::erase_if(slow, [&](std::size_t i) { return slowing->times[i] == 0; });
  Stopping stopping = stopping_with(by, *slowing, touching, values);
  move_on(forwards ? by : -by, slowing->accelerations);
  constexpr double part = 0.1;  // of the speed at which others count as stopped
  const ContactValues after = here_.values();
  std::erase_if(stopping.contacts, [&](std::size_t i) {
    return !stopping.all && !contains(slow, i) && slip_speed(i, after) > part * slips_.stop_speed(i);
  });
  take_out_slips(stopping.contacts, touching);
  for (std::size_t i = 0; i < here_.v.size(); ++i)  // what rounding leaves of all that stops is no motion
    if (std::abs(here_.v[i]) <= rest_unit * sizes_.speed(i)) here_.v[i] = 0;
}

/// Nothing where the motion, or its forces, are not found.
std::optional<SpaceFriction::Slowing> SpaceFriction::slowing(const std::vector<std::size_t>& touching,
                                                             const ContactValues& values, double bound) {
  auto outlook = motions_.outlook_in(choices_.mode_without_contacts(values), bound);
  if (!outlook) return std::nullopt;
  const Cones cones = cones_.of(cones_.pressed_of(touching, values), values, outlook->accelerations);
  const auto found = cone_forces(cones.problem);
  if (!found) return std::nullopt;
  const VectorXd changes = cones.response * found->forces;
  const VectorXd a = Eigen::Map<const VectorXd>(outlook->accelerations.data(), changes.size()) + changes;
  Slowing out{std::move(outlook->accelerations), a, {}};
  const std::span<const double> drifts = here_.drifts();
  const std::size_t contacts = values.gap.size(), seconds = drifts.size() - contacts;
  out.times.assign(contacts, 0);
  for (const std::size_t i : touching) {
    const double speed = slip_speed(i, values);
    const double falls =
        -(values.slip[i] * (drifts[contacts + i] + dot(values.tangent[i], out.accelerations)) +
          values.second_slip[i] * (drifts[seconds + i] + dot(values.second_tangent[i], out.accelerations)));
    if (falls > 0) out.times[i] = speed * speed / falls;
  }
  return out;
}

/// Feet of one body stop together, though their slips are not equal.
SpaceFriction::Stopping SpaceFriction::stopping_with(double by, const Slowing& slowing,
                                                     const std::vector<std::size_t>& touching,
                                                     const ContactValues& values) const {
  constexpr double together = 0.05, as_slow = 1e3, longer = 4;
  std::vector<std::size_t> near;
  double longest = by;
  for (const std::size_t i : touching) {
    const double speed = slip_speed(i, values);
    if (problem_.system.contacts[i].friction.in_space() && problem_.rubs(i, values) &&
        speed > sizes_.rest_slip(i, values) && speed <= as_slow * slips_.stop_speed(i))
      near.push_back(i), longest = std::max(longest, slowing.times[i]);
  }
  Stopping out;
  out.all = near.size() > 1 && all_stop(near, touching, values, slowing.free, longer * longest);
  std::copy_if(near.begin(), near.end(), std::back_inserter(out.contacts),
               [&](std::size_t i) { return out.all || std::abs(slowing.times[i] - by) <= together * by; });
  return out;
}

/// Whether these slips, which are slow, have all stopped after so long: by one implicit step in which friction takes
/// what it can. The end of a slip is shorter than all else, and its direction may turn until then, in feet of one body
/// each in its own way.
bool SpaceFriction::all_stop(const std::vector<std::size_t>& slow, const std::vector<std::size_t>& touching,
                             const ContactValues& values, std::span<const double> accelerations, double within) const {
  std::vector<Pressed> pressed = cones_.pressed_of(touching, values);
  for (Pressed& p : pressed)
    if (contains(slow, p.contact)) p.sliding.reset();
  Cones cones = cones_.of(pressed, values, accelerations);
  for (std::size_t c = 0; c < cones.contacts.size(); ++c) {
    const std::size_t i = cones.contacts[c];
    if (!contains(slow, i)) continue;
    cones.problem.contacts[c].friction = values.kinetic[i];
    cones.problem.free(at(cones.first[c] + 1)) += values.slip[i] / within;
    cones.problem.free(at(cones.first[c] + 2)) += values.second_slip[i] / within;
  }
  const auto found = cone_forces(cones.problem);
  if (!found) return false;
  const VectorXd sizes = sizes_of(cones.problem, *found);
  for (std::size_t c = 0; c < cones.contacts.size(); ++c) {
    const Index k = at(cones.first[c] + 1);
    if (contains(slow, cones.contacts[c]) &&
        found->accelerations.segment(k, 2).norm() > rounding_of_cones * sizes.segment(k, 2).norm())
      return false;
  }
  return true;
}

/// On by a moment with these accelerations: what they leave out are third powers of it, rounding.
void SpaceFriction::move_on(double by, const VectorXd& accelerations) {
  const double before = functions_.energy(here_);
  motions_.passed_moment().begin(here_.t, {accelerations.data(), accelerations.data() + accelerations.size()});
  for (std::size_t i = 0; i < here_.q.size(); ++i) {
    here_.q[i] += by * (here_.v[i] + 0.5 * by * accelerations(at(i)));
    here_.v[i] += by * accelerations(at(i));
  }
  here_.t += by;
  here_.t_rest = 0;
  sizes_.set_knows_compliances(false);
  carried_.rub(functions_.energy(here_) - before);
}

void SpaceFriction::take_out_slips(const std::vector<std::size_t>& stopping, const std::vector<std::size_t>& touching) {
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
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(1e-10);
  const VectorXd right = Eigen::Map<const VectorXd>(rates.data(), at(rates.size()));
  const VectorXd change = response * VectorXd(solver.compute(along_rows(rows, response)).solve(right));
  const double before = problem_.in_space ? functions_.energy(here_) : 0;
  for (std::size_t i = 0; i < here_.v.size(); ++i) here_.v[i] += change(at(i));
  if (problem_.in_space) carried_.rub(functions_.energy(here_) - before);  // else it is below rounding
}

bool SpaceFriction::may_begin(std::size_t i, const ContactValues& values) const {
  const Friction& f = problem_.system.contacts[i].friction;
  return f.in_space() && !f.sticking && problem_.rubs(i, values) && !(values.rate[i] > sizes_.rest_speed(i, values)) &&
         !slips_.slides(i, values);
}

bool SpaceFriction::choose_slips(const std::vector<std::size_t>& touching, const Met& met, double bound,
                                 bool all_give_way) {
  if (!problem_.in_space) return true;
  const ContactValues values = here_.values();
  if (std::none_of(touching.begin(), touching.end(), [&](std::size_t i) { return may_begin(i, values); })) return true;
  const auto outlook = motions_.outlook_in(choices_.mode_without_contacts(values), bound);
  if (!outlook) return true;
  Cones cones = cones_.of(cones_.pressed_of(touching, values), values, outlook->accelerations);
  const auto comes_to_limit = [&](std::size_t i) {
    return all_give_way || (!motions_.now().given.is_preload && met.comes_to_limit(i));
  };
  std::vector<bool> slides(cones.contacts.size(), false);
  for (int pass = 0; pass < 2; ++pass) {  // with static friction, then with the kinetic one of those that slide
    for (std::size_t c = 0; c < cones.contacts.size(); ++c)
      if (slides[c] || (pass == 0 && comes_to_limit(cones.contacts[c])))
        cones.problem.contacts[c].friction = values.kinetic[cones.contacts[c]];
    const auto found = cone_forces(cones.problem);
    if (!found) return false;
    cone_residual_ = std::max(cone_residual_, found->residual);
    const VectorXd sizes = sizes_of(cones.problem, *found);
    for (std::size_t c = 0; c < cones.contacts.size(); ++c) {
      const std::size_t i = cones.contacts[c];
      if (!may_begin(i, values)) continue;
      slides[c] = gives_way(cones, *found, sizes, c, comes_to_limit(i));
      if (!slides[c] || pass == 0) continue;
      const Index n = at(cones.first[c] + 1);
      sizes_.note_slip_in_space(i, VectorXd(found->accelerations.segment(n, 2)).norm() * outlook->length);
      slips_.begin(i, std::atan2(-found->forces(n + 1), -found->forces(n)));
    }
  }
  return true;
}

}  // namespace maupertuis::hybrid

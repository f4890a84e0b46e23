#include "simulation/hybrid_joint_forces.hpp"

#include "simulation/hybrid_cones.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace maupertuis::hybrid {
namespace {

constexpr double negligible_force = 1e-10;  // of the largest

ContactForceProblem::Contact contact_of(const ContactValues& values, std::span<const double> drifts,
                                        std::span<const double> accelerations, std::size_t i) {
  ContactForceProblem::Contact out;
  out.normal = values.normal[i];
  out.gap_acceleration = drifts[i];
  for (const auto& [k, g] : out.normal) out.gap_acceleration += g * accelerations[k];
  out.slip_acceleration = drifts[values.gap.size() + i];
  for (const auto& [k, x] : values.tangent[i]) out.slip_acceleration += x * accelerations[k];
  return out;
}

/// Puts the option that agrees with the forces first.
void prefer(std::vector<Choice::Option>& options, bool closed, FrictionState state) {
  const auto fits = [&](const Choice::Option& o) { return o.closed == closed && (!closed || o.state == state); };
  const auto found = std::find_if(options.begin(), options.end(), fits);
  if (found != options.end()) std::rotate(options.begin(), found, found + 1);
}

}  // namespace

std::optional<ContactForceProblem> JointForces::problem_of(const std::vector<Choice>& list, const ContactValues& values,
                                                           double bound) {
  const ContactMode base = choices_.mode_without_contacts(list);
  TaylorStepper& stepper = *motions_.in(base).stepper;
  stepper.start(here_.t, here_.q, here_.v, here_.t_rest);
  const Outlook outlook = stepper.outlook(bound);
  if (outlook.ending != StepEnding::None) return std::nullopt;
  const std::span<const double> drifts = here_.drifts();
  std::vector<SparseRow> normals, tangents, held;
  for (std::size_t i = base.closed.size(); i < base.friction.size(); ++i)
    if (base.friction[i] == FrictionState::Stick) held.push_back(values.tangent[i]);
  ContactForceProblem problem;
  for (const Choice& choice : list) {
    const std::size_t i = choice.contact;
    if (i >= base.closed.size()) continue;
    problem.contacts.push_back(contact_of(values, drifts, outlook.accelerations, i));
    auto& contact = problem.contacts.back();
    const Friction& friction = problem_.system.contacts[i].friction;
    const auto slides = [&](FrictionState s) { return choice.options[0].state == s; };
    contact.sliding = slides(FrictionState::Forward) ? 1 : slides(FrictionState::Backward) ? -1 : 0;
    if (problem_.rubs(i, values)) contact.tangent = values.tangent[i];
    contact.friction = friction.sticking ? held_fast : contact.sliding != 0 ? values.kinetic[i] : values.fixed[i];
    normals.push_back(values.normal[i]);
    tangents.push_back(contact.tangent);
  }
  problem.response = here_.response(normals, held);
  problem.tangent_response = here_.response(tangents, held);
  return problem;
}

namespace {

bool begins_to_slide(const ContactForceProblem& problem, const ContactForces& forces, std::size_t k) {
  return problem.contacts[k].sliding == 0 && !problem.contacts[k].tangent.empty() &&
         forces.friction[k] != FrictionState::Stick;
}

/// Static friction holds what it can. Contacts that begin to slide have the kinetic coefficient [contacts of the
/// problem], which is less, so that others may be held that were not; a contact that would be held beside the kinetic
/// friction of the others is. `left`: those that would be held too, but not beside one that is.
std::optional<ContactForces> forces_that_hold(ContactForceProblem& problem, const std::vector<double>& kinetic,
                                              std::vector<std::size_t>& left) {
  auto forces = contact_forces(problem);
  std::vector<double> static_;
  for (const auto& c : problem.contacts) static_.push_back(c.friction);
  std::vector<std::size_t> sliding;
  for (bool more = forces.has_value(); more;) {
    more = false;
    for (std::size_t k = 0; k < kinetic.size(); ++k) {
      auto& contact = problem.contacts[k];
      if (!begins_to_slide(problem, *forces, k) || contact.friction == kinetic[k]) continue;
      contact.friction = kinetic[k];
      sliding.push_back(k);
      more = true;
    }
    if (!more) break;
    if (auto next = contact_forces(problem))
      forces = std::move(next);
    else
      return forces;
  }
  const auto held = [&](std::size_t k) -> std::optional<ContactForces> {
    problem.contacts[k].friction = static_[k];
    auto out = contact_forces(problem);
    if (out && !begins_to_slide(problem, *out, k)) return out;
    problem.contacts[k].friction = kinetic[k];
    return std::nullopt;
  };
  for (const std::size_t k : sliding)
    if (held(k)) left.push_back(k), problem.contacts[k].friction = kinetic[k];
  for (const std::size_t k : sliding)
    if (auto out = held(k)) forces = std::move(out), std::erase(left, k);
  return forces;
}

}  // namespace

bool JointForces::order(std::vector<Choice>& list, const ContactValues& values, double bound) {
  auto problem = problem_of(list, values, bound);
  std::vector<double> kinetic;
  for (const Choice& c : list)
    if (c.contact < problem_.system.contacts.size())
      kinetic.push_back(problem_.system.contacts[c.contact].friction.sticking ? held_fast : values.kinetic[c.contact]);
  std::vector<std::size_t> left;
  const auto forces = problem ? forces_that_hold(*problem, kinetic, left) : std::nullopt;
  if (!forces) return false;
  double largest = 0, fastest = 0;
  for (std::size_t k = 0; k < problem->contacts.size(); ++k) {
    largest = std::max(largest, forces->normal[k]);
    fastest = std::max({fastest, std::abs(problem->contacts[k].gap_acceleration), forces->acceleration[k]});
  }
  std::vector<std::size_t> open_to_doubt;
  std::size_t k = 0;
  for (Choice& choice : list) {
    if (choice.contact >= problem_.system.contacts.size()) continue;
    const bool presses = forces->normal[k] > negligible_force * largest;
    prefer(choice.options, presses, forces->friction[k]);
    if (!presses && forces->acceleration[k] <= negligible_force * fastest) open_to_doubt.push_back(choice.contact);
    ++k;
  }
  // What is tried after the first guess begins with contacts that neither press nor open.
  std::stable_partition(list.begin(), list.end(), [&](const Choice& c) {
    return std::find(open_to_doubt.begin(), open_to_doubt.end(), c.contact) != open_to_doubt.end();
  });
  return !left.empty();
}

}  // namespace maupertuis::hybrid

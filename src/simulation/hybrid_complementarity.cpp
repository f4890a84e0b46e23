#include "simulation/contact/contact_forces.hpp"
#include "simulation/hybrid_parts.hpp"

#include <algorithm>
#include <cmath>

/// Which of the modes that are possible the forces of all contacts together point to.
namespace maupertuis {
namespace {

constexpr double held_fast = 1e3;  // a coefficient of friction for contacts that never slide

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
void prefer(std::vector<HybridOption>& options, bool closed, FrictionState state) {
  const auto fits = [&](const HybridOption& o) { return o.closed == closed && (!closed || o.state == state); };
  const auto found = std::find_if(options.begin(), options.end(), fits);
  if (found != options.end()) std::rotate(options.begin(), found, found + 1);
}

}  // namespace

/// The mode without contacts, friction of coordinates as is likeliest.
ContactMode HybridMotion::mode_without_contacts(const std::vector<Choice>& list) const {
  ContactMode mode = open_mode(system_);
  for (const Choice& c : list)
    if (c.contact >= mode.closed.size()) {
      mode.friction[c.contact] = c.options[0].state;
      mode.normal_sign[c.contact - mode.closed.size()] = c.options[0].normal_sign;
    }
  return mode;
}

void HybridMotion::order_by_forces(std::vector<Choice>& list, const ContactValues& values, double bound) {
  const ContactMode base = mode_without_contacts(list);
  TaylorStepper& stepper = *motion_in(base).stepper;
  stepper.start(t_, q_, v_);
  const TaylorStepper::Outlook outlook = stepper.outlook(bound);
  if (outlook.ending != StepEnding::None) return;
  const std::span<const double> drifts = functions_.drifts(t_, q_, v_);
  std::vector<SparseRow> normals, tangents, held;
  for (std::size_t i = base.closed.size(); i < base.friction.size(); ++i)
    if (base.friction[i] == FrictionState::Stick) held.push_back(values.tangent[i]);
  ContactForceProblem problem;
  std::vector<Choice*> contacts;
  for (Choice& choice : list) {
    const std::size_t i = choice.contact;
    if (i >= base.closed.size()) continue;
    problem.contacts.push_back(contact_of(values, drifts, outlook.accelerations, i));
    auto& contact = problem.contacts.back();
    const Friction& friction = system_.contacts[i].friction;
    const auto slides = [&](FrictionState s) { return choice.options[0].state == s; };
    contact.sliding = slides(FrictionState::Forward) ? 1 : slides(FrictionState::Backward) ? -1 : 0;
    if (friction.present()) contact.tangent = values.tangent[i];
    contact.friction = friction.sticking ? held_fast : contact.sliding != 0 ? values.kinetic[i] : values.fixed[i];
    normals.push_back(values.normal[i]);
    tangents.push_back(contact.tangent);
    contacts.push_back(&choice);
  }
  problem.response = functions_.response(t_, q_, v_, normals, held);
  problem.tangent_response = functions_.response(t_, q_, v_, tangents, held);
  const auto forces = contact_forces(problem);
  if (!forces) return;
  constexpr double small = 1e-10;
  double largest = 0, fastest = 0;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    largest = std::max(largest, forces->normal[k]);
    fastest = std::max({fastest, std::abs(problem.contacts[k].gap_acceleration), forces->acceleration[k]});
  }
  std::vector<std::size_t> open_to_doubt;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const bool presses = forces->normal[k] > small * largest;
    prefer(contacts[k]->options, presses, forces->friction[k]);
    if (!presses && forces->acceleration[k] <= small * fastest) open_to_doubt.push_back(contacts[k]->contact);
  }
  // What is tried after the first guess begins with contacts that neither press nor open.
  std::stable_partition(list.begin(), list.end(), [&](const Choice& c) {
    return std::find(open_to_doubt.begin(), open_to_doubt.end(), c.contact) != open_to_doubt.end();
  });
}

}  // namespace maupertuis

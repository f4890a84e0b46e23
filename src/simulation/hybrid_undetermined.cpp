#include "linear_algebra/independent_rows.hpp"
#include "simulation/hybrid_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// Contacts whose forces the motion does not determine: which they are, and forces that hold a rest.
namespace maupertuis {
namespace {

constexpr std::size_t most_that_hold = 32;  // contacts whose forces at rest are sought

bool are_dependent(const std::vector<SparseRow>& rows, std::size_t n) {
  IndependentRows independent;
  for (const SparseRow& row : rows) {
    std::vector<double> whole(n, 0);
    for (const auto& [k, x] : row) whole[k] = x;
    if (!independent.add(std::move(whole))) return true;
  }
  return false;
}

}  // namespace

/// Whether the others that are closed or stick leave a contact no slip.
bool HybridMotion::is_held(std::size_t contact, const ContactMode& mode, const ContactValues& values) {
  constexpr double digits = 1e-12;
  const SparseRow& own = values.tangent[contact];
  std::vector<SparseRow> held;
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    if (i < mode.closed.size() && mode.closed[i] && i != contact) held.push_back(values.normal[i]);
    if (mode.friction[i] == FrictionState::Stick) held.push_back(values.tangent[i]);
  }
  if (held.empty()) return false;
  if (contact < mode.closed.size()) held.push_back(values.normal[contact]);
  const double alone = dot(own, functions_.response(t_, q_, v_, {&own, 1}).col(0));
  return std::abs(dot(own, functions_.response(t_, q_, v_, {&own, 1}, held).col(0))) <= digits * std::abs(alone);
}

/// Contacts that hold each other where they rest (a ladder between rough walls, three rough feet) have forces that the
/// equations do not determine: some that keep the limits of friction are given. False where the forces are determined,
/// where none hold the rest, or where another condition of the mode is broken.
bool HybridMotion::fits_by_given_forces(Found& found, const std::vector<std::size_t>& touching, double bound) {
  const ContactMode& mode = found.mode;
  const ContactValues values = functions_.at(t_, q_, v_);
  const auto closed = static_cast<std::size_t>(std::count(mode.closed.begin(), mode.closed.end(), true));
  if (closed < 2 || closed > most_that_hold || !found.given.begins.empty() || !has_dependent_rows(mode, values))
    return false;
  const auto forces = forces_at_rest(mode, values, bound);
  if (!forces) return false;
  found.given.is_preload = true;
  found.given.values = *forces;
  return fits(found, touching, bound, Leniency::None);
}

/// The mode in which all that may rest does, with forces that are given: before the least forces are tried, which may
/// lie beyond the limits of friction though others do not.
std::optional<HybridMotion::Found> HybridMotion::undetermined_rest(const std::vector<Choice>& list,
                                                                   const std::vector<std::size_t>& touching,
                                                                   double bound) {
  std::vector<std::size_t> taken;
  for (const Choice& c : list) {
    const auto rests = std::find_if(c.options.begin(), c.options.end(), [&](const HybridOption& o) {
      return o.closed && (o.state == FrictionState::Stick || o.state == FrictionState::None);
    });
    const bool stays = c.contact < system_.contacts.size() && rests != c.options.end();  // others slide as they do
    taken.push_back(stays ? static_cast<std::size_t>(rests - c.options.begin()) : 0);
  }
  Found out{mode_of(list, taken), {}, {}};
  return fits_by_given_forces(out, touching, bound) ? std::optional(out) : std::nullopt;
}

/// ∂g/∂q of closed contacts with ∂v_t/∂q̇ of those that stick.
bool HybridMotion::has_dependent_rows(const ContactMode& mode, const ContactValues& values) const {
  std::vector<SparseRow> rows;
  for (std::size_t i = 0; i < mode.closed.size(); ++i) {
    if (!mode.closed[i]) continue;
    rows.push_back(values.normal[i]);
    if (mode.friction[i] != FrictionState::Stick) continue;
    rows.push_back(values.tangent[i]);
    if (!values.second_tangent[i].empty()) rows.push_back(values.second_tangent[i]);
  }
  return are_dependent(rows, q_.size());
}

/// More contacts than the motion needs: their forces are not unique, and what friction makes of them is not either.
void HybridMotion::note_indeterminate(const std::vector<Choice>& list, const ContactMode& mode,
                                      const ContactValues& values) {
  std::vector<std::size_t> contacts;
  std::vector<SparseRow> normals;
  bool rubs = false, holds = false;
  for (const Choice& c : list) {
    const std::size_t i = c.contact;
    if (i >= values.gap.size()) continue;
    const Friction& f = system_.contacts[i].friction;
    contacts.push_back(i);
    normals.push_back(values.normal[i]);
    rubs = rubs || (f.present() && !f.sticking);
    holds = holds || (mode.friction[i] == FrictionState::Stick && !f.sticking);
  }
  if (contacts.size() < 2) return;
  const bool are_normals = are_dependent(normals, q_.size());
  if (!are_normals && !(holds && has_dependent_rows(mode, values))) return;
  std::string names;
  constexpr std::size_t shown = 6;
  for (std::size_t k = 0; k < std::min(shown, contacts.size()); ++k)
    names += (k == 0 ? "" : ", ") + system_.contact_label(contacts[k]);
  if (contacts.size() > shown) names += ", …";
  if (are_normals)
    remark(fmt::format(
        "The contacts {} are more than the motion needs, so that it does not determine their forces (statically "
        "indeterminate). One distribution that carries it is shown{}.",
        names,
        rubs ? ", and friction follows that one: with another the motion may be another"
             : "; the motion is the same for all"));
  else
    remark(fmt::format(
        "Friction at the contacts {} holds more than the motion needs, so that it does not determine their forces "
        "(statically indeterminate). One distribution within the limits of friction is shown.",
        names));
}

}  // namespace maupertuis

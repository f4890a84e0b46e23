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

double HybridMotion::Given::preload(std::size_t constraint, double t) const {
  if (!is_preload) return 0;
  constexpr auto powers = static_cast<std::size_t>(preload_degree) + 1;
  double out = 0;
  for (std::size_t power = powers; power-- > 0;) out = out * (t - values[0]) + values[1 + constraint * powers + power];
  return out;
}

/// Forces that hold the rest later, if it lasts until then.
std::optional<std::vector<double>> HybridMotion::forces_later(const ContactMode& mode, double later, double bound) {
  const double t = t_, t_rest = t_rest_;
  const std::vector<double> q = q_;
  t_ += later;
  for (std::size_t i = 0; i < q_.size(); ++i) q_[i] += later * v_[i];
  auto out = forces_at_rest(mode, functions_.at(t_, q_, v_), bound + (bound - t));
  t_ = t, t_rest_ = t_rest, q_ = q;
  static_cast<void>(functions_.at(t_, q_, v_));  // whoever holds its values means those of now
  return out;
}

/// The time over which forces are found that hold the rest, `length` at most: its end to rounding where it comes
/// earlier.
double HybridMotion::rest_ahead(const ContactMode& mode, double length, double bound) {
  if (forces_later(mode, length, bound)) return length;
  constexpr int halvings = 45;
  double least = 0, most = length;
  for (int halving = 0; halving < halvings; ++halving) {
    const double middle = 0.5 * (least + most);
    (forces_later(mode, middle, bound) ? least : most) = middle;
  }
  return least;
}

/// Forces that hold the rest now, and such as hold it `ahead`, with that power of time between them. Limits of friction
/// are convex: where the forces of the system go with it too, their limits are kept all the way.
std::optional<HybridMotion::Given> HybridMotion::preload_through(const ContactMode& mode, double ahead, int power,
                                                                 double bound) {
  const auto here = forces_later(mode, 0, bound), there = forces_later(mode, ahead, bound);
  if (!here || !there) return std::nullopt;
  Given out;
  out.is_preload = true;
  out.values = {t_};
  for (std::size_t k = 0; k < here->size(); ++k) {
    std::vector<double> coefficients(preload_degree + 1, 0);
    coefficients[0] = (*here)[k];
    if (ahead != 0) coefficients[static_cast<std::size_t>(power)] = ((*there)[k] - (*here)[k]) / std::pow(ahead, power);
    out.values.insert(out.values.end(), coefficients.begin(), coefficients.end());
  }
  return out;
}

/// Contacts that hold each other where they rest (a ladder between rough walls, three rough feet) have forces that the
/// equations do not determine: some that keep the limits of friction are given. False where the forces are determined,
/// where none hold the rest, or where another condition of the mode is broken.
bool HybridMotion::fits_by_given_forces(Found& found, const std::vector<std::size_t>& touching, double bound) {
  const ContactMode& mode = found.mode;
  const auto closed = static_cast<std::size_t>(std::count(mode.closed.begin(), mode.closed.end(), true));
  if (closed < 2 || closed > most_that_hold || !found.given.begins.empty()) return false;
  const ContactValues values = functions_.at(t_, q_, v_);
  if (!has_dependent_rows(mode, values)) return false;
  const auto outlook = outlook_without_contacts(values, bound);
  if (!outlook || !forces_at_rest(mode, values, bound)) return false;
  const double ahead = rest_ahead(mode, std::copysign(outlook->length, bound - t_), bound);
  // A contact that presses by nothing yet has forces that begin with the power of time with which those of the system
  // do.
  for (int power = 1; power <= preload_degree; ++power) {
    auto given = preload_through(mode, ahead, power, bound);
    if (!given) return false;
    found.given = std::move(*given);
    if (fits(found, touching, bound, Leniency::None)) return true;
  }
  return false;
}

/// The mode in which all that may rest does, with forces that are given: before the least forces are tried, which may
/// lie beyond the limits of friction though others do not. Of more contacts than forces are sought for, those that the
/// forces of all point to.
std::optional<HybridMotion::Found> HybridMotion::undetermined_rest(const std::vector<Choice>& list,
                                                                   const std::vector<std::size_t>& touching,
                                                                   double bound) {
  std::vector<std::size_t> taken;
  const bool are_many = list.size() > most_that_hold;
  for (const Choice& c : list) {
    const auto rests = std::find_if(c.options.begin(), c.options.end(), [&](const HybridOption& o) {
      return o.closed && (o.state == FrictionState::Stick || o.state == FrictionState::None);
    });
    const bool may_stay = c.contact < system_.contacts.size() && rests != c.options.end();  // others slide as they do
    const bool stays = may_stay && (!are_many || c.options.front().closed);
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
  std::sort(contacts.begin(), contacts.end());
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

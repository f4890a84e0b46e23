#include "simulation/hybrid_undetermined.hpp"

#include "linear_algebra/independent_rows.hpp"
#include "linear_algebra/resting_forces.hpp"
#include "simulation/mode_remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace maupertuis::hybrid {
namespace {

constexpr std::size_t most_in_plane = 128, most_in_space = 32;  // contacts whose forces at rest are sought

/// Whether rows depend on each other beside those of constraints, whatever these do among themselves.
bool are_dependent(const std::vector<SparseRow>& rows, std::size_t n, const std::vector<SparseRow>& constraints = {}) {
  IndependentRows independent;
  const auto add = [&](const SparseRow& row) { return independent.add(whole_row(row, n)); };
  for (const SparseRow& row : constraints) static_cast<void>(add(row));
  return std::any_of(rows.begin(), rows.end(), [&](const SparseRow& row) { return !add(row); });
}

}  // namespace

bool UndeterminedForces::is_held(std::size_t contact, const ContactMode& mode, const ContactValues& values) const {
  constexpr double digits = 1e-12;
  const SparseRow& own = values.tangent[contact];
  std::vector<SparseRow> held;
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    if (i < mode.closed.size() && mode.closed[i] && i != contact) held.push_back(values.normal[i]);
    if (mode.friction[i] == FrictionState::Stick) held.push_back(values.tangent[i]);
  }
  if (held.empty()) return false;
  if (contact < mode.closed.size()) held.push_back(values.normal[contact]);
  const double alone = dot(own, here_.response({&own, 1}).col(0));
  return std::abs(dot(own, here_.response({&own, 1}, held).col(0))) <= digits * std::abs(alone);
}

/// Friction of a coordinate whose limit is known without the forces of constraints.
bool UndeterminedForces::may_be_given(std::size_t friction) const {
  return friction >= problem_.system.contacts.size() && !has_multipliers(friction_of(problem_.system, friction).normal);
}

std::size_t UndeterminedForces::most_that_hold() const { return problem_.in_space ? most_in_space : most_in_plane; }

/// Closed contacts, and frictions of coordinates that hold.
std::size_t UndeterminedForces::number_that_hold(const ContactMode& mode) const {
  auto out = static_cast<std::size_t>(std::count(mode.closed.begin(), mode.closed.end(), true));
  for (std::size_t i = mode.closed.size(); i < mode.friction.size(); ++i)
    out += mode.friction[i] == FrictionState::Stick && may_be_given(i);
  return out;
}

/// The mode with its contacts open and without the frictions of coordinates that hold, which `holding` gets.
ContactMode UndeterminedForces::mode_without_holding(const ContactMode& mode, std::vector<std::size_t>& holding) const {
  ContactMode out = mode;
  std::fill(out.closed.begin(), out.closed.end(), false);
  for (std::size_t i = 0; i < out.friction.size(); ++i) {
    const bool holds = out.friction[i] == FrictionState::Stick && may_be_given(i);
    if (holds) holding.push_back(i);
    if (holds || i < out.closed.size()) out.friction[i] = FrictionState::None;
  }
  return out;
}

/// Forces under which the closed contacts of a mode stay so, in the order of their multipliers in it: normal forces,
/// then friction of those that rest, then forces of the system's own constraints. Those of contacts that slide are left
/// to the constraints. Nothing where there are none within the limits of friction.
std::optional<std::vector<double>> UndeterminedForces::forces_at_rest(const ContactMode& mode,
                                                                      const ContactValues& values, double bound) {
  std::vector<std::size_t> holding;
  const ContactMode base = mode_without_holding(mode, holding);
  const auto outlook = motions_.outlook_in(base, bound);
  if (!outlook) return std::nullopt;
  std::vector<double> of_constraints = motions_.in(base).stepper->sample(here_.t).multipliers;
  const Cones cones = cones_.of(cones_.pressed_in(mode, values), holding, base, values, outlook->accelerations);
  if (!cones.problem.response.allFinite()) return std::nullopt;  // a slip that has no direction yet
  // A rest ends early by the margin that is left. Companions leave four times of it, so that their difference tells
  // what that does where forces jump.
  const auto found = resting_forces(cones.problem, (problem_.meets_late ? 4 : 1) * least_margin_of_rest);
  if (!found) return std::nullopt;
  const Eigen::VectorXd balanced = cones.response.cwiseAbs() * found->cwiseAbs();  // what they would do alone
  for (std::size_t k = 0; k < here_.q.size(); ++k) sizes_.note_acceleration(k, balanced(at(k)));
  return ordered_forces(mode, cones, *found, std::move(of_constraints));
}

/// As a mode is given them. `of_constraints`: without the forces that were found, those of frictions that hold beside
/// them behind those of constraints.
std::vector<double> UndeterminedForces::ordered_forces(const ContactMode& mode, const Cones& cones,
                                                       const Eigen::VectorXd& found,
                                                       std::vector<double> of_constraints) const {
  Eigen::VectorXd work = Eigen::VectorXd::Zero(at(here_.q.size()));
  for (std::size_t k = 0; k < cones.forces.size(); ++k)
    for (const auto& [i, x] : cones.forces[k]) work(at(i)) += x * found(at(k));
  const Eigen::VectorXd more = here_.multipliers(Eigen::VectorXd(cones.response * found), work, cones.held);
  for (std::size_t k = 0; k < of_constraints.size(); ++k) of_constraints[k] += more(at(k));
  std::vector<double> out;
  for (std::size_t c = 0; c < cones.contacts.size(); ++c)
    out.push_back(cones.slides[c] ? 0 : found(at(cones.first[c])));
  for (std::size_t c = 0; c < cones.contacts.size(); ++c)
    for (int k = 1; k <= cones.problem.contacts[c].tangents; ++k) out.push_back(found(at(cones.first[c]) + k));
  const std::size_t own = problem_.system.constraints.size();
  std::size_t next = cones.forces.size() - cones.problem.limits.size(), next_held = own;
  for (std::size_t i = mode.closed.size(); i < mode.friction.size(); ++i)
    if (mode.friction[i] == FrictionState::Stick)
      out.push_back(may_be_given(i) ? found(at(next++)) : of_constraints[next_held++]);
  out.insert(out.end(), of_constraints.begin(), of_constraints.begin() + static_cast<std::ptrdiff_t>(own));
  return out;
}

/// Forces that hold the rest later, if it lasts until then.
std::optional<std::vector<double>> UndeterminedForces::forces_later(const ContactMode& mode, double later,
                                                                    double bound) {
  const double t = here_.t, t_rest = here_.t_rest;
  const std::vector<double> q = here_.q;
  here_.t += later;
  for (std::size_t i = 0; i < here_.q.size(); ++i) here_.q[i] += later * here_.v[i];
  auto out = forces_at_rest(mode, here_.values(), bound + (bound - t));
  here_.t = t, here_.t_rest = t_rest, here_.q = q;
  static_cast<void>(here_.values());  // whoever holds its values means those of now
  return out;
}

/// `length` at most: its end to rounding where it comes earlier.
double UndeterminedForces::longest_rest(const ContactMode& mode, double length, double bound) {
  if (forces_later(mode, length, bound)) return length;
  constexpr int halvings = 45;
  double least = 0, most = length;
  for (int halving = 0; halving < halvings; ++halving) {
    const double middle = 0.5 * (least + most);
    (forces_later(mode, middle, bound) ? least : most) = middle;
  }
  return least;
}

std::optional<Given> UndeterminedForces::preload_through(const ContactMode& mode, double ahead, int power,
                                                         double bound) {
  const auto here = forces_later(mode, 0, bound), there = forces_later(mode, ahead, bound);
  if (!here || !there) return std::nullopt;
  Given out;
  out.is_preload = true;
  out.values = {here_.t};
  for (std::size_t k = 0; k < here->size(); ++k) {
    std::vector<double> coefficients(preload_degree + 1, 0);
    coefficients[0] = (*here)[k];
    if (ahead != 0) coefficients[static_cast<std::size_t>(power)] = ((*there)[k] - (*here)[k]) / std::pow(ahead, power);
    out.values.insert(out.values.end(), coefficients.begin(), coefficients.end());
  }
  return out;
}

/// ∂g/∂q of closed contacts with ∂v_t/∂q̇ of frictions that stick, beside the rows of constraints.
bool UndeterminedForces::has_dependent_rows(const ContactMode& mode, const ContactValues& values) const {
  std::vector<SparseRow> rows;
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    const bool is_contact = i < mode.closed.size();
    if (is_contact && !mode.closed[i]) continue;
    if (is_contact) rows.push_back(values.normal[i]);
    if (mode.friction[i] != FrictionState::Stick) continue;
    rows.push_back(values.tangent[i]);
    if (is_contact && !values.second_tangent[i].empty()) rows.push_back(values.second_tangent[i]);
  }
  return are_dependent(rows, here_.q.size(), here_.constraint_rows());
}

std::optional<double> UndeterminedForces::rest_ahead(const ContactMode& mode, double bound) {
  const std::size_t holds = number_that_hold(mode);
  const bool may_share = holds >= 2 || (holds == 1 && problem_.system.constrained());
  if (!may_share || holds > most_that_hold()) return std::nullopt;
  const ContactValues values = here_.values();
  if (!has_dependent_rows(mode, values)) return std::nullopt;
  const auto outlook = motions_.outlook_in(choices_.mode_without_contacts(values), bound);
  if (!outlook || !forces_at_rest(mode, values, bound)) return std::nullopt;
  return longest_rest(mode, std::copysign(outlook->length, bound - here_.t), bound);
}

std::string UndeterminedForces::sentence(const std::vector<Choice>& list, const ContactMode& mode,
                                         const ContactValues& values) const {
  std::vector<std::size_t> contacts, holding;  // that touch; all frictions that hold
  std::vector<SparseRow> normals;
  bool rubs = false;
  for (const Choice& c : list) {
    const std::size_t i = c.contact;
    const Friction& f = friction_of(problem_.system, i);
    if (mode.friction[i] == FrictionState::Stick && !f.sticking) holding.push_back(i);
    if (i >= values.gap.size()) continue;
    contacts.push_back(i);
    normals.push_back(values.normal[i]);
    rubs = rubs || (f.present() && !f.sticking);
  }
  const bool are_normals = contacts.size() > 1 && are_dependent(normals, here_.q.size(), here_.constraint_rows());
  if (are_normals) return undetermined_contacts_sentence(problem_.labels_of(contacts), rubs);
  if (holding.empty() || !has_dependent_rows(mode, values)) return {};
  std::sort(holding.begin(), holding.end());
  const bool are_contacts = holding.back() < values.gap.size();
  return fmt::format(
      "Friction at {}{} holds more than the motion needs, so that it does not determine {} (statically "
      "indeterminate). One distribution within the limits of friction is shown.",
      !are_contacts          ? ""
      : contacts.size() == 1 ? "the contact "
                             : "the contacts ",
      list_of(problem_.labels_of(are_contacts ? contacts : holding)),
      holding.size() > 1 || are_contacts ? "their forces" : "its force");
}

}  // namespace maupertuis::hybrid

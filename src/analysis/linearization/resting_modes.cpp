#include "analysis/linearization/mode_at_rest.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>

namespace maupertuis {
namespace {

constexpr std::size_t most_sets = 64;  // of closed contacts
constexpr double first_step = 1e-3, growth = 1.3, farthest = 1e6;

/// Sets of closed contacts, the smaller ones first.
std::vector<std::vector<bool>> sets_of(std::size_t contacts) {
  std::vector<std::vector<bool>> out;
  const std::size_t looked_at = std::min<std::size_t>(contacts, 20);
  for (std::size_t size = 0; size <= looked_at && out.size() < most_sets; ++size)
    for (std::size_t bits = 0; bits < (std::size_t{1} << looked_at) && out.size() < most_sets; ++bits) {
      if (static_cast<std::size_t>(std::popcount(bits)) != size) continue;
      std::vector<bool> closed(contacts, false);
      for (std::size_t i = 0; i < looked_at; ++i) closed[i] = ((bits >> i) & 1U) != 0;
      out.push_back(std::move(closed));
    }
  return out;
}

/// v_t of friction i while nothing moves: that of a belt.
double slip_at_rest(const MechanicalSystem& system, std::size_t i, const MotionState& start) {
  Bindings b = parameter_bindings(system);
  for (std::size_t k = 0; k < start.q.size(); ++k) {
    b[system.coordinates[k].q] = start.q[k];
    b[system.coordinates[k].velocity] = 0;
  }
  b[system.context->time()] = start.t;
  std::vector<double> components;
  for (const Expr& e : in_terms_of_motion(system, friction_of(system, i).slip)) components.push_back(evaluate(e, b));
  return components.size() == 1 ? components.front() : std::hypot(components[0], components[1]);
}

/// At rest friction sticks, or is left out; on what moves by itself it slides.
ContactMode mode_with(const MechanicalSystem& system, const std::vector<bool>& closed, bool sticks,
                      const MotionState& start) {
  ContactMode mode = open_mode(system);
  mode.closed = closed;
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    mode.friction[i] = FrictionState::None;
    const Friction& f = friction_of(system, i);
    if (!f.present() || (i < closed.size() && !closed[i])) continue;
    const double slip = f.sticking ? 0 : slip_at_rest(system, i, start);
    mode.friction[i] = slip != 0 && f.in_space() ? FrictionState::Slide
                       : slip > 0                ? FrictionState::Forward
                       : slip < 0                ? FrictionState::Backward
                       : sticks || f.sticking    ? FrictionState::Stick
                                                 : FrictionState::None;
  }
  return mode;
}

/// What is asked of the equations of a mode: all of its points of rest, or one.
using Question = std::function<std::optional<ModalStudy>(const PointEquations&, Diagnostics&)>;

using Presses = ModeAtRest::Presses;

/// Gives an entry its forces: where it moves beside contacts that others share, they bend what it feels.
void give_forces(const ModeAtRest& mode, const ModalStudy& study, const OperatingPoint& point, ModalEntry& e) {
  if (e.linearization.point.multipliers == point.multipliers) return;
  e.equilibrium.point.multipliers = e.linearization.point.multipliers = point.multipliers;
  if (e.linearization.independent.empty() || !e.side.empty()) return;
  e.linearization = linearize(mode.points(), point).linearization;
  e.analysis = modal_analysis(mode.points(), e.linearization, study.translations, &e.equilibrium);
}

/// The entries of a study at which its mode rests.
ModalStudy resting(const ModeAtRest& mode, const Question& ask, bool& touched) {
  Diagnostics unheard;  // a mode without equilibria is no mistake
  auto study = ask(mode.points(), unheard);
  if (!study) return {};
  std::erase_if(study->entries, [&](ModalEntry& e) {
    const OperatingPoint& point = e.linearization.point;
    const auto touching = e.equilibrium.at_rest ? mode.touching(point) : std::nullopt;
    const auto rests =
        touching == mode.mode().closed ? mode.with_forces(point, Presses::MoreThanRounding) : std::nullopt;
    touched = touched || (touching && !rests && mode.with_forces(point, Presses::AtMostPullsByRounding));
    if (rests) give_forces(mode, *study, *rests, e);
    return !rests;
  });
  for (ModalEntry& e : study->entries) {
    const bool moves = !e.linearization.independent.empty() || !e.linearization.independent_velocities.empty();
    if (moves || std::none_of(mode.mode().closed.begin(), mode.mode().closed.end(), [](bool b) { return b; })) continue;
    e.analysis.stability.verdict = Stability::Energetic;
    e.analysis.stability.reason = "the contacts press and leave nothing that could move";
  }
  study->failing.clear();
  study->kinks.clear();
  return std::move(*study);
}

/// How far one coordinate goes from a point while friction holds.
class RangeSearch {
 public:
  RangeSearch(const ModeAtRest& sticking, const MechanicalSystem& system) : sticking_(sticking), system_(system) {}

  std::optional<RestingRange> about(const OperatingPoint& point) const {
    EquilibriumSearch search;
    search.start = {point.t, point.q, std::vector<double>(point.q.size(), 0.0)};
    search.steady = false;
    const auto here = equilibrium_near(sticking_.points(), search);
    if (here.empty()) return std::nullopt;
    const auto translations = sticking_.points().translations();
    const bool moves_along = here.front().family == 0 && translations.size() == 1;
    if (moves_along && sticking_.is_free_along(translations.front()))
      return RestingRange{translations.front().pivot, -HUGE_VAL, HUGE_VAL};
    const bool is_family = here.front().family == 1 && !here.front().family_along.empty() && translations.empty();
    if (!moves_along && !is_family) return std::nullopt;
    const std::size_t k = moves_along ? translations.front().pivot : here.front().family_along.front();
    const double down = end(here.front().point, k, -1), up = end(here.front().point, k, 1);
    return RestingRange{k, down, up};
  }

 private:
  std::optional<OperatingPoint> moved_to(const OperatingPoint& from, std::size_t k, double value) const {
    EquilibriumSearch search;
    search.start = {from.t, from.q, std::vector<double>(from.q.size(), 0.0)};
    search.start.q[k] = value;
    search.fixed.q.assign(from.q.size(), false);
    search.fixed.q[k] = true;
    search.steady = false;
    const auto found = equilibrium_near(sticking_.points(), search);
    return found.empty() ? std::nullopt : std::optional(found.front().point);
  }
  /// Up to where the next contact touches.
  bool holds_at(const OperatingPoint& from, std::size_t k, double value) const {
    const auto there = moved_to(from, k, value);
    return there && sticking_.has_gaps(*there) && sticking_.with_forces(*there, Presses::NotLessThanZero);
  }

  double end(const OperatingPoint& from, std::size_t k, int direction) const {
    const double place = from.q[k], size = std::max(std::abs(place), 1.0);
    const bool angle = system_.coordinates[k].kind == "angle";
    double inside = 0, step = first_step * size;
    while (holds_at(from, k, place + direction * (inside + step))) {
      inside += step;
      step *= growth;
      if (angle && inside > 2 * std::numbers::pi) return direction * HUGE_VAL;
      if (inside > farthest * size) return direction * HUGE_VAL;
    }
    double outside = inside + step;
    for (int i = 0; i < 100 && outside - inside > 1e-16 * size; ++i) {
      const double middle = 0.5 * (inside + outside);
      (holds_at(from, k, place + direction * middle) ? inside : outside) = middle;
    }
    const double found = place + direction * inside;
    return std::abs(found) <= 1e-15 * size ? 0 : found;
  }

  const ModeAtRest& sticking_;
  const MechanicalSystem& system_;
};

/// Closed contacts, and what sticks or slides; friction that is left out is not named.
std::string text_of(const MechanicalSystem& system, const ContactMode& mode) {
  std::string out;
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    const bool contact = i < mode.closed.size();
    const FrictionState state = mode.friction[i];
    if (contact ? !mode.closed[i] : state == FrictionState::None) continue;
    out += out.empty() ? "" : ", ";
    out += contact ? system.contact_label(i) : system.frictions[i - mode.closed.size()].name;
    out += state == FrictionState::Stick     ? " sticking"
           : state == FrictionState::Slide   ? " sliding"
           : state == FrictionState::Forward ? " sliding +"
           : state == FrictionState::None    ? ""
                                             : " sliding −";
  }
  return out.empty() ? "free" : out;
}

std::optional<RestingMode> rest_with(const MechanicalSystem& system, const std::vector<bool>& closed,
                                     const MotionState& start, const Question& ask, bool& touched) {
  const ContactMode sticks = mode_with(system, closed, true, start), slides = mode_with(system, closed, false, start);
  const bool rubs = !(sticks == slides);
  const ModeAtRest plain(system, slides);
  RestingMode out;
  out.study = resting(plain, ask, touched);
  out.frictionless = rubs;
  const ModeAtRest* in = &plain;
  std::optional<ModeAtRest> sticking;
  if (rubs) sticking.emplace(system, sticks);
  if (rubs && out.study.entries.empty()) {
    out.study = resting(*sticking, ask, touched);
    out.frictionless = false;
    in = &*sticking;
  }
  if (out.study.entries.empty()) return std::nullopt;
  out.mode = in->mode();
  out.text = text_of(system, out.mode);
  out.equations = in->equations();
  for (const ModalEntry& e : out.study.entries) {
    out.forces_are_open.push_back(in->leaves_forces_open(e.linearization.point));
    out.holds.push_back(in->holds(e.linearization.point));
    out.ranges.push_back(rubs ? RangeSearch(*sticking, system).about(e.linearization.point) : std::nullopt);
  }
  return out;
}

void refuse_no_rest(bool touched, Diagnostics& diagnostics) {
  diagnostics.error(
      "E1308", std::nullopt, "no point of rest was found in any mode of the contacts",
      touched ? "There are points at which the forces balance and contacts touch without pressing: neighbours on one "
                "side of them are free and those on the other are not, so that nothing is linear there."
              : "At rest the forces balance, contacts that are closed press, and static friction holds what is left.",
      "--mode looks at one mode, whether its contacts press or not; --at at one point of it.");
}

}  // namespace

std::vector<RestingMode> resting_modes(const MechanicalSystem& system, const MotionState& start,
                                       Diagnostics& diagnostics) {
  std::vector<RestingMode> out;
  bool touched = false;
  const Question ask = [&](const PointEquations& points, Diagnostics& d) { return modal_study(points, start, d); };
  for (const auto& closed : sets_of(system.contacts.size()))
    if (auto found = rest_with(system, closed, start, ask, touched)) out.push_back(std::move(*found));
  if (out.empty()) refuse_no_rest(touched, diagnostics);
  return out;
}

std::optional<RestingMode> resting_mode_at(const MechanicalSystem& system, const MotionState& start,
                                           const std::vector<StartValue>& at, Diagnostics& diagnostics) {
  bool touched = false;
  const Question ask = [&](const PointEquations& points, Diagnostics& d) {
    return modal_study_at(points, start, at, d);
  };
  for (const auto& closed : sets_of(system.contacts.size()))
    if (auto found = rest_with(system, closed, start, ask, touched)) return found;
  refuse_no_rest(touched, diagnostics);
  return std::nullopt;
}

}  // namespace maupertuis

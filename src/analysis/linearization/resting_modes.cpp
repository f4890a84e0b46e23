#include "analysis/linearization/contact_sets.hpp"
#include "analysis/linearization/mode_at_rest.hpp"
#include "analysis/linearization/point_equations.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace maupertuis {
namespace {

constexpr double one_pose = 1e-6;  // of typical sizes
constexpr double first_step = 1e-3, growth = 1.3, farthest = 1e6;

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
struct Question {
  std::function<std::optional<ModalStudy>(const PointEquations&, Diagnostics&)> ask;
  bool is_of_all = false;  // of a family any member answers
};

using Presses = ModeAtRest::Presses;

/// Gives an entry its forces, or its place: where it moves beside contacts that others share, they bend what it feels.
void put_at(const ModeAtRest& mode, const ModalStudy& study, const OperatingPoint& point, ModalEntry& e) {
  const OperatingPoint& before = e.linearization.point;
  if (before.multipliers == point.multipliers && before.q == point.q) return;
  e.equilibrium.point = e.linearization.point = point;
  if (e.linearization.independent.empty() || !e.side.empty()) return;
  e.linearization = linearize(mode.points(), point).linearization;
  e.analysis = modal_analysis(mode.points(), e.linearization, study.translations, &e.equilibrium);
}

/// The rest of the mode with one coordinate at a value, next to a point.
std::optional<OperatingPoint> rest_with_value(const ModeAtRest& mode, const OperatingPoint& from, std::size_t k,
                                              double value) {
  EquilibriumSearch search;
  search.start = {from.t, from.q, std::vector<double>(from.q.size(), 0.0)};
  search.start.q[k] = value;
  search.fixed.q.assign(from.q.size(), false);
  search.fixed.q[k] = true;
  search.steady = false;
  const auto found = equilibrium_near(mode.points(), search);
  return found.empty() ? std::nullopt : std::optional(found.front().point);
}

/// The point with forces under which it rests. Of a family the search tells one member, and perhaps others rest: the
/// nearest in steps of a twenty-fourth of a half turn, or of a typical size, along one of its coordinates.
std::optional<OperatingPoint> with_forces_along(const ModeAtRest& mode, const Equilibrium& e) {
  constexpr int most_members = 24;
  if (auto here = mode.with_forces(e.point, Presses::MoreThanRounding)) return here;
  if (e.family == 0 || e.family_along.empty()) return std::nullopt;
  const MechanicalSystem& system = *mode.equations()->system;
  const auto is_angle = [&](std::size_t k) { return system.coordinates[k].kind == "angle"; };
  const auto angle = std::find_if(e.family_along.begin(), e.family_along.end(), is_angle);
  const std::size_t k = angle == e.family_along.end() ? e.family_along.front() : *angle;
  const double step = (is_angle(k) ? std::numbers::pi : typical_sizes(system, {0, e.point.q, {}})[k]) / most_members;
  for (int member = 1; member <= most_members; ++member)
    for (const int side : {1, -1}) {
      const auto there = rest_with_value(mode, e.point, k, e.point.q[k] + side * member * step);
      if (!there || mode.touching(*there) != mode.mode().closed) continue;
      if (auto rests = mode.with_forces(*there, Presses::MoreThanRounding)) return rests;
    }
  return std::nullopt;
}

/// What the modes in which rest is looked for meet beside their own rests.
struct Elsewhere {
  struct Pose {
    std::vector<bool> touching;  // more contacts than are closed in the mode that found it
    Equilibrium equilibrium;
  };
  std::vector<Pose> poses;
  bool touched = false;  // forces balance somewhere, and a contact that touches does not press
};

/// The entries of a study at which its mode rests, all that touch being closed.
ModalStudy resting(const ModeAtRest& mode, const Question& question, Elsewhere& elsewhere) {
  Diagnostics unheard;  // a mode without equilibria is no mistake
  auto study = question.ask(mode.points(), unheard);
  if (!study) return {};
  std::erase_if(study->entries, [&](ModalEntry& e) {
    const OperatingPoint& point = e.linearization.point;
    const auto touching = e.equilibrium.at_rest ? mode.touching(point) : std::nullopt;
    if (touching && touching != mode.mode().closed) elsewhere.poses.push_back({*touching, e.equilibrium});
    if (touching != mode.mode().closed) return true;
    const auto rests = question.is_of_all ? with_forces_along(mode, e.equilibrium)
                                          : mode.with_forces(point, Presses::MoreThanRounding);
    if (rests) put_at(mode, *study, *rests, e);
    elsewhere.touched = elsewhere.touched || (!rests && mode.with_forces(point, Presses::AtMostPullsByRounding));
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
  /// Up to where the next contact touches.
  bool holds_at(const OperatingPoint& from, std::size_t k, double value) const {
    const auto there = rest_with_value(sticking_, from, k, value);
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
                                     const MotionState& start, const Question& question, Elsewhere& elsewhere) {
  const ContactMode sticks = mode_with(system, closed, true, start), slides = mode_with(system, closed, false, start);
  const bool rubs = !(sticks == slides);
  const ModeAtRest plain(system, slides);
  RestingMode out;
  out.study = resting(plain, question, elsewhere);
  out.frictionless = rubs;
  const ModeAtRest* in = &plain;
  std::optional<ModeAtRest> sticking;
  if (rubs) sticking.emplace(system, sticks);
  if (rubs && out.study.entries.empty()) {
    out.study = resting(*sticking, question, elsewhere);
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

/// Whether two rests of a mode are one, also as members of a family or moved along a translation.
bool are_one_pose(const MechanicalSystem& system, const std::vector<Translation>& translations, const Equilibrium& a,
                  const Equilibrium& b) {
  const std::vector<double> sizes = typical_sizes(system, {a.point.t, a.point.q, a.point.v});
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const bool moves = std::any_of(translations.begin(), translations.end(),
                                   [&](const Translation& t) { return t.direction[k] != 0; });
    const auto along = [&](const Equilibrium& x) {
      return x.family > 0 && std::find(x.family_along.begin(), x.family_along.end(), k) != x.family_along.end();
    };
    if (moves || (along(a) && along(b))) continue;
    const double apart = std::abs(a.point.q[k] - b.point.q[k]);
    const bool one_turn = system.coordinates[k].kind == "angle" &&
                          std::max(std::abs(a.point.q[k]), std::abs(b.point.q[k])) < std::numbers::pi + one_pose;
    if (apart > one_pose * sizes[k] && !(one_turn && std::abs(apart - 2 * std::numbers::pi) <= one_pose)) return false;
  }
  return true;
}

/// Looks for rest in one set of closed contacts after the other.
class SearchOfRests {
 public:
  SearchOfRests(const MechanicalSystem& system, const MotionState& start) : system_(system), start_(start) {}

  /// Rests with these contacts closed.
  void look(const std::vector<bool>& closed, const Question& question) {
    looked_at_.push_back(closed);
    if (auto found = rest_with(system_, closed, start_, question, elsewhere_)) take(*std::move(found));
  }

  /// Rests that were met by fewer contacts than touch there: each belongs to the mode in which all of them are closed.
  void look_where_more_touch() {
    std::vector<Elsewhere::Pose> poses;
    std::swap(poses, elsewhere_.poses);
    while (!poses.empty()) {
      const std::vector<bool> closed = poses.front().touching;
      std::vector<Equilibrium> places;
      std::erase_if(poses, [&](const Elsewhere::Pose& pose) {
        if (pose.touching != closed) return false;
        if (!knows(closed, pose.equilibrium)) places.push_back(pose.equilibrium);
        return true;
      });
      if (places.empty()) continue;
      look(closed, {[&](const PointEquations& points, Diagnostics& d) { return study_near(points, places, d); }});
    }
  }

  /// By the number of contacts, then in their order.
  std::vector<RestingMode> in_order() && {
    const auto count = [](const RestingMode& m) {
      return std::count(m.mode.closed.begin(), m.mode.closed.end(), true);
    };
    std::stable_sort(found_.begin(), found_.end(), [&](const RestingMode& a, const RestingMode& b) {
      return count(a) != count(b) ? count(a) < count(b) : a.mode.closed > b.mode.closed;
    });
    return std::move(found_);
  }

  bool found_any() const { return !found_.empty(); }
  bool touched() const { return elsewhere_.touched; }
  /// Sets of contacts.
  std::size_t looked_at() const {
    std::vector<std::vector<bool>> sets = looked_at_;
    std::sort(sets.begin(), sets.end());
    return static_cast<std::size_t>(std::unique(sets.begin(), sets.end()) - sets.begin());
  }

 private:
  std::optional<ModalStudy> study_near(const PointEquations& points, const std::vector<Equilibrium>& places,
                                       Diagnostics& diagnostics) const {
    std::optional<ModalStudy> out;
    for (const Equilibrium& place : places) {
      const MotionState there{place.point.t, place.point.q, std::vector<double>(place.point.q.size())};
      auto study = modal_study_at(points, there, {}, diagnostics);
      if (!study) continue;
      if (!out)
        out = std::move(*study);
      else if (std::none_of(out->entries.begin(), out->entries.end(), [&](const ModalEntry& e) {
                 return are_one_pose(system_, out->translations, e.equilibrium, study->entries.front().equilibrium);
               }))
        std::move(study->entries.begin(), study->entries.end(), std::back_inserter(out->entries));
    }
    return out;
  }

  bool knows(const std::vector<bool>& closed, const Equilibrium& place) const {
    return std::any_of(found_.begin(), found_.end(),
                       [&](const RestingMode& m) { return m.mode.closed == closed && holds_pose(m, place); });
  }
  bool holds_pose(const RestingMode& mode, const Equilibrium& place) const {
    return std::any_of(mode.study.entries.begin(), mode.study.entries.end(), [&](const ModalEntry& e) {
      return are_one_pose(system_, mode.study.translations, e.equilibrium, place);
    });
  }

  /// Of a mode that rests elsewhere already the further poses.
  void take(RestingMode more) {
    const auto same =
        std::find_if(found_.begin(), found_.end(), [&](const RestingMode& m) { return m.mode == more.mode; });
    if (same == found_.end()) return found_.push_back(std::move(more));
    for (std::size_t i = 0; i < more.study.entries.size(); ++i) {
      if (holds_pose(*same, more.study.entries[i].equilibrium)) continue;
      same->study.entries.push_back(std::move(more.study.entries[i]));
      same->forces_are_open.push_back(more.forces_are_open[i]);
      same->holds.push_back(std::move(more.holds[i]));
      same->ranges.push_back(more.ranges[i]);
    }
  }

  const MechanicalSystem& system_;
  const MotionState& start_;
  std::vector<RestingMode> found_;
  std::vector<std::vector<bool>> looked_at_;
  Elsewhere elsewhere_;
};

void refuse_no_rest(const SearchOfRests& search, double all, Diagnostics& diagnostics) {
  const auto looked_at = static_cast<double>(search.looked_at());
  diagnostics.error(
      "E1308", std::nullopt,
      looked_at < all ? fmt::format("no point of rest was found in the {} of {:.6g} sets of closed contacts that were "
                                    "looked at",
                                    looked_at, all)
                      : "no point of rest was found in any mode of the contacts",
      search.touched()
          ? "There are points at which the forces balance and contacts touch without pressing: neighbours on one "
            "side of them are free and those on the other are not, so that nothing is linear there."
          : "At rest the forces balance, contacts that are closed press, and static friction holds what is left.",
      looked_at < all ? "A start at rest, or next to it, says which contacts press; --mode looks at one mode."
                      : "--mode looks at one mode, whether its contacts press or not; --at at one point of it.");
}

/// The start with the positions that are given.
MotionState start_at(const MechanicalSystem& system, MotionState start, const std::vector<StartValue>& at) {
  const Bindings parameters = parameter_bindings(system);
  for (const StartValue& s : at)
    if (s.order == 0) start.q[s.coordinate] = evaluate(in_terms_of_motion(system, {&s.value, 1}).front(), parameters);
  return start;
}

}  // namespace

RestingModes resting_modes(const MechanicalSystem& system, const MotionState& start, Diagnostics& diagnostics) {
  const ContactSets sets = contact_sets(system, start);
  SearchOfRests search(system, start);
  const Question question{[&](const PointEquations& points, Diagnostics& d) { return modal_study(points, start, d); },
                          true};
  for (const auto& closed : sets.chosen) search.look(closed, question);
  search.look_where_more_touch();
  if (!search.found_any()) refuse_no_rest(search, sets.all, diagnostics);
  const std::size_t looked_at = search.looked_at();
  return {std::move(search).in_order(), looked_at, sets.all};
}

std::optional<RestingMode> resting_mode_at(const MechanicalSystem& system, const MotionState& start,
                                           const std::vector<StartValue>& at, Diagnostics& diagnostics) {
  const ContactSets sets = contact_sets(system, start_at(system, start, at));
  SearchOfRests search(system, start);
  const Question question{
      [&](const PointEquations& points, Diagnostics& d) { return modal_study_at(points, start, at, d); }};
  for (const auto& closed : sets.chosen) {
    search.look(closed, question);
    search.look_where_more_touch();
    if (search.found_any()) return std::move(std::move(search).in_order().front());
  }
  refuse_no_rest(search, sets.all, diagnostics);
  return std::nullopt;
}

}  // namespace maupertuis

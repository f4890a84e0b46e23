#include <maupertuis/resting_modes.hpp>

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
constexpr double touches = 1e-9;       // of the sizes of the terms of a gap, and of the largest force
constexpr double no_force = 1e-14;     // of a limit of friction
constexpr double first_step = 1e-3, growth = 1.3, farthest = 1e6;

/// A mode at rest as equations and numbers.
class AtRest {
 public:
  AtRest(const MechanicalSystem& system, ContactMode mode) : system_(system), mode_(std::move(mode)) {
    Diagnostics unheard;  // the system passed its checks with its contacts
    MechanicalSystem in_mode = system_in_mode(system, mode_);
    in_mode.written = nullptr;
    equations_ = std::make_shared<const EquationsOfMotion>(
        *euler_lagrange(std::make_shared<const MechanicalSystem>(std::move(in_mode)), unheard));
    points_.emplace(*equations_);
  }

  const ContactMode& mode() const { return mode_; }
  const std::shared_ptr<const EquationsOfMotion>& equations() const { return equations_; }
  const PointEquations& points() const { return *points_; }

  Bindings at(const OperatingPoint& point) const {
    Bindings b = parameter_bindings(system_);
    for (std::size_t i = 0; i < point.q.size(); ++i) {
      b[system_.coordinates[i].q] = point.q[i];
      b[system_.coordinates[i].velocity] = 0;
      b[system_.coordinates[i].acceleration] = 0;
    }
    b[system_.context->time()] = point.t;
    for (const Contact& c : system_.contacts) b[c.multiplier] = 0;
    for (std::size_t i = 0; i < system_.contacts.size() + system_.frictions.size(); ++i)
      for (const Expr& m : friction_of(system_, i).multipliers) b[m] = 0;
    for (std::size_t k = 0; k < equations_->multipliers.size(); ++k)
      b[equations_->multipliers[k]] = point.multipliers[k];
    return b;
  }
  double value(Expr e, const Bindings& b) const { return evaluate(in_terms_of_motion(system_, {&e, 1}).front(), b); }

  /// Closed contacts press and open ones are open, by more than rounding. `touching`: whether nothing but rounding is
  /// missing.
  bool presses(const OperatingPoint& point, bool* touching = nullptr, double gap_digits = touches) const {
    const Bindings b = at(point);
    double largest = 0;
    for (const double x : point.multipliers) largest = std::max(largest, std::abs(x));
    bool good = true;
    if (touching) *touching = true;
    for (std::size_t i = 0; i < system_.contacts.size(); ++i) {
      const Contact& c = system_.contacts[i];
      const double x = mode_.closed[i] ? value(c.multiplier, b) : value(c.gap, b),
                   rounding =
                       mode_.closed[i] ? touches * std::max(largest, balanced(c, b)) : gap_digits * size(c.gap, b);
      good = good && x > rounding;
      if (touching) *touching = *touching && x >= -rounding;
    }
    return good;
  }

  /// Whether no open contact comes nearer or goes farther along this translation.
  bool is_free_along(const Translation& translation) const {
    for (std::size_t i = 0; i < system_.contacts.size(); ++i)
      for (std::size_t k = 0; k < system_.coordinates.size(); ++k)
        if (!mode_.closed[i] && translation.direction[k] != 0 &&
            !differentiate(system_.contacts[i].gap, system_.coordinates[k].q).is_zero())
          return false;
    return true;
  }

  std::vector<StaticHold> holds(const OperatingPoint& point) const {
    const Bindings b = at(point);
    std::vector<StaticHold> out;
    for (std::size_t i = 0; i < mode_.friction.size(); ++i) {
      const Friction& f = friction_of(system_, i);
      const bool acts = i >= system_.contacts.size() || mode_.closed[i];
      if (!f.present() || !acts || slides(mode_.friction[i])) continue;
      const Expr normal = normal_force(system_, mode_, i);
      const double limit = f.sticking ? HUGE_VAL : value(f.static_, b) * (normal ? std::abs(value(normal, b)) : 1);
      const std::string name =
          i < system_.contacts.size() ? system_.contact_label(i) : system_.frictions[i - system_.contacts.size()].name;
      const double force = force_of(f, b);
      const bool is_rounding = force <= no_force * limit && std::isfinite(limit);
      out.push_back({name, is_rounding ? 0.0 : force, limit, dimension_of_friction(i)});
    }
    return out;
  }
  Dimension dimension_of_friction(std::size_t i) const {
    if (i < system_.contacts.size()) return dimensions::force();
    const std::string& name = system_.frictions[i - system_.contacts.size()].name;
    for (const Coordinate& c : system_.coordinates)
      if (c.name == name) return system_.lagrangian_dimension / c.dimension;
    return {};
  }
  static bool slides(FrictionState state) { return state != FrictionState::None && state != FrictionState::Stick; }
  double force_of(const Friction& f, const Bindings& b) const {
    double square = 0;
    for (const Expr& m : f.multipliers) square += std::pow(value(m, b), 2);
    return std::sqrt(square);
  }
  bool friction_holds(const OperatingPoint& point) const {
    const auto all = holds(point);
    return std::all_of(all.begin(), all.end(), [](const StaticHold& h) { return h.force <= h.limit; });
  }

 private:
  /// The forces that balance where the contact pushes, in units of its λ.
  double balanced(const Contact& c, const Bindings& b) const {
    double out = 0;
    for (std::size_t k = 0; k < system_.coordinates.size(); ++k) {
      const double slope = std::abs(value(differentiate(c.gap, system_.coordinates[k].q), b));
      if (!(slope > 0)) continue;
      double forces = size(equations_->generalized_forces[k], b);
      for (const EnergyTerm& term : system_.potential)
        forces += std::abs(value(differentiate(term.value, system_.coordinates[k].q), b));
      out = std::max(out, forces / slope);
    }
    return out;
  }

  double size(Expr e, const Bindings& b) const {
    double sum = 0;
    for (std::size_t i = 0; i < (e.is(Kind::Sum) ? e.size() : 1); ++i)
      sum += std::abs(value(e.is(Kind::Sum) ? e[i] : e, b));
    return sum;
  }
  const MechanicalSystem& system_;
  ContactMode mode_;
  std::shared_ptr<const EquationsOfMotion> equations_;
  std::optional<PointEquations> points_;
};

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

/// The entries of a study at which its mode rests.
template <class Keep>
ModalStudy resting(const AtRest& mode, const Question& ask, bool& touched, const Keep& keep) {
  Diagnostics unheard;  // a mode without equilibria is no mistake
  auto study = ask(mode.points(), unheard);
  if (!study) return {};
  std::erase_if(study->entries, [&](const ModalEntry& e) {
    bool touching = false;
    const bool rests = e.equilibrium.at_rest && mode.presses(e.linearization.point, &touching);
    touched = touched || (e.equilibrium.at_rest && !rests && touching);
    return !rests || !keep(e.linearization.point);
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
  RangeSearch(const AtRest& sticking, const MechanicalSystem& system) : sticking_(sticking), system_(system) {}

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
    return there && sticking_.presses(*there, nullptr, 0) && sticking_.friction_holds(*there);
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

  const AtRest& sticking_;
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
  const AtRest plain(system, slides);
  RestingMode out;
  out.study = resting(plain, ask, touched, [](const OperatingPoint&) { return true; });
  out.frictionless = rubs;
  const AtRest* in = &plain;
  std::optional<AtRest> sticking;
  if (rubs) sticking.emplace(system, sticks);
  if (rubs && out.study.entries.empty()) {
    out.study = resting(*sticking, ask, touched, [&](const OperatingPoint& p) { return sticking->friction_holds(p); });
    out.frictionless = false;
    in = &*sticking;
  }
  if (out.study.entries.empty()) return std::nullopt;
  out.mode = in->mode();
  out.text = text_of(system, out.mode);
  out.equations = in->equations();
  for (const ModalEntry& e : out.study.entries) {
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

#include "analysis/linearization/dense.hpp"
#include "analysis/linearization/kinks.hpp"

#include <maupertuis/modes.hpp>
#include <maupertuis/quaternion_coordinates.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

/// From a question to its answer, with what can be wrong with either.
namespace maupertuis {
namespace {

constexpr double meant = 1e-4;  // of typical sizes: a given value is rounded by no more

void refuse_singular(const MechanicalSystem& system, std::size_t coordinate, const std::string& where,
                     Diagnostics& diagnostics) {
  diagnostics.error(
      "E1304", system.coordinates[coordinate].span, fmt::format("the mass matrix is singular {}", where),
      fmt::format("Some motion of {} has no inertia there, so that the equations do not determine its acceleration.",
                  system.coordinates[coordinate].name),
      "Coordinates fail at such places, as polar ones do at r = 0: describe the system by others near there.");
}

/// Linearizes what was found; the points at which coordinates fail stand apart.
constexpr double balanced = 1e-9;  // residual of rest

void add_entry(ModalStudy& study, const PointEquations& equations, const Equilibrium& x, const std::string& side) {
  ModalEntry entry{x, {}, {}, side};
  entry.linearization = linearize(equations, x.point).linearization;
  std::vector<Translation> symmetries = x.ways;
  symmetries.insert(symmetries.end(), study.translations.begin(), study.translations.end());
  entry.analysis = modal_analysis(equations, entry.linearization, symmetries, &entry.equilibrium);
  study.entries.push_back(std::move(entry));
}

ModalStudy analysed(const PointEquations& equations, std::vector<Equilibrium> found,
                    std::vector<Translation> translations) {
  ModalStudy study;
  study.translations = std::move(translations);
  for (Equilibrium& x : found) {
    if (const std::size_t count = x.coordinates_fail ? 0 : switches_at(equations, x); count > most_switches) {
      study.kinks.push_back({x, {}, false, count});
      continue;
    }
    const std::vector<OneSide> sides =
        x.coordinates_fail ? std::vector<OneSide>() : sides_at(equations, x, study.translations);
    if (sides.empty() && is_stiffness_unbounded(equations, x.point)) {
      study.kinks.push_back({x, {}, true});
      continue;
    }
    if (x.coordinates_fail) {
      study.failing.push_back(std::move(x));
      continue;
    }
    if (sides.empty()) add_entry(study, equations, x, {});
    for (const OneSide& side : sides) {
      if (is_stiffness_unbounded(side.equations, x.point))
        study.kinks.push_back({x, side.where, true});
      else if (side.residual <= balanced)
        add_entry(study, side.equations, x, side.where);
      else
        study.kinks.push_back({x, side.where});
    }
  }
  return study;
}

constexpr const char* unbounded_stiffness =
    "The forces balance there, but the stiffness grows without bound near the point, as that of abs(x)^1.5 at 0: small "
    "oscillations have frequencies that depend on their amplitudes.";
std::string crowded_switches(std::size_t count) {
  return fmt::format(
      "{} formulas switch there, which part its neighbourhood into up to 2^{} sides, each with its own "
      "frequencies. The sides of {} are looked at.",
      count, count, most_switches);
}
constexpr const char* one_side_instead = "Write the model with the formulas of the side that is meant.";

constexpr const char* smooth_instead = "`maup simulate` runs the model as it is.";

/// E1307: all that was found is on kinks, and balances on no side of them.
bool refuse_kinks_alone(const PointEquations& equations, const ModalStudy& study, std::optional<Span> place,
                        Diagnostics& diagnostics) {
  if (!study.entries.empty() || study.kinks.empty()) return false;
  if (const Kink& first = study.kinks.front(); first.switches > 0) {
    diagnostics.error(
        "E1307", place,
        fmt::format("no linearization at {}", point_text(equations.system(), first.equilibrium, study.translations)),
        crowded_switches(first.switches), one_side_instead);
    return true;
  }
  const bool steep = std::any_of(study.kinks.begin(), study.kinks.end(), [](const Kink& k) { return k.steep; });
  if (steep)
    diagnostics.error("E1307", place,
                      fmt::format("no linearization at {}",
                                  point_text(equations.system(), study.kinks.front().equilibrium, study.translations)),
                      unbounded_stiffness, smooth_instead);
  else
    diagnostics.error(
        "E1307", place,
        fmt::format("{} is on a kink",
                    point_text(equations.system(), study.kinks.front().equilibrium, study.translations)),
        "Beside it forces are left over on every side, however small the distance: there is no linearization and no "
        "frequency.",
        "A smooth function, as sqrt(x^2 + d^2) for abs(x), has one; `maup simulate` runs the model as it is.");
  return true;
}

void tell_of_kinks(const PointEquations& equations, const ModalStudy& study, Diagnostics& diagnostics) {
  for (const Kink& k : study.kinks)
    if (k.switches > 0)
      diagnostics.warning(
          "W1302", std::nullopt,
          fmt::format("no linearization at {}", point_text(equations.system(), k.equilibrium, study.translations)),
          crowded_switches(k.switches), one_side_instead);
    else if (k.steep)
      diagnostics.warning(
          "W1302", std::nullopt,
          fmt::format("no linearization at {}{}", point_text(equations.system(), k.equilibrium, study.translations),
                      k.side.empty() ? "" : " on the side " + k.side),
          unbounded_stiffness, smooth_instead);
    else
      diagnostics.warning(
          "W1302", std::nullopt,
          fmt::format("no linearization at {}{}", point_text(equations.system(), k.equilibrium, study.translations),
                      k.side.empty() ? "" : " on the side " + k.side),
          "The point is on a kink, and beside it forces are left over: they push back or away, however small the "
          "distance, so that there is no frequency.",
          "A smooth function, as sqrt(x^2 + d^2) for abs(x), has one; `maup simulate` runs the model as it is.");
}

void warn_of_failing(const PointEquations& equations, const ModalStudy& study, Diagnostics& diagnostics) {
  if (study.failing.empty()) return;
  const std::size_t others = study.failing.size() - 1;
  const std::string first = point_text(equations.system(), study.failing.front(), study.translations);
  diagnostics.warning(
      "W1301", std::nullopt,
      fmt::format("no linearization at {}{}", first,
                  others == 0 ? "" : fmt::format(", nor at {} other point{}", others, others == 1 ? "" : "s")),
      "The forces vanish there, but the mass matrix is singular: the coordinates fail.",
      "Describe the system by other coordinates near there.");
}

void refuse_none(const PointEquations& equations, std::size_t starts, Diagnostics& diagnostics) {
  if (!equations.autonomous())
    diagnostics.error(
        "E1303", std::nullopt, "the equations depend on the time, and no configuration is at rest at all times",
        "An equilibrium is a state in which all forces stay balanced; a drive that changes with time moves it.",
        "Declare the drive as `input u : [N] = …`: it is held at its value at the start; or take a point of the "
        "motion: --at 3s.");
  else
    diagnostics.error(
        "E1301", std::nullopt, "no equilibrium and no steady motion was found",
        fmt::format("Newton's method began from {} points, and nowhere do the forces vanish together.", starts),
        "Look at the model for a force that nothing balances; --at \"θ=1\" begins at a point of your own, "
        "--at 3s takes a point of the motion.");
}

/// Coordinates and rates that were given, over those of the start.
EquilibriumSearch question(const PointEquations& equations, const MotionState& start,
                           const std::vector<StartValue>& at) {
  const MechanicalSystem& system = equations.system();
  Bindings bindings = parameter_bindings(system);
  for (std::size_t i = 0; i < system.parameters.size(); ++i)
    bindings[system.parameters[i].symbol] = equations.parameter(i);
  EquilibriumSearch search;
  search.start = start;
  search.fixed.q.assign(start.q.size(), false);
  bool rates = false;
  std::vector<bool> fixed_rates(start.q.size(), false);
  for (const StartValue& s : at) {
    const double value = evaluate(in_terms_of_motion(system, {&s.value, 1}).front(), bindings);
    (s.order == 0 ? search.start.q : search.start.v)[s.coordinate] = value;
    (s.order == 0 ? search.fixed.q : fixed_rates)[s.coordinate] = true;
    rates |= s.order == 1;
  }
  if (rates) search.fixed.v = fixed_rates;
  return search;
}

/// How far a point is from what was given, by typical sizes.
double distance(const EquilibriumSearch& asked, const OperatingPoint& point, const MechanicalSystem& system) {
  const std::vector<double> sizes = typical_sizes(system, asked.start);
  double out = 0;
  for (std::size_t i = 0; i < point.q.size(); ++i) {
    if (asked.fixed.q[i]) out = std::max(out, std::abs(point.q[i] - asked.start.q[i]) / sizes[i]);
    if (!asked.fixed.v.empty() && asked.fixed.v[i])
      out = std::max(out, std::abs(point.v[i] - asked.start.v[i]) / std::max(sizes[i], std::abs(asked.start.v[i])));
  }
  return out;
}

/// A constraint of positions all of whose coordinates are given, and that they break: its label; else empty.
std::string broken_constraint(const PointEquations& equations, const EquilibriumSearch& asked) {
  PointEquations::Impl& e = equations.impl();
  const OperatingPoint point{0,
                             asked.start.q,
                             std::vector<double>(e.n),
                             std::vector<double>(e.n),
                             std::vector<double>(e.m),
                             equations.inputs_at(0)};
  const RowsAtPoint rows = e.at(e.positions, point);
  const std::vector<double> sizes = typical_sizes(equations.system(), asked.start);
  for (Index i = 0; i < rows.value.size(); ++i) {
    bool given = true;
    double size = 0;
    for (std::size_t j = 0; j < e.n; ++j) {
      const double slope = rows.by_q(i, static_cast<Index>(j));
      given = given && (slope == 0 || asked.fixed.q[j]);
      size += std::abs(slope) * sizes[j];
    }
    if (given && !(std::abs(rows.value[i]) <= meant * size))
      return equations.system().constraint_label(e.position_rows[static_cast<std::size_t>(i)]);
  }
  return {};
}

/// Only those that turn along stay what they are in the frame.
std::vector<Translation> seen_in_frame(const OperatingPoint& point, std::vector<Translation> translations) {
  const Matrix turning = to_eigen(point.turning);
  constexpr double rounding = 1e-9;
  std::erase_if(translations, [&](const Translation& t) {
    return turning.size() > 0 &&
           (turning * to_eigen(t.direction)).norm() > rounding * turning.norm() * to_eigen(t.direction).norm();
  });
  return translations;
}

/// Velocities that are not given, as constraints ask for them with those that are; 0 where none does.
void complete_velocities(PointEquations::Impl& e, const std::vector<bool>& given, MotionState& start) {
  for (std::size_t i = 0; i < start.v.size(); ++i)
    if (!given[i]) start.v[i] = 0;
  const OperatingPoint point{
      start.t, start.q, start.v, std::vector<double>(e.n), std::vector<double>(e.m), std::vector<double>(e.k)};
  const RowsAtPoint velocities = e.at(e.velocities, point), positions = e.at(e.positions, point);
  Matrix by(velocities.value.size() + positions.value.size(), static_cast<Index>(e.n));
  by << velocities.by_v, positions.by_q;
  Vector left(by.rows());
  left << velocities.value, positions.by_q * to_eigen(start.v);
  const std::vector<double> sizes = typical_sizes(*e.system, start);
  for (Index i = 0; i < by.cols(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    by.col(i) *= given[k] ? 0 : sizes[k];
  }
  if (by.rows() == 0 || !by.allFinite() || !left.allFinite()) return;
  const Vector move = least_squares(by, -left, 1e-9).x;
  for (std::size_t i = 0; i < start.v.size(); ++i)
    if (!given[i]) start.v[i] = sizes[i] * move[static_cast<Index>(i)];
}

/// Where velocities are given: the steady motion along rotations that has them.
std::optional<Equilibrium> turning_motion(const PointEquations& equations, const EquilibriumSearch& asked) {
  if (asked.fixed.v.empty() || !equations.autonomous()) return std::nullopt;
  MotionState start = asked.start;
  for (std::size_t i = 0; i < start.v.size(); ++i)
    if (!asked.fixed.v[i]) start.v[i] = 0;
  std::optional<Equilibrium> found = steady_rotation_near(equations, start);
  if (!found || distance(asked, found->point, equations.system()) > meant) {
    complete_velocities(equations.impl(), asked.fixed.v, start);
    found = steady_rotation_near(equations, start);
  }
  if (!found || distance(asked, found->point, equations.system()) > meant) return std::nullopt;
  found->coordinates_fail = linearize(equations, found->point).singular;
  return found;
}

/// With what was given kept; then, where that balances only nearly, with the coordinates free to move a little.
std::vector<Equilibrium> answer(const PointEquations& equations, const EquilibriumSearch& asked,
                                std::optional<Equilibrium>& nearest) {
  std::vector<Equilibrium> found = equilibrium_near(equations, asked);
  if (found.empty()) {
    EquilibriumSearch loose = asked;
    loose.fixed.q.assign(asked.start.q.size(), false);
    found = equilibrium_near(equations, loose);
  }
  if (!found.empty() && distance(asked, found.front().point, equations.system()) <= meant) return found;
  if (const auto turning = turning_motion(equations, asked)) return {*turning};
  if (!found.empty()) nearest = found.front();
  return {};
}

}  // namespace

std::optional<ModalStudy> modal_study(const PointEquations& equations, const MotionState& start,
                                      Diagnostics& diagnostics) {
  EquilibriumSearch search;
  search.start = start;
  EquilibriumSearchResult result = find_equilibria(equations, search);
  if (result.found.empty()) {
    refuse_none(equations, result.starts, diagnostics);
    return std::nullopt;
  }
  ModalStudy study = analysed(equations, std::move(result.found), std::move(result.translations));
  study.starts = result.starts;
  study.outside = result.outside;
  if (refuse_kinks_alone(equations, study, std::nullopt, diagnostics)) return std::nullopt;
  warn_of_failing(equations, study, diagnostics);
  tell_of_kinks(equations, study, diagnostics);
  return study;
}

std::optional<ModalStudy> modal_study_at(const PointEquations& equations, const MotionState& start,
                                         const std::vector<StartValue>& at, Diagnostics& diagnostics) {
  const EquilibriumSearch asked = question(equations, start, at);
  std::optional<Equilibrium> nearest;
  std::vector<Equilibrium> found = answer(equations, asked, nearest);
  const std::optional<Span> place = at.empty() ? std::nullopt : std::optional(at.front().span);
  std::vector<bool> preferred = asked.fixed.v;
  const std::vector<Translation> translations = equations.translations(preferred);
  if (found.empty()) {
    const std::string broken = broken_constraint(equations, asked);
    diagnostics.error("E1302", place, "the system neither rests nor moves steadily there",
                      !broken.empty() ? fmt::format("The values that are given break {}.", broken)
                      : nearest
                          ? fmt::format("The forces do not balance; Newton's method from there ends at {}.",
                                        point_text(equations.system(), *nearest, translations))
                          : "The forces do not balance, and Newton's method from there finds no place where they do.",
                      "`maup modes` without --at searches for all equilibria.");
    return std::nullopt;
  }
  if (found.front().coordinates_fail && !is_stiffness_unbounded(equations, found.front().point)) {
    const std::size_t culprit = linearize(equations, found.front().point).singular_coordinate;
    refuse_singular(equations.system(), culprit, "at " + point_text(equations.system(), found.front(), translations),
                    diagnostics);
    return std::nullopt;
  }
  ModalStudy study = analysed(equations, {found.front()}, seen_in_frame(found.front().point, translations));
  if (refuse_kinks_alone(equations, study, place, diagnostics)) return std::nullopt;
  tell_of_kinks(equations, study, diagnostics);
  return study;
}

std::optional<ModalStudy> modal_study_of(const PointEquations& equations, const MotionState& state,
                                         Diagnostics& diagnostics) {
  const std::optional<OperatingPoint> point = operating_point(equations, state);
  if (!point) {
    refuse_singular(equations.system(), 0, fmt::format("at t = {:g} s", state.t), diagnostics);
    return std::nullopt;
  }
  ModalStudy study;
  study.translations = equations.translations();
  ModalEntry entry{{*point, false, 0, 0, {}, false, {}}, linearize(equations, *point).linearization, {}, {}};
  entry.analysis = modal_analysis(equations, entry.linearization, {}, nullptr);
  study.entries.push_back(std::move(entry));
  return study;
}

// ------------------------------------------------------------------------------------------------------------------
// words

std::string_view stability_word(Stability verdict) {
  switch (verdict) {
    case Stability::Energetic:
    case Stability::Linear:
      return "stable";
    case Stability::Asymptotic:
      return "asymptotically stable";
    case Stability::Unstable:
      return "unstable";
    case Stability::Undecided:
      return "not decided by the linearization";
  }
  return "";
}

std::string value_text(const MechanicalSystem& system, double value, const Dimension& dimension, bool angle) {
  if (angle)
    for (const int part : {1, 2, 3, 4, 6, 12}) {
      const double count = value * part / std::numbers::pi;
      if (std::abs(count - std::round(count)) > 1e-12 * std::max(1.0, std::abs(count)) || std::abs(count) > 24)
        continue;
      const int k = static_cast<int>(std::round(count));
      if (k == 0) return "0";
      const std::string sign = k < 0 ? "-" : "", times = std::abs(k) == 1 ? "" : std::to_string(std::abs(k));
      return sign + times + "π" + (part == 1 ? "" : "/" + std::to_string(part));
    }
  const std::string unit = system.dimensionless ? "" : to_string(dimension);
  return fmt::format("{:.9g}{}{}", value, unit.empty() || unit == "1" || value == 0 ? "" : " ",
                     value == 0 || unit == "1" ? "" : unit);
}

namespace {

/// Of many coordinates: one value for all, or the first ones.
std::string short_point_text(const MechanicalSystem& system, const Equilibrium& equilibrium) {
  const auto text = [&](std::size_t i) {
    const Coordinate& c = system.coordinates[i];
    return value_text(system, equilibrium.point.q[i], c.dimension, c.kind == "angle");
  };
  const std::size_t n = system.coordinates.size();
  std::size_t equal = 1;
  while (equal < n && text(equal) == text(0)) ++equal;
  if (equal == n)
    return fmt::format("{} … {} = {}", system.coordinates[0].name, system.coordinates[n - 1].name, text(0));
  std::string out;
  constexpr std::size_t first = 6;
  for (std::size_t i = 0; i < first; ++i) out += fmt::format("{} = {}, ", system.coordinates[i].name, text(i));
  return out + fmt::format("… ({} coordinates)", n);
}

/// A motion that turns: the rates of the bodies on their own axes, and the velocities of what is no part of them.
std::string turning_text(const MechanicalSystem& system, const OperatingPoint& point) {
  const std::string unit = system.dimensionless ? "" : " rad/s";
  std::string out;
  const auto add = [&](const std::string& text) { out += (out.empty() ? "" : ", ") + text; };
  const auto rounded = [](double x, double size) { return std::abs(x) < 1e-14 * size ? 0.0 : x; };
  std::vector<bool> told(system.coordinates.size(), false);
  for (const auto& quaternion : quaternion_coordinates(system))
    for (const std::size_t i : quaternion) told[i] = true;
  Bindings bindings = parameter_bindings(system);
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    bindings[system.coordinates[i].q] = point.q[i];
    bindings[system.coordinates[i].velocity] = point.v[i];
  }
  for (const Body& body : system.bodies) {
    if (body.angular_velocity.size() != 3) continue;
    const ExprVector rates = in_terms_of_motion(system, body.angular_velocity);
    double w[3], size = 0;
    for (int k = 0; k < 3; ++k) w[k] = evaluate(rates[static_cast<std::size_t>(k)], bindings), size += std::abs(w[k]);
    add(fmt::format("{}.ω = ({:.9g}, {:.9g}, {:.9g}){}", body.name, rounded(w[0], size), rounded(w[1], size),
                    rounded(w[2], size), unit));
  }
  for (std::size_t i = 0; i < told.size(); ++i)
    if (!told[i] && point.v[i] != 0)
      add(fmt::format("{}' = {}", system.coordinates[i].name,
                      value_text(system, point.v[i], system.coordinates[i].dimension / system.independent_dimension)));
  return out;
}

}  // namespace

std::string point_text(const MechanicalSystem& system, const Equilibrium& equilibrium,
                       const std::vector<Translation>& translations) {
  const auto is_pivot = [&](std::size_t i) {
    return std::any_of(translations.begin(), translations.end(), [&](const Translation& t) { return t.pivot == i; });
  };
  constexpr std::size_t most = 8;
  if (system.coordinates.size() > most && equilibrium.point.turning.rows == 0)
    return short_point_text(system, equilibrium);
  std::string positions, rates;
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    const Coordinate& c = system.coordinates[i];
    if (!is_pivot(i))
      positions += fmt::format("{}{} = {}", positions.empty() ? "" : ", ", c.name,
                               value_text(system, equilibrium.point.q[i], c.dimension, c.kind == "angle"));
    if (equilibrium.point.v[i] != 0 && equilibrium.point.turning.rows == 0)
      rates += fmt::format("{}{}' = {}", rates.empty() ? "" : ", ", c.name,
                           value_text(system, equilibrium.point.v[i], c.dimension / system.independent_dimension));
  }
  if (equilibrium.point.turning.rows > 0) rates = turning_text(system, equilibrium.point);
  if (positions.empty() && rates.empty()) return "rest anywhere";
  return positions + (positions.empty() || rates.empty() ? "" : "; ") + rates;
}

}  // namespace maupertuis

#include "action_text.hpp"

#include "outcome.hpp"
#include "quantity.hpp"

#include <maupertuis/higher_order.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace maupertuis::app {
namespace {

std::string line(const std::string& head, const std::string& text) { return fmt::format("    {:<20}{}\n", head, text); }

std::string unit_of(const Dimension& dimension, const MechanicalSystem& system) {
  if (system.dimensionless) return {};
  const std::string unit = to_string(dimension);
  return unit == "1" ? "" : unit;
}

std::string action_unit(const MechanicalSystem& system) {
  return unit_of(system.lagrangian_dimension * system.independent_dimension, system);
}

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + unit;
}

std::string moment(double t, const MechanicalSystem& system) { return system.moment(fmt::format("{:.12g}", t)); }

/// One digit, rounded up: an error is not made smaller by printing it. (std::stod would throw where the result is
/// subnormal or infinite.)
std::string error_text(double error) {
  const std::string nearest = fmt::format("{:.0e}", error);
  if (!(std::strtod(nearest.c_str(), nullptr) < error)) return fmt::format("{:.1g}", error);
  const double digit = nearest[0] - '0', power = std::strtod(("1" + nearest.substr(1)).c_str(), nullptr);
  return fmt::format("{:.1g}", (digit + 1) * power);
}

std::string value_of_action(double value, double error, const MechanicalSystem& system) {
  return with_unit(fmt::format("{:.16g} ± {}", value, error_text(error)), action_unit(system));
}

std::string path_kind_text(const SecondVariation& s) {
  if (!s.index) return "stationary, of unknown index: " + s.reason;
  if (s.nullity > 0)
    return fmt::format("degenerate: index {}, and {} variation{} that leave{} S as it is to second order", *s.index,
                       s.nullity, s.nullity == 1 ? "" : "s", s.nullity == 1 ? "s" : "");
  return *s.index == 0 ? "a minimum of S (index 0)" : fmt::format("a saddle of S, index {}", *s.index);
}

std::string conjugate_text(const SecondVariation& s, const MechanicalSystem& system) {
  if (s.conjugate.empty()) return "none inside";
  std::string out;
  for (const ConjugatePoint& p : s.conjugate)
    out += fmt::format("{}{}{}", out.empty() ? "" : ", ", moment(p.t, system),
                       p.multiplicity > 1 ? fmt::format(" ({} times)", p.multiplicity) : "");
  return out;
}

std::string counts_text(const SecondVariation& s) {
  if (!s.by_inertia) return {};
  std::string out =
      fmt::format("{} negative eigenvalue{} of the second variation", *s.by_inertia, *s.by_inertia == 1 ? "" : "s");
  if (!s.by_fields) return out;
  out += fmt::format("; {} by Jacobi fields", *s.by_fields);
  if (s.concavity) out += fmt::format(", of which {} by the freedom of the ends", *s.concavity);
  return out + (s.index ? ": they agree" : ": they DISAGREE");
}

std::string check_text(const StationaryPath& p, const MechanicalSystem& system) {
  const MotionCheck& c = p.check;
  if (!c.done) return c.reason.empty() ? "" : "not carried: " + c.reason;
  std::string out = fmt::format("the motion, carried over {} stretch{}, misses the path by {:.1e} of its size",
                                c.stretches, c.stretches == 1 ? "" : "es", c.missed);
  if (c.from == p.path.start && c.to == p.path.end)
    return out + fmt::format("; its ∫ L d{} is off by {:.1e}", system.independent, std::abs(c.action - p.action));
  return out + fmt::format(" from {} on, where L is finite", moment(c.from, system));
}

std::string list(const std::vector<double>& values, const MechanicalSystem& system, const char* prefix,
                 const char* suffix) {
  std::string out;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string name = written_name(system, i);
    if (name.empty()) continue;
    out += fmt::format(
        "{}{}{}{} {}", out.empty() ? "" : ", ", prefix, name, suffix,
        std::isfinite(values[i]) ? fmt::format("= {:.9g}", values[i]) : "without a value, since L is infinite there");
  }
  return out;
}

std::string path_text(const StationaryPath& p, const MechanicalSystem& system) {
  std::string out = line("S", value_of_action(p.action, p.action_error, system));
  out += line("kind", path_kind_text(p.second));
  if (p.second.by_inertia) out += line("conjugate points", conjugate_text(p.second, system));
  if (const std::string counts = counts_text(p.second); !counts.empty()) out += line("counted", counts);
  out += line("starts with", list(p.start_velocity, system, "", "'"));
  if (!p.end_momentum.empty()) out += line("∂S/∂q at the end", list(p.end_momentum, system, "p_", ""));
  if (p.end_energy) out += line("−∂S/∂T", fmt::format("h_E = {:.9g}", *p.end_energy));
  for (std::size_t i = 0; i < p.multipliers.size(); ++i) {
    const std::string& name = system.integral_constraints[i].name;
    out += line("multiplier",
                fmt::format("λ{} = {:.12g}", name.empty() ? std::to_string(i + 1) : "_" + name, p.multipliers[i]));
  }
  if (const std::string check = check_text(p, system); !check.empty()) out += line("checked", check);
  double slope = 0;
  for (const TestVariation& v : p.second.variations) slope = std::max(slope, std::abs(v.slope));
  if (!p.second.variations.empty())
    out += line("first variation", fmt::format("at most {:.1e} of its terms, on {} neighbouring families", slope,
                                               p.second.variations.size()));
  return out;
}

std::string ends_text(const ActionEnds& ends, const MechanicalSystem& system) {
  const auto at = [&](const std::vector<std::optional<double>>& q) {
    std::string out;
    for (std::size_t i = 0; i < q.size(); ++i) {
      const std::string name = written_name(system, i);
      if (name.empty()) continue;
      const std::string value = q[i] ? brief(*q[i]) : "free";
      out += (out.empty() ? "" : ", ") + (system.higher.empty() ? value : name + " = " + value);
    }
    return "(" + out + ")";
  };
  return fmt::format("from {} at {} to {} at {}", at(ends.from), moment(ends.start, system), at(ends.to),
                     moment(ends.end, system));
}

Json or_null(const std::optional<double>& x) { return x ? Json(*x) : Json(nullptr); }
Json or_null(const std::optional<std::size_t>& x) { return x ? Json(*x) : Json(nullptr); }
Json finite(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json by_coordinate(const std::vector<double>& values, const MechanicalSystem& system) {
  Json out = Json::object();
  for (std::size_t i = 0; i < values.size(); ++i) out[system.coordinates[i].name] = finite(values[i]);
  return out;
}

Json variations_json(const std::vector<TestVariation>& variations) {
  Json out = Json::array();
  for (const TestVariation& v : variations)
    out.push_back({{"name", v.name},
                   {"slope", v.slope},
                   {"curvature", finite(v.curvature)},
                   {"epsilon", v.epsilon},
                   {"change", v.change}});
  return out;
}

Json path_json(const StationaryPath& p, const MechanicalSystem& system) {
  const SecondVariation& s = p.second;
  Json out = {
      {"action", p.action}, {"action_error", p.action_error}, {"path_error", p.path_error}, {"residual", p.residual}};
  out["kind"] = kind_of(s);
  out["index"] = or_null(s.index);
  out["by_inertia"] = or_null(s.by_inertia);
  out["by_fields"] = or_null(s.by_fields);
  out["concavity"] = or_null(s.concavity);
  out["nullity"] = s.nullity;
  out["nearest_eigenvalue"] = s.nearest;
  out["reason"] = s.reason;
  out["conjugate_points"] = Json::array();
  for (const ConjugatePoint& c : s.conjugate)
    out["conjugate_points"].push_back({{"t", c.t}, {"multiplicity", c.multiplicity}});
  out["start_velocity"] = by_coordinate(p.start_velocity, system);
  out["start_momentum"] = by_coordinate(p.start_momentum, system);
  out["end_momentum"] = by_coordinate(p.end_momentum, system);
  out["start_energy"] = or_null(p.start_energy);
  out["end_energy"] = or_null(p.end_energy);
  out["multipliers"] = p.multipliers;
  out["turns"] = p.turns;
  out["found_from"] = p.found_from;
  const MotionCheck& c = p.check;
  out["check"] = {{"done", c.done},     {"stretches", c.stretches}, {"missed", c.missed},
                  {"action", c.action}, {"from", c.from},           {"to", c.to},
                  {"reason", c.reason}};
  out["variations"] = variations_json(s.variations);
  return out;
}

}  // namespace

std::string action_text(const PathSearch& search, const MechanicalSystem& system) {
  std::string out = fmt::format("{}: {} stationary path{} {}\n", spoken_name(system), search.paths.size(),
                                search.paths.size() == 1 ? "" : "s", ends_text(search.ends, system));
  for (std::size_t k = 0; k < search.paths.size(); ++k) {
    const StationaryPath& p = search.paths[k];
    std::string turns;
    for (std::size_t i = 0; i < p.turns.size(); ++i)
      if (p.turns[i] != 0)
        turns += fmt::format(", {} turn{} of {} further", p.turns[i], std::abs(p.turns[i]) == 1 ? "" : "s",
                             system.coordinates[i].name);
    out += fmt::format("  path {}, found from {}{}\n", k + 1, p.found_from, turns) + path_text(p, system);
  }
  return out + "  " + search.bound + "\n";
}

Json action_json(const PathSearch& search, const MechanicalSystem& system) {
  const auto end = [&](const std::vector<std::optional<double>>& q) {
    Json out = Json::object();
    for (std::size_t i = 0; i < q.size(); ++i) out[system.coordinates[i].name] = or_null(q[i]);
    return out;
  };
  Json out = {{"start", search.ends.start}, {"end", search.ends.end},  {"from", end(search.ends.from)},
              {"to", end(search.ends.to)},  {"starts", search.starts}, {"failed", search.failed},
              {"bound", search.bound}};
  out["paths"] = Json::array();
  for (const StationaryPath& p : search.paths) out["paths"].push_back(path_json(p, system));
  return out;
}

namespace {

std::string corner_of(const PathCorner& corner, const MechanicalSystem& system) {
  return corner.row < system.coordinates.size() ? "p_" + system.coordinates[corner.row].name : "h_E";
}

std::string corner_text(const PathCorner& corner, const MechanicalSystem& system) {
  const std::string name = corner_of(corner, system), where = moment(corner.t, system);
  if (!std::isfinite(corner.before) || !std::isfinite(corner.after))
    return fmt::format("{} has no finite value at {}", name, where);
  return fmt::format("a corner at {}, where {} jumps from {:.6g} to {:.6g}", where, name, corner.before, corner.after);
}

Json corner_json(const PathCorner& corner, const MechanicalSystem& system) {
  return {{"t", corner.t},
          {"of", corner_of(corner, system)},
          {"before", finite(corner.before)},
          {"after", finite(corner.after)}};
}

}  // namespace

std::string action_text(const GivenPath& given, const MechanicalSystem& system) {
  std::string out = fmt::format("{}: the path given, from {} to {}\n", spoken_name(system), moment(given.start, system),
                                moment(given.end, system));
  out += line("S", value_of_action(given.action, given.action_error, system));
  for (std::size_t i = 0; i < given.integrals.size(); ++i) {
    const std::string& name = system.integral_constraints[i].name;
    out +=
        line("integral", fmt::format("{} = {:.16g}", name.empty() ? std::to_string(i + 1) : name, given.integrals[i]));
  }
  if (given.corner)
    out += line("stationary", "no: " + corner_text(*given.corner, system));
  else if (given.stationary)
    out += line("stationary", fmt::format("yes: the equations hold to {:.1e} of their terms", given.residual));
  else
    out += line("stationary", fmt::format("no: the equation of {} is off by {:.2g} of its terms at {}",
                                          system.coordinates[given.residual_row].name, given.residual,
                                          moment(given.residual_at, system)));
  for (const TestVariation& v : given.variations)
    out += line("neighbours", fmt::format("{:<18} dS/dε is {:.2g} of its terms", v.name, v.slope));
  return out;
}

Json action_json(const GivenPath& given, const MechanicalSystem& system) {
  return {{"start", given.start},
          {"end", given.end},
          {"action", given.action},
          {"action_error", given.action_error},
          {"integrals", given.integrals},
          {"stationary", given.stationary},
          {"residual", given.residual},
          {"residual_at", given.residual_at},
          {"residual_of", system.coordinates[given.residual_row].name},
          {"corner", given.corner ? corner_json(*given.corner, system) : Json(nullptr)},
          {"variations", variations_json(given.variations)}};
}

std::string action_text(const MotionAction& motion, const MechanicalSystem& system) {
  const StationaryPath& p = motion.path;
  std::string out = fmt::format("{}: the motion from {} to {}\n", spoken_name(system), moment(p.path.start, system),
                                moment(p.path.end, system));
  out += path_text(p, system);
  if (p.second.index && !p.second.conjugate.empty())
    out += fmt::format("  S is a minimum among paths between the same ends up to {}, and a saddle beyond.\n",
                       moment(p.second.conjugate.front().t, system));
  return out;
}

Json action_json(const MotionAction& motion, const MechanicalSystem& system) {
  Json out = path_json(motion.path, system);
  out["start"] = motion.path.path.start;
  out["end"] = motion.path.path.end;
  return out;
}

std::string action_text(const PeriodicAction& orbit, const MechanicalSystem& system) {
  std::string out = fmt::format("{}: a periodic motion as a closed path\n", spoken_name(system));
  out += line("period", with_unit(fmt::format("{:.12g}", orbit.period), system.independent_unit()));
  out += line("∮ p dq", with_unit(fmt::format("{:.12g}", orbit.abbreviated), action_unit(system)));
  return out + path_text(orbit.path, system);
}

Json action_json(const PeriodicAction& orbit, const MechanicalSystem& system) {
  Json out = path_json(orbit.path, system);
  out["period"] = orbit.period;
  out["abbreviated_action"] = orbit.abbreviated;
  return out;
}

}  // namespace maupertuis::app

#include "report/action.hpp"

#include "report/notation.hpp"

#include <maupertuis/action_pictures.hpp>

#include <fmt/format.h>

#include <cmath>

namespace maupertuis {
namespace {

std::string with_unit(double value, const std::string& unit, int digits) {
  return quantity(value, unit == "1" ? "" : unit, digits);
}

std::string kind_text(const SecondVariation& s) {
  if (!s.index) return "stationary, of unknown index: " + s.reason;
  const std::string kind = kind_of(s);
  return *s.index == 0 && s.nullity == 0 ? "a minimum of S" : fmt::format("{}, index {}", kind, *s.index);
}

std::string counts_text(const SecondVariation& s) {
  if (!s.by_inertia || !s.by_fields) return {};
  return fmt::format("{} by the inertia of the second variation, {} by Jacobi fields", *s.by_inertia, *s.by_fields);
}

std::string conjugate_text(const SecondVariation& s, const MechanicalSystem& system) {
  std::string out;
  for (const ConjugatePoint& c : s.conjugate)
    out += fmt::format("{}{} = {}{}", out.empty() ? "" : ", ", system.independent,
                       with_unit(c.t, system.independent_unit(), 7),
                       c.multiplicity > 1 ? fmt::format(" ({} times)", c.multiplicity) : "");
  return out.empty() ? "none inside" : out;
}

ReportContent::Finding finding(const StationaryPath& p, std::size_t number, const MechanicalSystem& system) {
  ReportContent::Finding out{fmt::format("Path {}", number), {}, "", {}, {}};
  const auto add = [&out](const char* name, std::string value) {
    if (!value.empty()) out.facts.emplace_back(name, std::move(value));
  };
  const std::string unit =
      system.dimensionless ? "" : to_string(system.lagrangian_dimension * system.independent_dimension);
  add("S", with_unit(p.action, unit, 12));
  add("kind", kind_text(p.second));
  add("conjugate points", conjugate_text(p.second, system));
  add("index", counts_text(p.second));
  for (const double lambda : p.multipliers) add("λ of the held integral", short_number(lambda, 9));
  if (p.check.done) add("the motion misses it by", short_number(p.check.missed, 2) + " of its size");
  return out;
}

}  // namespace

void add_action(ReportContent& content, const MechanicalSystem& system, const PathSearch& search) {
  std::vector<const StationaryPath*> paths;
  for (const StationaryPath& p : search.paths) {
    paths.push_back(&p);
    content.paths.push_back(finding(p, paths.size(), system));
  }
  content.path_search = search.bound;
  if (paths.empty()) return;
  content.path_pictures.push_back({"The paths; dots are points conjugate to the start.", paths_diagram(system, paths)});
  if (!paths.front()->second.variations.empty())
    content.path_pictures.push_back({"S on neighbours q + ε ξ of path 1: no slope where it is stationary.",
                                     neighbours_diagram(system, paths.front()->second.variations)});
}

}  // namespace maupertuis

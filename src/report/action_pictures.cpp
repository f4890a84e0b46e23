#include <maupertuis/action_pictures.hpp>

#include <fmt/format.h>

namespace maupertuis {
namespace {

constexpr int points_of_path = 400;

std::string unit_of(const Dimension& d, const MechanicalSystem& system) {
  const std::string unit = system.dimensionless ? "" : to_string(d);
  return unit == "1" ? "" : unit;
}

}  // namespace

Diagram neighbours_diagram(const MechanicalSystem& system, const std::vector<TestVariation>& variations) {
  Diagram out;
  out.x_name = "ε";
  out.y_name = "S(ε) − S(0)";
  out.y_unit = unit_of(system.lagrangian_dimension * system.independent_dimension, system);
  out.zero_line = true;
  for (std::size_t i = 0; i < variations.size(); ++i) {
    out.curves.push_back({variations[i].epsilon, variations[i].change, i, false, false});
    out.legend.push_back(
        {variations[i].name == "lowest" ? "the lowest variation" : variations[i].name, i, false, false});
  }
  return out;
}

Diagram paths_diagram(const MechanicalSystem& system, const std::vector<const StationaryPath*>& paths) {
  Diagram out;
  const auto is_length = [&](std::size_t i) {
    return system.coordinates[i].dimension.same_as(dimensions::length()) || system.dimensionless;
  };
  const bool plane = system.coordinates.size() >= 2 && is_length(0) && is_length(1) &&
                     system.coordinates[0].kind != "angle" && system.coordinates[1].kind != "angle";
  const std::size_t up = plane ? 1 : 0;
  out.x_name = plane ? system.coordinates[0].name : system.independent;
  out.x_unit = plane ? unit_of(system.coordinates[0].dimension, system) : system.independent_unit();
  out.y_name = system.coordinates[up].name;
  out.y_unit = unit_of(system.coordinates[up].dimension, system);
  for (std::size_t k = 0; k < paths.size(); ++k) {
    const ActionPath& path = paths[k]->path;
    const auto across = [&](const MotionState& s) { return plane ? s.q[0] : s.t; };
    Diagram::Curve curve;
    curve.series = k;
    for (int i = 0; i <= points_of_path; ++i) {
      const MotionState s =
          path.at(i == points_of_path ? path.end : path.start + (path.end - path.start) * i / points_of_path);
      curve.x.push_back(across(s));
      curve.y.push_back(s.q[up]);
    }
    out.curves.push_back(std::move(curve));
    const SecondVariation& second = paths[k]->second;
    out.legend.push_back({second.index ? fmt::format("{}: {}{}", k + 1, kind_of(second),
                                                     *second.index > 0 ? fmt::format(", index {}", *second.index) : "")
                                       : fmt::format("{}", k + 1),
                          k, false, false});
    for (const ConjugatePoint& c : second.conjugate) {
      const MotionState s = path.at(c.t);
      out.marks.push_back({across(s), s.q[up], ""});
    }
  }
  return out;
}

}  // namespace maupertuis

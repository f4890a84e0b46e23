#include <maupertuis/orbits.hpp>

#include <fmt/format.h>

namespace maupertuis {
namespace {

/// Of coordinate i (order 0) or its velocity (order 1); empty for numbers.
std::string unit_of(const MechanicalSystem& system, std::size_t i, int order) {
  if (system.dimensionless) return {};
  const Dimension d = system.coordinates[i].dimension;
  const std::string unit = to_string(order == 0 ? d : d / system.independent_dimension);
  return unit == "1" ? "" : unit;
}

}  // namespace

Trajectory section_rows(const SectionResult& r, const MechanicalSystem& system) {
  Trajectory out;
  out.independent = {system.independent, system.independent_unit()};
  out.columns = {{"orbit", ""}, {"number", ""}};
  for (int order = 0; order <= 1; ++order)
    for (std::size_t i = 0; i < system.coordinates.size(); ++i)
      out.columns.push_back({system.coordinates[i].name + (order ? "'" : ""), unit_of(system, i, order)});
  for (const Crossing& c : r.crossings) {
    out.times.push_back(c.state.t);
    out.values.push_back(static_cast<double>(c.orbit));
    out.values.push_back(static_cast<double>(c.number));
    out.values.insert(out.values.end(), c.state.q.begin(), c.state.q.end());
    out.values.insert(out.values.end(), c.state.v.begin(), c.state.v.end());
  }
  out.metadata["system"] = system.name;
  return out;
}

Trajectory lyapunov_rows(const LyapunovResult& r, const MechanicalSystem& system) {
  Trajectory out;
  out.independent = {system.independent, system.independent_unit()};
  for (std::size_t j = 0; j < r.exponents.size(); ++j)
    out.columns.push_back({fmt::format("λ{}", j + 1), system.dimensionless ? "" : "1/s"});
  out.times = r.times;
  out.values = r.running;
  out.metadata["system"] = system.name;
  return out;
}

}  // namespace maupertuis

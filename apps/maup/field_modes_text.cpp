#include "field_modes_text.hpp"

#include <fmt/format.h>

#include <maupertuis/coupled_fields.hpp>

#include <cmath>

namespace maupertuis::app {

std::string shape_of_bodies(const FieldEquations& equations, const FieldModes& modes, std::size_t index) {
  if (!equations.bodies || index >= modes.shapes.size()) return {};
  std::string out;
  const auto& coordinates = equations.bodies->system->coordinates;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    constexpr double rounding = 1e-10;  // beside 1
    const double value = modes.shapes[index].coordinates[i];
    out += fmt::format("{}{} {:.4g}", i ? ", " : "   ", coordinates[i].name, std::abs(value) < rounding ? 0 : value);
  }
  return out;
}

Json shapes_json(const FieldEquations& equations, const FieldModes& modes) {
  Json out{{"places", modes.places}, {"modes", Json::array()}};
  if (!modes.upwards.empty()) out["upwards"] = modes.upwards;
  for (const FieldModes::Shape& shape : modes.shapes) {
    Json one = Json::object();
    for (std::size_t a = 0; a < shape.fields.size(); ++a)
      one[equations.system().fields[equations.varied[a]].name] = shape.fields[a];
    for (std::size_t i = 0; i < shape.coordinates.size(); ++i)
      one[equations.bodies->system->coordinates[i].name] = shape.coordinates[i];
    out["modes"].push_back(one);
  }
  return out;
}

namespace {

/// Some of the places of the equilibrium, a line each along x, in the plane one along y too.
std::string values_at_places(const FieldEquations& equations, const FieldEquilibrium& found) {
  constexpr std::size_t every = 4, every_in_plane = 10;
  const bool plane = !found.upwards.empty();
  const FieldSystem& s = equations.system();
  std::string out = fmt::format("  {:>12}", s.space[0].name);
  if (plane) out += fmt::format("  {:>12}", s.space[1].name);
  for (const std::size_t field : equations.varied) out += fmt::format("  {:>20}", s.fields[field].name);
  out += "\n";
  const std::size_t step = plane ? every_in_plane : every;
  for (std::size_t j = 0; j < (plane ? found.upwards.size() : 1); j += step)
    for (std::size_t i = 0; i < found.places.size(); i += step) {
      out += fmt::format("  {:>12.6g}", found.places[i]);
      if (plane) out += fmt::format("  {:>12.6g}", found.upwards[j]);
      for (std::size_t a = 0; a < found.fields.size(); ++a) {
        const double value = found.fields[a][j * found.places.size() + i];
        out += fmt::format("  {:>20.12g}", std::abs(value) <= found.errors[a] ? 0.0 : value);
      }
      out += "\n";
    }
  return out;
}

std::string stability_of(const FieldEquilibrium& found) {
  if (!found.lowest)
    return "  no minimum of an energy: its second variation has no lower bound, or forces have no potential\n";
  // The coordinates of bodies have squares of their own, which no measure has in common with those of fields.
  if (found.falling == 0 && *found.lowest > 0 && !found.coordinates.empty())
    return "  a minimum of the energy: its second variation is positive\n";
  if (found.falling == 0 && *found.lowest > 0)
    return fmt::format("  a minimum of the energy: its second variation is at least {:.6g} in the mean square\n",
                       *found.lowest);
  if (found.falling == 0) return "  its energy does not change to second order along a displacement\n";
  return fmt::format("  no minimum: the second variation of the energy is negative along {} displacement{}\n",
                     found.falling, found.falling == 1 ? "" : "s");
}

}  // namespace

std::string equilibrium_text(const FieldEquations& equations, const FieldModes& modes) {
  if (!modes.equilibrium) return {};
  const FieldEquilibrium& found = *modes.equilibrium;
  std::string out = "Equilibrium next to the start\n" + values_at_places(equations, found);
  for (std::size_t a = 0; a < found.errors.size(); ++a)
    out += fmt::format("  {} is off by at most {:.1g}\n", equations.system().fields[equations.varied[a]].name,
                       found.errors[a]);
  for (std::size_t i = 0; i < found.coordinates.size(); ++i)
    out += fmt::format("  {} = {:.13g} ± {:.1g}\n", equations.bodies->system->coordinates[i].name, found.coordinates[i],
                       found.coordinate_errors[i]);
  out += fmt::format("  energy  {:.13g} ± {:.1g}\n", found.energy, found.energy_error);
  return out + stability_of(found);
}

Json equilibrium_json(const FieldEquations& equations, const FieldEquilibrium& found) {
  Json out{{"places", found.places}, {"fields", Json::object()}, {"errors", Json::object()}};
  if (!found.upwards.empty()) out["upwards"] = found.upwards;
  for (std::size_t a = 0; a < found.fields.size(); ++a) {
    const std::string& name = equations.system().fields[equations.varied[a]].name;
    out["fields"][name] = found.fields[a], out["errors"][name] = found.errors[a];
  }
  if (equations.bodies) out["coordinates"] = Json::object(), out["coordinate_errors"] = Json::object();
  for (std::size_t i = 0; i < found.coordinates.size(); ++i) {
    const std::string& name = equations.bodies->system->coordinates[i].name;
    out["coordinates"][name] = found.coordinates[i], out["coordinate_errors"][name] = found.coordinate_errors[i];
  }
  out["energy"] = found.energy, out["energy_error"] = found.energy_error;
  out["second_variation"] = found.lowest ? Json(*found.lowest) : Json(nullptr);
  out["falling"] = found.falling;
  return out;
}

}  // namespace maupertuis::app

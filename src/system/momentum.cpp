#include <maupertuis/integral_symbol.hpp>
#include <maupertuis/momentum.hpp>

#include <algorithm>

namespace maupertuis {
namespace {

bool is_taken(const MechanicalSystem& system, const std::string& name) {
  const auto has = [&](const auto& list) {
    return std::any_of(list.begin(), list.end(), [&](const auto& item) { return item.name == name; });
  };
  return has(system.coordinates) || has(system.parameters) || has(system.inputs) || has(system.definitions) ||
         has(system.frames) || has(system.points) || has(system.bodies) || has(system.constraints) ||
         has(system.releases);
}

}  // namespace

std::string momentum_name(const MechanicalSystem& system, std::size_t coordinate) {
  for (const char* prefix : {"p_", "P_"})
    if (const std::string name = prefix + system.coordinates[coordinate].name; !is_taken(system, name)) return name;
  return "momentum_" + system.coordinates[coordinate].name;
}

Expr momentum_symbol(const MechanicalSystem& system, std::size_t coordinate) {
  return rate_of_integral(*system.context, momentum_name(system, coordinate));
}

Expr momentum_rate_symbol(const MechanicalSystem& system, std::size_t coordinate) {
  return system.context->symbol(integral_name(momentum_name(system, coordinate)), Role::Coordinate, 2);
}

}  // namespace maupertuis

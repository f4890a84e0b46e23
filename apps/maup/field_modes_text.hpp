#pragma once
#include "json.hpp"

#include <maupertuis/field_run.hpp>

#include <cstddef>
#include <string>

namespace maupertuis::app {

/// "   u(l) 1, y 0.3": how coordinates and places move in a mode, the largest value of the field being 1; empty
/// without.
std::string shape_of_bodies(const FieldEquations& equations, const FieldModes& modes, std::size_t index);
/// [{field: [values at places], coordinate: value}], with the places.
Json shapes_json(const FieldEquations& equations, const FieldModes& modes);
/// Values of an equilibrium that was computed, its energy, and, where nothing moves, whether it is a minimum.
std::string equilibrium_text(const FieldEquations& equations, const FieldModes& modes);
Json equilibrium_json(const FieldEquations& equations, const FieldEquilibrium& found);

}  // namespace maupertuis::app

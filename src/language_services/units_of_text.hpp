#pragma once
#include <maupertuis/language_services.hpp>
#include <maupertuis/units.hpp>

#include "language_services/roles.hpp"

namespace maupertuis::language {

/// The value of a unit in SI base units.
double si_value(const Unit& unit);

/// The name of the model that a word of a quantity place stands for, the mass m in `2 m`; null where it is a unit, and
/// where the text has a mistake, so that nobody knows. Cost: an elaboration of the model.
const Declared* name_read(Document& document, std::size_t token);

}  // namespace maupertuis::language

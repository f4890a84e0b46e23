#pragma once
#include "system/elaboration.hpp"

namespace maupertuis::elaboration {

/// The unit that the words make, or nothing and a message (E0301 unknown, E0308 in a dimensionless model).
std::optional<Unit> unit_of(Elaboration& e, const syntax::UnitExpression& words);
/// True if every word is a unit.
bool all_units(const syntax::UnitExpression& words);
/// factor · π^pi_power, exactly.
Expr factor_of(Context& context, const Unit& unit);
/// The unit as it stands in the text, without brackets.
std::string written_unit(const SourceTexts& texts, const syntax::UnitExpression& words);

}  // namespace maupertuis::elaboration

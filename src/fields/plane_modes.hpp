#pragma once
#include <maupertuis/field_run.hpp>

namespace maupertuis {

/// field_modes of two space variables.
FieldModes plane_modes(const FieldEquations& equations, std::size_t count, Diagnostics& diagnostics);

}  // namespace maupertuis

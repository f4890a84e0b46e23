#pragma once
#include <maupertuis/fields.hpp>
#include <maupertuis/verification.hpp>

namespace maupertuis {

/// Carries out the `expect` and `claim` lines of a model with fields, in the order of the text.
Verification verify_fields(const Model& model, const FieldEquations& equations, const SourceText& source,
                           const SimulationOptions& options, Diagnostics& diagnostics);

}  // namespace maupertuis

#pragma once
#include "studio/requests.hpp"

#include <maupertuis/verification.hpp>

/// Lines of a model that say what must hold, carried out.
namespace maupertuis::studio {

Json result_json(const ExpectationResult& result);

/// The lines are carried out with a study of their own: a model that expects errors is judged by its diagnostics.
std::optional<Verification> verification_of(Study& study, const Interrupt& interrupt);

}  // namespace maupertuis::studio

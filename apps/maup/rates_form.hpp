#pragma once
#include "equation_forms.hpp"

namespace maupertuis::app {

/// The equations of motion in the rates of the model, or of its bodies where it names none, and q' by the rates.
EquationForm rates_form(Study& study);

}  // namespace maupertuis::app

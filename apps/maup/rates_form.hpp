#pragma once
#include "equation_forms.hpp"

namespace maupertuis::app {

/// The equations of motion in the rates of the model, or of its bodies where it names none, and q' by the rates.
EquationForm rates_form(Study& study);
/// Where no form is asked for: that in the rates that the model names; that in the angular velocities of its bodies
/// where it is shorter to read; else `standard`.
EquationForm form_in_rates_if_shorter(Study& study, const EquationForm& standard);

/// What stands below them in the text: what the rates are, L and the momenta in them.
std::string rates_text(const EquationForm& form, const EquationsOfMotion& equations);
/// σ = Y q' + y, a line a rate.
std::vector<FormulaLine> rate_definitions(const EquationForm& form, const EquationsOfMotion& equations);
/// The textbook path to the equations of the form: of that in rates up to L, and from there by its own steps.
std::vector<DerivationStep> steps_to(const EquationForm& form, Study& study);
/// The certificate with what the zero test said of the form in rates.
Certificate with_rates_check(Certificate certificate, const EquationForm& form);

}  // namespace maupertuis::app

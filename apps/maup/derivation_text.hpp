#pragma once
#include "equation_forms.hpp"
#include "json.hpp"

namespace maupertuis::app {

/// The whole answer of `maup derive` for a reader: steps if asked for, equations, momenta, energy, what is conserved,
/// and the certificate.
std::string lecture(Study& study, const EquationForm& form, const Certificate& certificate, bool with_steps);

/// The equations alone, a line each, with what the names in them stand for.
std::string equations_text(const EquationForm& form, const ReadingOrder& order);

/// The checks of a certificate, a line each, under a head.
std::string verdict_of(const Certificate& certificate);
std::string certificate_text(const Certificate& certificate);

/// The textbook path, a line a step, and what the names in it stand for.
std::vector<FormulaLine> step_lines(const std::vector<DerivationStep>& steps, const MechanicalSystem& system,
                                    const ReadingOrder& order);
/// [{section, rule, left, right, latex, sentence}]
Json steps_json(const std::vector<DerivationStep>& steps, const ReadingOrder& order);

}  // namespace maupertuis::app

#pragma once
#include "json.hpp"

#include <maupertuis/locus.hpp>
#include <maupertuis/modes.hpp>
#include <maupertuis/orbits.hpp>
#include <maupertuis/regulator.hpp>
#include <maupertuis/resting_modes.hpp>
#include <maupertuis/symbolic_linearization.hpp>

#include <string>

namespace maupertuis::app {

/// What was found, and of the first entries (one for each of `formulas`) the matrices, as far as they fit a line, and
/// the modes. `outputs`: what is measured, as written. `neighbours`: of the first entries of a driven system, whose
/// coefficients change with the time, the multipliers that stand in the place of modes.
std::string modes_text(const MechanicalSystem& system, const ModalStudy& study,
                       const std::vector<std::optional<SymbolicLinearization>>& formulas, const ReadingOrder& order,
                       const std::vector<std::string>& outputs,
                       const std::vector<std::optional<FloquetResult>>& neighbours);
Json modes_document(const MechanicalSystem& system, const ModalStudy& study);
/// A mode of contacts with its points of rest, and what static friction holds there.
std::string resting_text(const RestingMode& mode, bool first);
Json resting_document(const RestingMode& mode);
Json symbolic_json(const SymbolicLinearization& formulas, const ReadingOrder& order);
std::string regulator_text(const MechanicalSystem& system, const Linearization& linearization,
                           const Regulator& regulator);
Json regulator_json(const Regulator& regulator);
std::string locus_text(const MechanicalSystem& system, const Locus& locus);
Json locus_document(const MechanicalSystem& system, const Locus& locus);

}  // namespace maupertuis::app

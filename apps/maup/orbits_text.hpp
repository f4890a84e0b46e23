#pragma once
#include "json.hpp"

#include <maupertuis/orbits.hpp>

#include <string>

/// What `maup orbits` says: text as a reader wants it, documents for programs.
namespace maupertuis::app {

/// The period; then what becomes of neighbours: multipliers, stability, checks.
std::string period_text(const FloquetResult& result, const MechanicalSystem& system);
std::string neighbours_text(const FloquetResult& result);
std::string stability_sentence(const FloquetResult& result);
std::string floquet_text(const FloquetResult& result, const MechanicalSystem& system);
Json floquet_json(const FloquetResult& result, const MechanicalSystem& system);

/// `what`: the section as written, or "strobe every 2 s".
std::string section_text(const SectionResult& result, const std::string& what, const MechanicalSystem& system);
Json section_json(const SectionResult& result, const std::string& what, const MechanicalSystem& system);

std::string lyapunov_text(const LyapunovResult& result);
Json lyapunov_json(const LyapunovResult& result);

}  // namespace maupertuis::app

#pragma once
#include "json.hpp"

#include <maupertuis/field_run.hpp>
#include <maupertuis/simulation.hpp>

#include <string>

namespace maupertuis::app {

/// What a run has to tell of contacts, friction and events. Refers to the run.
struct Chronicle {
  const std::string& first_mode;
  const std::vector<Happening>& happenings;
  const std::optional<EnergyBooks>& books;
  const std::vector<std::string>& remarks;
  bool of_mesh = false;  // moments are known to what a mesh is good for, not to all digits
};
inline Chronicle chronicle_of(const SimulationResult& run) {
  return {run.first_mode, run.happenings, run.books, run.remarks};
}
inline Chronicle chronicle_of(const FieldRunResult& run) {
  return {run.first_mode, run.happenings, run.books, run.remarks, true};
}

/// How it begins, the first and the last happenings, a line each, remarks, where the energy went.
std::string happenings_text(const Chronicle& run, const MechanicalSystem& system);

/// "events" with all of them, "first_mode", "energy_books", "remarks".
void put_happenings(Json& document, const Chronicle& run, const MechanicalSystem& system);

}  // namespace maupertuis::app

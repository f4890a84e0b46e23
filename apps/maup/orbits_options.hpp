#pragma once
#include "command.hpp"
#include "study.hpp"

#include <maupertuis/orbits.hpp>

#include <memory>
#include <optional>
#include <string>

namespace maupertuis::app {

/// What `maup orbits` and `maup report` may be asked about periodic motions, sections and exponents.
struct OrbitsOptions {
  bool floquet = false, lyapunov = false;
  std::string section;
  std::optional<std::string> period, strobe, longest, interval, transient;  // as written
  std::optional<double> energy;
  std::size_t crossings = 500, starts = 1, exponents = 0;

  bool has_section() const { return !section.empty() || strobe; }
};

void add_orbits_options(Command& command, OrbitsOptions& options);
/// Times that are none, --section beside --strobe (E0809).
void check_orbits_options(const OrbitsOptions& options, Diagnostics& diagnostics);

FloquetOptions floquet_options(const OrbitsOptions& options);
LyapunovOptions lyapunov_options(const OrbitsOptions& options);

/// A section as the model of its own that it is read in: the equation stands in the place of the condition of `run
/// until`, so that it may hold whatever a condition may. Spans of its diagnostics are in that text.
struct SectionStudy {
  std::unique_ptr<Study> study;
  SectionOptions options;
  std::string what;  // "section x = 0 rising", "strobe every 2 s"
};
SectionStudy section_study(const OrbitsOptions& options, const ModelOptions& model, Study& as_written);

}  // namespace maupertuis::app

#pragma once
#include "command.hpp"
#include "open_study.hpp"

#include <maupertuis/orbits.hpp>

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
/// Times that are none or have two meanings, --section beside --strobe (E0809). `tree`: of the model; may be null.
void check_orbits_options(const OrbitsOptions& options, const syntax::SyntaxTree* tree, Diagnostics& diagnostics);

FloquetOptions floquet_options(const OrbitsOptions& options);
LyapunovOptions lyapunov_options(const OrbitsOptions& options);

/// Says the equation of --section beside the model. Precondition: the study has no model yet.
void put_in_section(const OrbitsOptions& options, Study& study);
/// Precondition: the study has a model.
SectionOptions section_options(const OrbitsOptions& options, Study& study);
/// "section x = 0 rising", "strobe every 2 s"
std::string section_text(const OrbitsOptions& options);

}  // namespace maupertuis::app

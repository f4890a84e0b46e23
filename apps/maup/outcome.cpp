#include "outcome.hpp"

#include <algorithm>
#include <maupertuis/trajectory.hpp>

namespace maupertuis::app {

namespace {

/// The file could not be read at all: nothing is known of the model.
bool unreadable(const Diagnostics& diagnostics) {
  const auto items = diagnostics.items();
  return std::any_of(items.begin(), items.end(), [](const Diagnostic& d) {
    return d.code == "E0801" || d.code == "E0802" || d.code == "E0803";
  });
}

}  // namespace

ExitCode finish(Console& console, Study& study, Json document) {
  if (console.json()) {
    document["ok"] = !study.wrong();
    document["diagnostics"] = to_json(study.diagnostics(), study.source());
    console.print_document(document);
  } else {
    console.show(study.diagnostics(), study.source());
  }
  if (unreadable(study.diagnostics())) return ExitCode::Usage;
  return study.wrong() ? ExitCode::ModelWrong : ExitCode::Fine;
}

void cannot_write(const std::string& failure, Diagnostics& diagnostics) {
  diagnostics.error("E0804", {}, failure + ".", {}, "What was there before is untouched.");
}

bool write_result(const std::string& path, const std::string& content, Diagnostics& diagnostics) {
  const std::string failure = write_file(path, content);
  if (!failure.empty()) cannot_write(failure, diagnostics);
  return failure.empty();
}

}  // namespace maupertuis::app

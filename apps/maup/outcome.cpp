#include "outcome.hpp"

#include <maupertuis/trajectory.hpp>

namespace maupertuis::app {

ExitCode finish(Console& console, Study& study, Json document) {
  if (console.json()) {
    document["ok"] = !study.wrong();
    document["diagnostics"] = to_json(study.diagnostics(), study.source());
    console.print_document(document);
  } else {
    console.show(study.diagnostics(), study.source());
  }
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

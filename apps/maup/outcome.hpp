#pragma once
#include "console.hpp"
#include "exit_code.hpp"
#include "json.hpp"
#include "study.hpp"

namespace maupertuis::app {

/// Ends a command that prints one document: the diagnostics go to standard error, or into the document under --json.
/// Returns Usage if the file could not be read, ModelWrong if there are other errors, else Fine.
ExitCode finish(Console& console, Study& study, Json document);

/// Writes a file the user asked for; false and E0804 when that fails.
bool write_result(const std::string& path, const std::string& content, Diagnostics& diagnostics);
/// The diagnostic of it; `failure` is the sentence of the writer.
void cannot_write(const std::string& failure, Diagnostics& diagnostics);

}  // namespace maupertuis::app

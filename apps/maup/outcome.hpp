#pragma once
#include "console.hpp"
#include "exit_code.hpp"
#include "json.hpp"
#include "numbers.hpp"
#include "open_study.hpp"

#include <maupertuis/trajectory.hpp>

#include <span>

namespace maupertuis::app {

/// How an answer calls the model at its head: by its name, or "the model" where it has none.
std::string spoken_name(const MechanicalSystem& system);

/// The file could not be read at all: nothing is known of the model.
bool unreadable(const Diagnostics& diagnostics);
/// Of several files the worst: Ctrl-C, a file that could not be read, a wrong model, a failed expectation.
ExitCode worse(ExitCode a, ExitCode b);

/// Ends a command that prints one document: the diagnostics go to standard error, or into the document under --json.
/// Returns Usage if the file could not be read, RunFailed if the document holds a NaN or an infinity (E0816),
/// ModelWrong if there are other errors, else Fine.
ExitCode finish(Console& console, Study& study, Json document);

/// What a study found, to be printed or to stand in the document under its kind.
struct Answer {
  const char* kind = "";
  std::string text;
  Json json;
};
/// Ends a command that found something and has written its files: RunFailed where one could not be written.
ExitCode finish_with(Console& console, Study& study, const char* command, const Answer& answer);
/// Ends a command that found nothing, and the diagnostics say why: Interrupted after Ctrl-C, RunFailed where the model
/// is read.
ExitCode finish_without(Console& console, Study& study, const char* command);
/// Ends a command whose options have no sense.
ExitCode finish_usage(Console& console, Study& study, const char* command);

/// Writes a file the user asked for; false and E0804 when that fails.
bool write_result(const std::string& path, const std::string& content, Diagnostics& diagnostics);
/// The same for a picture, in the format of the ending: .svg, .png or .pdf.
bool write_picture(const std::string& path, const std::string& svg, Diagnostics& diagnostics);
/// The same for rows, in the format of the ending; an empty path asks for nothing. Columns of the names `open` may hold
/// what is no finite number; others that do are told (E0816) and left out, and no file is written where none is left.
bool write_rows(const std::string& path, const Trajectory& rows, Diagnostics& diagnostics,
                std::span<const std::string> open = {}, const WrittenColumns& written = {});
/// N0844: a drawing whose frames do not follow the motion.
void note_moments_only(Diagnostics& diagnostics);
/// The diagnostic of it; `failure` is the sentence of the writer.
void cannot_write(const std::string& failure, Diagnostics& diagnostics);

}  // namespace maupertuis::app

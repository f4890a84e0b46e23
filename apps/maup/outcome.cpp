#include "outcome.hpp"

#include "interrupt.hpp"
#include "numbers.hpp"

#include <maupertuis/picture.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis::app {

std::string spoken_name(const MechanicalSystem& system) { return system.name.empty() ? "the model" : system.name; }

bool unreadable(const Diagnostics& diagnostics) {
  const auto items = diagnostics.items();
  return std::any_of(items.begin(), items.end(),
                     [](const Diagnostic& d) { return d.code == "E0801" || d.code == "E0802" || d.code == "E0803"; });
}

ExitCode worse(ExitCode a, ExitCode b) {
  for (const ExitCode code :
       {ExitCode::Interrupted, ExitCode::Usage, ExitCode::ModelWrong, ExitCode::ExpectationFailed})
    if (a == code || b == code) return code;
  return ExitCode::Fine;
}

namespace {

/// False where a number in it is none.
bool print_checked(Console& console, Study& study, Json& document) {
  const Saving saving;
  const bool numbers = check_numbers(document, study.diagnostics());
  if (console.json()) {
    const bool ended_well = !document.contains("ended") || document["ended"].value("ok", true);
    document["ok"] = !study.wrong() && !interrupt_flag() && ended_well;
    if (interrupt_flag()) document["interrupted"] = true;
    document["diagnostics"] = to_json(study.diagnostics(), study.texts());
    console.print_document(document);
  }
  return numbers;
}

}  // namespace

ExitCode finish(Console& console, Study& study, Json document) {
  const bool numbers = print_checked(console, study, document);
  if (!console.json()) console.show(study.diagnostics(), study.texts());
  if (unreadable(study.diagnostics()) || only_options_are_wrong(study)) return ExitCode::Usage;
  if (!numbers) return ExitCode::RunFailed;
  return study.wrong() ? ExitCode::ModelWrong : ExitCode::Fine;
}

ExitCode finish_with(Console& console, Study& study, const char* command, const Answer& answer) {
  if (!console.json()) console.print(answer.text);
  Json document = json_document(command);
  document["system"] = study.model()->system.name;
  document[answer.kind] = answer.json;
  const bool written = !study.wrong();
  const ExitCode told = finish(console, study, document);
  return written && told == ExitCode::Fine ? ExitCode::Fine : ExitCode::RunFailed;
}

/// An analysis that was told to stop did not find that the motion ends there, or that nothing converges: its errors
/// (E10xx to E14xx) speak of the interrupt alone, which the console tells.
static Diagnostics without_findings(const Diagnostics& all) {
  Diagnostics out;
  for (const Diagnostic& d : all.items())
    if (!d.code.starts_with("E1")) out.append(d);
  return out;
}

ExitCode finish_without(Console& console, Study& study, const char* command) {
  if (interrupt_flag().load()) study.diagnostics() = without_findings(study.diagnostics());
  const ExitCode code = finish(console, study, json_document(command));
  if (interrupt_flag().load()) return ExitCode::Interrupted;
  return code == ExitCode::ModelWrong ? ExitCode::RunFailed : code;
}

ExitCode finish_usage(Console& console, Study& study, const char* command) {
  finish(console, study, json_document(command));
  return ExitCode::Usage;
}

bool write_rows(const std::string& path, const Trajectory& rows, Diagnostics& diagnostics,
                std::span<const std::string> open, const WrittenColumns& written) {
  if (path.empty()) return check_numbers(rows, diagnostics, open, {}, written);
  const Saving saving(path);
  Diagnostics none;
  const bool numbers = check_numbers(rows, none, open);
  const Trajectory kept = numbers ? Trajectory{} : columns_of_numbers(rows, open);
  const bool nothing_left = !numbers && kept.columns.empty();
  if (!numbers)
    check_numbers(rows, diagnostics, open,
                  nothing_left ? fmt::format("No column is left, and {} was not written.", path)
                               : fmt::format("Columns that hold such a value are left out of {}.", path),
                  written);
  if (nothing_left) return false;
  const std::string failure = write_trajectory(numbers ? rows : kept, path);
  if (!failure.empty()) cannot_write(failure, diagnostics);
  return numbers && failure.empty();
}

void cannot_write(const std::string& failure, Diagnostics& diagnostics) {
  diagnostics.error("E0804", {}, failure + ".", {}, "What was there before is untouched.");
}

bool write_result(const std::string& path, const std::string& content, Diagnostics& diagnostics) {
  const Saving saving(path);
  const std::string failure = write_file(path, content);
  if (!failure.empty()) cannot_write(failure, diagnostics);
  return failure.empty();
}

void note_moments_only(Diagnostics& diagnostics) {
  diagnostics.note("N0844", {}, "the motion swings faster than the frames of its drawing follow",
                   "Each frame is a true moment; from one to the next it may seem to go slowly, or backwards.",
                   "Show less of it, such as `--duration 1s`; a film also goes more slowly, `--speed 0.01`.");
}

bool write_picture(const std::string& path, const std::string& svg, Diagnostics& diagnostics) {
  if (!path.ends_with(".png") && !path.ends_with(".pdf")) return write_result(path, svg, diagnostics);
  const PictureBytes picture = path.ends_with(".png") ? png_of(svg) : pdf_of(svg);
  if (picture.problem.empty()) return write_result(path, picture.bytes, diagnostics);
  diagnostics.error("E0840", {}, fmt::format("{} cannot be made: {}.", path, picture.problem), {},
                    "Take .svg, which needs nothing else.");
  return false;
}

}  // namespace maupertuis::app

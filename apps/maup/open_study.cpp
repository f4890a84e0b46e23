#include "open_study.hpp"

#include "interrupt.hpp"
#include "read_file.hpp"

#include <algorithm>

namespace maupertuis::app {

Study open_study(const std::string& path) {
  Diagnostics found;
  SourceText text(display_name(path), read_file(path, found));
  Study study(std::move(text), &interrupt_flag());
  study.diagnostics().append(found);
  return study;
}

namespace {

void put_in(Study& study, const ModelOptions& options) {
  for (const std::string& typed : options.set) study.override_with(OverrideKind::Parameters, "--set", typed);
  for (const std::string& typed : options.start) study.override_with(OverrideKind::Start, "--start", typed);
}

}  // namespace

Study open_study(const ModelOptions& options) {
  Study study = open_study(options.path);
  put_in(study, options);
  if (options.mode) study.fix_mode(*options.mode);
  return study;
}

Study study_in_mode(const SourceText& source, const ModelOptions& options, const std::string& mode,
                    const Interrupt& interrupt) {
  Study study(source, interrupt);
  put_in(study, options);
  study.fix_mode(mode);
  return study;
}

void refuse_option(Study& study, const std::string& option, const std::string& typed, std::string message,
                   std::string reason, std::string help, std::optional<Span> piece) {
  const SourceId text = study.add_text(option, typed);
  Span place = piece.value_or(Span{0, static_cast<std::uint32_t>(typed.size())});
  place.source = text;
  study.diagnostics().error("E0809", place, std::move(message), std::move(reason), std::move(help));
}

namespace {

/// What a run or a search does not find was asked for rightly.
bool is_of_a_search(const std::string& code) {
  const std::string stage = code.substr(0, 3);
  return stage == "E07" || stage == "E12" || code == "E1302" || code == "E1307";
}

}  // namespace

bool only_options_are_wrong(const Study& study) {
  const auto items = study.diagnostics().items();
  return study.wrong() && std::all_of(items.begin(), items.end(), [](const Diagnostic& d) {
           return d.severity != Severity::Error || (d.span && d.span->source != 0 && !is_of_a_search(d.code));
         });
}

}  // namespace maupertuis::app

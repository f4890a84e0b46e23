#pragma once
#include "command.hpp"

#include <maupertuis/study.hpp>

#include <optional>
#include <string>

namespace maupertuis::app {

/// The study of a file, "-" for standard input, that Ctrl-C interrupts. What cannot be read is an error of it (E0801 to
/// E0803).
Study open_study(const std::string& path);
/// The same with the values of --set and --start.
Study open_study(const ModelOptions& options);
/// The same with a text that is there, in this mode of contacts and frictions.
Study study_in_mode(const SourceText& source, const ModelOptions& options, const std::string& mode,
                    const Interrupt& interrupt);

/// E0809 about what an option said, or a piece of it.
void refuse_option(Study& study, const std::string& option, const std::string& typed, std::string message,
                   std::string reason = {}, std::string help = {}, std::optional<Span> piece = {});
/// Every error is one in what an option said: the model is as it should be.
bool only_options_are_wrong(const Study& study);

}  // namespace maupertuis::app

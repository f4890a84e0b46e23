#pragma once
#include <maupertuis/diagnostic.hpp>

#include <string>

namespace maupertuis::elaboration {

/// E0224: a value that was given beside the model is none of it. The message repeats what was given: "--set k=2: …".
void refuse_override(const SourceText& text, Span span, const std::string& message, std::string reason,
                     std::string help, Diagnostics& diagnostics);
/// The first error of `found` as one of the text; true if there was any.
bool tell_of_override(const Diagnostics& found, const SourceText& text, Diagnostics& diagnostics);

}  // namespace maupertuis::elaboration

#pragma once
#include <maupertuis/diagnostic.hpp>

#include <string>

namespace maupertuis::app {

/// The whole text of a file, or of standard input for "-". What cannot be read is a diagnostic (E0801 to E0803), and
/// the text is empty. At most 64 MiB are read, so that an endless device ends too.
std::string read_file(const std::string& path, Diagnostics& diagnostics);

/// How messages name the file: the path, or "standard input".
std::string display_name(const std::string& path);

}  // namespace maupertuis::app

#pragma once
#include <string>
#include <vector>

namespace maupertuis::app {

enum class Notation { Plain, Latex, Mathml };

/// Prose inside \text{}: the preamble of latex_document declares the letters and signs that it may hold.
std::string latex_text(const std::string& text);
std::string xml_text(const std::string& text);

/// A LaTeX document that compiles by itself, with one aligned display.
std::string latex_document(const std::vector<std::string>& lines);
/// One <math> element with a table of lines.
std::string mathml_document(const std::vector<std::string>& rows);

}  // namespace maupertuis::app

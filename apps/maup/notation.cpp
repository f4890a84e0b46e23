#include "notation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>
#include <utility>

namespace maupertuis::app {
namespace {

/// The letters and signs of rules and sentences that pdflatex does not know by itself.
std::string unicode_declarations() {
  constexpr std::pair<const char*, const char*> signs[] = {
      {"03B1", "\\alpha"}, {"03B2", "\\beta"}, {"03B3", "\\gamma"}, {"03B4", "\\delta"}, {"03B5", "\\varepsilon"},
      {"03B6", "\\zeta"}, {"03B7", "\\eta"}, {"03B8", "\\theta"}, {"03B9", "\\iota"}, {"03BA", "\\kappa"},
      {"03BB", "\\lambda"}, {"03BC", "\\mu"}, {"03BD", "\\nu"}, {"03BE", "\\xi"}, {"03BF", "o"}, {"03C0", "\\pi"},
      {"03C1", "\\rho"}, {"03C3", "\\sigma"}, {"03C4", "\\tau"}, {"03C5", "\\upsilon"}, {"03C6", "\\varphi"},
      {"03C7", "\\chi"}, {"03C8", "\\psi"}, {"03C9", "\\omega"}, {"0393", "\\Gamma"}, {"0394", "\\Delta"},
      {"0398", "\\Theta"}, {"039B", "\\Lambda"}, {"039E", "\\Xi"}, {"03A0", "\\Pi"}, {"03A3", "\\Sigma"},
      {"03A5", "\\Upsilon"}, {"03A6", "\\Phi"}, {"03A8", "\\Psi"}, {"03A9", "\\Omega"}, {"2202", "\\partial"},
      {"2211", "\\sum"}, {"2212", "-"}, {"22C5", "\\cdot"}, {"2248", "\\approx"}, {"2261", "\\equiv"},
      {"2260", "\\ne"}, {"1E59", "\\dot{r}"}, {"1E8B", "\\dot{x}"}, {"1E8F", "\\dot{y}"}, {"0307", "\\dot{}"},
      {"0308", "\\ddot{}"}, {"2080", "{}_0"}, {"2081", "{}_1"}, {"2082", "{}_2"}, {"1D40", "{}^{T}"},
      {"207B", "{}^{-}"}, {"00B9", "{}^{1}"}, {"1D62", "{}_i"}, {"2C7C", "{}_j"}, {"2192", "\\to"}};
  std::string out;
  for (const auto& [code, command] : signs)
    out += fmt::format("\\DeclareUnicodeCharacter{{{}}}{{\\ensuremath{{{}}}}}\n", code, command);
  return out;
}

}  // namespace

std::string latex_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '^' || c == '~' || c == '\\') {
      out += fmt::format("\\char{} ", static_cast<int>(c));
      continue;
    }
    if (std::string_view("#$%&_{}").find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

std::string xml_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '&') out += "&amp;";
    else out += c;
  }
  return out;
}

std::string latex_document(const std::vector<std::string>& lines) {
  return fmt::format(
      "\\documentclass{{article}}\n\\usepackage[a3paper,landscape,margin=2cm]{{geometry}}\n\\usepackage{{amsmath}}\n"
      "\\allowdisplaybreaks\n{}\\begin{{document}}\n\\begin{{align*}}\n{}\n\\end{{align*}}\n\\end{{document}}\n",
      unicode_declarations(), fmt::join(lines, " \\\\\n"));
}

std::string mathml_document(const std::vector<std::string>& rows) {
  std::string out = "<math xmlns=\"http://www.w3.org/1998/Math/MathML\" display=\"block\">\n<mtable columnalign=\"left\">\n";
  for (const std::string& row : rows) out += "<mtr><mtd><mrow>" + row + "</mrow></mtd></mtr>\n";
  return out + "</mtable>\n</math>\n";
}

}  // namespace maupertuis::app

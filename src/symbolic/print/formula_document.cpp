#include <maupertuis/formula_document.hpp>

#include <maupertuis/escape_xml.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <set>
#include <string_view>
#include <utility>

namespace maupertuis {
namespace {

/// The letters and signs of rules and sentences that pdflatex does not know by itself.
std::string unicode_declarations() {
  constexpr std::pair<const char*, const char*> signs[] = {
      {"03B1", "\\alpha"},      {"03B2", "\\beta"},  {"03B3", "\\gamma"},  {"03B4", "\\delta"},
      {"03B5", "\\varepsilon"}, {"03B6", "\\zeta"},  {"03B7", "\\eta"},    {"03B8", "\\theta"},
      {"03B9", "\\iota"},       {"03BA", "\\kappa"}, {"03BB", "\\lambda"}, {"03BC", "\\mu"},
      {"03BD", "\\nu"},         {"03BE", "\\xi"},    {"03BF", "o"},        {"03C0", "\\pi"},
      {"03C1", "\\rho"},        {"03C3", "\\sigma"}, {"03C4", "\\tau"},    {"03C5", "\\upsilon"},
      {"03C6", "\\varphi"},     {"03C7", "\\chi"},   {"03C8", "\\psi"},    {"03C9", "\\omega"},
      {"0393", "\\Gamma"},      {"0394", "\\Delta"}, {"0398", "\\Theta"},  {"039B", "\\Lambda"},
      {"039E", "\\Xi"},         {"03A0", "\\Pi"},    {"03A3", "\\Sigma"},  {"03A5", "\\Upsilon"},
      {"03A6", "\\Phi"},        {"03A8", "\\Psi"},   {"03A9", "\\Omega"},  {"2202", "\\partial"},
      {"2211", "\\sum"},        {"2212", "-"},       {"22C5", "\\cdot"},   {"2248", "\\approx"},
      {"2261", "\\equiv"},      {"2260", "\\ne"},    {"1E59", "\\dot{r}"}, {"1E8B", "\\dot{x}"},
      {"1E8F", "\\dot{y}"},     {"0307", "\\dot{}"}, {"0308", "\\ddot{}"}, {"2080", "{}_0"},
      {"2081", "{}_1"},         {"2082", "{}_2"},    {"1D40", "{}^{T}"},   {"207B", "{}^{-}"},
      {"00B9", "{}^{1}"},       {"1D62", "{}_i"},    {"2C7C", "{}_j"},     {"2192", "\\to"},
      {"2112", "\\mathcal{L}"}};
  std::string out;
  for (const auto& [code, command] : signs)
    out += fmt::format("\\DeclareUnicodeCharacter{{{}}}{{\\ensuremath{{{}}}}}\n", code, command);
  return out;
}

std::string latex_prose(std::string_view text) {
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

// ------------------------------------------------------------------------------------------------------------ LaTeX

constexpr double page_width = 46;   // em of 10 pt that fit into a line of the document, with room for what is estimated
constexpr double widest_left = 12;  // of a left side that lines are aligned at
constexpr double indent = 2;        // of what follows on further lines

/// An equation that begins at the margin, or `left &= right`: then `left_column` em are taken.
std::string latex_line(const FormulaLine& line, double left_column, bool aligned) {
  const double room = page_width - left_column;
  const bool apart = !line.left.empty() && (aligned || width(line.left) <= widest_left);
  std::vector<Layout> lines;
  if (apart)
    lines = broken_lines({}, line.right, room, room - indent);
  else
    lines = broken_lines(line.left, line.right, room, room - indent);
  std::string out = apart ? to_latex(line.left) + " &= " : "& ";
  for (std::size_t i = 0; i < lines.size(); ++i) out += (i ? " \\\\\n&\\quad " : "") + to_latex(lines[i]);
  if (line.note.empty()) return out;
  constexpr std::size_t longest_note = 60;
  const std::string note = fmt::format("\\text{{\\small {}}}", latex_prose(line.note));
  return out + (line.note.size() <= longest_note
                    ? fmt::format(" \\tag*{{{}}}", note)
                    : fmt::format(" \\tag*{{\\parbox{{7cm}}{{\\raggedleft\\small {}}}}}", latex_prose(line.note)));
}

/// Formulas that stand under each other. They are aligned at their signs where each fits into a line.
std::string latex_display(const std::vector<const FormulaLine*>& lines) {
  double left = 0, named = 0, right = 0;
  for (const FormulaLine* line : lines) {
    const double own = width(line->left);
    left = std::max(left, own);
    if (own <= widest_left) named = std::max(named, own);
    right = std::max(right, width(line->right));
  }
  const bool aligned = left + right + 2 <= page_width;
  std::vector<std::string> rows;
  for (const FormulaLine* line : lines) rows.push_back(latex_line(*line, (aligned ? left : named) + 2, aligned));
  return fmt::format("\\begin{{align*}}\n{}\n\\end{{align*}}\n", fmt::join(rows, " \\\\\n"));
}

/// Letters that neither LaTeX nor the declarations know are shown by their code.
std::string other_letters(std::string_view text, std::string_view declared) {
  std::set<std::uint32_t> codes;
  for (std::size_t at = 0; at < text.size();) {
    const auto lead = static_cast<unsigned char>(text[at]);
    const std::size_t size = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
    std::uint32_t code = size == 1 ? lead : lead & (0xFFu >> (size + 1));
    for (std::size_t i = 1; i < size && at + i < text.size(); ++i)
      code = code << 6 | (static_cast<unsigned char>(text[at + i]) & 0x3Fu);
    if (code > 0x17F) codes.insert(code);
    at += size;
  }
  std::string out;
  for (const std::uint32_t code : codes)
    if (const std::string name = fmt::format("{:04X}", code); declared.find("{" + name + "}") == std::string_view::npos)
      out += fmt::format("\\DeclareUnicodeCharacter{{{0}}}{{\\fbox{{\\tiny {0}}}}}\n", name);
  return out;
}

std::string latex_document(const std::vector<FormulaLine>& lines) {
  std::string body, section;
  std::vector<const FormulaLine*> display;
  const auto end_display = [&] {
    if (!display.empty()) body += latex_display(display);
    display.clear();
  };
  for (const FormulaLine& line : lines) {
    if (line.section != section) {
      end_display();
      section = line.section;
      if (!section.empty()) body += fmt::format("\\subsection*{{{}}}\n", latex_prose(section));
    }
    if (!line.right.empty())
      display.push_back(&line);
    else
      end_display(), body += fmt::format("{}\\par\n", latex_prose(line.sentence));
  }
  end_display();
  const std::string declared = unicode_declarations();
  return fmt::format(
      "\\documentclass[fleqn]{{article}}\n\\usepackage[a4paper,margin=2cm]{{geometry}}\n\\usepackage{{amsmath}}\n"
      "\\setlength{{\\mathindent}}{{0pt}}\n\\setlength{{\\parindent}}{{0pt}}\n\\allowdisplaybreaks\n{}{}\\begin{{"
      "document}}\n{}\\end{{document}}\n",
      declared, other_letters(body, declared), body);
}

// ----------------------------------------------------------------------------------------------------------- MathML

constexpr double mathml_width = 60;

std::string mathml_document(const std::vector<FormulaLine>& lines) {
  std::string out =
      "<math xmlns=\"http://www.w3.org/1998/Math/MathML\" display=\"block\">\n<mtable columnalign=\"left\" "
      "displaystyle=\"true\">\n";
  const auto row = [&](const std::string& content) { out += "<mtr><mtd><mrow>" + content + "</mrow></mtd></mtr>\n"; };
  for (const FormulaLine& line : lines) {
    if (line.right.empty()) {
      row(fmt::format("<mtext>{}</mtext>", escape_xml(line.sentence)));
      continue;
    }
    const std::vector<Layout> pieces = broken_lines(line.left, line.right, mathml_width, mathml_width - indent);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const bool last = i + 1 == pieces.size();
      row((i ? "<mspace width=\"2em\"/>" : "") + to_mathml(pieces[i]) +
          (last && !line.note.empty() ? fmt::format("<mtext>\u2003({})</mtext>", escape_xml(line.note)) : ""));
    }
  }
  return out + "</mtable>\n</math>\n";
}

// ------------------------------------------------------------------------------------------------------------ plain

std::string plain_document(const std::vector<FormulaLine>& lines) {
  std::string out;
  for (const FormulaLine& line : lines) {
    if (line.right.empty())
      out += "# " + line.sentence + "\n";
    else
      out += fmt::format("{}{}{}{}\n", line.known ? "# " : "", line.declared.empty() ? "" : line.declared + " ",
                         plain_text(line), line.note.empty() ? "" : "    # " + line.note);
  }
  return out;
}

}  // namespace

std::string plain_text(const FormulaLine& line) {
  return (line.left.empty() ? std::string() : to_plain(line.left) + " = ") + to_plain(line.right);
}

std::string latex_text(const FormulaLine& line) {
  return (line.left.empty() ? std::string() : to_latex(line.left) + " = ") + to_latex(line.right);
}

std::string identifier(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool kept = (c & 0x80) || std::isalnum(static_cast<unsigned char>(c));
    if (kept)
      out += c;
    else if (!out.empty() && out.back() != '_')
      out += '_';
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  return out;
}

std::string document(const std::vector<FormulaLine>& lines, Notation notation) {
  switch (notation) {
    case Notation::Plain:
      return plain_document(lines);
    case Notation::Latex:
      return latex_document(lines);
    case Notation::Mathml:
      return mathml_document(lines);
  }
  return {};
}

}  // namespace maupertuis

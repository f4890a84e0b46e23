#include "studio/shapes.hpp"

#include <maupertuis/math_markup.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis::studio {
namespace {

/// Bytes of the character that begins here, and its UTF-16 units.
struct Character {
  std::uint32_t bytes = 1, units = 1;
};
Character character_at(std::string_view text, std::size_t at) {
  const auto lead = static_cast<unsigned char>(text[at]);
  const std::uint32_t length = lead >= 0xf0 && lead < 0xf8 ? 4 : lead >= 0xe0 ? 3 : lead >= 0xc2 ? 2 : 1;
  if (length == 1 || lead >= 0xf8 || at + length > text.size()) return {};
  for (std::uint32_t i = 1; i < length; ++i)
    if ((static_cast<unsigned char>(text[at + i]) & 0xc0) != 0x80) return {};
  return {length, length == 4 ? 2u : 1u};
}

}  // namespace

Units::Units(std::string_view text) : text_(text) {
  marks_.push_back({0, 0});
  std::uint32_t byte = 0, unit = 0;
  while (byte < text.size()) {
    if (byte - marks_.back().byte >= stride) marks_.push_back({byte, unit});
    const Character c = character_at(text, byte);
    byte += c.bytes, unit += c.units;
  }
}

std::uint32_t Units::of_byte(std::uint32_t wanted) const {
  const auto after = std::upper_bound(marks_.begin(), marks_.end(), wanted,
                                      [](std::uint32_t value, const Mark& mark) { return value < mark.byte; });
  auto [byte, unit] = *(after - 1);
  while (byte < wanted && byte < text_.size()) {
    const Character c = character_at(text_, byte);
    if (byte + c.bytes > wanted) break;
    byte += c.bytes, unit += c.units;
  }
  return unit;
}

std::uint32_t Units::to_byte(std::uint32_t wanted) const {
  const auto after = std::upper_bound(marks_.begin(), marks_.end(), wanted,
                                      [](std::uint32_t value, const Mark& mark) { return value < mark.unit; });
  auto [byte, unit] = *(after - 1);
  while (byte < text_.size()) {
    const Character c = character_at(text_, byte);
    if (unit + c.units > wanted) break;
    byte += c.bytes, unit += c.units;
  }
  return byte;
}

Json formula_json(const Layout& formula) {
  if (formula.empty()) return nullptr;
  return {{"mathml", to_mathml(formula)}, {"latex", to_latex(formula)}, {"plain", to_plain(formula)}};
}

Json line_json(const ReportContent::Formula& line) {
  const bool shown = !line.left.empty() || !line.right.empty();
  return {{"left", formula_json(line.left)},
          {"right", formula_json(line.right)},
          {"mathml", shown ? display_math(line.left, line.right) : std::string()},
          {"rule", line.rule},
          {"sentence", line.sentence}};
}

Json lines_json(const std::vector<ReportContent::Formula>& lines) {
  Json list = Json::array();
  for (const auto& line : lines) list.push_back(line_json(line));
  return list;
}

Json sections_json(const std::vector<ReportContent::Section>& sections) {
  Json list = Json::array();
  for (const auto& section : sections)
    list.push_back({{"title", section.title}, {"notes", section.notes}, {"lines", lines_json(section.lines)}});
  return list;
}

Json conserved_json(const std::vector<ReportContent::Conserved>& conserved, bool formulas) {
  Json list = Json::array();
  for (const auto& c : conserved) {
    list.push_back({{"sentence", c.sentence}, {"value", c.value}, {"drift", c.drift}});
    if (formulas) list.back()["formula"] = line_json(c.formula);
  }
  return list;
}

Json pairs_json(const std::vector<std::pair<std::string, std::string>>& pairs) {
  Json list = Json::array();
  for (const auto& [name, value] : pairs) list.push_back({name, value});
  return list;
}

std::string help_on_page(const Diagnostic& d) {
  if (d.code == "E0109") return "Begin with a line such as `coord x : length`, or open one of the examples.";
  if (d.code == "E1301") return "Look at the model for a force that nothing balances.";
  if (d.code == "E1303") return "Declare the drive as `input u : [N] = …`: it is held at its value at the start.";
  return d.help;
}

Json diagnostics_json(const Diagnostics& diagnostics, const SourceTexts& texts, const Units& units) {
  Json list = Json::array();
  for (const Diagnostic& d : diagnostics.items()) {
    const bool placed = d.span && d.span->source == 0;
    const char* severity = d.severity == Severity::Error     ? "error"
                           : d.severity == Severity::Warning ? "warning"
                                                             : "note";
    Json item = {{"code", d.code}, {"severity", severity}};
    item["from"] = placed ? Json(units.of_byte(d.span->begin)) : Json();
    item["to"] = placed ? Json(units.of_byte(d.span->end)) : Json();
    const LineColumn place = placed ? texts.locate(*d.span) : LineColumn{};
    item["line"] = placed ? Json(place.line) : Json();
    item["column"] = placed ? Json(place.column) : Json();
    item["message"] = d.message, item["reason"] = d.reason, item["help"] = help_on_page(d);
    item["text"] = d.span && !placed ? std::string(texts.of(*d.span).text()) : std::string();
    list.push_back(std::move(item));
  }
  return list;
}

Json edits_json(const std::vector<language::TextEdit>& edits, const Units& units) {
  Json list = Json::array();
  for (const language::TextEdit& edit : edits)
    list.push_back(
        {{"from", units.of_byte(edit.span.begin)}, {"to", units.of_byte(edit.span.end)}, {"insert", edit.text}});
  return list;
}

Json range_json(Span span, const Units& units) {
  return Json::array({units.of_byte(span.begin), units.of_byte(span.end)});
}

Json drawing_of(const std::optional<Drawing>& drawing) {
  return drawing && !drawing->empty() ? Json::parse(drawing_json(*drawing)) : Json();
}

Json number_or_null(double x) { return std::isfinite(x) ? Json(x) : Json(); }

}  // namespace maupertuis::studio

#pragma once
#include <maupertuis/language_services.hpp>
#include <maupertuis/report.hpp>
#include <maupertuis/source.hpp>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// What returns in answers, as JSON (docs/design/studio.md, "Shapes that return").
namespace maupertuis::studio {

using Json = nlohmann::ordered_json;

/// Why there is no answer. Thrown by whoever finds it out, caught by the session.
struct Trouble {
  std::string kind;  // request, model, budget, cancelled, refused, internal
  std::string message, reason, help;
  std::string code;
  Json diagnostics = nullptr;  // beside kind model
};

/// Offsets of a text in bytes and in UTF-16 units. Bytes that are not UTF-8 count as one unit each.
/// A view; the text outlives it. Cost of a question: a scan of at most `stride` bytes.
class Units {
 public:
  explicit Units(std::string_view text);
  std::uint32_t of_byte(std::uint32_t byte) const;
  /// Within a character: its beginning; beyond the end: the end.
  std::uint32_t to_byte(std::uint32_t unit) const;

 private:
  static constexpr std::uint32_t stride = 512;
  std::string_view text_;
  struct Mark {
    std::uint32_t byte, unit;
  };
  std::vector<Mark> marks_;  // the beginnings of characters, about `stride` bytes apart
};

Json formula_json(const Layout& formula);
Json line_json(const ReportContent::Formula& line);
Json lines_json(const std::vector<ReportContent::Formula>& lines);
/// [{title, lines}]
Json sections_json(const std::vector<ReportContent::Section>& sections);
Json conserved_json(const std::vector<ReportContent::Conserved>& conserved, bool formulas = true);
Json pairs_json(const std::vector<std::pair<std::string, std::string>>& pairs);
/// The help of a message where it speaks of the command line: what to do on the page.
std::string help_on_page(const Diagnostic& diagnostic);
/// [{code, severity, from, to, line, column, message, reason, help, text}]
Json diagnostics_json(const Diagnostics& diagnostics, const SourceTexts& texts, const Units& units);
Json edits_json(const std::vector<language::TextEdit>& edits, const Units& units);
/// [from, to]
Json range_json(Span span, const Units& units);
Json drawing_of(const std::optional<Drawing>& drawing);
/// null where it is not finite.
Json number_or_null(double x);

}  // namespace maupertuis::studio

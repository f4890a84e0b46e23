#include "syntax/lexer.hpp"
#include "syntax/unicode.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis::syntax {
namespace {

constexpr std::size_t kMostBytes = 8u << 20;

bool is_control(unsigned char c) { return (c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7F; }

bool turns_direction(char32_t c) {
  return c == 0x61C || c == 0x200E || c == 0x200F || (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
}

/// In comments and titles; elsewhere it is an error of its own. Once in a text.
void warn_of_direction(const SourceText& source, Span span, char32_t c, Diagnostics& diagnostics) {
  const auto items = diagnostics.items();
  if (std::any_of(items.begin(), items.end(), [](const Diagnostic& d) { return d.code == "W0108"; })) return;
  diagnostics.warning("W0108", span,
                      fmt::format("line {} holds a character that is not shown (U+{:04X})",
                                  source.locate(span.begin).line, static_cast<std::uint32_t>(c)),
                      "It turns the direction of writing, so that an editor shows other text than is read here.",
                      "Remove it.");
}

}  // namespace

bool check_text(const SourceText& source, Diagnostics& diagnostics) {
  const std::string_view text = source.text();
  if (text.size() > kMostBytes) {
    diagnostics.error("E0101", std::nullopt, fmt::format("{} is too large: {} bytes", source.name(), text.size()),
                      fmt::format("A model text may have {} bytes (8 MiB).", kMostBytes),
                      "Is it a model? Data belong into files of their own.");
    return false;
  }
  if (text.substr(0, 2) == "\xFF\xFE" || text.substr(0, 2) == "\xFE\xFF") {
    diagnostics.error("E0102", std::nullopt, fmt::format("{} is UTF-16 text", source.name()), "Model texts are UTF-8.",
                      "Save it as UTF-8.");
    return false;
  }
  const auto control =
      std::find_if(text.begin(), text.end(), [](char c) { return is_control(static_cast<unsigned char>(c)); });
  if (control != text.end()) {
    const auto at = static_cast<std::uint32_t>(control - text.begin());
    diagnostics.error("E0103", std::nullopt, fmt::format("{} is no text file", source.name()),
                      fmt::format("Byte {} (line {}) is the control character 0x{:02X}.", at, source.locate(at).line,
                                  static_cast<unsigned char>(*control)),
                      "A model is plain UTF-8 text.");
    return false;
  }
  for (std::size_t i = 0; i < text.size();) {
    const auto c = decode(text, i);
    if (!c) {
      const auto at = static_cast<std::uint32_t>(i);
      diagnostics.error("E0102", Span{at, at + 1, source.id()},
                        fmt::format("the byte 0x{:02X} is not UTF-8", static_cast<unsigned char>(text[i])),
                        "Model texts are UTF-8; in other encodings θ, ° and é are other bytes.",
                        "Save the file as UTF-8.");
      return false;
    }
    const Span here{static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i + c->length), source.id()};
    if (turns_direction(c->value)) warn_of_direction(source, here, c->value, diagnostics);
    i += c->length;
  }
  return true;
}

}  // namespace maupertuis::syntax

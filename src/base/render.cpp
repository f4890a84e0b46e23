#include <maupertuis/diagnostic.hpp>
#include <maupertuis/look_alikes.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {
namespace {

struct Paint {
  bool on;
  const char* code(const char* sequence) const { return on ? sequence : ""; }
};

const char* severity_word(Severity severity) {
  switch (severity) {
    case Severity::Error:
      return "error";
    case Severity::Warning:
      return "warning";
    case Severity::Note:
      return "note";
  }
  return "";
}

const char* severity_color(Severity severity) {
  switch (severity) {
    case Severity::Error:
      return "\x1b[1;31m";
    case Severity::Warning:
      return "\x1b[1;33m";
    case Severity::Note:
      return "\x1b[1;36m";
  }
  return "";
}

bool starts_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0u) != 0x80u; }

/// Tabs as one space and what is not shown as one mark, so that the caret stands where it should and a terminal is
/// safe.
std::string printable(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i + 1;
    while (end < text.size() && !starts_character(text[end])) ++end;
    const std::string_view character = text.substr(i, end - i);
    if (character == "\t")
      out += ' ';
    else if (visible(character) == character && character != "\n")
      out += character;
    else
      out += "\xEF\xBF\xBD";  // the replacement character
    i = end;
  }
  return out;
}

std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), starts_character));
}

/// Characters [first, first + count) of a UTF-8 text.
std::string_view substring(std::string_view text, std::size_t first, std::size_t count) {
  std::size_t begin = text.size(), end = text.size(), seen = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!starts_character(text[i])) continue;
    if (seen == first) begin = i;
    if (seen == first + count) {
      end = i;
      break;
    }
    ++seen;
  }
  return text.substr(begin, end - begin);
}

/// The source line with a caret line below it. A long line is cut to a window around the caret.
std::string source_excerpt(const Diagnostic& d, const SourceText& source, Paint paint) {
  constexpr std::size_t window = 100, lead = 40;
  const LineColumn place = source.locate(d.span->begin);
  const std::string_view line = source.line(place.line);
  const std::size_t width = characters(line);
  const std::size_t column = place.column - 1;
  const LineColumn end_place = source.locate(std::max(d.span->end, d.span->begin));
  const std::size_t end_column = end_place.line == place.line ? end_place.column - 1 : width;
  const std::size_t first = width > window && column > lead ? column - lead : 0;
  const bool cut_right = width > first + window;
  const std::string shown = printable(substring(line, first, window));
  const std::size_t offset = column - first + (first ? 1 : 0);
  const std::size_t room = window > column - first ? window - (column - first) : 1;
  const std::size_t carets = std::clamp<std::size_t>(end_column > column ? end_column - column : 1, 1, room);
  const std::string number = std::to_string(place.line);
  return fmt::format("{0}{1} |{2} {3}{4}{5}\n{0}{6} |{2} {7}{8}{9}{2}\n", paint.code("\x1b[2m"), number,
                     paint.code("\x1b[0m"), first ? "…" : "", shown, cut_right ? "…" : "",
                     std::string(number.size(), ' '), std::string(offset, ' '), paint.code(severity_color(d.severity)),
                     std::string(carets, '^'));
}

std::string head_line(const Diagnostic& d, const SourceText& source, Paint paint) {
  std::string place = visible(source.name());
  if (d.span) {
    const LineColumn at = source.locate(d.span->begin);
    place += fmt::format(":{}:{}", at.line, at.column);
  }
  const std::string title = fmt::format("-- {} {} ", severity_word(d.severity), d.code);
  const std::size_t used = characters(title) + characters(place) + 1;
  return fmt::format("{}{}{}{} {}\n", paint.code(severity_color(d.severity)), title,
                     std::string(used < 80 ? 80 - used : 3, '-'), paint.code("\x1b[0m"), place);
}

}  // namespace

std::string render(const Diagnostic& d, const SourceTexts& texts, const RenderOptions& options) {
  const Paint paint{options.color};
  const SourceText& source = d.span ? texts.of(*d.span) : texts.model();
  std::string out = head_line(d, source, paint);
  out += fmt::format("\n{}{}{}\n", paint.code("\x1b[1m"), visible(d.message), paint.code("\x1b[0m"));
  if (d.span) out += "\n" + source_excerpt(d, source, paint);
  if (!d.reason.empty()) out += "\n" + visible(d.reason) + "\n";
  if (!d.help.empty())
    out += fmt::format("{}{}Help:{} {}\n", d.reason.empty() ? "\n" : "", paint.code("\x1b[32m"), paint.code("\x1b[0m"),
                       visible(d.help));
  return out;
}

std::string render(const Diagnostics& diagnostics, const SourceTexts& texts, const RenderOptions& options) {
  std::string out;
  std::size_t shown = 0;
  for (const Diagnostic& d : diagnostics.items()) {
    if (shown == options.limit) {
      out += fmt::format("\n… and {} more messages.\n", diagnostics.items().size() - shown);
      break;
    }
    if (shown++) out += "\n";
    out += render(d, texts, options);
  }
  return out;
}

}  // namespace maupertuis

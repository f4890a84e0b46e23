#include "plot/label.hpp"

#include <maupertuis/escape_xml.hpp>
#include <maupertuis/plot.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace maupertuis {
namespace {

std::size_t character_count(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// θ1 → θ, 1; x_cart → x, cart; θ1_max → θ, 1,max; energy stays a word. As formulas print the same names.
void split_index(std::string_view name, NameParts& parts) {
  const std::size_t underscore = name.find('_');
  const std::string_view stem = name.substr(0, underscore);
  std::size_t split = stem.size();
  while (split > 0 && is_digit(stem[split - 1])) --split;
  if (split == 0) split = stem.size();
  parts.base = stem.substr(0, split);
  parts.index = stem.substr(split);
  if (underscore != std::string_view::npos) {
    if (!parts.index.empty()) parts.index += ',';
    parts.index += name.substr(underscore + 1);
  }
  parts.upright = character_count(parts.base) > 1;
}

}  // namespace

NameParts name_parts(std::string_view name) {
  NameParts parts;
  while (!name.empty() && name.back() == '\'') {
    name.remove_suffix(1);
    ++parts.dots;
  }
  std::string owner;
  if (const auto dot = name.rfind('.'); dot != std::string_view::npos && dot + 1 < name.size()) {
    owner = name.substr(0, dot);
    name.remove_prefix(dot + 1);
  }
  split_index(name, parts);
  if (!owner.empty()) parts.index = parts.index.empty() ? owner : owner + "," + parts.index;
  return parts;
}

void append(RichText& text, const RichText& more) {
  for (const TextRun& run : more) {
    const bool joins =
        !text.empty() && text.back().dots == 0 && text.back().italic == run.italic && text.back().level == run.level;
    if (joins)
      text.back().text += run.text;
    else
      text.push_back(run);
  }
}

void append(RichText& text, std::string_view upright) { append(text, RichText{{std::string(upright), false, 0}}); }

namespace {

bool is_letter(char c) { return (c & 0x80) != 0 || std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }

// The end of the name or the number that begins at `at`: θ1', bob.x, 0.5, 1e-3.
std::size_t end_of_word(std::string_view text, std::size_t at) {
  std::size_t end = at;
  const auto next_is = [&](auto&& kind) { return end + 1 < text.size() && kind(text[end + 1]); };
  if (is_letter(text[at])) {
    while (end < text.size() &&
           (is_letter(text[end]) || is_digit(text[end]) || (text[end] == '.' && next_is(is_letter))))
      ++end;
    while (end < text.size() && text[end] == '\'') ++end;
  } else {
    const auto is_sign = [](char c) { return c == '-' || c == '+' || is_digit(c); };
    while (end < text.size() && (is_digit(text[end]) || text[end] == '.')) ++end;
    if (end < text.size() && (text[end] == 'e' || text[end] == 'E') && next_is(is_sign))
      for (end += 2; end < text.size() && is_digit(text[end]);) ++end;
  }
  return end;
}

// What is raised after a caret at `at`: a number, or all between brackets.
std::string_view exponent_after(std::string_view text, std::size_t& at) {
  std::size_t end = ++at;
  if (at < text.size() && text[at] == '(') {
    int depth = 0;
    do depth += text[end] == '(' ? 1 : text[end] == ')' ? -1 : 0;
    while (++end < text.size() && depth > 0);
    const std::string_view inside = text.substr(at + 1, end - at - (depth == 0 ? 2 : 1));
    at = end;
    return inside;
  }
  if (end < text.size() && text[end] == '-') ++end;
  if (end < text.size() && (is_letter(text[end]) || is_digit(text[end]))) end = end_of_word(text, end);
  const std::string_view word = text.substr(at, end - at);
  at = end;
  return word;
}

std::string with_minus_signs(std::string_view text) {
  std::string out;
  for (const char c : text) c == '-' ? out += "−" : out += c;
  return out;
}

RichText single_name(std::string_view name) {
  const NameParts parts = name_parts(name);
  const bool dotted = !parts.upright && parts.dots <= 3;  // a word, or a fourth derivative, has primes
  RichText text{{parts.base, !parts.upright, 0, dotted ? parts.dots : 0}};
  if (!dotted)
    for (int i = 0; i < parts.dots; ++i) text.back().text += "′";
  if (!parts.index.empty()) text.push_back({parts.index, false, -1});
  return text;
}

}  // namespace

RichText name_text(std::string_view text) {
  RichText out;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '^') {
      out.push_back({with_minus_signs(exponent_after(text, at)), false, 1});
      continue;
    }
    if (text[at] == '[') {  // a unit
      const std::size_t end = std::min(text.find(']', at), text.size() - 1) + 1;
      append(out, unit_text(text.substr(at, end - at)));
      at = end;
      continue;
    }
    const bool is_name = is_letter(text[at]), is_word = is_name || is_digit(text[at]);
    const std::size_t end = is_word ? end_of_word(text, at) : at + 1;
    const std::string_view word = text.substr(at, end - at);
    if (is_name)
      append(out, single_name(word));
    else
      append(out, word == "*" ? "·" : with_minus_signs(word));
    at = end;
  }
  return out;
}

RichText unit_text(std::string_view unit) {
  RichText text;
  std::size_t at = 0;
  while (at < unit.size()) {
    const std::size_t caret = std::min(unit.find('^', at), unit.size());
    if (caret > at) append(text, unit.substr(at, caret - at));
    if (caret == unit.size()) break;
    std::size_t end = caret + 1;
    while (end < unit.size() && (is_digit(unit[end]) || unit[end] == '-')) ++end;
    std::string exponent(unit.substr(caret + 1, end - caret - 1));
    if (!exponent.empty() && exponent[0] == '-') exponent.replace(0, 1, "−");
    text.push_back({exponent, false, 1});
    at = end;
  }
  return text;
}

RichText power_of_ten(int exponent) {
  return {{"10", false, 0}, {exponent < 0 ? fmt::format("−{}", -exponent) : fmt::format("{}", exponent), false, 1}};
}

RichText names_text(const std::vector<std::string>& names) {
  RichText text;
  const bool many = names.size() > 4;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (many && i > 0 && i + 1 < names.size()) continue;
    if (i > 0) append(text, many ? " … " : ", ");
    append(text, name_text(names[i]));
  }
  return text;
}

double text_width(const RichText& text, double font_size) {
  double width = 0;
  for (const auto& run : text) {
    const auto count = static_cast<double>(character_count(run.text));
    width += count * font_size * (run.level == 0 ? 0.56 : 0.42);
  }
  return width;
}

namespace {

// Width of an italic letter, and the height that a dot above it takes, in em, as serif faces agree on within a tenth.
struct LetterSize {
  double width, dot_height;
};
LetterSize letter_size(std::string_view letter) {
  const auto one_of = [&](std::string_view letters) { return letters.find(letter) != std::string_view::npos; };
  const bool tall = one_of("bdfhkltABCDEFGHIJKLMNOPQRSTUVWXYZθϑβδλξζΓΔΘΛΞΠΣΦΨΩ");
  const double width = one_of("iljtrfI")                            ? 0.34
                       : one_of("mwωφψϕ")                           ? 0.66
                       : one_of("ABCDEFGHKLMNOPQRTUVWXYZΔΘΛΞΠΣΦΨΩ") ? 0.7
                                                                    : 0.5;
  return {width, tall ? 0.8 : one_of("φψϕ") ? 0.66 : 0.56};
}

// Full stops, raised and moved back over the letter: combining marks collide with tall letters in common faces.
std::string dots_above(const TextRun& run, double font_size) {
  constexpr double stop = 0.28, slant = 0.09;  // em: advance of a full stop; how far the letter leans at its top
  const LetterSize letter = letter_size(run.text);
  const double row = stop * run.dots, back = 0.5 * (letter.width + row) - slant;
  return fmt::format(
      "<tspan dx=\"{0:.3g}\" dy=\"{1:.3g}\">{2}</tspan><tspan dx=\"{3:.3g}\" dy=\"{4:.3g}\">\u200b</tspan>",
      -back * font_size, -letter.dot_height * font_size, std::string(run.dots, '.'), (back - row) * font_size,
      letter.dot_height * font_size);
}

}  // namespace

std::string to_svg(const RichText& text, double font_size) {
  std::string svg;
  double shift = 0;
  for (const auto& run : text) {
    const double wanted = run.level < 0 ? 0.22 * font_size : run.level > 0 ? -0.36 * font_size : 0;
    std::string attributes;
    if (run.italic) attributes += " font-style=\"italic\"";
    if (run.level != 0) attributes += fmt::format(" font-size=\"{:.3g}\"", 0.72 * font_size);
    if (wanted != shift) attributes += fmt::format(" dy=\"{:.3g}\"", wanted - shift);
    shift = wanted;
    svg += attributes.empty() ? escape_xml(run.text)
                              : fmt::format("<tspan{}>{}</tspan>", attributes, escape_xml(run.text));
    if (run.dots > 0) svg += dots_above(run, font_size);
  }
  return svg;
}

std::string plain(const RichText& text) {
  std::string result;
  for (const auto& run : text) result += (run.level > 0 ? "^" + run.text : run.text) + std::string(run.dots, '\'');
  return result;
}

}  // namespace maupertuis

#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace maupertuis {

/// A piece of a line of text: italic or not, on the line, below it or above it.
struct TextRun {
  std::string text;
  bool italic = false;
  int level = 0;  // -1: index, 1: exponent
  int dots = 0;   // above its only character
};
using RichText = std::vector<TextRun>;

void append(RichText& text, const RichText& more);
void append(RichText& text, std::string_view upright);

RichText name_text(std::string_view text);  // θ1' as in print, and formulas of such names: 0.5 m θ1'^2
RichText unit_text(std::string_view unit);  // m^2 with an exponent
RichText power_of_ten(int exponent);
/// "θ₁, θ₂", or "θ₁ … θ₈" for many.
RichText names_text(const std::vector<std::string>& names);

/// Estimated width in px: fonts differ, so layouts leave room.
double text_width(const RichText& text, double font_size);
/// The children of an SVG <text> element of this font size.
std::string to_svg(const RichText& text, double font_size);
std::string plain(const RichText& text);

}  // namespace maupertuis

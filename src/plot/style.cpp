#include "plot/style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace maupertuis {
namespace {

// Okabe and Ito's colours (2008), the pale ones darkened for thin lines on white paper, all lightened for dark paper.
const std::vector<std::string_view> light_palette{"#0072b2", "#d55e00", "#009e73", "#b5528f",
                                                  "#c98700", "#3a9bd4", "#5b5b5b"};
const std::vector<std::string_view> dark_palette{"#5ab4ec", "#ff8c42", "#2fc99a", "#e39ac6",
                                                 "#f0b93a", "#9ed5f7", "#c4c4c4"};

struct Colours {
  std::string paper, ink, muted, grid;
  std::vector<std::string> series;
};

Colours colours_of(PlotTheme theme) {
  if (theme == PlotTheme::Page) {
    Colours page{"var(--paper)", "var(--ink)", "var(--muted)", "var(--grid)", {}};
    for (std::size_t i = 1; i <= light_palette.size(); ++i) page.series.push_back(fmt::format("var(--series-{})", i));
    return page;
  }
  const bool dark = theme == PlotTheme::Dark;
  const auto& palette = plot_palette(dark);
  return {dark ? "#16181d" : "#ffffff",
          dark ? "#e6e6e6" : "#1c1c1c",
          dark ? "#a3a7ae" : "#5c5c5c",
          dark ? "#2d3138" : "#e4e4e4",
          {palette.begin(), palette.end()}};
}

std::string rules(PlotTheme theme, std::string_view scope) {
  const Colours c = colours_of(theme);
  std::string css = fmt::format(
      "{0} text{{font-family:{1};fill:{2}}}{0} .paper{{fill:{3}}}{0} .tick{{fill:{4}}}"
      "{0} .grid{{stroke:{5};stroke-width:1;fill:none}}{0} .axis{{stroke:{4};stroke-width:1;fill:none}}"
      "{0} .curve{{fill:none;stroke-width:1.4;stroke-linejoin:round;stroke-linecap:round}}"
      "{0} .dots{{fill:none;stroke-width:1.7;stroke-linecap:round}}{0} "
      ".outline{{fill:none;stroke:{4};stroke-width:1;stroke-dasharray:4 3}}"
      "{0} .band{{stroke:none;fill-opacity:.2}}{0} .band.many{{fill:currentColor}}{0} .lost{{stroke-opacity:.3}}"
      "{0} .mark{{stroke:{4};stroke-width:.8;stroke-opacity:.55;fill:none}}{0} .mark.event{{stroke-dasharray:3 3}}"
      "{0} .strip{{stroke:none}}{0} .strip.open{{fill:{5}}}"
      "{0} .dense{{stroke-width:.8}}{0} .dot{{stroke:none}}{0} .dot.many{{fill:currentColor}}",
      scope, serif_faces, c.ink, c.paper, c.muted, c.grid);
  for (std::size_t i = 0; i < c.series.size(); ++i)
    css += fmt::format(
        "{0} .s{1}{{stroke:{2}}}{0} .dot.s{1},{0} .band.s{1},{0} .strip.s{1}{{fill:{2}}}{0} .band,{0} "
        ".strip{{stroke:none}}",
        scope, i + 1, c.series[i]);
  return css;
}

// A ramp from blue over grey-green to amber whose lightness stays in the middle: legible on light and on dark paper,
// told apart by any colour vision.
std::string ramp_colour(double s) {
  static constexpr std::array<std::array<double, 3>, 5> stops{
      {{36, 92, 190}, {74, 122, 168}, {120, 140, 128}, {178, 142, 72}, {224, 132, 20}}};
  const double place = s * (stops.size() - 1);
  const auto low = std::min<std::size_t>(static_cast<std::size_t>(place), stops.size() - 2);
  const double part = place - static_cast<double>(low);
  const auto mix = [&](int k) {
    return static_cast<int>(std::lround(stops[low][k] + part * (stops[low + 1][k] - stops[low][k])));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", mix(0), mix(1), mix(2));
}

}  // namespace

const std::vector<std::string_view>& plot_palette(bool dark) { return dark ? dark_palette : light_palette; }

std::string plot_page_style() { return rules(PlotTheme::Page, ".maup-plot"); }

std::string own_style(PlotTheme theme) { return rules(theme, ".maup-plot"); }

std::string series_attributes(std::size_t index, std::size_t count) {
  if (count <= light_palette.size()) return fmt::format("s{}\"", index + 1);
  const std::string colour = ramp_colour(static_cast<double>(index) / static_cast<double>(count - 1));
  return fmt::format("many\" style=\"stroke:{};color:{}\"", colour, colour);
}

}  // namespace maupertuis

#include "plot/panel.hpp"
#include "plot/style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

/// Instants as lines through the panels, and what contacts and frictions do as bars below them.
namespace maupertuis {
namespace {

using State = PlotStrip::State;

constexpr double bar = 10, between_bars = 5, names_height = 16, legend_line = 20, least_distance = 1.5;

bool over_time(const Figure& figure) { return figure.horizontal.is_time; }
bool has_marks(const Figure& figure) { return over_time(figure) && !figure.options.marks.empty(); }
bool has_strips(const Figure& figure) { return over_time(figure) && !figure.options.strips.empty(); }

struct Look {
  State state;
  std::size_t series;  // of the palette
  const char* word;
};
constexpr std::array<Look, 4> looks{{{State::Closed, 0, "closed"},
                                     {State::Stick, 2, "sticking"},
                                     {State::Forward, 1, "sliding +"},
                                     {State::Backward, 4, "sliding −"}}};

std::string class_of(State state) {
  for (const Look& look : looks)
    if (look.state == state) return fmt::format("s{}", look.series + 1);
  return "open";
}

std::vector<Look> occurring(const Figure& figure) {
  std::vector<Look> out;
  for (const Look& look : looks)
    for (const PlotStrip& strip : figure.options.strips)
      if (std::any_of(strip.parts.begin(), strip.parts.end(), [&](const auto& p) { return p.state == look.state; })) {
        out.push_back(look);
        break;
      }
  return out;
}

/// A name that would take the room of the picture is cut.
RichText shown_name(const std::string& name) {
  constexpr std::size_t longest = 18;
  std::size_t letters = 0, end = 0;
  while (end < name.size() && letters <= longest) {
    ++letters;
    do ++end;
    while (end < name.size() && (static_cast<unsigned char>(name[end]) & 0xc0) == 0x80);
  }
  return end == name.size() ? name_text(name) : RichText{{name.substr(0, end) + "…"}};
}

double x_of(const Figure& figure, const Axis& across, double t) {
  return figure.left + figure.frame_width() * std::clamp(across.position(figure.horizontal.factor * t), 0.0, 1.0);
}

bool is_shown(const Axis& across, const Figure& figure, double t) {
  const double u = across.position(figure.horizontal.factor * t);
  return u >= -1e-9 && u <= 1 + 1e-9;
}

struct PlacedName {
  RichText text;
  double x = 0;
  std::size_t row = 0;
};

/// Names in the order of the time; one that would stand on the last one goes below it if it is another, else it is left
/// out.
std::vector<PlacedName> placed_names(const Figure& figure, const Axis& across) {
  constexpr std::size_t rows = 2;
  std::vector<PlacedName> out;
  double free_from[rows] = {-HUGE_VAL, -HUGE_VAL};
  std::string last[rows];
  for (const PlotMark& mark : figure.options.marks) {
    if (mark.name.empty() || !is_shown(across, figure, mark.t)) continue;
    const RichText text = name_text(mark.name);
    const double half = text_width(text, tick_size) / 2, wanted = x_of(figure, across, mark.t),
                 x = std::clamp(wanted, half + 2, figure.options.width - half - 2);
    for (std::size_t row = 0; row < rows; ++row) {
      if (x - half >= free_from[row]) {
        free_from[row] = x + half + 8;
        last[row] = mark.name;
        out.push_back({text, x, row});
        break;
      }
      if (last[row] == mark.name) break;
    }
  }
  return out;
}

std::string draw_names(const Figure& figure, const Axis& across) {
  std::string svg;
  for (const PlacedName& name : placed_names(figure, across))
    if (name.row < figure.mark_rows)
      svg += text_element(name.x, figure.marks_top + 11 + names_height * static_cast<double>(name.row), "middle",
                          tick_size, name.text, " class=\"tick\"");
  return svg;
}

/// Of parts that fall into one pixel the longest is seen.
std::string draw_strip(const Figure& figure, const Axis& across, const PlotStrip& strip, double top) {
  std::map<std::string, std::string> paths;
  const double left = figure.left, right = figure.right;
  paths["open"] +=
      fmt::format("M{:.2f} {:.2f}h{:.2f}v{:.2f}h{:.2f}z", left, top + bar / 2 - 0.5, right - left, 1.0, left - right);
  double drawn_to = -HUGE_VAL;
  State last = State::Open;
  for (const PlotStrip::Part& part : strip.parts) {
    const double from = x_of(figure, across, std::min(part.from, part.to)),
                 to = x_of(figure, across, std::max(part.from, part.to));
    if (part.state == State::Open) continue;
    const double wide = std::max(to - from, 0.8);
    if (from + wide <= drawn_to + 0.3 && part.state == last) continue;
    paths[class_of(part.state)] += fmt::format("M{:.2f} {:.2f}h{:.2f}v{:.2f}h{:.2f}z", from, top, wide, bar, -wide);
    drawn_to = from + wide, last = part.state;
  }
  std::string svg;
  for (const auto& [name, path] : paths) svg += fmt::format("<path class=\"strip {}\" d=\"{}\"/>\n", name, path);
  return svg + text_element(figure.left - 7, top + bar - 1, "end", tick_size, shown_name(strip.name));
}

std::string draw_legend(const Figure& figure) {
  std::string svg;
  double x = figure.left;
  const double y = figure.bottom + 46 + legend_line - 8;
  for (const Look& look : occurring(figure)) {
    svg += fmt::format("<path class=\"strip {}\" d=\"M{:.1f} {:.1f}h20v{}h-20z\"/>\n", class_of(look.state), x,
                       y - bar + 1, bar);
    const RichText word{{look.word}};
    svg += text_element(x + 26, y, "start", tick_size, word);
    x += 26 + text_width(word, tick_size) + 18;
  }
  return svg;
}

}  // namespace

double names_of_marks_height(const Figure& figure) {
  const auto named = [](const PlotMark& mark) { return !mark.name.empty(); };
  const auto& marks = figure.options.marks;
  return has_marks(figure) && std::any_of(marks.begin(), marks.end(), named)
             ? names_height * static_cast<double>(figure.mark_rows) + 1
             : 0;
}

std::size_t rows_of_names(const Figure& figure, const Axis& across) {
  std::size_t rows = 1;
  if (has_marks(figure))
    for (const PlacedName& name : placed_names(figure, across)) rows = std::max(rows, name.row + 1);
  return rows;
}

double strips_height(const Figure& figure) {
  return has_strips(figure) ? 7 + static_cast<double>(figure.options.strips.size()) * (bar + between_bars) : 0;
}

double strips_legend_height(const Figure& figure) {
  return has_strips(figure) && !occurring(figure).empty() ? legend_line : 0;
}

double widest_strip_name(const Figure& figure) {
  double widest = 0;
  if (has_strips(figure))
    for (const PlotStrip& strip : figure.options.strips)
      widest = std::max(widest, text_width(shown_name(strip.name), tick_size));
  return widest;
}

std::string draw_marks(const Figure& figure, const Axis& across) {
  if (!has_marks(figure)) return {};
  std::string path, events;
  double last = -HUGE_VAL, last_event = -HUGE_VAL;
  for (const PlotMark& mark : figure.options.marks) {
    const double x = x_of(figure, across, mark.t);
    double& before = mark.dashed ? last_event : last;
    if (!is_shown(across, figure, mark.t) || std::abs(x - before) < least_distance) continue;
    before = x;
    for (const Panel& panel : figure.panels)
      (mark.dashed ? events : path) += fmt::format("M{:.2f} {:.2f}v{:.2f}", x, panel.top, panel.height);
  }
  std::string svg;
  if (!path.empty()) svg += fmt::format("<path class=\"mark\" d=\"{}\"/>\n", path);
  if (!events.empty()) svg += fmt::format("<path class=\"mark event\" d=\"{}\"/>\n", events);
  return svg;
}

std::string draw_names_and_strips(const Figure& figure, const Axis& across) {
  std::string svg;
  if (has_marks(figure)) svg += draw_names(figure, across);
  if (!has_strips(figure)) return svg;
  double top = figure.strips_top;
  for (const PlotStrip& strip : figure.options.strips) {
    svg += draw_strip(figure, across, strip, top);
    top += bar + between_bars;
  }
  return svg + draw_legend(figure);
}

}  // namespace maupertuis

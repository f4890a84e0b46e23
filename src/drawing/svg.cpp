#include "drawing/frame.hpp"
#include "drawing/moments.hpp"

#include <maupertuis/escape_xml.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

namespace maupertuis {
namespace {

using Ink = FrameColour::Ink;

constexpr double text_size = 15;
constexpr std::string_view faces =
    "'STIX Two Text','Latin Modern Roman','Cambria','Times New Roman','DejaVu Serif',serif";

struct Colours {
  std::array<double, 3> paper, ink, muted;
  std::vector<std::array<double, 3>> series;
};

std::array<double, 3> rgb(std::string_view hex) {
  std::array<double, 3> out{};
  for (std::size_t k = 0; k < 3; ++k) out[k] = std::stoi(std::string(hex.substr(1 + 2 * k, 2)), nullptr, 16);
  return out;
}

Colours colours_of(PlotTheme theme) {
  const bool dark = theme == PlotTheme::Dark;
  Colours c{
      rgb(dark ? "#16181d" : "#ffffff"), rgb(dark ? "#e6e6e6" : "#1c1c1c"), rgb(dark ? "#a3a7ae" : "#5c5c5c"), {}};
  for (const std::string_view s : plot_palette(dark)) c.series.push_back(rgb(s));
  return c;
}

std::string css(const FrameColour& colour, const Colours& c) {
  if (colour.ink == Ink::None) return "none";
  const std::array<double, 3>& to = colour.ink == Ink::Paper   ? c.paper
                                    : colour.ink == Ink::Ink   ? c.ink
                                    : colour.ink == Ink::Muted ? c.muted
                                                               : c.series[colour.series];
  std::string out = "#";
  for (std::size_t k = 0; k < 3; ++k)
    out += fmt::format("{:02x}", static_cast<int>(std::lround(c.paper[k] + std::clamp(colour.strength, 0.0, 1.0) *
                                                                               (to[k] - c.paper[k]))));
  return out;
}

/// A tenth of a px, without a zero that says nothing.
void append_number(std::string& out, double x) {
  const long tenths = std::lround(std::clamp(x, -1e7, 1e7) * 10);
  if (tenths < 0) out += '-';
  const long size = std::abs(tenths);
  if (size % 10 == 0)
    fmt::format_to(std::back_inserter(out), "{}", size / 10);
  else if (size < 10)
    fmt::format_to(std::back_inserter(out), ".{}", size);
  else
    fmt::format_to(std::back_inserter(out), "{}.{}", size / 10, size % 10);
}

std::string path_of(const FrameItem& item) {
  std::string d;
  for (std::size_t i = 0; i + 1 < item.points.size(); i += 2) {
    d += i == 0 ? "M" : i == 2 ? "L" : " ";
    append_number(d, item.points[i]);
    d += ' ';
    append_number(d, item.points[i + 1]);
  }
  if (item.closed) d += 'Z';
  return d;
}

std::string number(double x) {
  std::string out;
  append_number(out, x);
  return out;
}

std::string style_of(const FrameItem& item, const Colours& c) {
  if (item.kind == FrameItem::Kind::Text) {
    const char* anchor = item.align == 'l'   ? ""
                         : item.align == 'r' ? " text-anchor=\"end\""
                                             : " text-anchor=\"middle\"";
    return fmt::format(" fill=\"{}\"{}", css(item.fill, c), anchor);
  }
  std::string out = item.fill.ink == Ink::None ? "" : fmt::format(" fill=\"{}\"", css(item.fill, c));
  if (item.stroke.ink == Ink::None) return out;
  out += fmt::format(" stroke=\"{}\" stroke-width=\"{}\"", css({item.stroke.ink, item.stroke.series}, c),
                     number(item.width));
  if (item.stroke.strength < 1) out += fmt::format(" stroke-opacity=\"{:.2g}\"", item.stroke.strength);
  return out;
}

std::string letters(const NameParts& t, double size) {
  std::string dots;
  for (int i = 0; i < t.dots; ++i) dots += "\u0307";
  std::string out =
      t.upright ? escape_xml(t.base)
                : fmt::format("<tspan font-style=\"italic\">{}{}</tspan>", escape_xml(t.base), dots);
  if (!t.index.empty())
    out += fmt::format("<tspan dy=\"{}\" font-size=\"{}\">{}</tspan>", number(0.22 * size), number(0.72 * size),
                       escape_xml(t.index));
  return out;
}

std::string element_of(const FrameItem& item, const Colours& c, double unit, const std::string& inside = {}) {
  const std::string style = style_of(item, c);
  const auto close = [&](const char* name) {
    return inside.empty() ? std::string("/>\n") : fmt::format(">{}</{}>\n", inside, name);
  };
  switch (item.kind) {
    case FrameItem::Kind::Outline:
      return fmt::format("<path d=\"{}\"{}", path_of(item), style) + close("path");
    case FrameItem::Kind::Disc:
      return fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}", number(item.points[0]), number(item.points[1]),
                         number(item.radius), style) +
             close("circle");
    case FrameItem::Kind::Text:
      return fmt::format("<text x=\"{}\" y=\"{}\"{}>{}{}</text>\n", number(item.points[0]),
                         number(item.points[1] + 0.33 * text_size * unit), style, letters(item.text, text_size * unit),
                         inside);
  }
  return {};
}

std::string opening(const FrameOptions& options, const Colours& c, double unit) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"maup-drawing\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" font-family=\"{2}\" font-size=\"{3}\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"{4}\"/>\n<g fill=\"none\" stroke-linecap=\"round\" "
      "stroke-linejoin=\"round\">\n",
      number(options.width), number(options.height), faces, number(text_size * unit), css({Ink::Paper}, c));
}

// ---------------------------------------------------------------------------------------------------- animated
// pictures

using Frames = std::vector<std::vector<FrameItem>>;

/// Whether things lie over each other in the same order in every frame: then each is one element that moves.
bool keep_their_order(const Frames& frames) {
  std::map<std::pair<std::size_t, std::size_t>, bool> below;
  for (const auto& frame : frames)
    for (std::size_t i = 0; i < frame.size(); ++i)
      for (std::size_t k = i + 1; k < frame.size(); ++k) {
        if (below.count({frame[k].id, frame[i].id})) return false;
        below[{frame[i].id, frame[k].id}] = true;
      }
  return true;
}

/// `attribute` through all frames; nothing where it never changes.
std::string animation(const char* attribute, const std::vector<std::string>& values, const Playback& playback,
                      bool stepwise) {
  if (std::all_of(values.begin(), values.end(), [&](const auto& v) { return v == values[0]; })) return {};
  std::string list;
  for (const std::string& v : values) list += (list.empty() ? "" : ";") + v;
  return fmt::format("<animate attributeName=\"{}\" dur=\"{:.6g}s\" {}{} values=\"{}\"/>", attribute, playback.seconds,
                     playback.loop ? "repeatCount=\"indefinite\"" : "fill=\"freeze\"",
                     stepwise ? " calcMode=\"discrete\"" : "", list);
}

/// All moments of one thing. Where it is hidden its values repeat those of a moment when it is seen.
std::string moving_element(const std::vector<const FrameItem*>& moments, const Colours& c, double unit,
                           const Playback& playback) {
  const FrameItem* last =
      *std::find_if(moments.begin(), moments.end(), [](const FrameItem* m) { return m != nullptr; });
  const FrameItem& base = *last;
  std::vector<std::string> a, b, r, shown, fill;
  bool same_size = true, hides = false;
  for (const FrameItem* m : moments) {
    shown.push_back(m ? "visible" : "hidden");
    hides = hides || !m;
    if (m) last = m;
    same_size = same_size && last->points.size() == base.points.size();
    if (base.kind == FrameItem::Kind::Outline)
      a.push_back(path_of(*last));
    else {
      a.push_back(number(last->points[0]));
      b.push_back(number(last->points[1] + (base.kind == FrameItem::Kind::Text ? 0.33 * text_size * unit : 0)));
      r.push_back(number(last->radius));
    }
    fill.push_back(css(last->fill, c));
  }
  std::string inside;
  const bool stepwise = !same_size || hides;
  if (base.kind == FrameItem::Kind::Outline)
    inside += animation("d", a, playback, stepwise);
  else {
    const bool text = base.kind == FrameItem::Kind::Text;
    inside += animation(text ? "x" : "cx", a, playback, stepwise) + animation(text ? "y" : "cy", b, playback, stepwise);
    if (!text) inside += animation("r", r, playback, stepwise);
  }
  inside += animation("fill", fill, playback, stepwise) + animation("visibility", shown, playback, true);
  return element_of(base, c, unit, inside);
}

std::string moving_elements(const Frames& frames, const Colours& c, double unit, const Playback& playback) {
  std::map<std::size_t, std::vector<const FrameItem*>> moments;
  std::vector<std::size_t> order;
  for (std::size_t f = 0; f < frames.size(); ++f)
    for (std::size_t i = 0; i < frames[f].size(); ++i) {
      const FrameItem& item = frames[f][i];
      auto& own = moments[item.id];
      if (own.empty()) {
        own.resize(frames.size());
        // After the one that lies below it here.
        const auto below = i == 0 ? order.begin() : std::find(order.begin(), order.end(), frames[f][i - 1].id) + 1;
        order.insert(below, item.id);
      }
      own[f] = &item;
    }
  std::string out;
  for (const std::size_t id : order) out += moving_element(moments[id], c, unit, playback);
  return out;
}

/// Every frame whole, each seen in its own time: for things that pass in front of each other.
std::string turned_pages(const Frames& frames, const Colours& c, double unit, const Playback& playback) {
  std::string out;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const double n = static_cast<double>(frames.size()), from = static_cast<double>(f) / n,
                 to = static_cast<double>(f + 1) / n;
    std::string times = "0", values = f == 0 ? "visible" : "hidden";
    if (f > 0) times += fmt::format(";{:.5g}", from), values += ";visible";
    const bool last = f + 1 == frames.size();
    if (!last) times += fmt::format(";{:.5g}", to), values += ";hidden";
    out += fmt::format(
        "<g visibility=\"{}\"><animate attributeName=\"visibility\" calcMode=\"discrete\" dur=\"{:.6g}s\" {} "
        "keyTimes=\"{}\" values=\"{}\"/>\n",
        f == 0 ? "visible" : "hidden", playback.seconds,
        playback.loop ? "repeatCount=\"indefinite\"" : "fill=\"freeze\"", times, values);
    for (const FrameItem& item : frames[f]) out += element_of(item, c, unit);
    out += "</g>\n";
  }
  return out;
}

}  // namespace

std::string frame_svg(const Drawing& drawing, double elapsed, const FrameOptions& options) {
  const View view(drawing, options);
  const Colours c = colours_of(options.theme);
  std::string svg = opening(options, c, view.unit());
  for (const FrameItem& item : frame_items(drawing, view, elapsed, options)) svg += element_of(item, c, view.unit());
  for (const FrameItem& item : drawing::furniture(drawing, view, options)) svg += element_of(item, c, view.unit());
  return svg + "</g>\n</svg>\n";
}

std::string animated_svg(const Drawing& drawing, const Playback& playback, const FrameOptions& options) {
  const View view(drawing, options);
  const Colours c = colours_of(options.theme);
  Frames frames;
  for (const double elapsed : playback.elapsed) frames.push_back(frame_items(drawing, view, elapsed, options));
  std::string svg = opening(options, c, view.unit());
  // What never moves is written once, below the rest.
  std::vector<std::size_t> still;
  if (frames.size() > 1)
    for (std::size_t i = 0; i < frames[0].size(); ++i) {
      const auto same = [&](const std::vector<FrameItem>& frame) {
        return i < frame.size() && frame[i].id == frames[0][i].id && frame[i].kind == frames[0][i].kind &&
               frame[i].points == frames[0][i].points;
      };
      if (!std::all_of(frames.begin(), frames.end(), same)) break;
      svg += element_of(frames[0][i], c, view.unit());
      still.push_back(i);
    }
  for (auto& frame : frames) frame.erase(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(still.size()));
  svg += keep_their_order(frames) ? moving_elements(frames, c, view.unit(), playback)
                                  : turned_pages(frames, c, view.unit(), playback);
  for (const FrameItem& item : drawing::furniture(drawing, view, options)) svg += element_of(item, c, view.unit());
  return svg + "</g>\n</svg>\n";
}

}  // namespace maupertuis

#include "plot/polyline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace maupertuis {

std::vector<Polyline> split_at_gaps(const Polyline& points, const std::vector<std::size_t>& breaks) {
  std::vector<Polyline> lines(1);
  auto next = breaks.begin();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool is_break = next != breaks.end() && *next == i, is_finite = std::isfinite(points[i].x + points[i].y);
    if (is_break) ++next;
    if ((is_break || !is_finite) && !lines.back().empty()) lines.emplace_back();
    if (is_finite) lines.back().push_back(points[i]);
  }
  if (lines.back().empty()) lines.pop_back();
  return lines;
}

Polyline thin_columns(const Polyline& line, double width) {
  Polyline thinned;
  for (std::size_t first = 0; first < line.size();) {
    const double column = std::floor(line[first].x / width);
    std::size_t last = first, low = first, high = first;
    while (last + 1 < line.size() && std::floor(line[last + 1].x / width) == column) {
      ++last;
      if (line[last].y < line[low].y) low = last;
      if (line[last].y > line[high].y) high = last;
    }
    std::size_t kept[] = {first, std::min(low, high), std::max(low, high), last};
    for (auto end = std::unique(std::begin(kept), std::end(kept)), it = std::begin(kept); it != end; ++it)
      thinned.push_back(line[*it]);
    first = last + 1;
  }
  return thinned;
}

// From an anchor, every skipped point allows a cone of directions that pass it within the tolerance; a point outside
// the common cone, or one that comes back towards the anchor, makes its predecessor the next anchor.
Polyline straighten(const Polyline& line, double tolerance) {
  if (line.size() < 3) return line;
  Polyline kept{line[0]};
  Pixel anchor = line[0];
  double axis = 0, low = 0, high = 0, reach = 0;
  bool open = false;  // a cone exists
  const auto restart = [&](Pixel at) {
    anchor = at;
    open = false;
    reach = 0;
  };
  const auto fits = [&](Pixel p) {
    const double distance = std::hypot(p.x - anchor.x, p.y - anchor.y);
    if (distance < reach) return false;
    reach = distance;
    if (distance <= tolerance) return true;
    double direction = std::atan2(p.y - anchor.y, p.x - anchor.x);
    const double half = std::asin(tolerance / distance);
    if (!open) {
      axis = direction;
      low = -half;
      high = half;
      open = true;
      return true;
    }
    direction = std::remainder(direction - axis, 6.283185307179586);
    if (direction < low || direction > high) return false;
    low = std::max(low, direction - half);
    high = std::min(high, direction + half);
    return true;
  };
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (fits(line[i])) continue;
    kept.push_back(line[i - 1]);
    restart(line[i - 1]);
    fits(line[i]);
  }
  kept.push_back(line.back());
  return kept;
}

Ink::Ink(double width, double height)
    : columns_(static_cast<int>(width) + 3),
      rows_(static_cast<int>(height) + 3),
      dark_(static_cast<std::size_t>(columns_) * rows_) {}

bool Ink::stroke(Pixel from, Pixel to) {
  const double length = std::max(std::abs(to.x - from.x), std::abs(to.y - from.y));
  const int count = 1 + static_cast<int>(std::min(length * 2, 20'000.0));
  bool fresh = false;
  for (int i = 0; i <= count; ++i) {
    const double s = static_cast<double>(i) / count;
    const int column = std::clamp(static_cast<int>(from.x + s * (to.x - from.x)) + 1, 0, columns_ - 1);
    const int row = std::clamp(static_cast<int>(from.y + s * (to.y - from.y)) + 1, 0, rows_ - 1);
    auto cell = dark_[static_cast<std::size_t>(row) * columns_ + column];
    fresh = fresh || !cell;
    cell = true;
  }
  return fresh;
}

std::vector<Polyline> Ink::draw(const Polyline& line) {
  if (line.size() < 2) return {line};
  std::vector<Polyline> parts;
  bool drawing = false;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const bool fresh = stroke(line[i - 1], line[i]);
    if (fresh && !drawing) parts.push_back({line[i - 1]});
    if (fresh) parts.back().push_back(line[i]);
    drawing = fresh;
  }
  return parts;
}

namespace {

// A number of hundredths, as short as SVG allows; a separator only where one is needed.
void append_hundredths(std::string& out, long value, bool first) {
  if (value < 0)
    out += '-';
  else if (!first)
    out += ' ';
  const long size = std::abs(value), whole = size / 100, part = size % 100;
  if (whole != 0 || part == 0) fmt::format_to(std::back_inserter(out), "{}", whole);
  if (part != 0 && part % 10 == 0)
    fmt::format_to(std::back_inserter(out), ".{}", part / 10);
  else if (part != 0)
    fmt::format_to(std::back_inserter(out), ".{:02}", part);
}

}  // namespace

std::string path_data(const std::vector<Polyline>& lines) {
  std::string out;
  for (const Polyline& line : lines) {
    long x = 0, y = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const long next_x = std::lround(line[i].x * 100), next_y = std::lround(line[i].y * 100);
      if (i > 1 && next_x == x && next_y == y) continue;
      if (i == 0) out += 'M';
      if (i == 1) out += 'l';
      append_hundredths(out, next_x - x, i < 2);
      append_hundredths(out, next_y - y, false);
      x = next_x;
      y = next_y;
    }
    if (line.size() == 1) out += "h0";
  }
  return out;
}

}  // namespace maupertuis

#include "plot/bands.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace maupertuis {
namespace {

/// A corner, or where the level is crossed to the right of it or above it.
using Vertex = std::size_t;
enum Spot : std::size_t { Corner, Right, Above };

class Tracer {
 public:
  Tracer(const Grid& grid, double level) : g_(grid), nx_(grid.x.size()), ny_(grid.y.size()), level_(level) {}

  std::vector<Polyline> loops() {
    for (std::size_t j = 0; j + 1 < ny_; ++j)
      for (std::size_t i = 0; i + 1 < nx_; ++i) cell(i, j);
    std::vector<Polyline> out;
    while (!next_.empty()) {
      Polyline loop;
      for (auto at = next_.begin(); at != next_.end();) {
        loop.push_back(place(at->first));
        const Vertex to = at->second.back();
        at->second.pop_back();
        if (at->second.empty()) next_.erase(at);
        at = next_.find(to);
      }
      out.push_back(std::move(loop));
    }
    return out;
  }

 private:
  double value(std::size_t i, std::size_t j) const { return g_.values[j * nx_ + i]; }
  bool inside(std::size_t i, std::size_t j) const { return value(i, j) >= level_; }
  bool exists(std::size_t i, std::size_t j) const {
    return i + 1 < nx_ && j + 1 < ny_ && std::isfinite(value(i, j)) && std::isfinite(value(i + 1, j)) &&
           std::isfinite(value(i, j + 1)) && std::isfinite(value(i + 1, j + 1));
  }
  Vertex vertex(std::size_t i, std::size_t j, Spot spot) const { return 3 * (j * nx_ + i) + spot; }

  Pixel place(Vertex v) const {
    const std::size_t corner = v / 3, i = corner % nx_, j = corner / nx_;
    const auto part = [&](double from, double to) { return (level_ - from) / (to - from); };
    Pixel out{g_.x[i], g_.y[j]};
    if (v % 3 == Right) out.x += part(value(i, j), value(i + 1, j)) * (g_.x[i + 1] - g_.x[i]);
    if (v % 3 == Above) out.y += part(value(i, j), value(i, j + 1)) * (g_.y[j + 1] - g_.y[j]);
    return out;
  }

  /// Goes around the part of a cell that is inside. A side that a neighbour has too is no border.
  void cell(std::size_t i, std::size_t j) {
    if (!exists(i, j)) return;
    const std::size_t corner[4][2] = {{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}};
    const Vertex crossing[4] = {vertex(i, j, Right), vertex(i + 1, j, Above), vertex(i, j + 1, Right),
                                vertex(i, j, Above)};
    const bool open[4] = {!(j > 0 && exists(i, j - 1)), !exists(i + 1, j), !exists(i, j + 1),
                          !(i > 0 && exists(i - 1, j))};
    Vertex left = none_, first = none_;  // where the border left the cell's inside; where it came first
    for (std::size_t side = 0; side < 4; ++side) {
      const auto& a = corner[side];
      const auto& b = corner[(side + 1) % 4];
      const bool from = inside(a[0], a[1]), to = inside(b[0], b[1]);
      const Vertex here = vertex(a[0], a[1], Corner), there = vertex(b[0], b[1], Corner), cross = crossing[side];
      if (from && open[side]) join(here, to ? there : cross);
      if (!from && to && open[side]) join(cross, there);
      if (from && !to) left = cross;
      if (!from && to) {
        if (left == none_)
          first = cross;
        else
          join(left, cross), left = none_;
      }
    }
    if (left != none_ && first != none_) join(left, first);
  }
  void join(Vertex from, Vertex to) { next_[from].push_back(to); }

  static constexpr Vertex none_ = static_cast<Vertex>(-1);
  const Grid& g_;
  std::size_t nx_, ny_;
  double level_;
  std::map<Vertex, std::vector<Vertex>> next_;
};

}  // namespace

std::vector<Polyline> region_above(const Grid& grid, double level) { return Tracer(grid, level).loops(); }

std::string closed_path(const std::vector<Polyline>& loops) {
  std::string out;
  for (const Polyline& loop : loops) {
    Polyline closed = loop;
    closed.push_back(loop.front());
    closed = straighten(closed, 0.15);
    if (closed.size() < 4) continue;
    long x = 0, y = 0;
    for (std::size_t n = 0; n + 1 < closed.size(); ++n) {
      const long to_x = std::lround(10 * closed[n].x), to_y = std::lround(10 * closed[n].y);
      if (n > 0 && to_x == x && to_y == y) continue;
      out += fmt::format("{}{:g} {:g}", n == 0 ? "M" : "l", 0.1 * static_cast<double>(to_x - x),
                         0.1 * static_cast<double>(to_y - y));
      x = to_x, y = to_y;
    }
    out += "z";
  }
  return out;
}

}  // namespace maupertuis

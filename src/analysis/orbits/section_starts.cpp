#include "analysis/orbits/section_starts.hpp"

#include <maupertuis/interrupt.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>

/// The allowed part of the plane (b, b') is found on a grid: from the point that is known to be allowed it is filled
/// cell by cell, so that what lies beyond a saddle stays out, and the grid grows until the part no longer touches its
/// edge. Starts are the points of the additive recurrence R₂ (M. Roberts, 2018), which cover a plane evenly at every
/// number.
namespace maupertuis::orbits {
namespace {

using Index = Eigen::Index;

constexpr int cells = 120;  // of the grid in each direction
constexpr int most_doublings = 8;
constexpr int columns_of_outline = 240;
constexpr int halvings = 40;
constexpr std::size_t most_starts = 100'000;

class Plane {
 public:
  Plane(const EquationsOfMotion& equations, const SectionOptions& options, const MotionState& near, double energy)
      : section_(*equations.system, {&options.section, 1}),
        energy_(*equations.system, {&equations.energy_function, 1}),
        near_(near),
        value_(energy),
        direction_(options.direction == SectionDirection::Falling ? -1 : 1) {
    const Eigen::MatrixXd slope = section_.slopes(near);
    by_velocity_ = slope.rightCols(2).cwiseAbs().maxCoeff() > 0;
    along_ = std::abs(slope(0, 0)) >= std::abs(slope(0, 1)) ? 0 : 1;
  }

  bool by_velocity() const { return by_velocity_; }
  std::size_t along() const { return along_; }
  std::size_t across() const { return 1 - along_; }

  /// The state at (b, b'), if the section and the energy have one there.
  std::optional<MotionState> at(double b, double rate) const {
    MotionState s = near_;
    s.q[across()] = b;
    s.v[across()] = rate;
    if (!solve_section(s) || !solve_energy(s)) return std::nullopt;
    return s;
  }

 private:
  bool solve_section(MotionState& s) const {
    for (int turn = 0; turn < 60; ++turn) {
      const double value = section_.values(s)[0], slope = section_.slopes(s)(0, static_cast<Index>(along_));
      const double step = -value / slope;
      if (!std::isfinite(step)) return false;
      s.q[along_] += step;
      if (std::abs(step) <= 4e-16 * std::abs(s.q[along_]) || std::abs(value) <= 1e-300) return true;
      if (turn > 8 && std::abs(step) < 1e-13 * (std::abs(s.q[along_]) + std::abs(near_.q[along_]))) return true;
    }
    return false;
  }

  double energy_with(MotionState& s, double rate) const {
    s.v[along_] = rate;
    return energy_.values(s)[0] - value_;
  }

  /// h_E = c₀ + c₁ v + c₂ v² in the velocity v that is looked for; Newton's method for what is not quadratic.
  bool solve_energy(MotionState& s) const {
    const double low = energy_with(s, -1), middle = energy_with(s, 0), high = energy_with(s, 1);
    const double square = 0.5 * (high + low) - middle, linear = 0.5 * (high - low);
    const double discriminant = linear * linear - 4 * square * middle;
    if (!(discriminant >= 0) || square == 0) return false;
    for (const double root : {1.0, -1.0}) {
      double v = (-linear + root * std::sqrt(discriminant)) / (2 * square);
      for (int turn = 0; turn < 20; ++turn) {
        const double rest = energy_with(s, v), slope = energy_.slopes(s)(0, static_cast<Index>(2 + along_));
        const double step = slope != 0 ? rest / slope : 0;
        v -= step;
        if (std::abs(step) <= 4e-16 * std::abs(v)) break;
      }
      if (!(std::abs(energy_with(s, v)) <= 1e-9 * (std::abs(value_) + std::abs(middle)))) continue;
      const Eigen::MatrixXd slope = section_.slopes(s);
      if (direction_ * (slope(0, 0) * s.v[0] + slope(0, 1) * s.v[1]) >= 0) return true;
    }
    return false;
  }

  tangent::PointFunctions section_, energy_;
  MotionState near_;
  double value_;
  int direction_;
  bool by_velocity_ = false;
  std::size_t along_ = 0;
};

/// A box around the known point, and which of its cells belong to the part that contains it.
class Grid {
 public:
  Grid(const Plane& plane, double b, double rate, double half_width, double half_height)
      : plane_(plane), centre_{b, rate}, half_{half_width, half_height}, member_(cells * cells, false) {
    fill();
  }
  double x(double i) const { return centre_[0] + half_[0] * (2 * i / cells - 1); }
  double y(double j) const { return centre_[1] + half_[1] * (2 * j / cells - 1); }
  bool empty() const { return count_ == 0; }
  bool touches(int direction) const { return touches_[direction]; }
  bool holds(double b, double rate) const {
    const int i = static_cast<int>(std::floor((b - x(0)) / (x(1) - x(0)))),
              j = static_cast<int>(std::floor((rate - y(0)) / (y(1) - y(0))));
    for (int di = -1; di <= 1; ++di)
      for (int dj = -1; dj <= 1; ++dj)
        if (i + di >= 0 && i + di < cells && j + dj >= 0 && j + dj < cells && member_[(i + di) * cells + j + dj])
          return true;
    return false;
  }
  /// Cells of the part, its extent: first and last column, first and last row.
  int first[2] = {cells, cells}, last[2] = {-1, -1};

 private:
  void fill() {
    std::queue<std::pair<int, int>> open;
    std::vector<bool> seen(cells * cells, false);
    const auto add = [&](int i, int j) {
      if (i < 0 || j < 0 || i >= cells || j >= cells || seen[i * cells + j]) return;
      seen[i * cells + j] = true;
      if (!plane_.at(x(i + 0.5), y(j + 0.5))) return;
      open.push({i, j});
    };
    for (int di = -1; di <= 0; ++di)
      for (int dj = -1; dj <= 0; ++dj) add(cells / 2 + di, cells / 2 + dj);
    while (!open.empty()) {
      const auto [i, j] = open.front();
      open.pop();
      take(i, j);
      add(i + 1, j), add(i - 1, j), add(i, j + 1), add(i, j - 1);
    }
  }
  void take(int i, int j) {
    member_[i * cells + j] = true;
    ++count_;
    const int at[2] = {i, j};
    for (int k = 0; k < 2; ++k) {
      first[k] = std::min(first[k], at[k]), last[k] = std::max(last[k], at[k]);
      touches_[k] = touches_[k] || at[k] == 0 || at[k] == cells - 1;
    }
  }

  const Plane& plane_;
  double centre_[2], half_[2];
  std::vector<bool> member_;
  std::size_t count_ = 0;
  bool touches_[2] = {false, false};
};

/// Grown until the part lies inside, or it is clear that it has no border. Where the energy does not allow the known
/// point itself, points between it and rest at the origin are tried.
std::optional<Grid> fitted(const Plane& plane, const MotionState& near, const std::vector<double>& sizes) {
  for (const double part : {1.0, 0.7, 0.4, 0.2, 0.1, 0.0}) {
    const double b = part * near.q[plane.across()], rate = part * near.v[plane.across()];
    if (!plane.at(b, rate)) continue;
    double half[2] = {sizes[plane.across()], sizes[2 + plane.across()]};
    for (int turn = 0; turn < most_doublings; ++turn) {
      Grid grid(plane, b, rate, half[0], half[1]);
      if (!grid.empty() && !grid.touches(0) && !grid.touches(1)) return grid;
      for (int k = 0; k < 2; ++k) half[k] *= grid.empty() ? 0.5 : grid.touches(k) ? 2.0 : 1.0;
    }
    Grid last(plane, b, rate, half[0], half[1]);
    if (!last.empty()) return last;
  }
  return std::nullopt;
}

std::vector<MotionState> spread(const Plane& plane, const Grid& grid, std::size_t count, const StopFlag* interrupt) {
  constexpr double plastic = 1.32471795724474602596;  // x³ = x + 1
  std::vector<MotionState> out;
  for (std::size_t k = 1; out.size() < count && k < 400 * count; ++k) {
    if (k % 1024 == 0) Interrupt(interrupt).throw_if_asked();
    const double u = std::fmod(0.5 + static_cast<double>(k) / plastic, 1.0),
                 w = std::fmod(0.5 + static_cast<double>(k) / (plastic * plastic), 1.0);
    const double b = grid.x(grid.first[0] + u * (grid.last[0] + 1 - grid.first[0])),
                 rate = grid.y(grid.first[1] + w * (grid.last[1] + 1 - grid.first[1]));
    if (!grid.holds(b, rate)) continue;
    if (auto state = plane.at(b, rate)) out.push_back(std::move(*state));
  }
  return out;
}

/// Where a line that begins in the part leaves it.
template <class Inside>
double border(double inside, double outside, Inside holds) {
  for (int turn = 0; turn < halvings; ++turn)
    (holds(0.5 * (inside + outside)) ? inside : outside) = 0.5 * (inside + outside);
  return inside;
}

/// Column by column the lowest and the highest rate, for a part that each column cuts in one stretch.
std::vector<std::pair<double, double>> outline_of(const Plane& plane, const Grid& grid) {
  std::vector<std::pair<double, double>> above, below;
  const double low = grid.x(grid.first[0]), high = grid.x(grid.last[0] + 1);
  for (int k = 0; k <= columns_of_outline; ++k) {
    // Denser towards the ends, where the border is steep.
    const double b = low + (high - low) * 0.5 * (1 - std::cos(std::numbers::pi * k / columns_of_outline));
    std::optional<double> inside;
    for (int j = 0; j < 4 * cells && !inside; ++j)
      if (const double rate = grid.y(grid.first[1] + (grid.last[1] + 1 - grid.first[1]) * (j + 0.5) / (4 * cells));
          plane.at(b, rate) && grid.holds(b, rate))
        inside = rate;
    if (!inside) continue;
    const auto holds = [&](double rate) { return plane.at(b, rate).has_value(); };
    double top = *inside;
    const double step = (grid.y(1) - grid.y(0)) / 4;
    while (holds(top + step) && top < grid.y(cells)) top += step;
    above.emplace_back(b, border(top, top + step, holds));
    below.emplace_back(b, border(*inside, *inside - step, holds));
  }
  std::reverse(below.begin(), below.end());
  above.insert(above.end(), below.begin(), below.end());
  if (!above.empty()) above.push_back(above.front());
  return above;
}

}  // namespace

std::optional<SectionPlane> spread_starts(const EquationsOfMotion& equations, const SectionOptions& options,
                                          const MotionState& near, double energy, const std::vector<double>& sizes,
                                          Diagnostics& diagnostics) {
  const Plane plane(equations, options, near, energy);
  const auto refuse = [&](const std::string& why, const std::string& help) {
    diagnostics.error("E1407", {}, "several starts cannot be spread over this section", why, help);
    return std::nullopt;
  };
  if (options.starts > most_starts)
    return refuse(fmt::format("{} of them were asked for; no picture shows more than {}.", options.starts, most_starts),
                  "Take fewer.");
  if (plane.by_velocity())
    return refuse("A velocity stands in the section: then it does not fix a coordinate.",
                  "Take a section by positions, such as \"x = 0 rising\", or one start.");
  const auto grid = fitted(plane, near, sizes);
  if (!grid)
    return refuse(
        fmt::format("At the energy {:.9g} J no motion crosses the section near the one of the model.", energy),
        "Choose another energy.");
  SectionPlane out;
  out.along = plane.along();
  out.across = plane.across();
  out.energy = energy;
  out.starts = spread(plane, *grid, options.starts, options.interrupt);
  out.outline = outline_of(plane, *grid);
  if (out.starts.empty())
    return refuse("The part of the section that the energy allows is too small.", "Choose another energy.");
  return out;
}

}  // namespace maupertuis::orbits

#include <maupertuis/mode_pictures.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

enum class Line { Stable, Unstable, Undecided };

Line line_of(Stability s) {
  if (s == Stability::Unstable) return Line::Unstable;
  return s == Stability::Undecided ? Line::Undecided : Line::Stable;
}

std::string unit_text(const MechanicalSystem& system, const Dimension& dimension) {
  const std::string unit = system.dimensionless ? "" : to_string(dimension);
  return unit == "1" ? "" : unit;
}

double coordinate_at(const LocusPoint& x, std::size_t i) { return x.equilibrium.point.q[i]; }

/// Stretches of one verdict; neighbours share the point between them. An angle that passes ±π is cut there.
void add_branch(Diagram& diagram, const LocusBranch& branch, std::size_t i) {
  constexpr double half_turn = 3.141592653589793;
  const auto& points = branch.points;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Line line = line_of(points[k].stability.verdict);
    const bool jump = k > 0 && diagram.degrees_y &&
                      std::abs(coordinate_at(points[k], i) - coordinate_at(points[k - 1], i)) > half_turn;
    const bool begins = k == 0 || jump || line != line_of(points[k - 1].stability.verdict);
    if (begins) {
      diagram.curves.push_back({{},
                                {},
                                line == Line::Unstable ? std::size_t{1} : std::size_t{0},
                                line == Line::Unstable,
                                line == Line::Undecided});
      if (k > 0 && !jump) {
        diagram.curves.back().x.push_back(points[k - 1].parameter);
        diagram.curves.back().y.push_back(coordinate_at(points[k - 1], i));
      }
    }
    diagram.curves.back().x.push_back(points[k].parameter);
    diagram.curves.back().y.push_back(coordinate_at(points[k], i));
  }
}

/// A place that several branches share has one mark.
void add_mark(Diagram& diagram, const Parameter& p, double value, double y, const std::string& unit) {
  const bool told = std::any_of(diagram.marks.begin(), diagram.marks.end(), [&](const Diagram::Mark& m) {
    return std::abs(m.x - value) <= 1e-9 * std::abs(m.x) && std::abs(m.y - y) <= 1e-9;
  });
  if (!told)
    diagram.marks.push_back({value, y, fmt::format("{} = {:.6g}{}{}", p.name, value, unit.empty() ? "" : " ", unit)});
}

void add_marks(Diagram& diagram, const MechanicalSystem& system, const Locus& locus, std::size_t i) {
  const Parameter& p = system.parameters[locus.parameter];
  const std::string unit = unit_text(system, p.dimension);
  for (const StabilityChange& change : locus.changes) {
    const auto& points = locus.branches[change.branch].points;
    const auto nearest = std::min_element(points.begin(), points.end(), [&](const LocusPoint& x, const LocusPoint& y) {
      return std::abs(x.parameter - change.parameter) < std::abs(y.parameter - change.parameter);
    });
    add_mark(diagram, p, change.parameter, coordinate_at(*nearest, i), unit);
  }
  for (const Fold& fold : locus.folds) add_mark(diagram, p, fold.parameter, fold.equilibrium.point.q[i], unit);
}

void add_legend(Diagram& diagram) {
  bool seen[3] = {};
  for (const auto& c : diagram.curves) seen[c.dots ? 2 : c.dashed ? 1 : 0] = true;
  if (seen[0]) diagram.legend.push_back({"stable", 0, false, false});
  if (seen[1]) diagram.legend.push_back({"unstable", 1, true, false});
  if (seen[2]) diagram.legend.push_back({"not decided by the linearization", 0, false, true});
}

}  // namespace

std::vector<Diagram> bifurcation_diagrams(const MechanicalSystem& system, const Locus& locus, std::size_t most) {
  std::vector<Diagram> out;
  const Parameter& p = system.parameters[locus.parameter];
  for (std::size_t i = 0; i < system.coordinates.size() && out.size() < most; ++i) {
    const Coordinate& c = system.coordinates[i];
    if (std::any_of(locus.translations.begin(), locus.translations.end(),
                    [&](const Translation& t) { return t.pivot == i; }))
      continue;
    Diagram d;
    d.x_name = p.name;
    d.x_unit = unit_text(system, p.dimension);
    d.y_name = c.name;
    d.y_unit = unit_text(system, c.dimension);
    d.degrees_y = c.kind == "angle";
    for (const LocusBranch& b : locus.branches) add_branch(d, b, i);
    add_marks(d, system, locus, i);
    add_legend(d);
    out.push_back(std::move(d));
  }
  return out;
}

Diagram root_locus(const MechanicalSystem& system, const Locus& locus) {
  Diagram d;
  d.x_name = "Re λ";
  d.y_name = "Im λ";
  d.x_unit = system.dimensionless ? "" : "1/s";
  d.y_unit = system.dimensionless ? "" : "rad/s";
  d.zero_line = true;
  for (std::size_t b = 0; b < locus.branches.size(); ++b) {
    Diagram::Curve curve;
    curve.series = b;
    curve.dots = true;
    for (const LocusPoint& x : locus.branches[b].points)
      for (const auto& z : x.eigenvalues) curve.x.push_back(z.real()), curve.y.push_back(z.imag());
    d.curves.push_back(std::move(curve));
    constexpr std::size_t most = 5;
    if (locus.branches.size() > 1 && b < most) d.legend.push_back({fmt::format("branch {}", b + 1), b, false, true});
  }
  return d;
}

Diagram shape_diagram(const MechanicalSystem& system, const Mode& mode) {
  Diagram d;
  d.y_name = "shape";
  d.width = 300;
  d.frame_height = 120;
  d.zero_line = true;
  const std::size_t n = mode.shape.size(), stride = (n + 9) / 10;
  Diagram::Curve dots;
  dots.dots = true;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = static_cast<double>(i), y = mode.shape[i].real();
    d.curves.push_back({{x, x}, {0, y}, 0, false, false});
    dots.x.push_back(x);
    dots.y.push_back(y);
    if (i % stride == 0) d.x_labels.emplace_back(x, system.coordinates[i].name);
  }
  d.curves.push_back(std::move(dots));
  return d;
}

}  // namespace maupertuis

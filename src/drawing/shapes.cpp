#include "drawing/shapes.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::shapes {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int corners_of_a_circle = 72;

using Point = std::array<double, 3>;
using Outline = SolidShape::Outline;

Outline outline(int dimension, const std::vector<Point>& points, bool closed) {
  Outline out;
  out.closed = closed;
  for (const Point& p : points) out.points.insert(out.points.end(), p.begin(), p.begin() + dimension);
  return out;
}

Outline ring(int dimension, int first = 0, int second = 1) {
  std::vector<Point> points;
  for (int i = 0; i < corners_of_a_circle; ++i) {
    Point p{};
    p[static_cast<std::size_t>(first)] = std::cos(2 * pi * i / corners_of_a_circle);
    p[static_cast<std::size_t>(second)] = std::sin(2 * pi * i / corners_of_a_circle);
    points.push_back(p);
  }
  return outline(dimension, points, true);
}

// Short strokes behind a line from (x0, y) to (x1, y), leaning back.
void add_hatching(SolidShape& shape, double x0, double x1, double y, double spacing, double depth) {
  const int count = std::max(1, static_cast<int>(std::lround((x1 - x0) / spacing)));
  for (int i = 1; i <= count; ++i) {
    const double x = x0 + (x1 - x0) * i / count;
    shape.lines.push_back(outline(2, {{x, y, 0}, {x - depth, y - depth, 0}}, false));
  }
}

}  // namespace

SolidShape box(int dimension, bool flat) {
  SolidShape shape;
  if (dimension == 2 || flat) {
    shape.faces.push_back(outline(dimension, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, true));
    return shape;
  }
  shape.convex = true;
  for (int k = 0; k < 3; ++k)
    for (const int side : {-1, 1}) {
      std::vector<Point> face;
      for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
        Point p{};
        p[static_cast<std::size_t>(k)] = side;
        p[static_cast<std::size_t>((k + 1) % 3)] = side * u;  // turned the other way on the far side
        p[static_cast<std::size_t>((k + 2) % 3)] = v;
        face.push_back(p);
      }
      shape.faces.push_back(outline(3, face, true));
    }
  return shape;
}

SolidShape disc(int dimension) {
  SolidShape shape;
  shape.faces.push_back(ring(dimension));
  return shape;
}

SolidShape hoop(int dimension) {
  SolidShape shape;
  shape.lines.push_back(ring(dimension));
  return shape;
}

void add_spokes(SolidShape& shape, int dimension, int count) {
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * pi * i / count;
    shape.lines.push_back(outline(dimension, {{0, 0, 0}, {std::cos(angle), std::sin(angle), 0}}, false));
  }
}

SolidShape ball(bool meridians) {
  SolidShape shape;
  shape.ball = true;
  for (const auto& [first, second] : {std::pair{0, 1}, {1, 2}, {2, 0}})
    if (meridians) shape.lines.push_back(ring(3, first, second));
  return shape;
}

SolidShape spring(int dimension, int windings, double slant) {
  constexpr double lead = 0.1;  // straight ends
  constexpr int steps_of_a_winding = 16;
  SolidShape shape;
  std::vector<Point> points{{0, 0, 0}};
  const int steps = windings * steps_of_a_winding;
  for (int i = 0; i <= steps; ++i) {
    const double part = static_cast<double>(i) / steps, phase = 2 * pi * windings * part;
    const double swell = std::pow(std::max(0.0, std::sin(pi * part)), 0.25);  // the coil grows out of the straight ends
    const double back = dimension == 2 ? slant * swell * std::cos(phase) : 0;
    points.push_back({lead + (1 - 2 * lead) * part + back, swell * std::sin(phase), swell * std::cos(phase)});
  }
  points.push_back({1, 0, 0});
  shape.lines.push_back(outline(dimension, points, false));
  return shape;
}

SolidShape cup(int dimension, double from, double to) {
  SolidShape shape;
  shape.lines.push_back(outline(dimension, {{0, 0, 0}, {from, 0, 0}}, false));
  shape.lines.push_back(outline(dimension, {{to, 1, 0}, {from, 1, 0}, {from, -1, 0}, {to, -1, 0}}, false));
  return shape;
}

SolidShape plate(int dimension, double rod) {
  SolidShape shape;
  shape.lines.push_back(outline(dimension, {{0, 0, 0}, {rod, 0, 0}}, false));
  shape.lines.push_back(outline(dimension, {{rod, 0.8, 0}, {rod, -0.8, 0}}, false));
  return shape;
}

void add_bars_to_middle(SolidShape& shape, int dimension, double aside, bool both_ends) {
  for (const double end : {0.0, 1.0})
    if (end == 0 || both_ends) shape.lines.push_back(outline(dimension, {{end, 0, 0}, {end, -aside, 0}}, false));
}

SolidShape pivot() {
  SolidShape shape;
  shape.role = SolidShape::Role::Ground;
  shape.faces.push_back(outline(2, {{0, 0, 0}, {-0.55, -1, 0}, {0.55, -1, 0}}, true));
  shape.lines.push_back(outline(2, {{-0.95, -1, 0}, {0.95, -1, 0}}, false));
  add_hatching(shape, -0.95, 0.95, -1, 0.38, 0.3);
  return shape;
}

SolidShape anchor() {
  SolidShape shape;
  shape.role = SolidShape::Role::Ground;
  shape.lines.push_back(outline(2, {{-1, 0, 0}, {1, 0, 0}}, false));
  add_hatching(shape, -1, 1, 0, 0.4, 0.32);
  return shape;
}

SolidShape ground_line(double half, double spacing) {
  SolidShape shape;
  shape.role = SolidShape::Role::Ground;
  shape.lines.push_back(outline(2, {{-half, 0, 0}, {half, 0, 0}}, false));
  constexpr double most = 600;
  spacing = std::max(spacing, 2 * half / most);
  add_hatching(shape, -half, half, 0, spacing, 0.7 * spacing);
  return shape;
}

SolidShape ground_grid(int lines) {
  SolidShape shape;
  shape.role = SolidShape::Role::Ground;
  for (int i = 0; i <= lines; ++i) {
    const double d = -1 + 2.0 * i / lines;
    shape.lines.push_back(outline(3, {{d, -1, 0}, {d, 1, 0}}, false));
    shape.lines.push_back(outline(3, {{-1, d, 0}, {1, d, 0}}, false));
  }
  return shape;
}

namespace {

/// Eigenvalues and eigenvectors of a symmetric matrix by Jacobi's rotations; the vectors are the rows of `axes`.
void diagonalize(std::array<Point, 3>& a, std::array<Point, 3>& axes) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) axes[i][j] = i == j;
  for (int sweep = 0; sweep < 30; ++sweep)
    for (const auto& [p, q] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
      if (a[p][q] == 0) continue;
      const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
      const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
      const double c = 1 / std::sqrt(t * t + 1), s = t * c;
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = a[k][p], y = a[k][q];
        a[k][p] = c * x - s * y;
        a[k][q] = s * x + c * y;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = a[p][k], y = a[q][k];
        a[p][k] = c * x - s * y;
        a[q][k] = s * x + c * y;
        const double u = axes[p][k], v = axes[q][k];
        axes[p][k] = c * u - s * v;
        axes[q][k] = s * u + c * v;
      }
    }
}

Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

// I₁ = m (b² + c²)/5, and so on round: a² = 5 (I₂ + I₃ − I₁)/(2 m).
Ellipsoid ellipsoid_of_inertia(const std::array<Point, 3>& inertia, double mass) {
  std::array<Point, 3> moments = inertia;
  Ellipsoid out;
  diagonalize(moments, out.axes);
  out.axes[2] = cross(out.axes[0], out.axes[1]);
  const double trace = moments[0][0] + moments[1][1] + moments[2][2];
  double largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double square = 2.5 * (trace - 2 * moments[k][k]) / (mass > 0 ? mass : 1);
    out.semi_axes[k] = std::sqrt(std::max(0.0, square));
    largest = std::max(largest, out.semi_axes[k]);
  }
  for (double& a : out.semi_axes) {
    a = std::max(a, 0.02 * largest);
    if (!(mass > 0) && largest > 0) a /= largest;
  }
  return out;
}

std::array<Point, 3> basis_about(const Point& axis) {
  const double length = std::hypot(axis[0], axis[1], axis[2]);
  const Point n = length > 0 ? Point{axis[0] / length, axis[1] / length, axis[2] / length} : Point{0, 0, 1};
  // The x axis of the model seen along n, or its y axis where n is along x.
  const Point seed = std::abs(n[0]) < 0.9 ? Point{1, 0, 0} : Point{0, 1, 0};
  const double along = seed[0] * n[0] + seed[1] * n[1] + seed[2] * n[2];
  Point u{seed[0] - along * n[0], seed[1] - along * n[1], seed[2] - along * n[2]};
  const double size = std::hypot(u[0], u[1], u[2]);
  for (double& x : u) x /= size;
  return {u, cross(n, u), n};
}

}  // namespace maupertuis::shapes

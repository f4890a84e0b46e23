// Solids in their own axes; the ellipsoid that stands for an inertia.
#include "drawing/shapes.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace maupertuis;

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix diagonal(double a, double b, double c) { return {{{a, 0, 0}, {0, b, 0}, {0, 0, c}}}; }

}  // namespace

TEST_CASE("the ellipsoid of a homogeneous ellipsoid is itself, its axes in order") {
  const double m = 3, a = 0.2, b = 0.5, c = 0.9;
  const auto e = shapes::ellipsoid_of_inertia(
      diagonal(m / 5 * (b * b + c * c), m / 5 * (a * a + c * c), m / 5 * (a * a + b * b)), m);
  CHECK(e.semi_axes[0] == doctest::Approx(a));
  CHECK(e.semi_axes[1] == doctest::Approx(b));
  CHECK(e.semi_axes[2] == doctest::Approx(c));
  CHECK(e.axes[1][1] == doctest::Approx(1));
}

TEST_CASE("the ellipsoid of a box is √(5/3) of its half sides") {
  const double m = 2, sides[3] = {0.4, 1.0, 0.1};
  const auto moment = [&](int i, int j) { return m / 12 * (sides[i] * sides[i] + sides[j] * sides[j]); };
  const auto e = shapes::ellipsoid_of_inertia(diagonal(moment(1, 2), moment(0, 2), moment(0, 1)), m);
  for (std::size_t k = 0; k < 3; ++k) CHECK(e.semi_axes[k] == doctest::Approx(sides[k] / 2 * std::sqrt(5.0 / 3)));
}

TEST_CASE("an inertia about turned axes gives the turned ellipsoid, right-handed") {
  const double m = 1, a = 0.3, b = 0.2, c = 0.1, angle = 0.6, s = std::sin(angle), k = std::cos(angle);
  const double A = m / 5 * (b * b + c * c), B = m / 5 * (a * a + c * c), C = m / 5 * (a * a + b * b);
  const Matrix inertia{
      {{k * k * A + s * s * B, k * s * (A - B), 0}, {k * s * (A - B), s * s * A + k * k * B, 0}, {0, 0, C}}};
  const auto e = shapes::ellipsoid_of_inertia(inertia, m);
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::abs(e.semi_axes[i] - a) < 1e-9) CHECK(std::abs(e.axes[i][0] * k + e.axes[i][1] * s) == doctest::Approx(1));
    double length = 0;
    for (std::size_t j = 0; j < 3; ++j) length += e.axes[i][j] * e.axes[i][j];
    CHECK(length == doctest::Approx(1));
  }
  const auto& x = e.axes;
  const double volume = x[0][0] * (x[1][1] * x[2][2] - x[1][2] * x[2][1]) -
                        x[0][1] * (x[1][0] * x[2][2] - x[1][2] * x[2][0]) +
                        x[0][2] * (x[1][0] * x[2][1] - x[1][1] * x[2][0]);
  CHECK(volume == doctest::Approx(1));
}

TEST_CASE("a flat or impossible inertia still has an ellipsoid; without mass the largest semi-axis is 1") {
  const auto flat = shapes::ellipsoid_of_inertia(diagonal(1, 2, 3), 1);
  CHECK(flat.semi_axes[2] == doctest::Approx(0.02 * flat.semi_axes[0]));
  const auto bare = shapes::ellipsoid_of_inertia(diagonal(1, 2, 3), 0);
  CHECK(bare.semi_axes[0] == doctest::Approx(1));
  const auto wrong = shapes::ellipsoid_of_inertia(diagonal(1, 1, 5), 1);
  for (const double a : wrong.semi_axes) CHECK(a > 0);
}

TEST_CASE("a spring has its windings, and ends where it is fastened") {
  for (const int windings : {5, 12}) {
    const auto shape = shapes::spring(2, windings, 0.01);
    const auto& p = shape.lines.at(0).points;
    CHECK(p[0] == 0);
    CHECK(p[1] == 0);
    CHECK(p[p.size() - 2] == 1);
    CHECK(p.back() == 0);
    int crossings = 0;  // of the axis, upwards
    for (std::size_t i = 3; i + 2 < p.size(); i += 2) crossings += p[i - 2] < -1e-9 && p[i] >= -1e-9;
    CHECK(crossings == windings);
  }
}

TEST_CASE("the faces of a box turn counter-clockwise seen from outside") {
  const auto shape = shapes::box(3, false);
  REQUIRE(shape.faces.size() == 6);
  for (const auto& face : shape.faces) {
    const auto& p = face.points;
    double outward = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      const double n = (p[3 + i] - p[i]) * (p[6 + j] - p[3 + j]) - (p[3 + j] - p[j]) * (p[6 + i] - p[3 + i]);
      outward += n * (p[k] + p[6 + k]);  // the middle of the face is half of that
    }
    CHECK(outward > 0);
  }
}

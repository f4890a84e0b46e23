#pragma once
#include <maupertuis/comparison.hpp>

#include <functional>

namespace maupertuis::comparison {

/// The value of an expression at the start.
using AtStart = std::function<double(Expr)>;

/// x = −rest/c where φ = c x + rest and c holds neither coordinates nor time.
struct LinearSolution {
  Expr coordinate, value;
  double pivot = 0;  // c at the start
};
std::optional<LinearSolution> solve_linear(Expr relation, Expr coordinate, const AtStart& at_start);

/// Σ ((x_i − c_i)/r_i)² = 1: where φ is quadratic in two or three coordinates without mixed terms, and nothing else
/// moves its size.
struct Ellipsoid {
  ExprVector coordinates, centre, radii;  // [2] or [3]
  bool round = false;                     // all radii are one
};
std::optional<Ellipsoid> find_ellipsoid(Expr relation, std::span<const Expr> candidates, const AtStart& at_start);

/// a x + b y + c = 0 in two coordinates, a and b functions of time: a line that turns. Its foot is the point nearest to
/// the origin, its direction a unit vector.
struct Line {
  ExprVector coordinates, foot, direction;  // [2]
};
std::optional<Line> find_line(Expr relation, std::span<const Expr> candidates, const AtStart& at_start);

/// √u = r as u − r² = 0; other relations as they are.
Expr without_root(Expr relation);

bool holds_coordinates(Expr e);
bool holds_time(Expr e);

}  // namespace maupertuis::comparison

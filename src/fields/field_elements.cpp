#include "fields/field_elements.hpp"

#include "linear_algebra/quadrature.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

/// P_n and its integrals from −1, once and twice, at ξ: [times][n] for n ≤ last. ∫P_n = (P_{n+1} − P_{n−1})/(2n + 1).
struct LegendreIntegrals {
  std::vector<double> of[3];

  LegendreIntegrals(double xi, std::size_t last) {
    std::vector<double>& p = of[0];
    p.assign(last + 3, 1);
    p[1] = xi;
    for (std::size_t n = 2; n < p.size(); ++n)
      p[n] = ((2.0 * static_cast<double>(n) - 1) * xi * p[n - 1] - (static_cast<double>(n) - 1) * p[n - 2]) /
             static_cast<double>(n);
    for (int times = 1; times <= 2; ++times) {
      of[times].assign(last + 3 - static_cast<std::size_t>(times), 0);
      // Below n = times the integral is none of the functions of an element.
      for (std::size_t n = static_cast<std::size_t>(times); n < of[times].size(); ++n)
        of[times][n] = (of[times - 1][n + 1] - of[times - 1][n - 1]) / (2.0 * static_cast<double>(n) + 1);
    }
    // ∫∫P_n for n ≥ 2 needs ∫P_1 = (P_2 − P_0)/3, which is there.
  }
};

}  // namespace

ElementSpace::ElementSpace(const ElementMesh& mesh, Kind kind) : mesh_(mesh), kind_(kind) {
  const std::size_t elements = mesh_.borders.size() - 1, degree = static_cast<std::size_t>(mesh_.degree);
  const std::size_t own = kind_ == Kind::Smooth ? 2 : 1, inner = degree + 1 - 2 * own;
  size_ = elements * (own + inner) + (mesh_.periodic ? 0 : own);
  const Lobatto rule(mesh_.points);
  for (std::size_t e = 0; e < elements; ++e) {
    const double a = mesh_.borders[e], half = (mesh_.borders[e + 1] - a) / 2;
    for (std::size_t q = 0; q < rule.x.size(); ++q)
      points_.push_back({a + half * (1 + rule.x[q]), half * rule.w[q], in(e, rule.x[q])});
  }
}

std::size_t ElementSpace::dofs_of_border(std::size_t border) const {
  const std::size_t degree = static_cast<std::size_t>(mesh_.degree);
  const std::size_t per_element = kind_ == Kind::Smooth ? degree - 1 : degree;
  if (mesh_.periodic && border + 1 == mesh_.borders.size()) border = 0;
  return border * per_element;
}

std::size_t ElementSpace::value_at_border(std::size_t border) const { return dofs_of_border(border); }
std::size_t ElementSpace::slope_at_border(std::size_t border) const { return dofs_of_border(border) + 1; }

std::vector<ElementSpace::Part> ElementSpace::in(std::size_t element, double xi) const {
  const double half = (mesh_.borders[element + 1] - mesh_.borders[element]) / 2;
  const std::size_t left = dofs_of_border(element), right = dofs_of_border(element + 1);
  const std::size_t degree = static_cast<std::size_t>(mesh_.degree);
  std::vector<Part> out;
  const auto add = [&](std::size_t dof, double u, double slope, double curvature) {
    out.push_back({dof, {u, slope / half, curvature / (half * half)}});
  };
  if (kind_ == Kind::Nodal) {
    const Lobatto rule(mesh_.degree);
    std::vector<double> value, slope;
    rule.at(xi, value, slope);
    for (std::size_t m = 0; m <= degree; ++m)
      add(m == 0 ? left : m == degree ? right : left + m, value[m], slope[m], 0);
    return out;
  }
  const LegendreIntegrals p(xi, degree);
  if (kind_ == Kind::Continuous) {
    add(left, (1 - xi) / 2, -0.5, 0), add(right, (1 + xi) / 2, 0.5, 0);
    for (std::size_t n = 1; n < degree; ++n) {
      const double size = std::sqrt(static_cast<double>(n) + 0.5);
      add(left + n, size * p.of[1][n], size * p.of[0][n], 0);
    }
    return out;
  }
  const double l = (1 - xi) / 2, r = (1 + xi) / 2;  // slopes by x: the functions of slopes are `half` times larger
  add(left, l * l * (2 + xi), -3 * l * r, 1.5 * xi);
  add(left + 1, half * 2 * l * l * r, half * (l * l - 2 * l * r), half * (1.5 * xi - 0.5));
  add(right, r * r * (2 - xi), 3 * l * r, -1.5 * xi);
  add(right + 1, -half * 2 * r * r * l, half * (r * r - 2 * l * r), half * (1.5 * xi + 0.5));
  for (std::size_t n = 2; n + 1 < degree; ++n) {
    const double size = std::sqrt(static_cast<double>(n) + 0.5);
    add(left + n, size * p.of[2][n], size * p.of[1][n], size * p.of[0][n]);
  }
  return out;
}

std::vector<ElementSpace::Part> ElementSpace::at(double x, bool from_left) const {
  const auto above = from_left ? std::lower_bound(mesh_.borders.begin(), mesh_.borders.end(), x)
                               : std::upper_bound(mesh_.borders.begin(), mesh_.borders.end(), x);
  const std::size_t elements = mesh_.borders.size() - 1;
  const std::size_t after = static_cast<std::size_t>(above - mesh_.borders.begin());
  const std::size_t e = std::min(after == 0 ? 0 : after - 1, elements - 1);
  return in(e, 2 * (x - mesh_.borders[e]) / (mesh_.borders[e + 1] - mesh_.borders[e]) - 1);
}

}  // namespace maupertuis

#pragma once
#include <cstddef>
#include <vector>

namespace maupertuis {

/// Elements on borders that need not be equally far apart, with one rule of quadrature for all fields of a model.
struct ElementMesh {
  std::vector<double> borders;  // ascending
  int degree = 8;               // of the polynomials in an element
  int points = 8;               // order of the Gauss-Lobatto rule
  bool periodic = false;        // the last border is the first one
};

/// The functions of one field on such elements: continuous ones, or ones with continuous slopes. Nodal ones are
/// Lagrange's through the Gauss-Lobatto points (continuous; degree = points), which makes mass matrices diagonal. The
/// others are those of the borders, linear or Hermite's cubic ones, and within an element integrals of Legendre's
/// polynomials, once or twice, whose slopes or curvatures are orthonormal: they keep the digits of low modes.
class ElementSpace {
 public:
  enum class Kind { Nodal, Continuous, Smooth };
  ElementSpace(const ElementMesh& mesh, Kind kind);

  /// The share of one degree of freedom in u, u_x and u_xx.
  struct Part {
    std::size_t dof = 0;
    double of[3] = {0, 0, 0};
  };
  struct Point {
    double x = 0, weight = 0;
    std::vector<Part> parts;
  };
  Kind kind() const { return kind_; }
  std::size_t size() const { return size_; }  // degrees of freedom
  /// Those of quadrature, element by element; the same places for every kind.
  const std::vector<Point>& points() const { return points_; }
  /// The parts at any place of the domain; of the element to the left where `from_left`.
  std::vector<Part> at(double x, bool from_left = false) const;
  /// The parts at ξ in [−1, 1] of an element.
  std::vector<Part> in(std::size_t element, double xi) const;
  /// The degree of freedom that is the value, or the slope, at a border.
  std::size_t value_at_border(std::size_t border) const;
  std::size_t slope_at_border(std::size_t border) const;  // Smooth alone
  const std::vector<double>& borders() const { return mesh_.borders; }

 private:
  std::size_t dofs_of_border(std::size_t border) const;

  ElementMesh mesh_;
  Kind kind_;
  std::size_t size_ = 0;
  std::vector<Point> points_;
};

}  // namespace maupertuis

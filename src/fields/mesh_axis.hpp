#pragma once
#include "fields/element.hpp"

#include <cstdint>
#include <functional>
#include <utility>

namespace maupertuis {

/// One direction of a mesh: equal elements side by side, with the functions of smooth and of continuous fields on them.
///
/// Functions of a mesh of two directions are products. Where a field has one space variable the other direction is a
/// point: one element with the function 1, whose derivatives vanish, and the weight 1.
class MeshAxis {
 public:
  MeshAxis();  // a point
  /// Gauss's rule of degree + 2 points in each element; smooth elements are at least cubics. `of_plane`: inner
  /// functions are made about as large as those of the ends, since of products the small ones would be lost beside the
  /// others.
  MeshAxis(double from, double to, int cells, int degree, bool periodic, bool of_plane);

  bool is_point() const { return elements_.empty(); }
  std::size_t cells() const { return cells_; }
  double width() const { return width_; }  // of a cell
  std::size_t points() const { return weights_.size(); }
  double weight(std::size_t point) const { return weights_[point]; }  // w width/2
  double place(std::size_t cell, double xi) const {
    return from_ + width_ * (static_cast<double>(cell) + 0.5 * (1 + xi));
  }
  double point(std::size_t cell, std::size_t point) const { return is_point() ? 0 : place(cell, xi_[point]); }

  std::size_t size(bool smooth) const { return is_point() ? 1 : element(smooth).size(); }
  /// Functions that stand at each end of an element; 0 of a point.
  std::size_t at_end(bool smooth) const { return is_point() ? 0 : element(smooth).at_end(); }
  /// d^k/dx^k, k ≤ 2, of the functions of a cell at the points of its rule, [points × functions]. Slopes of what is 1
  /// at the left end are those of what is 1 at the right one with the other sign, to the bit.
  const std::vector<double>& table(bool smooth, int k) const {
    return tables_[smooth ? 1 : 0][static_cast<std::size_t>(k)];
  }
  /// d^k/dx^k of the functions of the cell that `x` lies in; returns the cell.
  std::size_t at(bool smooth, int k, double x, std::vector<double>& out) const;

  /// Where function i of a cell stands among those of all cells, from left to right, and which of those there it is:
  /// the same for what neighbours share. In a ring cells are taken from both sides in turn, so that neighbours have
  /// near numbers all round.
  struct Number {
    std::uint32_t rank = 0, own = 0;
  };
  Number number(bool smooth, std::size_t cell, std::size_t function) const;

  /// Functions of a cell from values of derivatives: coefficient i = Σ_s projection[i × samples + s] f^(k_s)(x_s). At
  /// ends the value and the slope; between them the static solution of a string, or a beam, under the function's load.
  struct Sample {
    double xi = 0;
    int derivative = 0;
  };
  const std::vector<Sample>& samples(bool smooth) const { return samples_[smooth ? 1 : 0]; }
  const std::vector<double>& projection(bool smooth) const { return projections_[smooth ? 1 : 0]; }
  /// Coefficients of f, given with its derivatives, in all cells: [cells × functions].
  std::vector<double> project(bool smooth, const std::function<double(int derivative, double x)>& f) const;

 private:
  const Element& element(bool smooth) const { return elements_[smooth ? 1 : 0]; }
  void find_sizes(bool smooth);
  void make_tables(bool smooth);
  void make_projection(bool smooth);

  std::size_t cells_ = 1;
  double from_ = 0, width_ = 0;
  bool periodic_ = false;
  std::vector<Element> elements_;  // continuous, smooth
  std::vector<double> xi_, weights_;
  std::vector<double> sizes_[2];  // of the functions, beside those of the element
  std::vector<std::vector<double>> tables_[2];
  std::vector<Sample> samples_[2];
  std::vector<double> projections_[2];
};

}  // namespace maupertuis

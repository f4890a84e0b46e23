#pragma once
#include <maupertuis/fields.hpp>

#include "fields/field_elements.hpp"
#include "linear_algebra/dense.hpp"

#include <functional>
#include <vector>

namespace maupertuis {

/// Functions of place of all varied fields, on elements along a line or products of such over a rectangle, with their
/// derivatives at the points of quadrature. A point is numbered (along y) × (points along x) + (along x), a function
/// alike, those of a field after those of the one before.
class StaticSpace {
 public:
  using Side = BoundaryCondition::Side;
  struct Along {
    std::vector<double> borders;  // of elements
    int degree = 8;
  };
  /// `smooth` [varied]: with continuous slopes. `along`: of each direction.
  StaticSpace(const FieldEquations& equations, const std::vector<Along>& along, const std::vector<bool>& smooth);

  Eigen::Index size() const { return first_.back(); }
  Eigen::Index first(std::size_t field) const { return first_[field]; }  // of its functions
  Eigen::Index size_of(std::size_t field) const { return first_[field + 1] - first_[field]; }
  Eigen::Index points() const { return weight_.size(); }
  const Eigen::VectorXd& weights() const { return weight_; }
  double place(std::size_t direction, Eigen::Index point) const;
  /// A derivative of the functions of a field at all points, [points × functions].
  Eigen::MatrixXd table(std::size_t field, const std::vector<int>& space) const;
  double value(const Eigen::VectorXd& c, const FieldJet& jet, double x, double y) const;
  /// Whether the functions have this derivative: continuous ones the first, smooth ones the second.
  bool has(const FieldJet& jet) const;
  /// Of one space variable: the function that is φ at the border of elements next to `place`, or its slope there.
  Eigen::Index function_at(std::size_t field, double place, bool slope) const;

  using Function = std::function<double(double x, double y)>;
  /// Next to a function in the mean square; c of that field alone.
  void fit(std::size_t field, const Function& f, Eigen::VectorXd& c) const;
  /// The functions that are φ at a side, or its slope across it, with their coefficients there for φ = f along it.
  /// `slope_along`: f' by the place along the side.
  struct Held {
    Eigen::Index function;
    double value;
  };
  std::vector<Held> held(std::size_t field, Side side, bool slope, const std::function<double(double)>& f,
                         const std::function<double(double)>& slope_along) const;
  /// ∫ f N along a side for the same functions: what a force there does.
  std::vector<Held> loads(std::size_t field, Side side, bool slope, const std::function<double(double)>& f) const;

 private:
  struct Line {                       // functions along one direction
    std::vector<ElementSpace> space;  // one; none of a single function 1
    std::vector<double> borders, x;
    Eigen::VectorXd weight;
    Eigen::MatrixXd of[3];  // [points × functions]
    Eigen::Index size() const { return of[0].cols(); }
    std::vector<ElementSpace::Part> at(double place) const;
    Eigen::MatrixXd fitted(const Eigen::MatrixXd& values) const;
    Eigen::VectorXd interpolated(const std::function<double(double)>& f,
                                 const std::function<double(double)>& slope) const;
  };
  static Line line(const Along& along, bool periodic, bool smooth);
  static Line single();
  static std::size_t across(Side side) { return side == Side::Left || side == Side::Right ? 0 : 1; }
  std::vector<Eigen::Index> functions_at(std::size_t field, Side side, bool slope) const;

  std::vector<std::size_t> varied_;
  std::vector<std::array<Line, 2>> lines_;  // [varied]
  std::vector<Eigen::Index> first_;         // [varied + 1]
  Eigen::VectorXd weight_;
};

}  // namespace maupertuis

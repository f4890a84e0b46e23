#pragma once
#include <maupertuis/evaluate.hpp>
#include <maupertuis/fields.hpp>
#include <maupertuis/repeated_evaluation.hpp>

#include "linear_algebra/dense.hpp"

#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

/// Coordinates and bodies that rest beside fields: with z = (q, λ) the forces −R + Aᵀλ on the coordinates, values of
/// fields at places among them, and φ(q) of the constraints. Their derivatives by z are symmetric where the forces have
/// a potential.
class StaticBodies {
 public:
  /// Why they have no rest; empty: they are read, or there are none.
  std::string read(const FieldEquations& equations);

  Eigen::Index coordinates() const { return static_cast<Eigen::Index>(q_.size()); }
  Eigen::Index constraints() const { return static_cast<Eigen::Index>(lambda_.size()); }
  Eigen::Index size() const { return coordinates() + constraints(); }
  /// Of the start of the model, 0 where it gives none.
  const Eigen::VectorXd& start() const { return start_; }
  /// By what a change of each coordinate is measured, SI: its size, 1 for an angle, the domain for a length.
  double scale(Eigen::Index coordinate, double value) const;

  struct Values {
    Eigen::VectorXd force;   // [size]
    Eigen::MatrixXd slopes;  // [size × size] ∂force/∂z
    double energy = 0;       // −L of the coordinates at rest
  };
  Values at(const Eigen::VectorXd& z) const;
  /// The name of a contact that bodies at z have gone through; nothing where there is none.
  std::optional<std::string> contact_passed(const Eigen::VectorXd& z) const;

 private:
  std::string read_start(const FieldEquations& equations);

  const FieldEquations* equations_ = nullptr;
  std::vector<Expr> q_, lambda_;
  std::vector<Expr> roots_;  // −L, then [size] forces, then [size × size] their slopes
  std::optional<RepeatedEvaluation> evaluated_;
  Bindings values_;  // of parameters
  Eigen::VectorXd start_;
  std::vector<double> least_scale_;
};

}  // namespace maupertuis

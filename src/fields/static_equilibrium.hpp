#pragma once
#include <maupertuis/evaluate.hpp>
#include <maupertuis/field_run.hpp>
#include <maupertuis/repeated_evaluation.hpp>

#include "fields/resting_fields.hpp"
#include "fields/static_bodies.hpp"
#include "fields/static_density.hpp"
#include "fields/static_space.hpp"

#include <memory>
#include <string>
#include <vector>

namespace maupertuis {

/// δ∫ℒ = 0 for φ = Σ c_i N_i that does not move, with the bodies that take hold of it: F_i = Σ_q w_q Σ_J ∂ℒ/∂φ_J
/// N_i^(J)
/// + ∫ f N_i + forces at sides and of bodies = 0 for the functions that sides leave free, and φ(q) = 0 of constraints.
/// Unknowns are the coefficients of the functions, those coordinates of bodies that are no values of fields at places,
/// and the multipliers of constraints. Newton's steps are shortened until the next one, of the same matrix, is shorter
/// than this one: that test does not depend on units or on how large the functions are (Deuflhard, Newton Methods for
/// Nonlinear Problems, §3.3).
class StaticEquilibrium {
 public:
  StaticEquilibrium(const FieldEquations& equations, const StaticDensity& density, const StaticBodies& bodies,
                    std::shared_ptr<const StaticSpace> space);

  /// From `before`, or from formulas [varied]. Why there is none; empty: `c` is it.
  std::string find(const RestingFields* before, const std::vector<Expr>& formulas, Eigen::VectorXd& c);
  /// What rounding leaves open of what was found, beside its size.
  double rounding() const { return rounding_; }
  /// −∫ℒ, and −L of the bodies.
  double energy(const Eigen::VectorXd& c);
  /// The second variation of the energy in the mean square, of coordinates by their squares.
  void judge(const Eigen::VectorXd& c, FieldEquilibrium& out);
  /// (q, λ) of the bodies.
  Eigen::VectorXd of_bodies(const Eigen::VectorXd& c) const;

 private:
  double number(Expr e, BoundaryCondition::Side side, double along);
  void begin(std::size_t a, const RestingFields* before, Expr formula, Eigen::VectorXd& c) const;
  void begin_bodies(const RestingFields* before, Eigen::VectorXd& c) const;
  std::string hold(Eigen::VectorXd& c);
  std::string add_load(const FieldJet& jet, BoundaryCondition::Side side, Expr value);
  std::string add_given_slope(const BoundaryCondition& b);
  Eigen::VectorXd evaluate_at(const Eigen::VectorXd& c, Eigen::MatrixXd* slopes);
  Eigen::MatrixXd slopes_of(const Eigen::MatrixXd& found) const;
  Eigen::MatrixXd mean_square() const;
  Eigen::VectorXd restricted(const Eigen::VectorXd& all) const;
  Eigen::MatrixXd restricted(const Eigen::MatrixXd& all) const;
  Eigen::MatrixXd along_constraints(const Eigen::MatrixXd& slopes) const;
  Eigen::VectorXd moved(const Eigen::VectorXd& c, const Eigen::VectorXd& step, double part) const;
  double length(const Eigen::VectorXd& step, const Eigen::VectorXd& c) const;
  std::string newton(Eigen::VectorXd& c);
  bool descend(Eigen::VectorXd& c);
  /// The energy less the work of forces at sides, of what was evaluated last.
  double height_of(const Eigen::VectorXd& c) const { return -energy_ - load_.dot(c.head(load_.size())); }
  bool settled(const Eigen::VectorXd& force, const Eigen::MatrixXd& slopes, const Eigen::VectorXd& c) const;
  Eigen::Index unknowns() const { return space_->size() + own_bodies_; }

  const FieldEquations& equations_;
  const FieldSystem& s_;
  const StaticDensity& density_;
  const StaticBodies& bodies_;
  std::shared_ptr<const StaticSpace> space_;
  RepeatedEvaluation at_;
  Bindings values_;
  std::vector<Eigen::MatrixXd> tables_;  // [slots]
  std::vector<Eigen::Index> free_;
  std::vector<Eigen::Index> of_body_;  // [size of bodies] the unknown that each is
  Eigen::Index own_bodies_ = 0;        // unknowns behind those of the fields
  Eigen::VectorXd load_;
  double energy_ = 0, size_of_forces_ = 0, rounding_ = 0;
};

}  // namespace maupertuis

#pragma once
#include <maupertuis/field_run.hpp>

#include "fields/static_space.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

/// An equilibrium that no formula gives: δ∫ℒ = 0 for fields that do not move, in numbers.
class RestingFields {
 public:
  /// `bodies`: their coordinates q, and the multipliers of their constraints.
  RestingFields(std::shared_ptr<const StaticSpace> space, Eigen::VectorXd coefficients, Eigen::VectorXd bodies)
      : space_(std::move(space)), coefficients_(std::move(coefficients)), bodies_(std::move(bodies)) {}
  /// Of a derivative of a field in space, at a place.
  double value(const FieldJet& jet, double x, double y) const { return space_->value(coefficients_, jet, x, y); }
  const StaticSpace& space() const { return *space_; }
  const Eigen::VectorXd& coefficients() const { return coefficients_; }
  const Eigen::VectorXd& bodies() const { return bodies_; }

 private:
  std::shared_ptr<const StaticSpace> space_;
  Eigen::VectorXd coefficients_, bodies_;
};

/// Two sizes of functions, the last ones; what they differ by is the error.
struct ComputedRest {
  std::shared_ptr<const RestingFields> finest, before;
  FieldEquilibrium values;
  double missing = 1;   // how many times that difference the error is
  double rounding = 0;  // of the fields, beside their size
  /// Of a value that is `now` on the finest functions and `then` on those before.
  double error(double now, double then) const;
};

/// The equilibrium of the fields and bodies of a model, by Newton's method, for more and more functions until two sizes
/// agree to 1e-11. It begins at φ = `formulas` [varied] and at the start of bodies. Nothing, and why, where it is not
/// found, or no two sizes agree to 3 %. Of fields with a domain of one or two space variables.
std::optional<ComputedRest> computed_rest(const FieldEquations& equations, const std::vector<Expr>& formulas,
                                          std::string& why);

/// The same, of the rest that the model has: its start where that is a rest, else φ = 0 where that is one, else what is
/// next to the start.
std::optional<ComputedRest> rest_in_numbers(const FieldEquations& equations, std::string& why);

/// Whether a derivative by the time stands in the equation of a field. One without any, as of a string or a beam
/// without mass, is at rest at every moment: no waves run in it.
bool moves(const FieldEquations& equations, std::size_t field);

/// Whether nothing of a model can move: no derivative by the time stands in the equations of its fields and bodies.
bool nothing_moves(const FieldEquations& equations);

/// Whether fields are 0 everywhere, but for rounding.
bool vanishes(const FieldEquations& equations, const FieldEquilibrium& rest);

}  // namespace maupertuis

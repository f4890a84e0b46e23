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
  RestingFields(std::shared_ptr<const StaticSpace> space, Eigen::VectorXd coefficients)
      : space_(std::move(space)), coefficients_(std::move(coefficients)) {}
  /// Of a derivative of a field in space, at a place.
  double value(const FieldJet& jet, double x, double y) const { return space_->value(coefficients_, jet, x, y); }
  const StaticSpace& space() const { return *space_; }
  const Eigen::VectorXd& coefficients() const { return coefficients_; }

 private:
  std::shared_ptr<const StaticSpace> space_;
  Eigen::VectorXd coefficients_;
};

/// Two sizes of functions, the last ones; what they differ by is the error.
struct ComputedRest {
  std::shared_ptr<const RestingFields> finest, before;
  FieldEquilibrium values;
};

/// The equilibrium next to the start of the model, by Newton's method from there, for more and more functions until two
/// sizes agree to 1e-11. Nothing, and why, where it is not found, or no two sizes agree to 3 %. Of fields without
/// bodies, with a domain of one or two space variables.
std::optional<ComputedRest> computed_rest(const FieldEquations& equations, std::string& why);

}  // namespace maupertuis

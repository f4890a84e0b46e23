#pragma once
#include "fields/field_mesh.hpp"

#include <maupertuis/function_kernel.hpp>

#include <span>
#include <vector>

namespace maupertuis {

/// φ_x at an end, closer than that of the polynomials there: what the condition at the end or the equation of its node
/// says of s = ∂ℒ/∂φ_x − ∂𝒟/∂φ_tx, solved for φ_x by Newton's method.
class EndSlopes {
 public:
  /// Of sides across one of the directions of the form.
  EndSlopes(const PointForm& form, const std::vector<Parameter>& parameters, std::size_t across = 0);

  /// Of one space variable: s of each field at an end of an element from the equation of its node for this element
  /// alone, w J (A φ'' + g) = Σ_q w_q ℓ'(x_q) s_q ∓ s. `inputs` are those of the form at its nodes.
  std::vector<double> stresses(const Lobatto& rule, double width, bool right,
                               const std::vector<std::vector<double>>& inputs,
                               const std::vector<double>& accelerations);
  /// `inputs` at the end with a guess of the slopes, which stays where no better one is found, and of the fields that
  /// are `kept`.
  void solve(std::span<double> inputs, const std::vector<double>& s, const std::vector<bool>& kept);

 private:
  std::size_t fields_, per_field_, slope_;  // inputs of a field; the place of its slope among them
  FunctionKernel at_nodes_, at_end_;        // A, g, s; s, ∂s/∂φ_x
  FunctionWorkspace node_work_, end_work_;
};

}  // namespace maupertuis

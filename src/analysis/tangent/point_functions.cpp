#include "analysis/tangent/point_functions.hpp"

#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/transform.hpp>

namespace maupertuis::tangent {

PointFunctions::PointFunctions(const MechanicalSystem& system, std::span<const Expr> functions)
    : rows_(functions.size()), columns_(2 * system.coordinates.size()) {
  FunctionSource source;
  for (const Coordinate& c : system.coordinates) source.inputs.push_back(c.q);
  for (const Coordinate& c : system.coordinates) source.inputs.push_back(c.velocity);
  source.inputs.push_back(system.context->time());
  for (const Parameter& p : system.parameters) source.parameters.push_back(p.symbol);
  source.outputs = expand_time_derivatives(in_terms_of_motion(system, functions));
  kernel_ = build_differentiable(source, 0, columns_);
  for (const auto& [work, kernel] :
       {std::pair(&values_, &kernel_.values), std::pair(&all_, &kernel_.values_and_entries)}) {
    work->emplace(*kernel);
    (*work)->set_parameters(parameter_values(system));
  }
}

std::vector<double> PointFunctions::evaluate(FunctionWorkspace& work, std::size_t count,
                                             const MotionState& state) const {
  std::vector<double> inputs(state.q), outputs(count);
  inputs.insert(inputs.end(), state.v.begin(), state.v.end());
  inputs.push_back(state.t);
  work.evaluate(inputs, outputs);
  return outputs;
}

std::vector<double> PointFunctions::values(const MotionState& state) const { return evaluate(*values_, rows_, state); }

Eigen::MatrixXd PointFunctions::slopes(const MotionState& state) const {
  const std::vector<double> outputs = evaluate(*all_, rows_ + kernel_.entries.size(), state);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows_), static_cast<Eigen::Index>(columns_));
  for (std::size_t k = 0; k < kernel_.entries.size(); ++k)
    out(static_cast<Eigen::Index>(kernel_.entries[k].row), static_cast<Eigen::Index>(kernel_.entries[k].column)) =
        outputs[rows_ + k];
  return out;
}

}  // namespace maupertuis::tangent

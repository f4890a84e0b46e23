#include "analysis/tangent/trigger.hpp"

#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>

namespace maupertuis::tangent {
namespace {

using Index = Eigen::Index;

/// Multipliers that the equations do not have are those of contacts that are open.
Expr without_open_contacts(const EquationsOfMotion& equations, Expr function) {
  ExprMap open;
  for (const Expr& s : symbols_of({&function, 1}))
    if (s.role() == Role::Multiplier &&
        std::find(equations.multipliers.begin(), equations.multipliers.end(), s) == equations.multipliers.end())
      open.emplace(s, function.context().number(0));
  return open.empty() ? function : substitute(function, open);
}

}  // namespace

Trigger::Trigger(const EquationsOfMotion& equations, Expr function)
    : n_(equations.system->coordinates.size()), m_(equations.multipliers.size()) {
  const MechanicalSystem& system = *equations.system;
  const Expr plain = without_open_contacts(equations, in_terms_of_motion(system, {&function, 1}).front());
  FunctionSource source;
  for (const Coordinate& c : system.coordinates) source.inputs.push_back(c.q);
  for (const Coordinate& c : system.coordinates) source.inputs.push_back(c.velocity);
  for (const Coordinate& c : system.coordinates) source.inputs.push_back(c.acceleration);
  source.inputs.insert(source.inputs.end(), equations.multipliers.begin(), equations.multipliers.end());
  source.inputs.push_back(system.context->time());
  for (const Parameter& p : system.parameters) source.parameters.push_back(p.symbol);
  source.outputs = {expand_time_derivatives(plain)};
  kernel_ = build_differentiable(source, 0, source.inputs.size() - 1);
  for (const JacobianEntry& e : kernel_.entries) sees_forces_ = sees_forces_ || e.column >= 2 * n_;
  work_.emplace(kernel_.values_and_entries);
  work_->set_parameters(parameter_values(system));
}

Eigen::RowVectorXd Trigger::along(const TangentPoint& point, const std::optional<TangentForces>& forces) const {
  std::vector<double> inputs(point.state.q), out(1 + kernel_.entries.size());
  inputs.insert(inputs.end(), point.state.v.begin(), point.state.v.end());
  const std::vector<double> none(n_ + m_, 0.0);
  inputs.insert(inputs.end(), forces ? forces->a.begin() : none.begin(),
                forces ? forces->a.end() : none.begin() + static_cast<std::ptrdiff_t>(n_));
  inputs.insert(inputs.end(), forces ? forces->multipliers.begin() : none.begin(),
                forces ? forces->multipliers.end() : none.begin() + static_cast<std::ptrdiff_t>(m_));
  inputs.push_back(point.state.t);
  work_->evaluate(inputs, out);
  Eigen::RowVectorXd found = Eigen::RowVectorXd::Zero(static_cast<Index>(point.columns()));
  for (std::size_t k = 0; k < kernel_.entries.size(); ++k) {
    const std::size_t by = kernel_.entries[k].column;
    for (std::size_t j = 0; j < point.columns(); ++j) {
      const double change = by < 2 * n_   ? point.column(j)[by]
                            : by < 3 * n_ ? forces->changes_of_a[j * n_ + by - 2 * n_]
                                          : forces->changes_of_multipliers[j * m_ + by - 3 * n_];
      found(static_cast<Index>(j)) += out[1 + k] * change;
    }
  }
  return found;
}

}  // namespace maupertuis::tangent

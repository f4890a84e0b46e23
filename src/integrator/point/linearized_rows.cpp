#include "integrator/point/point_solver.hpp"

#include <cmath>

namespace maupertuis {

LinearizedRows::LinearizedRows(const DifferentiableKernel& kernel, std::span<const double> parameters)
    : kernel_(kernel),
      values_work_(kernel.values),
      all_work_(kernel.values_and_entries),
      out_(kernel.values_and_entries.outputs()) {
  values_work_.set_parameters(parameters);
  all_work_.set_parameters(parameters);
}

std::span<const double> LinearizedRows::values(std::span<const double> point) {
  const std::span<double> values(out_.data(), kernel_.size());
  values_work_.evaluate(point, values);
  return values;
}

void LinearizedRows::linearize(std::span<const double> point) { all_work_.evaluate(point, out_); }

void LinearizedRows::block(std::size_t first, Eigen::Ref<Eigen::MatrixXd> block) const {
  block.setZero();
  const auto columns = static_cast<std::size_t>(block.cols());
  for (std::size_t k = 0; k < kernel_.entries.size(); ++k) {
    const JacobianEntry& entry = kernel_.entries[k];
    if (entry.column < first || entry.column >= first + columns) continue;
    block(static_cast<Eigen::Index>(entry.row), static_cast<Eigen::Index>(entry.column - first)) =
        out_[kernel_.size() + k];
  }
}

bool LinearizedRows::finite() const {
  for (const double x : out_)
    if (!std::isfinite(x)) return false;
  return true;
}

}  // namespace maupertuis

#include "kernel/workspace/full_factors.hpp"

#include <algorithm>

namespace maupertuis::workspace {

bool FullFactors::find(FullMatrix& matrix) {
  const std::size_t freedoms = x_.program.freedoms, constraints = x_.unknowns - freedoms;
  if (!solver_) solver_.emplace(freedoms, constraints, constraints > 0 || matrix.has_symmetric_pattern());
  const std::vector<double>& values = matrix.values();
  if (!factored_.empty() && factored_ == values) return true;
  factored_.clear();
  std::copy(values.begin(), values.end(), solver_->matrix().begin());
  if (const auto undetermined = solver_->factor()) {
    singular_ = *undetermined;
    return false;
  }
  factored_ = values;
  return true;
}

}  // namespace maupertuis::workspace

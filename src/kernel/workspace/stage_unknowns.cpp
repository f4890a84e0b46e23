#include "kernel/workspace/stage_unknowns.hpp"

#include <algorithm>

namespace maupertuis::workspace {
namespace {

/// What a rough solution may be wrong by. Beyond, the error bounds of LiftedSolve decide, since M₀ may be badly
/// conditioned.
constexpr double largest_correction = 1e-9;

}  // namespace

StageUnknowns::StageUnknowns(const Expansion& x)
    : x_(x), padded_(x.padded_unknowns(), 0.0), values_(padded_.data(), x.unknowns), rough_(padded_) {}

void StageUnknowns::take_residual(const double* row) {
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i] = -row[x_.program.residual[i]];
  std::fill(padded_.begin() + static_cast<std::ptrdiff_t>(values_.size()), padded_.end(), 0.0);
}

bool StageUnknowns::are_finite() const {
  return x_.engine.are_finite(values_.data(), values_.size(), 1, values_.size());
}

void StageUnknowns::keep_as_rough() { std::copy(values_.begin(), values_.end(), rough_.begin()); }

bool StageUnknowns::add_rough() {
  const packed::Sizes size = x_.engine.add(rough_.data(), values_.data(), 1, values_.size());
  std::copy_n(rough_.begin(), values_.size(), values_.begin());
  return size.change <= largest_correction * size.values;
}

}  // namespace maupertuis::workspace

#pragma once
#include <maupertuis/disks.hpp>

#include <cmath>
#include <vector>

namespace maupertuis {

/// Coefficients of any number type as Disks reads them: doubles as they are, others times powers of a unit, so that
/// those of high orders stay in the range of double.
template <class T>
class ScaledRows {
 public:
  SlotCoefficients of(const T* rows, std::size_t stride, int order, int log2_unit) {
    const int orders = order + 2;
    doubles_.resize(static_cast<std::size_t>(orders) * stride);
    using std::ldexp;
    for (int k = 0; k < orders; ++k)
      for (std::size_t i = 0; i < stride; ++i) {
        const std::size_t at = static_cast<std::size_t>(k) * stride + i;
        doubles_[at] = static_cast<double>(ldexp(rows[at], k * log2_unit));
      }
    return {doubles_.data(), stride, order, std::ldexp(1.0, log2_unit)};
  }

 private:
  std::vector<double> doubles_;
};

template <>
class ScaledRows<double> {
 public:
  SlotCoefficients of(const double* rows, std::size_t stride, int order, int) { return {rows, stride, order, 1}; }
};

}  // namespace maupertuis

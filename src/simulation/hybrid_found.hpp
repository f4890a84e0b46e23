#pragma once
#include "simulation/hybrid_met.hpp"
#include "simulation/hybrid_slips.hpp"

#include <string>
#include <vector>

namespace maupertuis::hybrid {

/// An instant at which a mode is sought.
struct Instant {
  const Met& met;
  const std::vector<std::size_t>& touching;
  double bound = 0;          // up to which it is looked ahead
  bool has_started = false;  // not the first instant of the run
};

/// A mode that is tried, or fits.
struct Found {
  ContactMode mode;
  std::vector<double> accelerations;  // [n] in it
  Given given;
};

/// What may be violated by rounding.
enum class Leniency { None, Forces, Gaps };

}  // namespace maupertuis::hybrid

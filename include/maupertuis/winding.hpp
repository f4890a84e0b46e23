#pragma once
#include <maupertuis/kernel.hpp>

#include <cstdint>
#include <vector>

namespace maupertuis {

/// What a turn of a coordinate, q + 2π, adds to a value, in units of 2π.
struct TurnGain {
  std::uint32_t coordinate = 0;
  int turns = 0;
};

/// Angles that enter through sines and cosines of whole multiples alone: a turn of theirs changes nothing but
/// observables such as the angle itself. Only what the program itself shows counts: a factor that is a parameter is
/// none.
struct Winding {
  std::vector<bool> coordinates;                   // [n]
  std::vector<std::vector<TurnGain>> observables;  // [observables]
};

/// Found when the kernel was built, at a cost linear in its size.
const Winding& winding(const Kernel& kernel);

}  // namespace maupertuis

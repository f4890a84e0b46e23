#pragma once
#include <maupertuis/units.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace maupertuis {

/// A unit word: its exponents of m kg s A K mol cd rad, and its exact value in these, factor · π^pi_power.
struct UnitEntry {
  std::string_view word;
  std::array<std::int8_t, 8> exponents;
  std::string_view factor;  // "a" or "a/b", a and b decimal numbers
  int pi_power = 0;
  bool prefixes = false;  // an SI unit: takes SI prefixes
};

struct PrefixEntry {
  std::string_view word;
  int power;  // of ten
};

std::span<const AmbiguousUnit> ambiguous_units();
std::span<const UnitEntry> unit_table();
std::span<const PrefixEntry> prefix_table();

}  // namespace maupertuis

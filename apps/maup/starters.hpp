#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace maupertuis::app {

/// A model that `maup new NAME` writes.
struct Starter {
  std::string_view name;
  std::string_view text;
};

/// The fixed ones, from starters/*.lag.
std::span<const Starter> starters();

/// Of all starters, sorted; `chain` among them.
std::vector<std::string> starter_names();

/// N pendulums, each hung from the one before.
std::string chain_starter(int links);

}  // namespace maupertuis::app

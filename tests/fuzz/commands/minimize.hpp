#pragma once
#include "supervisor.hpp"

namespace maupertuis::fuzz {

/// A smaller input with the same failure: options, lines and words that do not matter are left out. At most two
/// minutes.
Input minimized(Input input, const std::string& wrong, const Program& program, const Supervisor::Judge& judge);

}  // namespace maupertuis::fuzz

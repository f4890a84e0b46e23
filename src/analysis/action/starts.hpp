#pragma once
#include "analysis/action/problem.hpp"

#include <string>
#include <vector>

namespace maupertuis::action {

/// A path to begin Newton's method from.
struct Start {
  std::string name;
  Trial trial;
};

/// The straight line between the ends, the line bent by sines of each coordinate, and bent at random (with a fixed
/// seed): in this order, on a mesh as fine as the frequencies along the line ask for.
std::vector<Start> starts_between(Problem& problem, const ActionEnds& ends);

}  // namespace maupertuis::action

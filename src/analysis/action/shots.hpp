#pragma once
#include "analysis/action/problem.hpp"

namespace maupertuis::action {

/// Of one freedom: all motions from the start that arrive, by shooting with every initial velocity up to a bound.
struct Shots {
  std::vector<Trial> arrivals;  // as paths on a mesh
  double fastest = 0;           // the bound
  std::size_t count = 0;
};
Shots shoot_all(Problem& problem, const ActionEnds& ends, const StopFlag* interrupt);

}  // namespace maupertuis::action

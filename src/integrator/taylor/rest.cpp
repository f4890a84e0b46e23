#include "integrator/taylor/rest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::taylor {
namespace {

constexpr double unit = 16 * std::numeric_limits<double>::epsilon();

bool moves_less_than(const KernelWorkspace& work, std::size_t i, double h, double speed) {
  double sum = 0, power = 1;
  for (int k = 0; k <= work.order(); ++k, power *= h) {
    sum += (k + 1) * std::abs(work.coordinate(k + 1)[i]) * power;
    if (!(sum <= speed)) return false;  // mostly by its velocity
  }
  return true;
}

}  // namespace

std::vector<AtRest> resting(const KernelWorkspace& work, std::size_t freedoms, std::size_t constraints, double h,
                            std::span<const double> usual) {
  std::vector<AtRest> out;
  std::vector<bool> rests(freedoms, false), is_tied(freedoms, false);
  for (std::size_t i = 0; i < std::min(freedoms, usual.size()); ++i)
    rests[i] = moves_less_than(work, i, h, h * unit * usual[i]);
  if (constraints == 0 || std::find(rests.begin(), rests.end(), true) == rests.end()) return out;
  for (bool more = true; more;) {
    more = false;
    for (std::size_t j = 0; j < constraints; ++j) {
      bool all_rest = true;
      for (std::size_t i = 0; i < freedoms; ++i)
        if (work.constraint_matrix(j, i) != 0) is_tied[i] = true, all_rest = all_rest && rests[i];
      for (std::size_t i = 0; i < freedoms && !all_rest; ++i)
        if (rests[i] && work.constraint_matrix(j, i) != 0) rests[i] = false, more = true;
    }
  }
  for (std::size_t i = 0; i < freedoms; ++i)
    if (rests[i] && is_tied[i]) out.push_back({i, unit * usual[i]});
  return out;
}

}  // namespace maupertuis::taylor

#include "integrator/taylor/rest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::taylor {
namespace {

constexpr double unit = 16 * std::numeric_limits<double>::epsilon();

bool is_accelerated(const KernelWorkspace& work, std::size_t i, double h, double by_rounding) {
  double sum = 0, power = 1;
  for (int k = 1; k <= work.order(); ++k, power *= h) {
    sum += (k + 1) * std::abs(work.coordinate(k + 1)[i]) * power;
    if (!(sum <= by_rounding)) return true;  // mostly by the first
  }
  return false;
}

/// Of what is tied together all are in the list, or none.
void leave_out_groups(const KernelWorkspace& work, std::size_t constraints, std::vector<bool>& list) {
  for (bool more = true; more;) {
    more = false;
    for (std::size_t j = 0; j < constraints; ++j) {
      bool all = true;
      for (std::size_t i = 0; i < list.size(); ++i) all = all && (list[i] || work.constraint_matrix(j, i) == 0);
      for (std::size_t i = 0; i < list.size() && !all; ++i)
        if (list[i] && work.constraint_matrix(j, i) != 0) list[i] = false, more = true;
    }
  }
}

bool is_tied(const KernelWorkspace& work, std::size_t constraints, std::size_t i) {
  for (std::size_t j = 0; j < constraints; ++j)
    if (work.constraint_matrix(j, i) != 0) return true;
  return false;
}

}  // namespace

std::vector<Balanced> balanced(const KernelWorkspace& work, std::size_t freedoms, std::size_t constraints, double h,
                               double step_before, const UsualSizes& usual) {
  std::vector<Balanced> out;
  if (constraints == 0 || usual.a.empty()) return out;
  std::vector<bool> balance(freedoms), rest(freedoms);
  for (std::size_t i = 0; i < freedoms; ++i)
    balance[i] = !is_accelerated(work, i, h, unit * usual.a[i]) && is_tied(work, constraints, i);
  if (std::find(balance.begin(), balance.end(), true) == balance.end()) return out;
  leave_out_groups(work, constraints, balance);
  for (std::size_t i = 0; i < freedoms; ++i)
    rest[i] = balance[i] && std::abs(work.coordinate(1)[i]) <= unit * std::max(usual.v[i], usual.a[i] * step_before);
  leave_out_groups(work, constraints, rest);
  for (std::size_t i = 0; i < freedoms; ++i)
    if (balance[i]) out.push_back({i, unit * usual.a[i], rest[i]});
  return out;
}

}  // namespace maupertuis::taylor

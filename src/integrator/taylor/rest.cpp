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

/// Coordinates that constraints tie together, directly or through others; those that none ties are in no group.
std::vector<std::vector<std::size_t>> tied_groups(const KernelWorkspace& work, std::size_t freedoms,
                                                  std::size_t constraints) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t j = 0; j < constraints; ++j) {
    std::vector<std::size_t> row;
    for (std::size_t i = 0; i < freedoms; ++i)
      if (work.constraint_matrix(j, i) != 0) row.push_back(i);
    const auto meets = [&](const std::vector<std::size_t>& group) {
      return std::find_first_of(group.begin(), group.end(), row.begin(), row.end()) != group.end();
    };
    const auto first = std::stable_partition(groups.begin(), groups.end(), [&](const auto& g) { return !meets(g); });
    for (auto g = first; g != groups.end(); ++g) row.insert(row.end(), g->begin(), g->end());
    groups.erase(first, groups.end());
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    if (!row.empty()) groups.push_back(std::move(row));
  }
  return groups;
}

/// Whether the constraints leave the group no freedom: their rows have the rank of its coordinates.
bool is_held(const KernelWorkspace& work, std::size_t constraints, const std::vector<std::size_t>& group) {
  constexpr double least = 1e-10;  // of a pivot, beside the largest entry of its row at first
  std::vector<std::vector<double>> rows;
  for (std::size_t j = 0; j < constraints; ++j) {
    std::vector<double> row;
    double largest = 0;
    for (const std::size_t i : group)
      row.push_back(work.constraint_matrix(j, i)), largest = std::max(largest, std::abs(row.back()));
    if (largest == 0) continue;
    for (double& x : row) x /= largest;
    rows.push_back(std::move(row));
  }
  for (std::size_t c = 0; c < group.size(); ++c) {
    const auto size = [c](const std::vector<double>& row) { return std::abs(row[c]); };
    const auto pivot =
        std::max_element(rows.begin(), rows.end(), [&](const auto& a, const auto& b) { return size(a) < size(b); });
    if (pivot == rows.end() || size(*pivot) <= least) return false;
    const std::vector<double> used = std::move(*pivot);
    rows.erase(pivot);
    for (std::vector<double>& row : rows)
      for (std::size_t k = group.size(); k-- > c;) row[k] -= row[c] / used[c] * used[k];
  }
  return true;
}

/// Whether what is left of the forces on a coordinate is rounding of those of constraints among them. On a floor with a
/// slope of 1e-15 it is not: there is no other force along it.
bool cancels(const KernelWorkspace& work, std::size_t freedoms, std::size_t constraints, std::size_t i) {
  double left = 0, sizes = 0;
  for (std::size_t k = 0; k < freedoms; ++k) left += work.mass(i, k) * 2 * work.coordinate(2)[k];
  for (std::size_t j = 0; j < constraints; ++j) sizes += std::abs(work.constraint_matrix(j, i) * work.multiplier(j));
  return std::abs(left) <= unit * sizes;
}

}  // namespace

std::vector<Balanced> balanced(const KernelWorkspace& work, std::size_t freedoms, std::size_t constraints, double h,
                               double step_before, const UsualSizes& usual) {
  std::vector<Balanced> out;
  if (constraints == 0 || usual.a.empty()) return out;
  std::vector<bool> still(freedoms);
  for (std::size_t i = 0; i < freedoms; ++i) still[i] = !is_accelerated(work, i, h, unit * usual.a[i]);
  if (std::find(still.begin(), still.end(), true) == still.end()) return out;
  for (const std::vector<std::size_t>& group : tied_groups(work, freedoms, constraints)) {
    const auto all = [&](const auto& what) { return std::all_of(group.begin(), group.end(), what); };
    if (!all([&](std::size_t i) { return still[i]; })) continue;
    if (!is_held(work, constraints, group) &&
        !all([&](std::size_t i) { return cancels(work, freedoms, constraints, i); }))
      continue;
    const bool rests = all([&](std::size_t i) {
      return std::abs(work.coordinate(1)[i]) <= unit * std::max(usual.v[i], usual.a[i] * step_before);
    });
    for (const std::size_t i : group) out.push_back({i, unit * usual.a[i], rests});
  }
  std::sort(out.begin(), out.end(), [](const Balanced& a, const Balanced& b) { return a.coordinate < b.coordinate; });
  return out;
}

}  // namespace maupertuis::taylor

#include "kernel/sparse/parts.hpp"

#include <deque>
#include <set>

namespace maupertuis::sparse {
namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};
/// Levels at both ends that are left to the separators, besides the outermost of these: ends differ from what lies between.
constexpr std::size_t spared = 2;

using Levels = std::vector<std::vector<std::uint32_t>>;

/// Coordinates by their distance from the first one; those that it does not reach are in none.
Levels levels_from(const LiftedSystem& system, std::uint32_t first) {
  const std::vector<std::uint32_t> group = nearest_coordinates(system);
  std::vector<std::set<std::uint32_t>> neighbours(system.row_of_residual.size());
  for (const auto& [row, column] : system.entries) {
    const std::uint32_t a = group[system.own_column[row]], b = group[column];
    neighbours[a].insert(b), neighbours[b].insert(a);
  }
  std::vector<bool> seen(neighbours.size(), false);
  Levels levels{{first}};
  for (seen[first] = true; !levels.back().empty();) {
    std::vector<std::uint32_t> next;
    for (const std::uint32_t here : levels.back())
      for (const std::uint32_t there : neighbours[here])
        if (!seen[there]) seen[there] = true, next.push_back(there);
    levels.push_back(std::move(next));
  }
  levels.pop_back();
  return levels;
}

/// Levels of a part, if there are `parts` of them.
std::size_t length_of(std::size_t levels, std::size_t parts) {
  const std::size_t others = parts + 1 + spared;
  return levels > others ? (levels - others) / parts : 0;
}

}  // namespace

std::vector<std::uint32_t> nearest_coordinates(const LiftedSystem& system) {
  std::vector<std::vector<std::uint32_t>> neighbours(system.size);
  for (const auto& [row, column] : system.entries) {
    neighbours[system.own_column[row]].push_back(column);
    neighbours[column].push_back(system.own_column[row]);
  }
  std::vector<std::uint32_t> nearest(system.size, none);
  std::deque<std::uint32_t> open;
  for (std::uint32_t i = 0; i < system.row_of_residual.size(); ++i) nearest[i] = i, open.push_back(i);
  for (; !open.empty(); open.pop_front())
    for (const std::uint32_t next : neighbours[open.front()])
      if (nearest[next] == none) nearest[next] = nearest[open.front()], open.push_back(next);
  return nearest;
}

std::vector<std::vector<std::uint32_t>> cut_into_parts(const LiftedSystem& system, std::uint32_t first) {
  const Levels levels = levels_from(system, first);
  std::size_t parts = 0, least = levels.size() * 3 / 4;  // levels that wait for each other
  for (const std::size_t count : {4, 8}) {
    const std::size_t length = length_of(levels.size(), count), depth = levels.size() - (count - 1) * length;
    if (length >= 2 && depth < least) parts = count, least = depth;
  }
  std::vector<std::vector<std::uint32_t>> out(parts);
  if (parts == 0) return out;
  const std::size_t length = length_of(levels.size(), parts), left = levels.size() - parts * (length + 1) - 1;
  for (std::size_t part = 0; part < parts; ++part)
    for (std::size_t turn = 0; turn < length; ++turn) {
      const auto& level = levels[left / 2 + 1 + part * (length + 1) + turn];
      out[part].insert(out[part].end(), level.begin(), level.end());
    }
  for (const auto& part : out)
    if (part.size() != out[0].size()) return {};
  return out;
}

}  // namespace maupertuis::sparse

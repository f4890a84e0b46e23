#include "kernel/sparse/parts.hpp"

#include <deque>
#include <set>

namespace maupertuis::sparse {
namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};
/// Levels at both ends that are left to the separators, besides the outermost of these: ends differ from what lies
/// between.
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

/// end | part 0 | · | part 1 | · … part | end
struct Cut {
  std::size_t parts = 0, length = 0, left = 0;  // left: levels at the ends besides the outermost of these

  /// `turn` = length: the level after the part.
  std::size_t level(std::size_t part, std::size_t turn) const { return left / 2 + 1 + part * (length + 1) + turn; }
};

/// That with the fewest levels that wait for each other; no parts where these are not much fewer than all.
Cut best_cut(std::size_t levels) {
  Cut best;
  std::size_t least = levels * 3 / 4;
  for (const std::size_t parts : {4, 8}) {
    const std::size_t length = length_of(levels, parts), depth = levels - (parts - 1) * length;
    if (length >= 2 && depth <= least) best = {parts, length, levels - parts * (length + 1) - 1}, least = depth;
  }
  return best;
}

constexpr std::size_t eight = 8;

std::size_t count_coordinates(const Levels& levels) {
  std::size_t count = 0;
  for (const auto& level : levels) count += level.size();
  return count;
}

/// Whether as many coordinates stand there in all parts.
bool are_alike(const Levels& levels, const Cut& cut, std::size_t turn) {
  for (std::size_t part = 1; part < eight; ++part)
    if (levels[cut.level(part, turn)].size() != levels[cut.level(0, turn)].size()) return false;
  return true;
}

/// By eights, one of each part; `turn` = length: between parts.
void add_turn(const Levels& levels, const Cut& cut, std::size_t turn, Strip& out) {
  for (std::size_t i = 0; i < levels[cut.level(0, turn)].size(); ++i)
    for (std::size_t part = 0; part < eight; ++part) {
      out.order.push_back(levels[cut.level(part, turn)][i]);
      if (turn < cut.length) out.parts[part].push_back(out.order.back());
    }
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
  const Cut cut = best_cut(levels.size());
  std::vector<std::vector<std::uint32_t>> out(cut.parts);
  for (std::size_t part = 0; part < cut.parts; ++part)
    for (std::size_t turn = 0; turn < cut.length; ++turn) {
      const auto& level = levels[cut.level(part, turn)];
      out[part].insert(out[part].end(), level.begin(), level.end());
    }
  for (const auto& part : out)
    if (part.size() != out[0].size()) return {};
  return out;
}

Strip strip_of(const Program& program) {
  const auto system = lift(program, std::vector<bool>(program.slots, false));
  if (!system) return {};
  const Levels levels = levels_from(*system, levels_from(*system, 0).back().front());
  const Cut cut = best_cut(levels.size());
  if (cut.parts != eight || count_coordinates(levels) != program.unknowns) return {};
  Strip out{Levels(eight), std::vector<std::uint32_t>(program.unknowns), levels.size(), {}, 0};
  for (std::uint32_t l = 0; l < levels.size(); ++l)
    for (const std::uint32_t coordinate : levels[l]) out.level[coordinate] = l;
  for (std::size_t turn = 0; turn <= cut.length; ++turn) {
    if (are_alike(levels, cut, turn))
      add_turn(levels, cut, turn, out);
    else if (turn < cut.length)
      return {};
  }
  out.whole = out.order.size();
  std::vector<bool> placed(program.unknowns, false);
  for (const std::uint32_t coordinate : out.order) placed[coordinate] = true;
  for (std::uint32_t i = 0; i < program.unknowns; ++i)
    if (!placed[i]) out.order.push_back(i);
  return out;
}

}  // namespace maupertuis::sparse

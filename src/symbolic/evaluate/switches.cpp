#include <maupertuis/switches.hpp>

#include <maupertuis/transform.hpp>

#include "symbolic/evaluate/branch_search.hpp"
#include "symbolic/evaluate/switch_nodes.hpp"

#include <algorithm>
#include <array>
#include <set>

namespace maupertuis {
namespace {

using evaluation::BranchSearch;
using evaluation::difference_of;
using evaluation::opposite;
using evaluation::Signs;

constexpr std::size_t few_switches = 6;  // of which all combinations are looked for
constexpr std::size_t most_combinations = 400;
constexpr int draws = 48;

/// What a node that switches is where its g > 0, or where g < 0.
Expr branch_of(Expr node, bool above) {
  Context& context = node.context();
  if (node.is(Kind::Abs)) return above ? node[0] : -node[0];
  if (node.is(Kind::Sign)) return context.number(above ? 1 : -1);
  if (node.is(Kind::Step)) return context.number(above ? 1 : 0);
  if (node.is(Kind::Min)) return node[above ? 0 : 1];
  if (node.is(Kind::Max)) return node[above ? 1 : 0];
  const std::array sides{context.number(0), context.number(above ? 1 : -1)};  // 0 < 1 holds, 0 < -1 does not
  return context.function(Kind::Less, sides);
}

std::vector<Signs> wanted_signs(std::size_t count) {
  std::vector<Signs> out;
  if (count <= few_switches) {
    for (std::size_t k = 0; k < std::size_t{1} << count; ++k) {
      Signs signs(count);
      for (std::size_t i = 0; i < count; ++i) signs[i] = k >> i & 1 ? 1 : -1;
      out.push_back(std::move(signs));
    }
    return out;
  }
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (const auto& [a, b] : std::array<std::pair<int, int>, 4>{{{1, 1}, {1, -1}, {-1, 1}, {-1, -1}}}) {
        if (out.size() == most_combinations) return out;
        Signs signs(count, 0);
        signs[i] = static_cast<std::int8_t>(a), signs[j] = static_cast<std::int8_t>(b);
        out.push_back(std::move(signs));
      }
  return out;
}

bool fits(const Signs& signs, const Signs& wanted) {
  for (std::size_t i = 0; i < signs.size(); ++i)
    if (wanted[i] != 0 && wanted[i] != signs[i]) return false;
  return true;
}

std::ptrdiff_t misfits(const Signs& signs, const Signs& wanted) {
  std::ptrdiff_t count = 0;
  for (std::size_t i = 0; i < signs.size(); ++i) count += wanted[i] != 0 && wanted[i] != signs[i];
  return count;
}

}  // namespace

std::vector<Expr> switches_of(std::span<const Expr> roots) {
  std::vector<Expr> out;
  for (const Expr& node : topological_order(roots)) {
    const Expr g = difference_of(node);
    if (!g || g.is_number()) continue;
    if (std::find(out.begin(), out.end(), g) == out.end() &&
        std::find(out.begin(), out.end(), opposite(g)) == out.end())
      out.push_back(g);
  }
  return out;
}

std::vector<Expr> on_side(std::span<const Expr> roots, Expr difference, bool above) {
  std::vector<Expr> out(roots.begin(), roots.end());
  const Expr other = opposite(difference);
  // A branch may hold further nodes that the same switch decides.
  for (bool changed = true; changed;) {
    ExprMap branches;
    for (const Expr& node : topological_order(out)) {
      const Expr g = difference_of(node);
      if (g && (g == difference || g == other)) branches.emplace(node, branch_of(node, above == (g == difference)));
    }
    changed = !branches.empty();
    if (changed) out = substitute(out, branches);
  }
  return out;
}

BranchPoints points_in_branches(std::span<const Expr> switches, const SwitchSearch& search) {
  BranchPoints out;
  if (switches.empty()) return out;
  BranchSearch branches(switches, search);
  std::vector<Signs> found;
  const auto take = [&](const Bindings& point) {
    const Signs signs = branches.signs(point);
    const bool on_a_switch = std::count(signs.begin(), signs.end(), 0) > 0;
    if (on_a_switch || std::find(found.begin(), found.end(), signs) != found.end()) return;
    found.push_back(signs);
    out.points.push_back(point);
  };
  take(search.center);
  for (int k = 0; k < draws; ++k) take(branches.draw());
  for (const Signs& wanted : wanted_signs(switches.size())) {
    ++out.combinations;
    if (std::any_of(found.begin(), found.end(), [&](const Signs& s) { return fits(s, wanted); })) continue;
    // From the point that comes nearest.
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < found.size(); ++k)
      if (misfits(found[k], wanted) < misfits(found[nearest], wanted)) nearest = k;
    Bindings point = found.empty() ? search.center : out.points[nearest];
    const std::size_t before = out.points.size();
    if (branches.reach(point, wanted)) take(point);
    out.missing += out.points.size() == before;
  }
  return out;
}

}  // namespace maupertuis

#include "certificate/route_results.hpp"
#include "symbolic/evaluate/witness.hpp"

#include <maupertuis/kinds.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>

/// Every side of every switch. Signs that come up by chance meet the last of 30 pieces once in 2^29 points, and a
/// mistake there would pass. So the formulas of each side (symbolic/evaluate/leaves.hpp) are compared as formulas.
namespace maupertuis::certification {
namespace {

constexpr std::size_t leaves_together = 64;
constexpr std::size_t most_unproved = 64;  // sides for which points are looked for

bool any_fails(const RoutesResult& r) {
  return std::any_of(r.routes.begin(), r.routes.end(), [](const RouteResult& route) { return route.fails; });
}

bool any_switch(const std::vector<Expr>& roots) {
  const std::vector<Expr> nodes = topological_order(roots);
  return std::any_of(nodes.begin(), nodes.end(), [](Expr e) { return has_switch(e.kind()); });
}

/// Compares the leaves of a set of questions, and gathers what they tell.
class BySides {
 public:
  BySides(const Questions& questions, const evaluation::Leaves& leaves, std::uint64_t seed)
      : questions_(questions), leaves_(leaves), seed_(seed) {
    result_.error_bound = 0;
  }

  RoutesResult run() {
    for (std::size_t from = 0; from < leaves_.all.size() && unproved_ < most_unproved; from += leaves_together) {
      const std::size_t to = std::min(leaves_.all.size(), from + leaves_together);
      if (take(compare(from, to))) continue;
      for (std::size_t k = from; k < to; ++k) {
        const RoutesResult alone = compare(k, k + 1);
        if (take(alone)) continue;
        ++unproved_;
        if (any_fails(alone) && fails_at_real_point(k, alone)) return result_;
      }
    }
    result_.complete = unproved_ == 0;
    return result_;
  }

 private:
  RoutesResult compare(std::size_t from, std::size_t to) const {
    std::vector<Expr> formulas;
    for (std::size_t k = from; k < to; ++k)
      formulas.insert(formulas.end(), leaves_.all[k].formulas.begin(), leaves_.all[k].formulas.end());
    return compare_formulas(questions_.about(std::move(formulas)), seed_);
  }

  /// Whether it proves its leaves.
  bool take(const RoutesResult& here) {
    if (!here.complete || any_fails(here)) return false;
    for (std::size_t route = 0; route < RouteCount; ++route) result_.routes[route].points += here.routes[route].points;
    result_.error_bound = std::max(result_.error_bound, here.error_bound);
    return true;
  }

  /// Formulas may agree on their side alone, as √(x²) and x where x > 0; and a side may have no points.
  bool fails_at_real_point(std::size_t k, const RoutesResult& alone) {
    for (std::size_t route = 0; route < RouteCount; ++route)
      result_.routes[route].is_doubtful |= alone.routes[route].fails;
    const evaluation::Leaf& leaf = leaves_.all[k];
    const Questions here = questions_.about(leaf.formulas);
    return evaluation::any_point_on_sides(leaves_.sides_of(leaf), symbols_of(leaf.formulas), seed_,
                                          [&](const Bindings& point) {
                                            const RoutesResult real = compare_at_real_point(here, point, seed_);
                                            if (!real.complete || !any_fails(real)) return false;
                                            result_.is_real = true;
                                            for (std::size_t route = 0; route < RouteCount; ++route) {
                                              RouteResult& r = result_.routes[route];
                                              r.is_doubtful = false;
                                              r.row = alone.routes[route].row;
                                              r.fails = real.routes[route].fails;
                                              r.difference = real.routes[route].difference;
                                              r.points += !r.fails;
                                            }
                                            return true;
                                          });
  }

  const Questions& questions_;
  const evaluation::Leaves& leaves_;
  std::uint64_t seed_;
  std::size_t unproved_ = 0;
  RoutesResult result_;
};

}  // namespace

std::optional<RoutesResult> compare_by_sides(const Questions& questions, std::uint64_t seed) {
  if (!any_switch(questions.roots)) return std::nullopt;
  const auto leaves = evaluation::joint_leaves(questions.roots, questions.products());
  return leaves ? std::optional(BySides(questions, *leaves, seed).run()) : std::nullopt;
}

}  // namespace maupertuis::certification

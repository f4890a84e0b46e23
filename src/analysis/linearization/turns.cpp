#include "analysis/linearization/turns.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

namespace maupertuis {
namespace {

/// The rows as they are and a turn further, with a symbol for each sine, cosine and tangent of q: of whole multiples of
/// q it stays, of an odd number of halves a sine or cosine changes its sign.
struct TurnedNodes {
  ExprMap here, there;
};

TurnedNodes turned_nodes(const ExprVector& rows, Expr q) {
  Context& context = q.context();
  TurnedNodes out;
  for (const Expr& node : topological_order(rows)) {
    if (!node.is(Kind::Sin) && !node.is(Kind::Cos) && !node.is(Kind::Tan)) continue;
    const Expr multiple = differentiate(node[0], q);
    if (multiple.is_zero() || !multiple.is_number()) continue;
    const Rational halves = multiple.number() * Rational(2);
    if (!halves.is_integer()) continue;
    const bool stays = multiple.number().is_integer() || node.is(Kind::Tan);
    const Expr s = context.symbol(fmt::format("turned {}", out.here.size()), Role::Parameter);
    out.here.emplace(node, s);
    out.there.emplace(node, stays ? s : -s);
  }
  out.there.emplace(q, q + context.number(2) * context.pi());
  return out;
}

}  // namespace

bool repeats_each_turn(const PointEquations::Impl& e, std::size_t coordinate, const ExprMap& values) {
  ExprVector rows = e.balance_rows;
  rows.insert(rows.end(), e.kept_rows.begin(), e.kept_rows.end());
  rows = substitute(rows, values);
  const TurnedNodes nodes = turned_nodes(rows, e.system->coordinates[coordinate].q);
  const ExprVector here = substitute(rows, nodes.here), there = substitute(rows, nodes.there);
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (here[i] != there[i] && zero_test(here[i] - there[i]).verdict != Verdict::Zero) return false;
  return true;
}

}  // namespace maupertuis

#include "symbolic/evaluate/tape.hpp"

#include <algorithm>
#include <memory>

namespace maupertuis::evaluation {

Tape::Tape(std::span<const Expr> roots) {
  const std::vector<Expr> order = topological_order(roots);
  if (order.empty()) return;
  // Ids ascend along the order; only the entries of its nodes are ever written or read.
  const std::unique_ptr<Position[]> position(new Position[order.back().id() + 1]);
  nodes_.reserve(order.size());
  for (const Expr& e : order) {
    const auto ids = e.argument_ids();
    position[e.id()] = static_cast<Position>(nodes_.size());
    nodes_.push_back({e, static_cast<std::uint32_t>(arguments_.size()), static_cast<std::uint32_t>(ids.size()), e.kind()});
    for (const NodeId id : ids) arguments_.push_back(position[id]);
  }
  for (const Expr& root : roots) roots_.push_back(position[root.id()]);
}

std::size_t depth_of_time_derivatives(const Tape& tape) {
  std::vector<std::uint8_t> depth(tape.size(), 0);
  std::uint8_t deepest = 0;
  for (Position at = 0; at < tape.size(); ++at) {
    for (const Position argument : tape.arguments(at)) depth[at] = std::max(depth[at], depth[argument]);
    if (tape.kind(at) == Kind::TimeDerivative && depth[at] < 255) ++depth[at];
    deepest = std::max(deepest, depth[at]);
  }
  return deepest;
}

TermView term_view(const Tape& tape, Position at) {
  if (tape.kind(at) != Kind::Product || tape.kind(tape.argument(at, 0)) != Kind::Number) return {1, at};
  const Rational coefficient = tape.expression(tape.argument(at, 0)).number();
  return {coefficient, tape.arguments(at).size() == 2 ? tape.argument(at, 1) : at};
}

}  // namespace maupertuis::evaluation

#include "symbolic/evaluate/tape.hpp"

#include "symbolic/evaluate/normalize.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>

namespace maupertuis::evaluation {

Tape::Tape(std::span<const Expr> roots) { lay_out(topological_order(roots), roots); }

/// `order`: children before parents, whatever their ids.
void Tape::lay_out(const std::vector<Expr>& order, std::span<const Expr> roots) {
  if (order.empty()) return;
  const NodeId top =
      std::max_element(order.begin(), order.end(), [](const Expr& a, const Expr& b) { return a.id() < b.id(); })->id();
  // Only the entries of its nodes are ever written or read.
  const std::unique_ptr<Position[]> position(new Position[top + 1]);
  nodes_.reserve(order.size());
  for (const Expr& e : order) {
    const auto ids = e.argument_ids();
    position[e.id()] = static_cast<Position>(nodes_.size());
    nodes_.push_back(
        {e, static_cast<std::uint32_t>(arguments_.size()), static_cast<std::uint32_t>(ids.size()), e.kind()});
    for (const NodeId id : ids) arguments_.push_back(position[id]);
  }
  for (const Expr& root : roots) roots_.push_back(position[root.id()]);
}

namespace {

/// Appends what stands below `root` and is not there yet.
void append_below(Expr root, std::vector<Expr>& order, std::unordered_map<NodeId, Position>& places) {
  for (const Expr& e : topological_order({&root, 1}))
    if (places.try_emplace(e.id(), static_cast<Position>(order.size())).second) order.push_back(e);
}

}  // namespace

Tape Tape::with_gaussians(std::span<const Expr> roots) {
  std::vector<Expr> order;
  std::unordered_map<NodeId, Position> places;
  Tape tape;
  for (const Expr& e : topological_order(roots)) {  // an erf within another comes first
    if (!e.is(Kind::Erf)) continue;
    const Expr gaussian = flatten_arguments(std::array{apply(Kind::Exp, -pow(e[0], Rational(2)))}).front();
    append_below(gaussian, order, places);
    append_below(e, order, places);
    tape.gaussians_.emplace(places.at(e.id()), places.at(gaussian.id()));
  }
  for (const Expr& e : topological_order(roots))
    if (places.try_emplace(e.id(), static_cast<Position>(order.size())).second) order.push_back(e);
  tape.lay_out(order, roots);
  return tape;
}

Position Tape::gaussian(Position erf) const {
  const auto found = gaussians_.find(erf);
  if (found == gaussians_.end())
    throw std::logic_error("a series of erf was asked for on a tape without Gaussians; please report");
  return found->second;
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

#pragma once
#include <maupertuis/expression.hpp>

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace maupertuis::evaluation {

using Position = std::uint32_t;

/// The nodes below some roots laid out flat, children before parents: what every evaluation walks, once and in order.
class Tape {
 public:
  explicit Tape(std::span<const Expr> roots);
  /// For series: exp(−x²) stands beside and before every erf(x), whose derivative it is but for a factor.
  static Tape with_gaussians(std::span<const Expr> roots);

  std::size_t size() const { return nodes_.size(); }
  Kind kind(Position at) const { return nodes_[at].kind; }
  Expr expression(Position at) const { return nodes_[at].expression; }
  std::span<const Position> arguments(Position at) const {
    return {arguments_.data() + nodes_[at].first, nodes_[at].count};
  }
  Position argument(Position at, std::size_t index) const { return arguments_[nodes_[at].first + index]; }
  std::span<const Position> roots() const { return roots_; }
  /// Of an erf of a tape with Gaussians. Throws std::logic_error on others.
  Position gaussian(Position erf) const;

 private:
  Tape() = default;
  void lay_out(const std::vector<Expr>& order, std::span<const Expr> roots);

  struct Node {
    Expr expression;
    std::uint32_t first = 0, count = 0;
    Kind kind = Kind::Number;
  };
  std::vector<Node> nodes_;
  std::vector<Position> arguments_;
  std::vector<Position> roots_;
  std::unordered_map<Position, Position> gaussians_;
};

/// The deepest nesting of d/dt: how many orders of a series an evaluation of the roots uses up.
std::size_t depth_of_time_derivatives(const Tape& tape);

/// A node c·rest as a coefficient and what it multiplies. `rest` is the node itself where c = 1; where the node is a
/// product of a number and several factors, no single node holds the rest: then `rest` is the product.
struct TermView {
  Rational coefficient = 1;
  Position rest = 0;
};
TermView term_view(const Tape& tape, Position at);

}  // namespace maupertuis::evaluation

#pragma once
#include "kernel/program/program.hpp"

#include <maupertuis/rational.hpp>

#include <map>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

/// The program while it is being built: value-numbered nodes, not yet ordered. Equal nodes are one node.
namespace maupertuis::lowering {

using NodeIndex = std::uint32_t;
inline constexpr NodeIndex no_node = ~NodeIndex{0};

/// coefficient · node; a constant when node is no_node. So scalar factors travel to the consumer for nothing.
struct Scaled {
  ConstantId coefficient = 0;
  NodeIndex node = no_node;
  bool is_constant() const { return node == no_node; }
};

struct Node {
  Op op = Op::One;
  Kind function = Kind::Exp;
  ConstantId constant = 0;  // exponent; Coordinate: its index
  NodeIndex a = no_node, b = no_node;
  std::vector<Term> terms{};  // slots are node indices here
  int level = 0;              // number of d/dt above the leaves; only orders the factors of products
};

struct KeyHash {
  std::size_t operator()(const std::vector<std::uint32_t>& key) const;
};
template <class Id>
using ByKey = std::unordered_map<std::vector<std::uint32_t>, Id, KeyHash>;

/// Constants, literals folded exactly.
class ConstantPool {
 public:
  ConstantId literal(const Rational& value);
  ConstantId parameter(std::uint32_t index);
  ConstantId side(std::uint32_t switch_index);
  ConstantId apply(Kind kind, std::span<const ConstantId> arguments);
  ConstantId multiply(ConstantId a, ConstantId b);
  ConstantId add(ConstantId a, ConstantId b);
  const Rational* literal_or_null(ConstantId id) const { return rationals_[id] ? &*rationals_[id] : nullptr; }
  bool is_one(ConstantId id) const { return rationals_[id] && rationals_[id]->is_one(); }
  bool is_zero(ConstantId id) const { return rationals_[id] && rationals_[id]->is_zero(); }
  /// Whether a = −b as polynomials; false may be wrong.
  bool are_opposite(ConstantId a, ConstantId b);

  std::vector<Constant> constants;
  std::vector<ConstantId> arguments;
  std::vector<Rational> literals;

 private:
  ConstantId append(Constant constant, std::optional<Rational> rational);
  /// Numbers by the factors that they multiply, which are in order.
  using Polynomial = std::map<std::vector<ConstantId>, Rational>;
  static Polynomial product(const Polynomial& x, const Polynomial& y);
  const Polynomial& polynomial(ConstantId id);
  Polynomial make_polynomial(ConstantId id);
  std::vector<std::optional<Rational>> rationals_;
  std::unordered_map<std::string, ConstantId> literals_;
  std::map<ConstantId, Polynomial> polynomials_;  // of those that were compared; references stay
  ByKey<ConstantId> by_key_;
};

class Graph {
 public:
  ConstantPool constants;
  std::vector<Node> nodes;

  NodeIndex leaf(Op op, std::uint32_t index = 0);
  /// Σ of the terms (b == no_node: linear), like terms collected.
  Scaled linear(std::vector<Term> terms);
  NodeIndex multiply(NodeIndex a, NodeIndex b);
  NodeIndex unary(Op op, NodeIndex a, ConstantId constant = 0);
  NodeIndex quotient(NodeIndex a, NodeIndex b);
  /// sin and cos, or sinh and cosh, of a: the first and the companion.
  std::pair<NodeIndex, NodeIndex> pair(Op op, NodeIndex a);
  /// y = f(a, b) with dy = Σ c w du. A w that needs y itself is no_node here and set afterwards.
  NodeIndex function(Kind f, NodeIndex a, NodeIndex b, std::vector<Term> differential);
  NodeIndex select(std::vector<Term> choices);
  /// The scaled value as a node of its own.
  NodeIndex node_of(Scaled value);

  Scaled scaled(NodeIndex node) { return {constants.literal(1), node}; }

 private:
  NodeIndex intern(Node node);
  ByKey<NodeIndex> by_key_;
};

/// Merges sums and products that are used once into the sum that uses them, and d/dt into its terms.
void fuse(Graph& graph, std::span<const NodeIndex> roots);

/// What the outputs of a source became.
struct Outputs {
  std::vector<NodeIndex> residual, switches, events, integrands, observables;
  std::vector<NodeIndex> constraint_values, constraint_rates;  // no_node: level 1
};

/// Orders the live nodes, gives them lags and slots. Throws std::logic_error on a residual non-linear in q̈.
void schedule(const Graph& graph, const Outputs& outputs, Program& program);

}  // namespace maupertuis::lowering

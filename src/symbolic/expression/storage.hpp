#pragma once
#include <maupertuis/expression.hpp>
#include <maupertuis/interrupt_scope.hpp>

#include <deque>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

namespace maupertuis {

/// The interned nodes of a context. Argument lists live in chunks that never move, so that a span over them stays
/// valid while further nodes are made.
struct Context::Storage {
  struct Node {
    const NodeId* arguments = nullptr;
    std::uint32_t count = 0;
    std::uint32_t payload = 0;  // index of a number or of a symbol
    Kind kind = Kind::Number;
    bool time_dependent = false;
    bool has_time_derivative = false;
  };
  struct Symbol {
    std::string name;
    Role role;
    int order;
    NodeId next = 0;  // its time derivative, 0: not made yet
  };

  std::vector<Node> nodes;
  std::deque<Rational> numbers;
  std::deque<Symbol> symbols;
  std::unordered_map<std::string, std::vector<NodeId>> symbols_by_name;  // [order]
  mutable int numbered_names = 0;  // k1 … kn are names already: who needs a fresh one goes on from there
  NodeId time = 0;                 // the one symbol of Role::Time, 0: not made yet

  std::vector<NodeId> table;  // open addressing, 0: empty (node 0 is a sentinel)
  std::vector<std::unique_ptr<NodeId[]>> chunks;
  std::size_t chunk_used = 0, chunk_size = 0;

  mutable std::recursive_mutex mutex;  // see ExpressionLock
  mutable Interrupt interrupt;         // not of the expressions, but of the work on them: see InterruptScope
  std::uint32_t until_look = 1;        // nodes still to be asked for before it is looked at again

  Storage();
  NodeId intern(Kind kind, std::span<const NodeId> arguments);
  NodeId intern_number(const Rational& value);
  NodeId append(Node node);

 private:
  void look_at_interrupt() {
    if (--until_look != 0) return;
    until_look = 256;
    interrupt.throw_if_asked();
  }
  template <class Equal>
  NodeId* find_slot(std::size_t hash, Equal equal);
  const NodeId* copy_arguments(std::span<const NodeId> arguments);
  void grow_table();
  std::size_t hash_of(const Node& node) const;
};

}  // namespace maupertuis

#include "kernel/program/graph.hpp"

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <utility>

/// Order of execution: sections (what is needed when), within a section levels (who waits for whom), within a level
/// runs of one op and lag, so that an interpreter decides once for many instructions.
namespace maupertuis::lowering {
namespace {

constexpr std::uint8_t dead = SectionCount;

bool is_leaf(Op op) { return op == Op::One || op == Op::Time || op == Op::Coordinate; }

class Scheduler {
 public:
  Scheduler(const Graph& graph, const Outputs& outputs, Program& program)
      : graph_(graph), outputs_(outputs), program_(program), section_(graph.nodes.size(), dead) {}

  void run() {
    for (const auto* roots : {&outputs_.residual, &outputs_.constraint_values, &outputs_.constraint_rates})
      mark(*roots, Dynamics);
    for (const auto* roots : {&outputs_.switches, &outputs_.events, &outputs_.integrands}) mark(*roots, Along);
    mark(outputs_.observables, AtPoint);
    find_lags();
    check_linear();
    find_levels();
    find_stored();
    order_instructions();
    assign_slots();
    emit();
  }

 private:
  /// Calls f(operand, number of d/dt taken of it) for every node whose value of the same order must be known before. A
  /// Function does not wait for the factors w of its differential: it reads their earlier orders only, and w may itself
  /// be made from it.
  template <class F>
  void for_operands(const Node& node, F&& f) const {
    const int shift = node.op == Op::Derivative ? 1 : 0;
    if (node.a != no_node) f(node.a, shift);
    if (node.b != no_node) f(node.b, 0);
    for (const Term& term : node.terms) {
      if (node.op != Op::Function) f(term.a, static_cast<int>(term.shift));
      if (term.b != no_node) f(term.b, 0);
    }
  }

  void mark(const std::vector<NodeIndex>& roots, std::uint8_t section) {
    std::vector<NodeIndex> open;
    const auto reach = [&](NodeIndex node) {
      if (node == no_node || section_[node] <= section) return;
      section_[node] = section;
      open.push_back(node);
    };
    for (const NodeIndex root : roots) reach(root);
    while (!open.empty()) {
      const NodeIndex index = open.back();
      open.pop_back();
      const Node& node = graph_.nodes[index];
      reach(node.a);
      reach(node.b);
      for (const Term& term : node.terms) reach(term.a), reach(term.b);
      if (node.op == Op::SinCos || node.op == Op::SinhCosh) reach(companion(index));
    }
  }

  /// Graph::pair makes the companion right after its node.
  NodeIndex companion(NodeIndex pair) const { return pair + 1; }

  void find_lags() {
    const std::size_t count = graph_.nodes.size();
    follows_q_.assign(count, false);
    lag_.assign(count, 0);
    int depth = 0;  // how often functions of t alone are differentiated
    for (std::size_t i = 0; i < count; ++i) {
      follows_q_[i] = graph_.nodes[i].op == Op::Coordinate;
      for_operands(graph_.nodes[i],
                   [&](NodeIndex operand, int) { follows_q_[i] = follows_q_[i] || follows_q_[operand]; });
      lag_[i] = lag_of(i, 0);
      if (section_[i] != dead && !follows_q_[i]) depth = std::max(depth, lag_[i]);
    }
    // Their lag starts so low that they never hold anything up.
    for (std::size_t i = 0; i < count; ++i) {
      lag_[i] = lag_of(i, -depth);
      if (section_[i] != dead && lag_[i] > 2)
        throw std::invalid_argument("build_kernel: a third time derivative of a coordinate stands in the source");
    }
    program_.first_stage = -2 - depth;
    delay();
    find_moved();
  }

  /// Which operands move with q̈_k at stage k: a force of q that is found at order k does not.
  void find_moved() {
    moved_.assign(graph_.nodes.size(), false);
    for (std::size_t i = 0; i < graph_.nodes.size(); ++i) {
      moved_[i] = graph_.nodes[i].op == Op::Coordinate;
      for_operands(graph_.nodes[i], [&](NodeIndex operand, int shift) {
        moved_[i] = moved_[i] || (moved_[operand] && lag_[operand] + shift == lag_[i]);
      });
    }
  }

  /// The lags so far are the least, at which everything is found as early as it can be: forces of q at order k + 2 of
  /// stage k, with q_{k+2} = 0, to be corrected when q̈_k is known. What waits for nothing but a residual or an
  /// observable, without being differentiated, is found at order k instead: q_k is known then, and no acceleration
  /// moves it. So forces between particles have no tangents, and no corrections.
  void delay() {
    can_wait_.assign(graph_.nodes.size(), true);
    const auto keep = [this](NodeIndex node) {
      if (node == no_node || !can_wait_[node]) return false;
      can_wait_[node] = false;
      return true;
    };
    for (const auto* roots : {&outputs_.constraint_values, &outputs_.constraint_rates})
      for (const NodeIndex root : *roots) keep(root);
    for (const auto* roots : {&outputs_.switches, &outputs_.events, &outputs_.integrands})
      for (const NodeIndex root : *roots) keep(root);
    for (bool changed = true; std::exchange(changed, false);)
      for (NodeIndex i = static_cast<NodeIndex>(graph_.nodes.size()); i-- > 0;)
        if (section_[i] != dead) for_needed_early(i, [&](NodeIndex operand) { changed |= keep(operand); });
    for (NodeIndex i = 0; i < graph_.nodes.size(); ++i)
      if (waits(i)) lag_[i] = 2;
  }

  /// Of velocities the residual waits less if they are at hand before.
  bool waits(NodeIndex i) const {
    return follows_q_[i] && can_wait_[i] && !is_leaf(graph_.nodes[i].op) && (lag_[i] <= 0 || section_[i] == AtPoint);
  }

  /// Calls f for what a node reads ahead of its own order, or at order 0 before the first accelerations are solved for:
  /// the coefficients of these.
  template <class F>
  void for_needed_early(NodeIndex i, F&& f) const {
    const Node& node = graph_.nodes[i];
    const bool is_at_stage = lag_[i] == 2 || waits(i);
    for_operands(node, [&](NodeIndex operand, int shift) {
      if (!is_at_stage || shift > 0) f(operand);
    });
    const auto accelerates = [&](NodeIndex n) { return n != no_node && follows_q_[n] && lag_[n] == 2; };
    for (const Term& term : node.terms) {
      if (node.op == Op::Function && !is_at_stage) f(term.a);
      if (accelerates(term.a)) f(term.b);
      if (term.b != no_node && accelerates(term.b)) f(term.a);
    }
    if (accelerates(node.a)) f(node.b);
    if (accelerates(node.b)) f(node.a);
    if (node.op == Op::Companion && !waits(i)) f(node.a);
    if ((node.op == Op::SinCos || node.op == Op::SinhCosh) && !waits(i)) f(companion(i));
  }

  int lag_of(std::size_t index, int lowest) const {
    const Node& node = graph_.nodes[index];
    if (node.op == Op::Coordinate) return 0;
    int lag = lowest;
    for_operands(node, [&](NodeIndex operand, int shift) {
      // The derivatives of the constant 1 vanish at every order and wait for nothing.
      if (graph_.nodes[operand].op != Op::One) lag = std::max(lag, lag_[operand] + shift);
    });
    return lag;
  }

  void check_linear() const {
    const auto accelerates = [&](NodeIndex node) { return node != no_node && moved_[node] && lag_[node] == 2; };
    for (std::size_t i = 0; i < graph_.nodes.size(); ++i) {
      const Node& node = graph_.nodes[i];
      if (section_[i] != Dynamics || lag_[i] != 2) continue;
      bool linear = true;
      if (node.op == Op::Products)
        for (const Term& term : node.terms) linear &= !(accelerates(term.a) && accelerates(term.b));
      else if (node.op == Op::Quotient)
        linear = !accelerates(node.b);
      else if (node.op != Op::Linear && node.op != Op::Derivative && node.op != Op::Select && node.op != Op::Companion)
        linear = !accelerates(node.a);
      if (!linear) throw std::invalid_argument("build_kernel: the residual is not linear in the accelerations");
    }
  }

  void find_levels() {
    level_.assign(graph_.nodes.size(), 0);
    for (std::size_t i = 0; i < graph_.nodes.size(); ++i) {
      if (is_leaf(graph_.nodes[i].op)) continue;
      for_operands(graph_.nodes[i],
                   [&](NodeIndex operand, int) { level_[i] = std::max(level_[i], level_[operand] + 1); });
    }
  }

  /// Later orders, later sections or higher lags read these: their coefficients must be right after the solve.
  void find_stored() {
    stored_.assign(graph_.nodes.size(), false);
    const auto store = [&](NodeIndex node) {
      if (node != no_node) stored_[node] = true;
    };
    for (std::size_t i = 0; i < graph_.nodes.size(); ++i) {
      const Node& node = graph_.nodes[i];
      if (section_[i] == dead) continue;
      for_operands(node, [&](NodeIndex operand, int shift) {
        const bool other_lag = lag_[operand] + shift != lag_[i];
        if (other_lag || section_[operand] < section_[i]) store(operand);
      });
      if (node.op == Op::Linear || node.op == Op::Derivative || node.op == Op::Select) continue;
      if (node.op == Op::Products || node.op == Op::Function)
        for (const Term& term : node.terms)
          if (term.b != no_node) store(term.a), store(term.b);
      if (node.op != Op::Products) store(node.a), store(node.b), store(static_cast<NodeIndex>(i));
    }
    for (const auto* roots : {&outputs_.switches, &outputs_.events, &outputs_.integrands, &outputs_.observables})
      for (const NodeIndex root : *roots) store(root);
  }

  void order_instructions() {
    for (NodeIndex i = 0; i < graph_.nodes.size(); ++i)
      if (section_[i] != dead && !is_leaf(graph_.nodes[i].op) && graph_.nodes[i].op != Op::Companion)
        order_.push_back(i);
    const auto key = [&](NodeIndex i) {
      return std::tuple(section_[i], level_[i], graph_.nodes[i].op, lag_[i], graph_.nodes[i].terms.size(), i);
    };
    std::sort(order_.begin(), order_.end(), [&](NodeIndex x, NodeIndex y) { return key(x) < key(y); });
  }

  void assign_slots() {
    slot_.assign(graph_.nodes.size(), no_slot);
    Slot next = 0;
    for (NodeIndex i = 0; i < graph_.nodes.size(); ++i)
      if (graph_.nodes[i].op == Op::Coordinate) slot_[i] = next++;
    const auto place = [&](NodeIndex i) {
      if (slot_[i] == no_slot) slot_[i] = next++;
    };
    const auto is_corrected = [&](NodeIndex i, int lag) {
      return stored_[i] && section_[i] == Dynamics && moved_[i] && lag_[i] == lag;
    };
    const auto with_companion = [&](NodeIndex i, auto&& f) {
      f(i);
      if (graph_.nodes[i].op == Op::SinCos || graph_.nodes[i].op == Op::SinhCosh) f(companion(i));
    };
    for (int lag = 0; lag <= 2; ++lag) {
      for (const NodeIndex i : order_)
        with_companion(i, [&](NodeIndex node) {
          if (is_corrected(node, lag)) place(node);
        });
      program_.stored_end[static_cast<std::size_t>(lag)] = next;
    }
    for (const NodeIndex i : order_) with_companion(i, place);
    for (NodeIndex i = 0; i < graph_.nodes.size(); ++i)
      if (is_leaf(graph_.nodes[i].op) && section_[i] != dead) {
        place(i);
        if (graph_.nodes[i].op == Op::One) program_.one = slot_[i];
        if (graph_.nodes[i].op == Op::Time) program_.time = slot_[i];
      }
    program_.slots = next;
    program_.lags.assign(next, 0);
    program_.tangent_lags.assign(next, Program::unmoved);
    for (NodeIndex i = 0; i < graph_.nodes.size(); ++i) {
      if (slot_[i] == no_slot) continue;
      program_.lags[slot_[i]] = static_cast<std::int8_t>(lag_[i]);
      if (moved_[i]) program_.tangent_lags[slot_[i]] = static_cast<std::int8_t>(lag_[i]);
    }
  }

  Slot slot_or_none(NodeIndex node) const { return node == no_node ? no_slot : slot_[node]; }

  Instruction instruction(NodeIndex index) {
    const Node& node = graph_.nodes[index];
    Instruction result{.op = node.op,
                       .function = node.function,
                       .lag = static_cast<std::int8_t>(lag_[index]),
                       .out = slot_[index],
                       .a = slot_or_none(node.a),
                       .b = slot_or_none(node.b),
                       .constant = node.constant};
    if (node.op == Op::SinCos || node.op == Op::SinhCosh) result.second = slot_[companion(index)];
    result.first_term = result.first_product = static_cast<std::uint32_t>(program_.terms.size());
    for (const Term& term : node.terms) {
      program_.terms.push_back({term.coefficient, slot_or_none(term.a), slot_or_none(term.b), term.shift});
      if (term.b == no_node) ++result.first_product;
    }
    result.last_term = static_cast<std::uint32_t>(program_.terms.size());
    return result;
  }

  void emit() {
    program_.terms.clear();
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
      const std::uint8_t section = section_[order_[i]];
      program_.instructions.push_back(instruction(order_[i]));
      const Instruction& added = program_.instructions.back();
      auto& runs = program_.runs[section];
      const bool goes_on = i > 0 && !runs.empty() && runs.back().op == added.op && runs.back().lag == added.lag &&
                           level_[order_[i]] == level_[order_[i - 1]];
      if (!goes_on) runs.push_back({added.op, added.lag, i, i});
      runs.back().last = i + 1;
    }
    const auto slots = [&](const std::vector<NodeIndex>& nodes) {
      std::vector<Slot> result;
      for (const NodeIndex node : nodes) result.push_back(slot_or_none(node));
      return result;
    };
    program_.residual = slots(outputs_.residual);
    program_.constraint_values = slots(outputs_.constraint_values);
    program_.constraint_rates = slots(outputs_.constraint_rates);
    program_.switch_slots = slots(outputs_.switches);
    program_.events = slots(outputs_.events);
    program_.integrands = slots(outputs_.integrands);
    program_.observables = slots(outputs_.observables);
  }

  const Graph& graph_;
  const Outputs& outputs_;
  Program& program_;
  std::vector<std::uint8_t> section_;
  std::vector<bool> follows_q_, can_wait_, moved_, stored_;
  std::vector<int> lag_, level_;
  std::vector<NodeIndex> order_;
  std::vector<Slot> slot_;
};

}  // namespace

void schedule(const Graph& graph, const Outputs& outputs, Program& program) {
  Scheduler(graph, outputs, program).run();
}

}  // namespace maupertuis::lowering

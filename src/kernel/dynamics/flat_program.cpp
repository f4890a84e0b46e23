#include "kernel/dynamics/flat_program.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

namespace maupertuis::dynamics {
namespace {

struct LinearPart {
  Coefficient coefficient;
  Cell a;
};
struct ProductPart {
  Coefficient coefficient;
  Cell a, b;
};

/// One coefficient of one order, before cells are numbered in their final order.
struct Node {
  enum What : std::uint8_t { Given, Sum, Sine, Cosine, Function, Second, Choose } kind = Given;
  std::vector<LinearPart> linear{};   // Choose: coefficient.constant is the condition
  std::vector<ProductPart> products{};
  Cell divisor = cell_of_one;         // Sum
  Op op = Op::One;                    // Function
  Kind function = Kind::Exp;
  Cell a = cell_of_zero, b = cell_of_zero;  // Sine, Function: operands; Cosine, Second: the node of the first result
  ConstantId exponent = 0;
  int level = 0;
  bool needed = false;
};

class Flattener {
 public:
  Flattener(const Program& program, bool with_accelerations, const std::vector<bool>& kept)
      : program_(program), orders_(1 - program.first_stage), kept_(kept),
        cell_(program.slots, std::vector<Cell>(static_cast<std::size_t>(orders_), cell_of_zero)) {
    nodes_.resize(first_coordinate_cell + 3 * program.unknowns);
    if (program.one != no_slot) cell_[program.one][0] = cell_of_one;
    if (program.time != no_slot) cell_[program.time][0] = cell_of_time, cell_[program.time][1] = cell_of_one;
    for (std::size_t i = 0; i < program.unknowns; ++i) {
      for (std::size_t k = 0; k < 2 && i < program.freedoms; ++k) cell_[i][k] = coordinate(i, k);
      if (with_accelerations) cell_[i][2] = coordinate(i, 2);
    }
  }

  FlatProgram run() {
    for (int stage = program_.first_stage; stage <= 0; ++stage)
      for (const Run& run : program_.runs[Dynamics])
        for (std::uint32_t i = run.first; i < run.last; ++i)
          if (const int order = stage + 2 - run.lag; order >= 0) make(program_.instructions[i], order);
    mark_needed();
    find_levels();
    write();
    return std::move(out_);
  }

 private:
  Cell coordinate(std::size_t i, std::size_t order) const {
    return first_coordinate_cell + static_cast<Cell>(order * program_.unknowns + i);
  }
  Cell at(Slot slot, int order) const { return order < orders_ ? cell_[slot][static_cast<std::size_t>(order)] : cell_of_zero; }

  // ---------------------------------------------------------------------------------------- the recurrences, written out

  void product(Node& node, Coefficient c, Slot a, int i, Slot b, int j) {
    const Cell x = at(a, i), y = at(b, j);
    if (x == cell_of_zero || y == cell_of_zero) return;
    if (y == cell_of_one) node.linear.push_back({c, x});
    else if (x == cell_of_one) node.linear.push_back({c, y});
    else {
      for (ProductPart& p : node.products)  // a_i b_j and a_j b_i of a square
        if (std::minmax(p.a, p.b) == std::minmax(x, y) && p.coefficient.constant == c.constant && p.coefficient.offset == 0 && c.offset == 0) {
          p.coefficient.factor += c.factor;
          return;
        }
      node.products.push_back({c, x, y});
    }
  }

  void make(const Instruction& i, int k) {
    switch (i.op) {
      case Op::Linear:
      case Op::Products: return sum(i, k);
      case Op::Square: return convolution(i, k);
      case Op::Quotient: return quotient(i, k);
      case Op::SquareRoot: return k == 0 ? call(i) : root(i, k);
      case Op::Power: return k == 0 ? call(i) : power(i, k);
      case Op::SinCos: return k == 0 ? sine(i) : pair(i, k, -1);
      case Op::SinhCosh: return k == 0 ? call(i) : pair(i, k, 1);
      case Op::Function: return k == 0 ? call(i) : integral(i, k);
      case Op::Derivative: return derivative(i, k);
      case Op::Select: return select(i, k);
      case Op::One: case Op::Time: case Op::Coordinate: case Op::Companion: return;
    }
    throw unknown_op(i.op, "the flat program");
  }

  Coefficient number(double factor) const { return {no_constant, 0, factor}; }

  void sum(const Instruction& i, int k) {
    Node node{.kind = Node::Sum};
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
      const Term& term = program_.terms[t];
      if (term.b == no_slot) {
        const double factor = term.shift == 0 ? 1 : term.shift == 1 ? k + 1.0 : (k + 1.0) * (k + 2.0);
        const Cell a = at(term.a, k + static_cast<int>(term.shift));
        if (a != cell_of_zero) node.linear.push_back({{term.coefficient, factor, 0}, a});
      } else {
        for (int j = 0; j <= k; ++j) product(node, {term.coefficient, 1, 0}, term.a, j, term.b, k - j);
      }
    }
    put(i.out, k, std::move(node));
  }

  void convolution(const Instruction& i, int k) {
    Node node{.kind = Node::Sum};
    for (int j = 0; j <= k; ++j) product(node, number(1), i.a, j, i.a, k - j);
    put(i.out, k, std::move(node));
  }

  void quotient(const Instruction& i, int k) {
    Node node{.kind = Node::Sum, .divisor = at(i.b, 0)};
    if (at(i.a, k) != cell_of_zero) node.linear.push_back({number(1), at(i.a, k)});
    for (int j = 1; j <= k; ++j) product(node, number(-1), i.b, j, i.out, k - j);
    put(i.out, k, std::move(node));
  }

  void root(const Instruction& i, int k) {
    Node node{.kind = Node::Sum, .divisor = at(i.out, 0)};
    if (at(i.a, k) != cell_of_zero) node.linear.push_back({number(0.5), at(i.a, k)});
    for (int j = 1; j < k; ++j) product(node, number(-0.5), i.out, j, i.out, k - j);
    put(i.out, k, std::move(node));
  }

  /// Σ_{j=1..k} (p j − (k − j)) u_j y_{k−j} / (k u_0)
  void power(const Instruction& i, int k) {
    Node node{.kind = Node::Sum, .divisor = at(i.a, 0)};
    for (int j = 1; j <= k; ++j)
      product(node, {i.constant, static_cast<double>(j) / k, -static_cast<double>(k - j) / k}, i.a, j, i.out, k - j);
    put(i.out, k, std::move(node));
  }

  void pair(const Instruction& i, int k, double sign) {
    Node first{.kind = Node::Sum}, second{.kind = Node::Sum};
    for (int j = 1; j <= k; ++j) {
      product(first, number(static_cast<double>(j) / k), i.a, j, i.second, k - j);
      product(second, number(sign * j / k), i.a, j, i.out, k - j);
    }
    put(i.out, k, std::move(first));
    put(i.second, k, std::move(second));
  }

  void integral(const Instruction& i, int k) {
    Node node{.kind = Node::Sum};
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
      const Term& term = program_.terms[t];
      for (int j = 1; j <= k; ++j) product(node, {term.coefficient, static_cast<double>(j) / k, 0}, term.b, j, term.a, k - j);
    }
    put(i.out, k, std::move(node));
  }

  void derivative(const Instruction& i, int k) {
    Node node{.kind = Node::Sum};
    if (at(i.a, k + 1) != cell_of_zero) node.linear.push_back({number(k + 1), at(i.a, k + 1)});
    put(i.out, k, std::move(node));
  }

  void sine(const Instruction& i) {
    const Cell first = append({.kind = Node::Sine, .a = at(i.a, 0)});
    cell_[i.out][0] = first;
    cell_[i.second][0] = append({.kind = Node::Cosine, .a = first});
  }

  void call(const Instruction& i) {
    Node node{.kind = Node::Function, .op = i.op, .function = i.function, .a = at(i.a, 0), .exponent = i.constant};
    if (i.b != no_slot) node.b = at(i.b, 0);
    const Cell first = append(std::move(node));
    cell_[i.out][0] = first;
    if (i.second != no_slot) cell_[i.second][0] = append({.kind = Node::Second, .a = first});
  }

  void select(const Instruction& i, int k) {
    Node node{.kind = Node::Choose};
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t)
      node.linear.push_back({{program_.terms[t].coefficient, 1, 0}, at(program_.terms[t].a, k)});
    cell_[i.out][static_cast<std::size_t>(k)] = append(std::move(node));
  }

  Cell append(Node node) {
    nodes_.push_back(std::move(node));
    return static_cast<Cell>(nodes_.size() - 1);
  }

  bool is_one(const Coefficient& c) const {
    if (c.constant == no_constant) return c.offset == 1;
    const Constant& constant = program_.constants[c.constant];
    return constant.kind == Kind::Number && constant.value * c.factor + c.offset == 1;
  }

  void put(Slot out, int k, Node node) {
    Cell& cell = cell_[out][static_cast<std::size_t>(k)];
    const bool divides = node.divisor != cell_of_one;
    if (node.linear.empty() && node.products.empty()) cell = cell_of_zero;
    else if (!divides && node.products.empty() && node.linear.size() == 1 && is_one(node.linear[0].coefficient)) cell = node.linear[0].a;
    else cell = append(std::move(node));
  }

  // ------------------------------------------------------------------------------------------------- what is needed, when

  template <class F>
  static void for_operands(const Node& node, F&& f) {
    for (const LinearPart& part : node.linear) f(part.a);
    for (const ProductPart& part : node.products) f(part.a), f(part.b);
    f(node.divisor), f(node.a), f(node.b);
  }

  void mark_needed() {
    for (const Slot slot : program_.residual) nodes_[at(slot, 0)].needed = true;
    for (Slot slot = 0; slot < program_.slots; ++slot)
      if (kept_[slot]) nodes_[at(slot, 0)].needed = true;
    for (std::size_t i = nodes_.size(); i-- > 0;)
      if (nodes_[i].needed) for_operands(nodes_[i], [&](Cell cell) { nodes_[cell].needed = true; });
  }

  void find_levels() {
    for (Node& node : nodes_) {
      if (node.kind == Node::Given) continue;
      int level = 0;
      for_operands(node, [&](Cell cell) { level = std::max(level, nodes_[cell].level); });
      node.level = node.kind == Node::Cosine || node.kind == Node::Second ? level : level + 1;
    }
  }

  // --------------------------------------------------------------------------------------------------------- the program

  void write() {
    const std::size_t given = first_coordinate_cell + 3 * program_.unknowns;
    std::vector<Cell> order;
    for (Cell i = static_cast<Cell>(given); i < nodes_.size(); ++i)
      if (nodes_[i].needed && nodes_[i].kind != Node::Cosine && nodes_[i].kind != Node::Second) order.push_back(i);
    const auto key = [&](Cell i) {
      const Node& n = nodes_[i];
      return std::tuple(n.level, n.kind, n.divisor != cell_of_one, n.linear.size(), n.products.size(), i);
    };
    std::sort(order.begin(), order.end(), [&](Cell a, Cell b) { return key(a) < key(b); });
    number_.assign(nodes_.size(), cell_of_zero);
    for (Cell i = 0; i < given; ++i) number_[i] = i;
    next_ = (given + 7) / 8 * 8;
    for (std::size_t i = 0; i < order.size();) {
      std::size_t last = i + 1;
      while (last < order.size() && same_run(order[i], order[last])) ++last;
      write_run({order.begin() + static_cast<std::ptrdiff_t>(i), order.begin() + static_cast<std::ptrdiff_t>(last)});
      i = last;
    }
    out_.cells = next_;
    for (const Slot slot : program_.residual) out_.residual.push_back(number_[at(slot, 0)]);
    for (Slot slot = 0; slot < program_.slots; ++slot) out_.value_of_slot.push_back(number_[at(slot, 0)]);
  }

  bool same_run(Cell a, Cell b) const {
    const Node &x = nodes_[a], &y = nodes_[b];
    return x.level == y.level && x.kind == y.kind && (x.divisor != cell_of_one) == (y.divisor != cell_of_one) &&
           x.linear.size() == y.linear.size() && x.products.size() == y.products.size();
  }

  void write_run(const std::vector<Cell>& run) {
    switch (nodes_[run[0]].kind) {
      case Node::Sum: return write_sums(run);
      case Node::Sine: return write_sines(run);
      case Node::Function: return write_calls(run);
      case Node::Choose: return write_choices(run);
      case Node::Given: case Node::Cosine: case Node::Second: break;   // made by others
    }
    throw std::logic_error("the flat program met a number that no step makes; please report");
  }

  template <class Items>
  void step(FlatStep::Kind kind, const Items& items) {
    out_.steps.push_back({kind, static_cast<std::uint32_t>(items.size() - 1)});
  }

  void write_sums(const std::vector<Cell>& run) {
    const Node& shape = nodes_[run[0]];
    const auto first = static_cast<std::uint32_t>(out_.sum_out.size());
    out_.sums.push_back({static_cast<std::uint32_t>(shape.linear.size()), static_cast<std::uint32_t>(shape.products.size()), first,
                         first + static_cast<std::uint32_t>(run.size()), static_cast<std::uint32_t>(out_.linear_cell.size()),
                         static_cast<std::uint32_t>(out_.product_a.size()), shape.divisor != cell_of_one});
    step(FlatStep::Sum, out_.sums);
    for (const Cell i : run) {
      const Node& node = nodes_[i];
      number_[i] = static_cast<Cell>(next_++);
      out_.sum_out.push_back(number_[i]);
      out_.sum_divisor.push_back(number_[node.divisor]);
      for (const LinearPart& part : node.linear) {
        out_.linear_coefficient.push_back(part.coefficient);
        out_.linear_cell.push_back(number_[part.a]);
      }
      for (const ProductPart& part : node.products) {
        out_.product_coefficient.push_back(part.coefficient);
        out_.product_a.push_back(number_[part.a]);
        out_.product_b.push_back(number_[part.b]);
      }
    }
  }

  void write_sines(const std::vector<Cell>& run) {
    for (std::size_t i = 0; i < run.size(); i += 8) {
      next_ = (next_ + 7) / 8 * 8;
      SineRun sines{{}, static_cast<Cell>(next_)};
      for (std::size_t lane = 0; lane < 8; ++lane) {
        const bool used = i + lane < run.size();
        sines.angle[lane] = used ? number_[nodes_[run[i + lane]].a] : cell_of_one;
        if (!used) continue;
        number_[run[i + lane]] = static_cast<Cell>(next_ + lane);
        number_[run[i + lane] + 1] = static_cast<Cell>(next_ + 8 + lane);  // its cosine follows it
      }
      next_ += 16;
      out_.sines.push_back(sines);
      step(FlatStep::Sine, out_.sines);
    }
  }

  void write_calls(const std::vector<Cell>& run) {
    for (const Cell i : run) {
      const Node& node = nodes_[i];
      number_[i] = static_cast<Cell>(next_++);
      FunctionCall call{node.op, node.function, number_[node.a], number_[node.b], number_[i], cell_of_zero, node.exponent};
      if (node.op == Op::SinhCosh) call.second = number_[i + 1] = static_cast<Cell>(next_++);
      out_.functions.push_back(call);
      step(FlatStep::Function, out_.functions);
    }
  }

  void write_choices(const std::vector<Cell>& run) {
    for (const Cell i : run) {
      number_[i] = static_cast<Cell>(next_++);
      const auto first = static_cast<std::uint32_t>(out_.choice_cells.size());
      for (const LinearPart& part : nodes_[i].linear) {
        out_.choice_conditions.push_back(part.coefficient.constant);
        out_.choice_cells.push_back(number_[part.a]);
      }
      out_.choices.push_back({number_[i], first, static_cast<std::uint32_t>(out_.choice_cells.size())});
      step(FlatStep::Choose, out_.choices);
    }
  }

  const Program& program_;
  int orders_;
  const std::vector<bool>& kept_;
  std::vector<std::vector<Cell>> cell_;  // [slots][orders] node of the coefficient
  std::vector<Node> nodes_;
  std::vector<Cell> number_;             // [nodes] its cell in the end
  std::size_t next_ = 0;
  FlatProgram out_;
};

}  // namespace

FlatProgram flatten(const Program& program, bool with_accelerations, const std::vector<bool>& kept) {
  return Flattener(program, with_accelerations, kept).run();
}

}  // namespace maupertuis::dynamics

#include "kernel/sparse/tangent_graph.hpp"

#include <algorithm>
#include <cstdint>

namespace maupertuis::sparse {
namespace {

class Collector {
 public:
  explicit Collector(const Program& program) : program_(program) {}

  void operator()(const Instruction& i) {
    if (program_.tangent_lags[i.out] == Program::unmoved) return;
    lag_ = i.lag;
    switch (i.op) {
      case Op::Linear:
      case Op::Products:
        return terms(i);
      case Op::Square:
        return add({Rule::Double, i.out, i.a, 0, i.a});
      case Op::Quotient:
        add({Rule::Reciprocal, i.out, i.a, 0, i.b});
        return add({Rule::Ratio, i.out, i.b, 0, i.b, i.out});
      case Op::SquareRoot:
        return add({Rule::HalfReciprocal, i.out, i.a, 0, i.out});
      case Op::Power:
        return add({Rule::PowerSlope, i.out, i.a, i.constant, i.a, i.out});
      case Op::SinCos:
        return pair(i, Rule::Negative);
      case Op::SinhCosh:
        return pair(i, Rule::Value);
      case Op::Function:
        return differential(i);
      case Op::Derivative:
        return add({Rule::One, i.out, i.a}, 1);
      case Op::Select:
        return select(i);
      case Op::One:
      case Op::Time:
      case Op::Coordinate:
      case Op::Companion:
        return;
    }
    throw unknown_op(i.op, "the graph of tangents");
  }

  std::vector<Edge> edges;

 private:
  void add(Edge edge, std::uint32_t shift = 0) {
    if (program_.tangent_lags[edge.operand] + static_cast<int>(shift) == lag_) edges.push_back(edge);
  }

  void terms(const Instruction& i) {
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
      const Term& term = program_.terms[t];
      if (term.b == no_slot) {
        add({Rule::Coefficient, i.out, term.a, term.coefficient}, term.shift);
        continue;
      }
      add({Rule::Scaled, i.out, term.a, term.coefficient, term.b});
      add({Rule::Scaled, i.out, term.b, term.coefficient, term.a});
    }
  }

  void pair(const Instruction& i, Rule of_second) {
    add({Rule::Value, i.out, i.a, 0, i.second});
    add({of_second, i.second, i.a, 0, i.out});
  }

  void differential(const Instruction& i) {
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
      const Term& term = program_.terms[t];
      add({Rule::Scaled, i.out, term.b, term.coefficient, term.a});
    }
  }

  void select(const Instruction& i) {
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t)
      add({Rule::Choice, i.out, program_.terms[t].a, t, i.first_term, i.last_term});
  }

  const Program& program_;
  int lag_ = 0;
};

}  // namespace

std::vector<Edge> tangent_edges(const Program& program) {
  Collector collector(program);
  for (const Run& run : program.runs[Dynamics])
    for (std::uint32_t i = run.first; i < run.last; ++i) collector(program.instructions[i]);
  return std::move(collector.edges);
}

std::vector<Edge> tangent_edges(const Program& program, const Instruction& instruction) {
  Collector collector(program);
  collector(instruction);
  return std::move(collector.edges);
}

std::vector<Edge> edges_to(const Program& program, std::vector<bool> needed) {
  std::vector<Edge> edges = tangent_edges(program), out;
  for (auto edge = edges.rbegin(); edge != edges.rend(); ++edge)
    if (needed[edge->out]) needed[edge->operand] = true, out.push_back(*edge);
  std::reverse(out.begin(), out.end());
  return out;
}

std::vector<Edge> edges_of_mass(const Program& program) {
  std::vector<bool> needed(program.slots, false);
  for (const Slot slot : program.residual) needed[slot] = program.tangent_lags[slot] == 2;
  return edges_to(program, std::move(needed));
}

bool has_symmetric_pattern(const Program& program) {
  constexpr std::size_t bits = 64;
  const std::size_t n = program.unknowns, words = (n + bits - 1) / bits;
  std::vector<std::uint64_t> followed(program.slots * words, 0);  // of each slot, a bit for each unknown
  for (std::size_t d = 0; d < n; ++d) followed[d * words + d / bits] |= std::uint64_t{1} << d % bits;
  for (const Edge& edge : tangent_edges(program))
    for (std::size_t w = 0; w < words; ++w) followed[edge.out * words + w] |= followed[edge.operand * words + w];
  const auto follows = [&](std::size_t i, std::size_t j) {
    const Slot slot = program.residual[i];
    return program.tangent_lags[slot] == 2 && (followed[slot * words + j / bits] >> j % bits & 1) != 0;
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (follows(i, j) != follows(j, i)) return false;
  return true;
}

}  // namespace maupertuis::sparse

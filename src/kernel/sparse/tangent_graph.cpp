#include "kernel/sparse/tangent_graph.hpp"

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
      case Op::Products: return terms(i);
      case Op::Square: return add({Rule::Double, i.out, i.a, 0, i.a});
      case Op::Quotient:
        add({Rule::Reciprocal, i.out, i.a, 0, i.b});
        return add({Rule::Ratio, i.out, i.b, 0, i.b, i.out});
      case Op::SquareRoot: return add({Rule::HalfReciprocal, i.out, i.a, 0, i.out});
      case Op::Power: return add({Rule::PowerSlope, i.out, i.a, i.constant, i.a, i.out});
      case Op::SinCos: return pair(i, Rule::Negative);
      case Op::SinhCosh: return pair(i, Rule::Value);
      case Op::Function: return differential(i);
      case Op::Derivative: return add({Rule::One, i.out, i.a}, 1);
      case Op::Select: return select(i);
      case Op::One: case Op::Time: case Op::Coordinate: case Op::Companion: return;
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
      if (term.b == no_slot) { add({Rule::Coefficient, i.out, term.a, term.coefficient}, term.shift); continue; }
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

bool is_constant(Rule rule) { return rule == Rule::One || rule == Rule::Coefficient || rule == Rule::Choice; }

double constant_factor(const Edge& edge, const Program& program, const double* constants) {
  if (edge.rule == Rule::One) return 1;
  if (edge.rule == Rule::Coefficient) return constants[edge.index];
  // Choice: the first term whose condition holds is taken, the last one if none does.
  std::uint32_t t = edge.x;
  while (t + 1 < edge.y && constants[program.terms[t].coefficient] == 0) ++t;
  return t == edge.index ? 1 : 0;
}

double factor_at(const Edge& edge, const double* constants, const double* now) {
  switch (edge.rule) {
    case Rule::Scaled: return constants[edge.index] * now[edge.x];
    case Rule::Value: return now[edge.x];
    case Rule::Negative: return -now[edge.x];
    case Rule::Double: return 2 * now[edge.x];
    case Rule::Reciprocal: return 1 / now[edge.x];
    case Rule::HalfReciprocal: return 0.5 / now[edge.x];
    case Rule::Ratio: return -now[edge.y] / now[edge.x];
    case Rule::PowerSlope: return constants[edge.index] * now[edge.y] / now[edge.x];
    case Rule::One: case Rule::Coefficient: case Rule::Choice: break;   // see constant_factor
  }
  return 0;
}

}  // namespace maupertuis::sparse

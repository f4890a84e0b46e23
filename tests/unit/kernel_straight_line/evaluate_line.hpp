#pragma once
#include "kernel/straight_line/builder.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

/// A straight line by the meaning of its nodes, as straight_line.hpp gives it.
struct Evaluated {
  std::vector<std::vector<double>> values;  // [nodes][1 or wide]
  std::vector<std::vector<double>> arrays;
  double margin = INFINITY;
};

inline Evaluated evaluate(const maupertuis::straight::StraightLine& line, std::vector<std::vector<double>> arrays) {
  using namespace maupertuis;
  using straight::Node, straight::Value, straight::none;
  Evaluated out{{}, std::move(arrays)};
  const auto in_lane = [&](Value v, std::size_t lane) {
    return v == none ? 1.0 : out.values[v][out.values[v].size() == 1 ? 0 : lane];
  };
  for (const Node& node : line.nodes) {
    const auto number = [&](std::size_t lane) -> double {
      const auto at = [&](Value v) { return in_lane(v, lane); };
      double sum = 0;
      switch (node.what) {
        case Node::Literal:
          return node.literal;
        case Node::Given:
          return out.arrays[node.array][node.index + lane];
        case Node::Sum:
          for (std::uint32_t i = node.first; i < node.last; ++i)
            sum += line.terms[i].factor * at(line.terms[i].a) * at(line.terms[i].b) * at(line.terms[i].c);
          return sum * at(node.a) / at(node.b);
        case Node::Magnitudes:
          for (std::uint32_t i = node.first; i < node.last; ++i)
            sum += std::abs(line.terms[i].factor * at(line.terms[i].a) * at(line.terms[i].b) * at(line.terms[i].c));
          return sum;
        case Node::Larger:
          return std::max(std::abs(at(node.a)), std::abs(at(node.b)));
        case Node::Chosen:
          return at(node.a) != 0 ? at(node.b) : at(node.c);
        case Node::Angles:
          return NAN;
        case Node::Sine:
          return std::sin(at(line.operands[line.nodes[node.a].first + node.index]));
        case Node::Cosine:
          return std::cos(at(line.operands[line.nodes[node.a].first + node.index]));
        case Node::Root:
          return std::sqrt(at(node.a));
        case Node::Call:
          if (node.function == Kind::Exp) return std::exp(at(node.a));
          if (node.function == Kind::Atan2) return std::atan2(at(node.a), at(node.b));
          throw std::logic_error("a function that these tests do not use");
        case Node::Lane:
          return out.values[node.a][node.index];
        case Node::Unit:
          return node.index == lane ? 1 : 0;
        case Node::Gather:
          return at(line.operands[node.first + lane]);
        case Node::Wide:
          for (std::uint32_t i = node.first; i < node.last; ++i)
            sum += line.terms[i].factor * at(line.terms[i].a) * at(line.terms[i].b) * at(line.terms[i].c);
          return sum;
      }
      throw std::logic_error("a node that these tests do not know");
    };
    std::vector<double> numbers;
    for (std::size_t lane = 0; lane < (straight::is_wide(node) ? line.wide : 1); ++lane)
      numbers.push_back(number(lane));
    out.values.push_back(std::move(numbers));
  }
  for (const straight::Store& store : line.stores)
    for (std::size_t lane = 0; lane < out.values[store.value].size(); ++lane)
      out.arrays[store.array][store.index + lane] = out.values[store.value][lane];
  for (const straight::PivotCheck& check : line.checks)
    for (std::size_t lane = 0; lane < out.values[check.pivot].size(); ++lane)
      out.margin = std::min(out.margin, in_lane(check.pivot, lane) - check.share * in_lane(check.size, lane));
  return out;
}

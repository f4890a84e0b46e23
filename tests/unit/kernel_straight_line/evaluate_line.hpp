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
  const auto at = [&](Value v) { return v == none ? 1.0 : out.values[v][0]; };
  for (const Node& node : line.nodes) {
    const auto scalar = [&]() -> double {
      double sum = 0;
      switch (node.what) {
        case Node::Literal: return node.literal;
        case Node::Given: return out.arrays[node.array][node.index];
        case Node::Sum:
          for (std::uint32_t i = node.first; i < node.last; ++i)
            sum += line.terms[i].factor * at(line.terms[i].a) * at(line.terms[i].b) * at(line.terms[i].c);
          return sum * at(node.a) / at(node.b);
        case Node::Magnitudes:
          for (std::uint32_t i = node.first; i < node.last; ++i)
            sum += std::abs(line.terms[i].factor * at(line.terms[i].a) * at(line.terms[i].b) * at(line.terms[i].c));
          return sum;
        case Node::Larger: return std::max(std::abs(at(node.a)), std::abs(at(node.b)));
        case Node::Chosen: return at(node.a) != 0 ? at(node.b) : at(node.c);
        case Node::Angles: return NAN;
        case Node::Sine: return std::sin(at(line.operands[line.nodes[node.a].first + node.index]));
        case Node::Cosine: return std::cos(at(line.operands[line.nodes[node.a].first + node.index]));
        case Node::Root: return std::sqrt(at(node.a));
        case Node::Call:
          if (node.function == Kind::Exp) return std::exp(at(node.a));
          if (node.function == Kind::Atan2) return std::atan2(at(node.a), at(node.b));
          throw std::logic_error("a function that these tests do not use");
        case Node::Lane: return out.values[node.a][node.index];
        default: return NAN;
      }
    };
    if (node.what != Node::Unit && node.what != Node::Wide) { out.values.push_back({scalar()}); continue; }
    std::vector<double> wide(line.wide, 0.0);
    if (node.what == Node::Unit) wide[node.index] = 1;
    for (std::uint32_t i = node.first; node.what == Node::Wide && i < node.last; ++i)
      for (std::uint32_t lane = 0; lane < line.wide; ++lane)
        wide[lane] += line.terms[i].factor * at(line.terms[i].a) * at(line.terms[i].b) * out.values[line.terms[i].c][lane];
    out.values.push_back(std::move(wide));
  }
  for (const straight::Store& store : line.stores) out.arrays[store.array][store.index] = at(store.value);
  for (const straight::PivotCheck& check : line.checks) out.margin = std::min(out.margin, at(check.pivot) - check.share * at(check.size));
  return out;
}

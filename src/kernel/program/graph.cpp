#include "kernel/program/graph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace maupertuis::lowering {

std::size_t KeyHash::operator()(const std::vector<std::uint32_t>& key) const {
  std::size_t hash = key.size();
  for (const std::uint32_t part : key) hash = (hash ^ part) * 0x9E3779B97F4A7C15ull + (hash >> 29);
  return hash;
}

// ---------------------------------------------------------------------------------------------------- constants

ConstantId ConstantPool::append(Constant constant, std::optional<Rational> rational) {
  constants.push_back(constant);
  rationals_.push_back(std::move(rational));
  return static_cast<ConstantId>(constants.size() - 1);
}

ConstantId ConstantPool::literal(const Rational& value) {
  const auto [place, fresh] = literals_.try_emplace(value.to_string(), 0);
  if (fresh) {
    place->second =
        append({.kind = Kind::Number, .value = value.to_double(), .index = static_cast<std::uint32_t>(literals.size())},
               value);
    literals.push_back(value);
  }
  return place->second;
}

ConstantId ConstantPool::parameter(std::uint32_t index) {
  const auto [place, fresh] = by_key_.try_emplace({static_cast<std::uint32_t>(Kind::Symbol), index}, 0);
  if (fresh) place->second = append({.kind = Kind::Symbol, .index = index}, {});
  return place->second;
}

ConstantId ConstantPool::side(std::uint32_t switch_index) {
  // No other constant of kind Less has a single argument, so that this key is free.
  const auto [place, fresh] = by_key_.try_emplace({static_cast<std::uint32_t>(Kind::Less), switch_index}, 0);
  if (fresh) place->second = append({.kind = Kind::Sign, .index = switch_index}, {});
  return place->second;
}

ConstantId ConstantPool::apply(Kind kind, std::span<const ConstantId> operands) {
  std::vector<std::uint32_t> key{static_cast<std::uint32_t>(kind)};
  key.insert(key.end(), operands.begin(), operands.end());
  if (kind == Kind::Sum || kind == Kind::Product) std::sort(key.begin() + 1, key.end());
  const auto [place, fresh] = by_key_.try_emplace(key, 0);
  if (!fresh) return place->second;
  const auto first = static_cast<std::uint32_t>(arguments.size());
  arguments.insert(arguments.end(), key.begin() + 1, key.end());
  const auto count = static_cast<std::uint32_t>(operands.size());
  return place->second = append({.kind = kind, .first_argument = first, .arguments = count}, {});
}

ConstantId ConstantPool::multiply(ConstantId a, ConstantId b) {
  if (is_one(a) || is_zero(b)) return b;
  if (is_one(b) || is_zero(a)) return a;
  if (rationals_[a] && rationals_[b]) return literal(*rationals_[a] * *rationals_[b]);
  return apply(Kind::Product, std::array{a, b});
}

ConstantId ConstantPool::add(ConstantId a, ConstantId b) {
  if (is_zero(a)) return b;
  if (is_zero(b)) return a;
  if (rationals_[a] && rationals_[b]) return literal(*rationals_[a] + *rationals_[b]);
  return apply(Kind::Sum, std::array{a, b});
}

ConstantPool::Polynomial ConstantPool::product(const Polynomial& x, const Polynomial& y) {
  Polynomial result;
  for (const auto& [of_x, a] : x)
    for (const auto& [of_y, b] : y) {
      std::vector<ConstantId> factors;
      std::merge(of_x.begin(), of_x.end(), of_y.begin(), of_y.end(), std::back_inserter(factors));
      Rational& coefficient = result.try_emplace(std::move(factors), Rational(0)).first->second;
      coefficient = coefficient + a * b;
    }
  return result;
}

/// Of constants that are written once: each is looked at once.
const ConstantPool::Polynomial& ConstantPool::polynomial(ConstantId id) {
  const auto found = polynomials_.find(id);
  return found != polynomials_.end() ? found->second : polynomials_.emplace(id, make_polynomial(id)).first->second;
}

ConstantPool::Polynomial ConstantPool::make_polynomial(ConstantId id) {
  constexpr std::size_t most_terms = 8;
  if (rationals_[id]) return {{{}, *rationals_[id]}};
  const Constant& c = constants[id];
  const std::span<const ConstantId> operands = std::span(arguments).subspan(c.first_argument, c.arguments);
  const Polynomial alone{{{id}, Rational(1)}};
  Polynomial result;
  if (c.kind == Kind::Sum) {
    for (const ConstantId operand : operands) {
      for (const auto& [factors, a] : polynomial(operand)) {
        Rational& coefficient = result.try_emplace(factors, Rational(0)).first->second;
        coefficient = coefficient + a;
      }
      if (result.size() > most_terms) return alone;
    }
  } else if (c.kind == Kind::Product) {
    result = {{{}, Rational(1)}};
    for (const ConstantId operand : operands) {
      result = product(result, polynomial(operand));
      if (result.size() > most_terms) return alone;
    }
  } else if (c.kind == Kind::Power && literal_or_null(operands[1]) && *literal_or_null(operands[1]) == Rational(2)) {
    const Polynomial& base = polynomial(operands[0]);
    result = product(base, base);
  } else {
    return alone;
  }
  std::erase_if(result, [](const auto& term) { return term.second.is_zero(); });
  return result.size() > most_terms ? alone : result;
}

bool ConstantPool::are_opposite(ConstantId a, ConstantId b) {
  const Polynomial &x = polynomial(a), &y = polynomial(b);
  return std::equal(x.begin(), x.end(), y.begin(), y.end(), [](const auto& of_x, const auto& of_y) {
    return of_x.first == of_y.first && of_x.second == -of_y.second;
  });
}

// -------------------------------------------------------------------------------------------------------- nodes

NodeIndex Graph::intern(Node node) {
  std::vector<std::uint32_t> key{static_cast<std::uint32_t>(node.op), static_cast<std::uint32_t>(node.function),
                                 node.constant, node.a, node.b};
  for (const Term& term : node.terms) key.insert(key.end(), {term.coefficient, term.a, term.b, term.shift});
  const auto [place, fresh] = by_key_.try_emplace(std::move(key), static_cast<NodeIndex>(nodes.size()));
  if (!fresh) return place->second;
  const auto raise = [&](NodeIndex operand) {
    if (operand != no_node && operand < nodes.size()) node.level = std::max(node.level, nodes[operand].level);
  };
  raise(node.a);
  raise(node.b);
  for (const Term& term : node.terms) raise(term.a), raise(term.b);
  if (node.op == Op::Derivative) ++node.level;
  nodes.push_back(std::move(node));
  return place->second;
}

NodeIndex Graph::leaf(Op op, std::uint32_t index) { return intern({.op = op, .constant = index}); }

namespace {
bool by_operands(const Term& x, const Term& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; }
}  // namespace

Scaled Graph::linear(std::vector<Term> terms) {
  std::stable_sort(terms.begin(), terms.end(), by_operands);
  std::vector<Term> collected;
  for (const Term& term : terms) {
    if (!collected.empty() && !by_operands(collected.back(), term))
      collected.back().coefficient = constants.add(collected.back().coefficient, term.coefficient);
    else
      collected.push_back(term);
  }
  std::erase_if(collected, [&](const Term& term) { return constants.is_zero(term.coefficient); });
  if (collected.empty()) return {constants.literal(0), no_node};
  if (collected.size() == 1 && nodes[collected[0].a].op == Op::One) return {collected[0].coefficient, no_node};
  if (collected.size() == 1) return {collected[0].coefficient, collected[0].a};
  return scaled(intern({.op = Op::Linear, .terms = std::move(collected)}));
}

NodeIndex Graph::multiply(NodeIndex a, NodeIndex b) {
  if (nodes[a].op == Op::One) return b;
  if (nodes[b].op == Op::One) return a;
  if (a == b) return unary(Op::Square, a);
  return intern({.op = Op::Products, .terms = {{constants.literal(1), std::min(a, b), std::max(a, b)}}});
}

NodeIndex Graph::unary(Op op, NodeIndex a, ConstantId constant) {
  return intern({.op = op, .constant = constant, .a = a});
}

NodeIndex Graph::quotient(NodeIndex a, NodeIndex b) { return intern({.op = Op::Quotient, .a = a, .b = b}); }

std::pair<NodeIndex, NodeIndex> Graph::pair(Op op, NodeIndex a) {
  const NodeIndex first = unary(op, a);
  return {first, unary(Op::Companion, first)};
}

NodeIndex Graph::function(Kind f, NodeIndex a, NodeIndex b, std::vector<Term> differential) {
  return intern({.op = Op::Function, .function = f, .a = a, .b = b, .terms = std::move(differential)});
}

NodeIndex Graph::select(std::vector<Term> choices) { return intern({.op = Op::Select, .terms = std::move(choices)}); }

NodeIndex Graph::node_of(Scaled value) {
  if (value.is_constant()) value.node = leaf(Op::One);
  if (constants.is_one(value.coefficient)) return value.node;
  return intern({.op = Op::Linear, .terms = {{value.coefficient, value.node}}});
}

}  // namespace maupertuis::lowering

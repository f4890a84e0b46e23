#include "symbolic/expression/storage.hpp"

#include <algorithm>

namespace maupertuis {
namespace {

std::size_t mix(std::size_t h, std::size_t value) {
  h ^= value + 0x9E3779B97F4A7C15ull + (h << 6) + (h >> 2);
  return h * 0xFF51AFD7ED558CCDull;
}

std::size_t hash_arguments(Kind kind, std::span<const NodeId> arguments) {
  std::size_t h = static_cast<std::size_t>(kind) + 1;
  for (const NodeId id : arguments) h = mix(h, id);
  return h ^ (h >> 29);
}

std::size_t hash_number(const Rational& value) { return mix(0x5bd1e995, value.hash()); }

}  // namespace

Context::Storage::Storage() : nodes(1), table(1024, 0) {}

NodeId Context::Storage::append(Node node) {
  nodes.push_back(node);
  return static_cast<NodeId>(nodes.size() - 1);
}

const NodeId* Context::Storage::copy_arguments(std::span<const NodeId> arguments) {
  if (chunks.empty() || chunk_used + arguments.size() > chunk_size) {
    chunk_size = std::max<std::size_t>(4096, arguments.size());
    chunk_used = 0;
    chunks.push_back(std::make_unique<NodeId[]>(chunk_size));
  }
  NodeId* place = chunks.back().get() + chunk_used;
  std::copy(arguments.begin(), arguments.end(), place);
  chunk_used += arguments.size();
  return place;
}

std::size_t Context::Storage::hash_of(const Node& node) const {
  if (node.kind == Kind::Number) return hash_number(numbers[node.payload]);
  return hash_arguments(node.kind, {node.arguments, node.count});
}

template <class Equal>
NodeId* Context::Storage::find_slot(std::size_t hash, Equal equal) {
  const std::size_t mask = table.size() - 1;
  std::size_t i = hash & mask;
  while (table[i] != 0 && !equal(nodes[table[i]])) i = (i + 1) & mask;
  return &table[i];
}

void Context::Storage::grow_table() {
  if (nodes.size() * 2 < table.size()) return;
  std::vector<NodeId> old(table.size() * 4, 0);
  old.swap(table);
  for (const NodeId id : old)
    if (id != 0) *find_slot(hash_of(nodes[id]), [](const Node&) { return false; }) = id;
}

NodeId Context::Storage::intern(Kind kind, std::span<const NodeId> arguments) {
  look_at_interrupt();
  grow_table();
  NodeId* slot = find_slot(hash_arguments(kind, arguments), [&](const Node& node) {
    return node.kind == kind && node.count == arguments.size() &&
           std::equal(arguments.begin(), arguments.end(), node.arguments);
  });
  if (*slot != 0) return *slot;
  Node node;
  node.kind = kind;
  node.arguments = copy_arguments(arguments);
  node.count = static_cast<std::uint32_t>(arguments.size());
  node.has_time_derivative = kind == Kind::TimeDerivative;
  for (const NodeId id : arguments) {
    node.time_dependent |= nodes[id].time_dependent;
    node.has_time_derivative |= nodes[id].has_time_derivative;
  }
  return *slot = append(node);
}

NodeId Context::Storage::intern_number(const Rational& value) {
  look_at_interrupt();
  grow_table();
  NodeId* slot = find_slot(hash_number(value), [&](const Node& node) {
    return node.kind == Kind::Number && numbers[node.payload] == value;
  });
  if (*slot != 0) return *slot;
  Node node;
  node.kind = Kind::Number;
  node.payload = static_cast<std::uint32_t>(numbers.size());
  numbers.push_back(value);
  return *slot = append(node);
}

}  // namespace maupertuis

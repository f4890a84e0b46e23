#include <maupertuis/expression.hpp>
#include <maupertuis/require.hpp>

#include "symbolic/expression/storage.hpp"

#include <algorithm>

namespace maupertuis {

Kind Expr::kind() const { return context_->storage().nodes[id_].kind; }
std::size_t Expr::size() const { return context_->storage().nodes[id_].count; }

Expr Expr::operator[](std::size_t index) const {
  const auto& node = context_->storage().nodes[id_];
  MAUP_REQUIRE(index < node.count);
  return Expr(context_, node.arguments[index]);
}

std::span<const NodeId> Expr::argument_ids() const {
  const auto& node = context_->storage().nodes[id_];
  return {node.arguments, node.count};
}

bool Expr::is_zero() const { return is_number() && number().is_zero(); }
bool Expr::is_one() const { return is_number() && number().is_one(); }

const Rational& Expr::number() const {
  MAUP_REQUIRE(is_number());
  return context_->storage().numbers[context_->storage().nodes[id_].payload];
}

namespace {
const Context::Storage::Symbol& symbol_of(const Expr& e) {
  MAUP_REQUIRE(e.is_symbol());
  const auto& storage = e.context().storage();
  return storage.symbols[storage.nodes[e.id()].payload];
}
}  // namespace

const std::string& Expr::name() const { return symbol_of(*this).name; }
Role Expr::role() const { return symbol_of(*this).role; }
int Expr::order() const { return symbol_of(*this).order; }

Context::Context() : storage_(std::make_unique<Storage>()) {
  // The leaves that every system uses get the first ids, whatever is built first.
  number(0);
  number(1);
  number(-1);
  pi();
}
Context::~Context() = default;

std::size_t Context::node_count() const { return storage_->nodes.size() - 1; }
bool Context::depends_on_time(NodeId id) const { return storage_->nodes[id].time_dependent; }
bool Context::has_time_derivative(NodeId id) const { return storage_->nodes[id].has_time_derivative; }

Expr Context::number(const Rational& value) { return Expr(this, storage_->intern_number(value)); }
Expr Context::pi() { return Expr(this, storage_->intern(Kind::Pi, {})); }
Expr Context::time() { return storage_->time ? Expr(this, storage_->time) : symbol("t", Role::Time); }

Expr Context::symbol(std::string_view name, Role role, int order) {
  MAUP_REQUIRE(order == 0 || role == Role::Coordinate || role == Role::Input);
  auto& orders = storage_->symbols_by_name[std::string(name)];
  if (orders.size() <= static_cast<std::size_t>(order)) orders.resize(static_cast<std::size_t>(order) + 1, 0);
  NodeId& id = orders[static_cast<std::size_t>(order)];
  if (id == 0) {
    Storage::Node node;
    node.kind = Kind::Symbol;
    node.payload = static_cast<std::uint32_t>(storage_->symbols.size());
    node.time_dependent =
        role == Role::Coordinate || role == Role::Input || role == Role::Time || role == Role::Multiplier;
    storage_->symbols.push_back({std::string(name), role, order});
    id = storage_->append(node);
    if (role == Role::Time) {
      MAUP_REQUIRE(storage_->time == 0);
      storage_->time = id;
    }
  }
  const Expr symbol(this, id);
  MAUP_REQUIRE(symbol.role() == role);
  return symbol;
}

std::vector<Expr> topological_order(std::span<const Expr> roots) {
  std::vector<Expr> order;
  if (roots.empty()) return order;
  Context& context = roots.front().context();
  NodeId top = 0;
  for (const Expr& root : roots) top = std::max(top, root.id());
  std::vector<std::uint64_t> reached(top / 64 + 1, 0);
  std::vector<NodeId> found;  // grows while it is walked
  const auto reach = [&](NodeId id) {
    std::uint64_t& word = reached[id / 64];
    const std::uint64_t bit = 1ull << (id % 64);
    if (word & bit) return;
    word |= bit;
    found.push_back(id);
  };
  for (const Expr& root : roots) reach(root.id());
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const NodeId argument : Expr(&context, found[i]).argument_ids()) reach(argument);
  // Children have smaller ids: ascending ids are a topological order.
  std::sort(found.begin(), found.end());
  order.reserve(found.size());
  for (const NodeId id : found) order.emplace_back(&context, id);
  return order;
}

std::vector<Expr> symbols_of(std::span<const Expr> roots) {
  std::vector<Expr> symbols;
  for (const Expr& e : topological_order(roots))
    if (e.is_symbol()) symbols.push_back(e);
  return symbols;
}

}  // namespace maupertuis

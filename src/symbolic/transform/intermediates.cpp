#include "symbolic/transform/intermediates.hpp"
#include "symbolic/transform/rebuild.hpp"

#include <algorithm>
#include <string>
#include <unordered_map>
#include <unordered_set>

namespace maupertuis::terms {
namespace {

/// Names that nothing in the context has yet: c2 and s2 for the cosine and sine of the second coordinate, k1, k2, …
class FreshNames {
 public:
  FreshNames(Context& context, const ReadingOrder& order) : context_(context), order_(order) {
    for (NodeId id = 1; id <= context.node_count(); ++id)
      if (const Expr e = context.node(id); e.is_symbol()) taken_.insert(e.name());
  }

  Expr name_for(Expr value) {
    if (value.is(Kind::Sin) || value.is(Kind::Cos)) {
      const auto place = std::find(order_.coordinates.begin(), order_.coordinates.end(), value[0]);
      const std::string name = (value.is(Kind::Sin) ? "s" : "c") + std::to_string(place - order_.coordinates.begin() + 1);
      if (place != order_.coordinates.end() && taken_.insert(name).second) return symbol(name);
    }
    std::string name;
    do name = "k" + std::to_string(++last_);
    while (!taken_.insert(name).second);
    return symbol(name);
  }

 private:
  Expr symbol(const std::string& name) { return context_.symbol(name, Role::Auxiliary); }

  Context& context_;
  const ReadingOrder& order_;
  std::unordered_set<std::string> taken_;
  int last_ = 0;
};

/// Too small to deserve a name: leaves, and products of up to four names.
bool is_small(Expr e) {
  if (e.size() == 0) return true;
  if (e.is(Kind::Power)) return e[0].size() == 0 && e[1].is_number();
  if (!e.is(Kind::Product)) return false;
  std::size_t names = 0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    if (e[i].is_number()) continue;
    if (!is_small(e[i]) || e[i].is(Kind::Product)) return false;
    ++names;
  }
  return names <= 4;
}

bool is_condition(Kind kind) {
  return kind == Kind::Less || kind == Kind::LessEqual || kind == Kind::And || kind == Kind::Or;
}

/// Σ (∂R/∂q_j'') q_j'' + R at q'' = 0: the coefficients of a row that is linear in the accelerations.
struct Row {
  std::vector<Expr> coefficients;   // by accelerations
  Expr rest;
};

std::vector<Expr> accelerations(std::span<const Expr> rows) {
  std::vector<Expr> found;
  for (const Expr& s : symbols_of(rows))
    if (s.role() == Role::Coordinate && s.order() == 2) found.push_back(s);
  return found;
}

std::vector<Row> split(std::span<const Expr> rows, const std::vector<Expr>& accelerations) {
  std::vector<Row> result;
  ExprMap at_rest;
  for (const Expr& a : accelerations) at_rest.emplace(a, a.context().number(0));
  for (const Expr& row : rows) {
    std::vector<Expr> coefficients = gradient(row, accelerations);
    const bool linear = std::none_of(coefficients.begin(), coefficients.end(), [&](const Expr& c) {
      const auto inside = symbols_of({&c, 1});
      return std::any_of(inside.begin(), inside.end(), [&](const Expr& s) { return at_rest.count(s) != 0; });
    });
    if (linear) result.push_back({std::move(coefficients), substitute(row, at_rest)});
    else result.push_back({std::vector<Expr>(accelerations.size(), row.context().number(0)), row});
  }
  return result;
}

}  // namespace

std::vector<ReadableForm> with_intermediates(std::span<const Expr> rows, const ReadingOrder& order) {
  Context& context = rows.front().context();
  const std::vector<Expr> rates = accelerations(rows);
  const std::vector<Row> split_rows = split(rows, rates);
  std::vector<Expr> roots;
  for (const Row& row : split_rows) {
    roots.insert(roots.end(), row.coefficients.begin(), row.coefficients.end());
    roots.push_back(row.rest);
  }

  const std::vector<Expr> nodes = topological_order(roots);
  std::unordered_map<NodeId, int> uses;
  for (const Expr& root : roots) ++uses[root.id()];
  for (const Expr& node : nodes)
    for (const NodeId argument : node.argument_ids()) ++uses[argument];

  // Children first, so that every value is written in names that stand before it.
  FreshNames names(context, order);
  std::unordered_map<NodeId, Expr> written;
  std::vector<Intermediate> intermediates;
  for (const Expr& node : nodes) {
    Expr value = rebuild(node, [&](Expr argument) { return written.at(argument.id()); });
    if (uses[node.id()] > 1 && !is_small(value) && !is_condition(node.kind())) {
      intermediates.push_back({names.name_for(value), value});
      value = intermediates.back().symbol;
    }
    written.emplace(node.id(), value);
  }

  std::vector<ReadableForm> forms;
  for (const Row& row : split_rows) {
    std::vector<Expr> terms;
    for (std::size_t j = 0; j < rates.size(); ++j) terms.push_back(written.at(row.coefficients[j].id()) * rates[j]);
    const Expr rest = written.at(row.rest.id());
    if (!rest.is(Kind::Sum)) terms.push_back(rest);
    else for (std::size_t i = 0; i < rest.size(); ++i) terms.push_back(rest[i]);
    forms.push_back({context.sum(terms), intermediates, {}});
  }
  return forms;
}

}  // namespace maupertuis::terms

#include <maupertuis/shared_form.hpp>

#include "symbolic/expression/storage.hpp"
#include "symbolic/transform/intermediates.hpp"
#include "symbolic/transform/rebuild.hpp"
#include "symbolic/transform/reverse_sweep.hpp"

#include <algorithm>
#include <string>
#include <unordered_map>

namespace maupertuis::terms {
namespace {

/// Names that nothing in the context has yet: c2 and s2 for the cosine and sine of the second coordinate, k1, k2, …
class FreshNames {
 public:
  FreshNames(Context& context, const ReadingOrder& order) : context_(context), places_(places_of(order.coordinates)) {}

  Expr name_for(Expr value) {
    if (value.is(Kind::Sin) || value.is(Kind::Cos)) {
      if (const auto place = places_.find(value[0].id()); place != places_.end()) {
        const std::string name = (value.is(Kind::Sin) ? "s" : "c") + std::to_string(place->second + 1);
        if (is_free(name)) return symbol(name);
      }
    }
    std::string name;
    int& last = context_.storage().numbered_names;
    do name = "k" + std::to_string(++last);
    while (!is_free(name));
    return symbol(name);
  }

 private:
  bool is_free(const std::string& name) const { return !context_.storage().symbols_by_name.contains(name); }
  Expr symbol(const std::string& name) { return context_.symbol(name, Role::Auxiliary); }

  Context& context_;
  std::unordered_map<NodeId, std::size_t> places_;  // of the coordinates
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
  std::vector<Expr> coefficients;  // by accelerations
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
    if (linear)
      result.push_back({std::move(coefficients), substitute(row, at_rest)});
    else
      result.push_back({std::vector<Expr>(accelerations.size(), row.context().number(0)), row});
  }
  return result;
}

/// What stands in several places of the roots gets a name, children first, so that every value is written in names that
/// stand before it.
class NamedParts {
 public:
  NamedParts(std::span<const Expr> roots, const ReadingOrder& order, std::span<const Intermediate> known)
      : names_(roots.front().context(), order) {
    for (const Intermediate& i : known) known_.emplace(i.value, i.symbol);
    const std::vector<Expr> nodes = topological_order(roots);
    std::unordered_map<NodeId, int> uses;
    for (const Expr& root : roots) ++uses[root.id()];
    for (const Expr& node : nodes)
      for (const NodeId argument : node.argument_ids()) ++uses[argument];
    for (const Expr& node : nodes) {
      Expr value = rebuild(node, [&](Expr argument) { return written_.at(argument.id()); });
      if (const auto name = known_.find(value); name != known_.end())
        value = name->second;
      else if (uses[node.id()] > 1 && !is_small(value) && !is_condition(node.kind()))
        value = named(value);
      written_.emplace(node.id(), value);
    }
  }

  Expr written(Expr e) const { return written_.at(e.id()); }
  std::vector<Intermediate> intermediates;

 private:
  Expr named(Expr value) {
    intermediates.push_back({names_.name_for(value), value});
    return intermediates.back().symbol;
  }

  FreshNames names_;
  ExprMap known_;  // values that have a name already
  std::unordered_map<NodeId, Expr> written_;
};

/// The terms of a sum, of the sums that are its terms, and so on: opposite ones meet.
void gather_terms(Expr e, std::vector<Expr>& terms) {
  if (!e.is(Kind::Sum)) return terms.push_back(e);
  for (std::size_t i = 0; i < e.size(); ++i) gather_terms(e[i], terms);
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
  const NamedParts parts(roots, order, {});
  std::vector<ReadableForm> forms;
  for (const Row& row : split_rows) {
    std::vector<Expr> terms;
    for (std::size_t j = 0; j < rates.size(); ++j) terms.push_back(parts.written(row.coefficients[j]) * rates[j]);
    const Expr rest = parts.written(row.rest);
    if (!rest.is(Kind::Sum))
      terms.push_back(rest);
    else
      for (std::size_t i = 0; i < rest.size(); ++i) terms.push_back(rest[i]);
    forms.push_back({context.sum(terms), parts.intermediates, {}});
  }
  return forms;
}

}  // namespace maupertuis::terms

namespace maupertuis {

SharedForm shared_form(std::span<const Expr> rows, const ReadingOrder& order, std::span<const Intermediate> known) {
  SharedForm form;
  if (rows.empty()) return form;
  const std::vector<Expr> expanded = expand_time_derivatives(rows);
  const terms::NamedParts parts(expanded, order, known);
  for (const Expr& row : expanded) {
    std::vector<Expr> summands;
    terms::gather_terms(parts.written(row), summands);
    form.rows.push_back(row.context().sum(summands));
  }
  form.intermediates = parts.intermediates;
  return form;
}

}  // namespace maupertuis

#include <maupertuis/kinds.hpp>
#include <maupertuis/print.hpp>

#include <unordered_map>

/// The DAG as text, one node a line, numbered from the leaves: what `--emit` shows of a stage.
namespace maupertuis {
namespace {

std::string leaf(Expr e) {
  if (e.is_number()) return e.number().to_string();
  return e.is(Kind::Pi) ? "pi" : symbol_to_plain(e);
}

}  // namespace

std::string to_dag_text(std::span<const Expr> roots) {
  std::unordered_map<NodeId, std::string> labels;
  std::string text;
  std::size_t next = 0;
  for (const Expr& e : topological_order(roots)) {
    if (e.size() == 0) {
      labels.emplace(e.id(), leaf(e));
      continue;
    }
    const std::string label = "%" + std::to_string(next++);
    text += label + " = " + std::string(name_of(e.kind()));
    for (const NodeId argument : e.argument_ids()) text += " " + labels.at(argument);
    text += "\n";
    labels.emplace(e.id(), label);
  }
  for (std::size_t i = 0; i < roots.size(); ++i)
    text += "root " + std::to_string(i) + " = " + labels.at(roots[i].id()) + "\n";
  return text;
}

}  // namespace maupertuis

#include "system/lint.hpp"

#include <maupertuis/print.hpp>

#include <fmt/format.h>

#include <map>

namespace maupertuis::lint_rules {
namespace {

struct Owner {
  std::string name;
  bool of_the_program = false;  // p_x and h_E, which stand beside the equations
};

}  // namespace

void names_printed_alike(Subject& s) {
  std::map<std::string, Owner> seen;  // by how LaTeX writes it
  Context ours;
  const auto add_ours = [&](const std::string& name) {
    seen[symbol_to_latex(ours.symbol(name, Role::Auxiliary))] = {name, true};
  };
  add_ours("h_E");
  for (const Coordinate& c : s.system.coordinates) add_ours("p_" + c.name);
  const auto look_at = [&](Expr symbol, const std::string& name, Span span) {
    const auto [place, is_new] = seen.try_emplace(symbol_to_latex(symbol), Owner{name, false});
    if (is_new || (place->second.name == name && !place->second.of_the_program)) return;
    const Owner& other = place->second;
    s.diagnostics.warning(
        "W0438", span,
        other.of_the_program ? fmt::format("`{}` is printed as {} is, {}", name, other.name,
                                           other.name == "h_E" ? "the energy function" : "a momentum")
                             : fmt::format("`{}` and `{}` are printed alike", name, other.name),
        "In formulas a second letter and what follows an underscore stand below the line: mS and m_S are one symbol.",
        "Rename one of them.");
  };
  for (const Coordinate& c : s.system.coordinates) look_at(c.q, c.name, c.span);
  for (const Parameter& p : s.system.parameters)
    if (p.symbol.role() == Role::Parameter) look_at(p.symbol, p.name, p.span);
  for (const Input& u : s.system.inputs) look_at(u.symbol, u.name, u.span);
}

}  // namespace maupertuis::lint_rules

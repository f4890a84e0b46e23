#include "system/elaboration.hpp"
#include "system/override_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

/// What was said beside the model, in the place of its own: values of parameters, of the start and of a point.
namespace maupertuis::elaboration {
namespace {

/// A statement that was said beside the model, with the mistakes in it: they are told as mistakes of its text.
struct Beside {
  const SourceText& text;
  syntax::SyntaxTree tree;
  Diagnostics found;

  template <class Part>
  Beside(const Elaboration& e, const Part& part, Span span) : text(e.texts.of(span)) {
    tree.statements.push_back({part, span});
  }
  /// Warnings, and the first error as one of the text; true where there was one.
  bool hand_over(Elaboration& e) {
    const Diagnostics told = std::exchange(found, {});
    for (const Diagnostic& d : told.items())
      if (d.severity == Severity::Warning) e.diagnostics.append(d);
    return tell_of_override(told, text, e.diagnostics);
  }
};

void unknown_parameter(Elaboration& e, const Beside& said, const Declaration& given, const Declaration* d) {
  const std::string& name = given.name;
  std::vector<std::string> names;
  for (const Declaration& other : e.table.declarations())
    if (other.kind == Declaration::Kind::Parameter) names.push_back(other.name);
  const std::string near = did_you_mean(name, names);
  refuse_override(said.text, given.span,
                  d && d->statement ? fmt::format("`{}` is a {}, not a parameter", name, word_of(d->kind))
                                    : fmt::format("the model has no parameter `{}`", name),
                  "Only parameters can be set.", near.empty() ? "" : fmt::format("Did you mean `{}`?", near),
                  e.diagnostics);
}

/// Puts the value and unit that were given in the place of the model's.
void replace(Elaboration& e, Declaration& d, const Elaboration& inner) {
  for (const Parameter& given : inner.model.system.parameters)
    for (Parameter& p : e.system().parameters) {
      if (p.symbol != given.symbol) continue;
      p.value = given.value;
      p.si_value = given.si_value;
      p.unit = given.unit;
      p.unit_factor = given.unit_factor;
      if (d.value.fits_any) p.dimension = given.dimension;
      e.values[p.symbol] = p.si_value;
      e.exact_values[p.symbol] = p.value;
    }
}

/// False where the dimension is another.
bool check_kept_dimension(Elaboration& e, const Beside& said, const Declaration& d, const Declaration& given) {
  const bool fits = d.value.fits_any || given.value.fits_any || given.value.dimension.same_as(d.value.dimension);
  if (fits && given.value.parts.size() == d.value.parts.size()) return true;
  refuse_override(
      said.text, std::get<syntax::ParamStatement>(given.statement->body).items[given.item].value->span,
      fmt::format("`{}` is {}, this is {}", d.name, describe(d.value.dimension), describe(given.value.dimension)),
      "A parameter keeps its dimension.",
      fmt::format("Write {} {}=… with a unit of the same dimension.", said.text.name(), d.name), e.diagnostics);
  return false;
}

void set_parameter(Elaboration& e, Beside& said, Elaboration& inner, Declaration& given) {
  Declaration* d = e.table.find(given.name);
  if (!d || d->kind != Declaration::Kind::Parameter) return unknown_parameter(e, said, given, d);
  elaborate_parameter(inner, given);
  if (said.hand_over(e) || d->value.poisoned || given.value.poisoned || !check_kept_dimension(e, said, *d, given))
    return;
  replace(e, *d, inner);
  if (d->value.fits_any) {
    d->value.dimension = given.value.dimension;
    d->value.fits_any = given.value.fits_any;
  }
}

}  // namespace

Elaboration::Elaboration(const Elaboration& outer, const syntax::SyntaxTree& tree, Diagnostics& diagnostics)
    : tree(tree),
      texts(outer.texts),
      overrides(outer.overrides),
      diagnostics(diagnostics),
      table(tree, outer.texts, diagnostics),
      model{MechanicalSystem{}, Experiment{}},
      context(outer.context),
      values(outer.values),
      exact_values(outer.exact_values),
      dimensionless(outer.dimensionless),
      higher(outer.higher) {
  model.system.context = outer.model.system.context;
  model.system.space_dimension = outer.model.system.space_dimension;
  model.system.independent = outer.model.system.independent;
  model.system.independent_dimension = outer.model.system.independent_dimension;
}

namespace {

/// Formulas that follow hold its value.
void make_constant(Elaboration& e, const std::string& name) {
  Declaration* d = e.table.find(name);
  if (!d || d->kind != Declaration::Kind::Parameter || d->value.poisoned) return;
  for (Expr& part : d->value.parts)
    if (const auto value = e.exact_values.find(part); value != e.exact_values.end()) part = value->second;
}

void set_parameters(Elaboration& e, const syntax::ParamStatement& part, bool constant) {
  Beside said(e, part, part.items.front().name.span);
  Elaboration inner(e, said.tree, said.found);
  if (said.hand_over(e)) return;
  for (Declaration& given : inner.table.declarations()) {
    if (given.kind != Declaration::Kind::Parameter) continue;
    set_parameter(e, said, inner, given);
    if (constant) make_constant(e, given.name);
  }
}

}  // namespace

void override_parameters(Elaboration& e) {
  for (const syntax::ParamStatement& part : e.overrides.parameters) set_parameters(e, part, false);
  for (const syntax::ParamStatement& part : e.overrides.constants) set_parameters(e, part, true);
}

namespace {

void override_conditions(Elaboration& e, const std::vector<StartCondition>& said) {
  std::vector<StartCondition>& list = e.experiment().start_conditions;
  for (const StartCondition& condition : said) {
    std::erase_if(list, [&](const StartCondition& old) { return old.formula == condition.formula; });
    list.push_back(condition);
  }
}

/// What the model asks of the places that this coordinate moves: what is said of the coordinate itself counts.
void forget_places_with(Elaboration& e, const StartValue& said) {
  if (said.order != 0) return;
  const Expr q = e.system().coordinates[said.coordinate].q;
  std::erase_if(e.experiment().start_conditions, [&](const StartCondition& old) {
    const std::vector<Expr> held = symbols_of({&old.formula, 1});
    return old.is_of_positions() && std::find(held.begin(), held.end(), q) != held.end();
  });
}

/// The items of `θ=1, φ'=2`, each handed to `take(inner, item)` until a mistake was told.
template <class Take>
void for_each_item(Elaboration& e, const syntax::StartStatement& part, Take&& take) {
  if (part.items.empty()) return;
  Beside said(e, part, part.items.front().variable->span);
  Elaboration inner(e, said.tree, said.found);
  inner.table.adopt(e.table);
  inner.system().coordinates = e.system().coordinates;
  inner.poses = e.poses;
  for (const auto& item : part.items) {
    take(inner, item);
    if (said.hand_over(e)) break;
  }
}

void replace_start(std::vector<StartValue>& list, StartValue value) {
  std::erase_if(list,
                [&](const StartValue& old) { return old.coordinate == value.coordinate && old.order == value.order; });
  list.push_back(std::move(value));
}

}  // namespace

void override_start(Elaboration& e) {
  for (const syntax::StartStatement& part : e.overrides.start)
    for_each_item(e, part, [&](Elaboration& inner, const auto& item) {
      if (is_start_condition(inner, *item.variable)) return override_conditions(e, start_conditions(inner, item));
      auto value = start_value(inner, item);
      if (!value) return;
      forget_places_with(e, *value);
      replace_start(e.experiment().start, std::move(*value));
    });
  std::vector<StartCondition> rates;
  for (const syntax::StartStatement& part : e.overrides.at)
    for_each_item(e, part, [&](Elaboration& inner, const auto& item) {
      if (is_rate(inner, *item.variable)) {
        const std::vector<StartCondition> given = start_conditions(inner, item);
        rates.insert(rates.end(), given.begin(), given.end());
        return;
      }
      if (auto value = start_value(inner, item)) replace_start(e.experiment().at, std::move(*value));
    });
  add_velocities_of_rates(e, rates, e.experiment().at);
}

}  // namespace maupertuis::elaboration

#include "system/elaboration.hpp"

#include <fmt/format.h>

#include <algorithm>

/// `--set m=2kg` and `--start θ=1` of the command line: each is read as a statement of its own (`param m = 2kg`), and
/// its value takes the place of the model's. The texts of the options count as lines behind the text of the model, in the
/// order of Overrides: that is where a mistake in one of them has its place.
namespace maupertuis::elaboration {
namespace {

/// One override as a model text of one statement.
struct Fragment {
  std::string option, text;
  std::uint32_t place;   // of the text, behind that of the model
  std::uint32_t head;    // bytes before it in the statement
  SourceText source;
  Diagnostics diagnostics;
  syntax::SyntaxTree tree;

  Fragment(const char* option, const char* statement, const std::string& text, std::uint32_t place)
      : option(option),
        text(text),
        place(place),
        head(static_cast<std::uint32_t>(std::string_view(statement).size() + 1)),
        source("command line", fmt::format("{} {}\n", statement, text)),
        tree(syntax::parse(source, diagnostics)) {}
};

Span all_of(const Fragment& f) { return {f.head, f.head + static_cast<std::uint32_t>(f.text.size())}; }

void refuse(Elaboration& e, const Fragment& f, Span span, const std::string& message, std::string reason, std::string help) {
  const Span all = all_of(f);
  const auto shifted = [&](std::uint32_t at) { return f.place + std::clamp(at, all.begin, all.end) - all.begin; };
  e.diagnostics.error("E0224", Span{shifted(span.begin), shifted(span.end)}, fmt::format("{} {}: {}", f.option, f.text, message),
                      std::move(reason), std::move(help));
}

/// The first mistake inside the fragment, told as one of the option; true if there was any.
bool hand_over(Elaboration& e, const Fragment& f) {
  for (const Diagnostic& d : f.diagnostics.items()) {
    if (d.severity != Severity::Error) continue;
    refuse(e, f, d.span.value_or(all_of(f)), d.message, d.reason, d.help);
    return true;
  }
  return false;
}

/// Where the n-th text of the overrides stands: each is a line of its own behind the model.
std::uint32_t place_behind(const Elaboration& e, const Overrides& overrides, std::size_t n) {
  std::size_t place = e.source.text().size() + 1;
  for (const auto* list : {&overrides.parameters, &overrides.start, &overrides.at})
    for (const std::string& text : *list) {
      if (n-- == 0) return static_cast<std::uint32_t>(place);
      place += text.size() + 1;
    }
  return static_cast<std::uint32_t>(place);
}

void unknown_parameter(Elaboration& e, const Fragment& f, const Declaration& given, const Declaration* d) {
  const std::string& name = given.name;
  std::vector<std::string> names;
  for (const Declaration& other : e.table.declarations())
    if (other.kind == Declaration::Kind::Parameter) names.push_back(other.name);
  const std::string near = did_you_mean(name, names);
  refuse(e, f, given.span,
         d && d->statement ? fmt::format("`{}` is a {}, not a parameter", name, word_of(d->kind))
                           : fmt::format("the model has no parameter `{}`", name),
         "Only parameters can be set.", near.empty() ? "" : fmt::format("Did you mean `{}`?", near));
}

/// Puts the value and unit that the fragment gave in place of the model's.
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

void set_parameter(Elaboration& e, Fragment& f, Elaboration& inner, Declaration& given) {
  Declaration* d = e.table.find(given.name);
  if (!d || d->kind != Declaration::Kind::Parameter) return unknown_parameter(e, f, given, d);
  elaborate_parameter(inner, given);
  if (hand_over(e, f) || d->value.poisoned || given.value.poisoned) return;
  const bool fits = d->value.fits_any || given.value.fits_any || given.value.dimension.same_as(d->value.dimension);
  if (!fits || given.value.parts.size() != d->value.parts.size())
    return refuse(
        e, f, std::get<syntax::ParamStatement>(given.statement->body).items[given.item].value->span,
        fmt::format("`{}` is {}, this is {}", d->name, describe(d->value.dimension), describe(given.value.dimension)),
        "A parameter keeps its dimension.",
        fmt::format("Write --set {}=… with a unit of the same dimension.", d->name));
  replace(e, *d, inner);
  if (d->value.fits_any) {
    d->value.dimension = given.value.dimension;
    d->value.fits_any = given.value.fits_any;
  }
}

}  // namespace

Elaboration::Elaboration(const Elaboration& outer, const syntax::SyntaxTree& tree, const SourceText& source,
                         Diagnostics& diagnostics)
    : tree(tree),
      source(source),
      diagnostics(diagnostics),
      table(tree, source, diagnostics),
      model{MechanicalSystem{}, Experiment{}},
      context(outer.context),
      values(outer.values),
      exact_values(outer.exact_values),
      dimensionless(outer.dimensionless) {
  model.system.context = outer.model.system.context;
  model.system.space_dimension = outer.model.system.space_dimension;
  model.system.independent = outer.model.system.independent;
  model.system.independent_dimension = outer.model.system.independent_dimension;
}

void apply_parameter_overrides(Elaboration& e, const Overrides& overrides) {
  for (std::size_t i = 0; i < overrides.parameters.size(); ++i) {
    Fragment f("--set", "param", overrides.parameters[i], place_behind(e, overrides, i));
    if (hand_over(e, f)) continue;
    Elaboration inner(e, f.tree, f.source, f.diagnostics);
    for (Declaration& given : inner.table.declarations())
      if (given.kind == Declaration::Kind::Parameter) set_parameter(e, f, inner, given);
  }
}

namespace {

void override_rates(Elaboration& e, const std::vector<StartRate>& rates) {
  std::vector<StartRate>& list = e.experiment().start_rates;
  for (const StartRate& rate : rates) {
    std::erase_if(list, [&](const StartRate& old) { return old.rate == rate.rate; });
    list.push_back({rate.rate, rate.value, {}});
  }
}

}  // namespace

namespace {

/// The items of `--start θ=1, φ'=2` or `--at …`, each handed to `take(inner, item)` until a mistake was told.
template <class Take>
void for_each_item(Elaboration& e, const char* option, const std::string& text, std::uint32_t place, Take&& take) {
  Fragment f(option, "start", text, place);
  if (hand_over(e, f)) return;
  Elaboration inner(e, f.tree, f.source, f.diagnostics);
  inner.table.adopt(e.table);
  inner.system().coordinates = e.system().coordinates;
  inner.poses = e.poses;
  for (const syntax::Statement& s : f.tree.statements) {
    const auto* start = std::get_if<syntax::StartStatement>(&s.body);
    if (!start) continue;
    for (const auto& item : start->items) {
      take(inner, item);
      if (hand_over(e, f)) break;
    }
  }
}

void replace_start(std::vector<StartValue>& list, StartValue value) {
  std::erase_if(list, [&](const StartValue& old) { return old.coordinate == value.coordinate && old.order == value.order; });
  value.span = {};
  list.push_back(value);
}

}  // namespace

void apply_start_overrides(Elaboration& e, const Overrides& overrides) {
  for (std::size_t i = 0; i < overrides.start.size(); ++i)
    for_each_item(e, "--start", overrides.start[i], place_behind(e, overrides, overrides.parameters.size() + i), [&](Elaboration& inner, const auto& item) {
      if (is_body_rate(inner, *item.variable)) return override_rates(e, start_rates(inner, item));
      if (const auto value = start_value(inner, item)) replace_start(e.experiment().start, *value);
    });
}

void apply_at_overrides(Elaboration& e, const Overrides& overrides) {
  for (std::size_t i = 0; i < overrides.at.size(); ++i)
    for_each_item(e, "--at", overrides.at[i], place_behind(e, overrides, overrides.parameters.size() + overrides.start.size() + i), [&](Elaboration& inner, const auto& item) {
      if (const auto value = start_value(inner, item)) replace_start(e.experiment().at, *value);
    });
}

}  // namespace maupertuis::elaboration

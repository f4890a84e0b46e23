#include "system/field_elaboration.hpp"
#include "system/field_places.hpp"
#include "system/unit_expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// The space of a model with fields, the names in it, and the order in which its statements are read.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;
using syntax::FieldDeclaration;
using Kind = Declaration::Kind;

struct End {
  Expr value;
  Dimension dimension;
};

/// An end of a domain: known before the run, of the dimension that the variable has.
std::optional<End> end_of_range(Elaboration& e, const Expression& x) {
  Place place;
  place.inline_constants = true;
  const Value v = evaluate_formula(e, x, place);
  if (v.poisoned) return std::nullopt;
  if (v.is_vector || e.context.depends_on_time(v.scalar().id()) || !constant_value(e, v.scalar())) {
    e.diagnostics.error("E0284", x.span, "an end of a domain must be known before the run",
                        "A field lives between places that stand in the model: numbers and parameters.",
                        "Write a number or a parameter there.");
    return std::nullopt;
  }
  return End{v.scalar(), v.fits_any ? e.dimension(dimensions::length()) : v.dimension};
}

void range_of(Elaboration& e, const FieldDeclaration::Range& range) {
  SpaceVariable* variable = nullptr;
  for (SpaceVariable& x : system_of(e).space)
    if (x.name == range.variable.text) variable = &x;
  if (!variable) {
    e.diagnostics.error("E0284", range.variable.span,
                        fmt::format("`{}` is no variable of this field", range.variable.text),
                        "A domain gives each space variable of the field its two ends.",
                        "Write a variable that stands in the brackets of the field.");
    return;
  }
  const auto to = end_of_range(e, *range.to), from = end_of_range(e, *range.from);
  if (!to || !from) return;
  variable->dimension = to->dimension;
  const auto a = constant_value(e, from->value), b = constant_value(e, to->value);
  if (*a < *b) {
    variable->from = from->value;
    variable->to = to->value;
    return;
  }
  e.diagnostics.error("E0284", cover(range.from->span, range.to->span), "the domain ends before it begins",
                      fmt::format("{} goes from the smaller value to the larger one.", variable->name),
                      "Exchange the two ends.");
}

/// A whole number that is known; 0, and a message, if it is none.
int whole_number(Elaboration& e, const Expression& x, const char* what, double least, double most) {
  const Value v = constant_of(e, x, Dimension{}, what);
  if (v.poisoned) return 0;
  const double n = constant_value(e, v.scalar()).value_or(0);
  if (n >= least && n <= most && n == std::floor(n)) return static_cast<int>(n);
  e.diagnostics.error("E0287", x.span, fmt::format("{} is a whole number from {} to {}", what, least, most),
                      most > 100 ? "A finer mesh would not fit into memory, nor be finished in a lifetime." : "",
                      most > 100 ? "Write fewer cells, or a higher order of the elements." : "");
  return 0;
}

/// boundary periodic, boundary periodic x
void declare_around(Elaboration& e, const FieldDeclaration& s) {
  FieldSystem& system = system_of(e);
  system.around.assign(system.space.size(), s.periodic && s.around.empty());
  for (const syntax::Name& name : s.around) {
    std::size_t i = 0;
    while (i < system.space.size() && system.space[i].name != name.text) ++i;
    if (i < system.space.size())
      system.around[i] = true;
    else
      e.diagnostics.error("E0286", name.span, fmt::format("`{}` is no space variable of this field", name.text),
                          "A domain is closed along its space variables.",
                          fmt::format("Write one of them, such as `boundary periodic {}`.", system.space.front().name));
  }
}

/// No space is left where the name of a variable has another meaning.
void declare_space(Elaboration& e, const FieldDeclaration& s) {
  FieldSystem& system = system_of(e);
  for (const syntax::Name& x : s.items.front().variables) {
    Declaration* d = e.table.find(x.text);
    if (!d || d->kind != Kind::Space) continue;
    if (std::any_of(system.space.begin(), system.space.end(), [&](const auto& one) { return one.name == x.text; })) {
      e.diagnostics.error("E0202", x.span, fmt::format("`{}` is declared twice", x.text),
                          "It is a space variable of this field already.", "Give one of them another name.");
    }
    system.space.push_back(
        {x.text, e.context.symbol(x.text, Role::Auxiliary), e.dimension(dimensions::length()), {}, {}, 0, x.span});
  }
  if (system.space.size() < s.items.front().variables.size()) return system.space.clear();  // told already
  if (system.space.size() > 3)
    e.diagnostics.error("E0284", s.items.front().variables[3].span, "a field of more than three space variables",
                        "Space has three dimensions.", "Leave the fourth variable out.");
  for (const FieldDeclaration::Range& range : s.ranges) range_of(e, range);
  constexpr double most_cells = 1e6;
  for (std::size_t i = 0; i < s.cells.size(); ++i) {
    if (i >= system.space.size()) {
      e.diagnostics.error("E0287", s.cells[i]->span, "more numbers of cells than space variables",
                          "A mesh has one number of cells for each space variable.", "");
      break;
    }
    system.space[i].cells = whole_number(e, *s.cells[i], "the number of cells", 1, most_cells);
  }
  double all = 1;
  for (const SpaceVariable& x : system.space) all *= std::max(x.cells, 1);
  if (all > most_cells)
    e.diagnostics.error("E0287", cover(s.cells.front()->span, s.cells.back()->span),
                        fmt::format("a mesh of {:.3g} cells is too large", all),
                        fmt::format("A mesh may have {:.0g} cells: a finer one would not fit into memory.", most_cells),
                        "Write fewer cells, or a higher order of the elements.");
  if (s.order) system.element_order = whole_number(e, *s.order, "the order of the elements", 1, 20);
  declare_around(e, s);
}

bool same_variables(const FieldSystem& system, const std::vector<syntax::Name>& variables) {
  if (variables.size() != system.space.size()) return false;
  for (std::size_t i = 0; i < variables.size(); ++i)
    if (variables[i].text != system.space[i].name) return false;
  return true;
}

/// E0284 where two fields live on different variables.
bool check_variables(Elaboration& e, const std::vector<syntax::Name>& variables) {
  if (same_variables(system_of(e), variables)) return true;
  std::string names;
  for (const SpaceVariable& x : system_of(e).space) names += (names.empty() ? "" : ", ") + x.name;
  e.diagnostics.error(
      "E0284", cover(variables.front().span, variables.back().span), "fields of different variables",
      fmt::format("One density holds all fields of a model, so that they live on the same space: {}.", names),
      fmt::format("Write ({}).", names));
  return false;
}

Dimension dimension_of_field(Elaboration& e, const FieldDeclaration::Item& item) {
  if (item.unit) {
    const std::optional<Unit> unit = unit_of(e, *item.unit);
    return unit ? unit->dimension : Dimension{};
  }
  const std::string& kind = item.kind.text;
  return e.dimension(kind == "angle"    ? dimensions::angle()
                     : kind == "length" ? dimensions::length()
                     : kind == "charge" ? dimensions::charge()
                                        : Dimension{});
}

void declare_field(Elaboration& e, const FieldDeclaration::Item& item) {
  Declaration* d = e.table.find(item.name.text);
  if (!d || d->kind != Kind::Field) return;
  d->done = true;
  d->used = true;
  d->value = Value::poison();
  if (!check_variables(e, item.variables)) return;
  d->index = system_of(e).fields.size();
  Field f{item.name.text, dimension_of_field(e, item), item.kind.text, false, {}, item.name.span};
  d->value = Value::of(e.context.symbol(f.name, Role::Coordinate, 0), f.dimension, 0);
  system_of(e).fields.push_back(std::move(f));
}

/// input q(x) : [N/m]
void declare_given(Elaboration& e) {
  for (const syntax::Statement& s : e.tree.statements) {
    const auto* input = std::get_if<syntax::InputStatement>(&s.body);
    Declaration* d = input && !input->variables.empty() ? e.table.find(input->name.text) : nullptr;
    if (!d || d->kind != Kind::Input) continue;
    d->done = true;
    d->value = Value::poison();
    if (!check_variables(e, input->variables)) continue;
    const std::optional<Unit> unit = input->unit ? unit_of(e, *input->unit) : std::optional<Unit>(Unit{});
    if (!unit) continue;
    Field f{input->name.text, unit->dimension, "", true, {}, input->name.span};
    d->value = Value::of(e.context.symbol(f.name, Role::Input, 0), f.dimension);
    system_of(e).fields.push_back(std::move(f));
  }
}

/// E0290: u_x would be two things.
void check_reserved(Elaboration& e) {
  for (const Declaration& d : e.table.declarations()) {
    if (d.kind == Kind::Field || d.kind == Kind::Energy || !d.statement) continue;
    const std::optional<FieldJet> jet = system_of(e).jet_of_name(d.name);
    if (!jet || jet->order() == 0) continue;
    e.diagnostics.error(
        "E0290", d.span,
        fmt::format("`{}` is a derivative of the field {}", d.name, system_of(e).fields[jet->field].name),
        "The name of a field with an underscore and variables is its derivative.", "Give it another name.");
  }
}

/// ω and k of waves, under names that the model does not have.
void name_waves(Elaboration& e) {
  const auto symbol = [&](std::string name) {
    while (e.table.find(name)) name += "_w";
    return e.context.symbol(name, Role::Auxiliary);
  };
  const std::vector<SpaceVariable>& space = system_of(e).space;
  e.fields->omega = symbol("ω");
  for (const SpaceVariable& x : space)
    e.fields->wave_numbers.push_back(symbol(space.size() == 1 ? "k" : "k_" + x.name));
}

Dimension density_dimension(Elaboration& e) {
  Dimension out = e.dimension(dimensions::energy());
  for (const SpaceVariable& x : system_of(e).space) out = out / x.dimension;
  return out;
}

void given_formulas(Elaboration& e) {
  for (const syntax::Statement& s : e.tree.statements) {
    const auto* input = std::get_if<syntax::InputStatement>(&s.body);
    if (!input || input->variables.empty() || !input->value) continue;
    for (Field& f : system_of(e).fields) {
      if (!f.given || f.name != input->name.text) continue;
      const Value v = scalar_of(e, *input->value, f.dimension, fmt::format("the input {}", f.name));
      if (!v.poisoned && v.order < 0) f.formula = drives_as_formulas(e, v.scalar());
    }
  }
}

/// E0281 where a density or a boundary stands in a model without a field, unless one may be among the statements that
/// were left out because of a mistake.
void refuse_without_field(Elaboration& e) {
  if (!e.tree.lost_names.empty()) return;
  for (const syntax::Statement& s : e.tree.statements) {
    const auto* f = std::get_if<syntax::FieldStatement>(&s.body);
    if (!f) continue;
    e.diagnostics.error("E0281", s.span, fmt::format("`{}` stands in a model without a field", f->what),
                        "It is a part of the action of a field.", "Declare one, for example `field u(x) : length`.");
    return;
  }
}

}  // namespace

/// Whatever stands for a field, its space or what is given on it has no value after a mistake in the first field.
void without_value(Elaboration& e) {
  for (Declaration& d : e.table.declarations())
    if (d.kind == Kind::Field || d.kind == Kind::Space || d.kind == Kind::Input)
      d.done = d.used = true, d.value = Value::poison();
}

bool declare_fields(Elaboration& e) {
  bool any = false;
  each_clause<FieldDeclaration>(e, [&](const FieldDeclaration& s, Span) {
    if (!any) {
      e.fields = std::make_shared<FieldModel>();
      system_of(e).context = e.system().context;
      system_of(e).time_dimension = e.time();
      declare_space(e, s);
    } else if (!s.ranges.empty() || !s.cells.empty() || s.order) {
      e.diagnostics.error("E0284", s.items.front().name.span, "a second domain",
                          "All fields of a model live on the domain of the first one.", "Leave the domain out here.");
    }
    any = true;
    if (system_of(e).space.empty()) return;
    for (const FieldDeclaration::Item& item : s.items) declare_field(e, item);
  });
  if (!any) return false;
  if (system_of(e).space.empty()) {
    without_value(e);
    return true;
  }
  declare_given(e);
  for (const SpaceVariable& x : system_of(e).space)
    if (Declaration* d = e.table.find(x.name); d && d->kind == Kind::Space) {
      d->done = d->used = true;
      d->value = Value::of(x.symbol, x.dimension);
    }
  for (Declaration& d : e.table.declarations())  // of a field that was refused
    if (d.kind == Kind::Space && !d.done) d.done = true, d.value = Value::poison();
  system_of(e).density_dimension = density_dimension(e);
  check_reserved(e);
  e.fields->coupled = couples_mechanics(e);
  refuse_beside_fields(e);
  name_waves(e);
  return true;
}

void elaborate_fields(Elaboration& e) {
  if (!e.fields) return refuse_without_field(e);
  if (system_of(e).space.empty()) return;
  given_formulas(e);
  densities(e);
  boundaries(e);
  refuse_slopes_beside_values(e);
  forces(e);
  for (const Definition& d : e.system().definitions)
    if (d.symbol) system_of(e).definitions[d.symbol] = d.value;
  check_places(e);
  e.fields->complete = true;
}

}  // namespace maupertuis::elaboration

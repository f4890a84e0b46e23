#include "language_services/names_text.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/field_system.hpp>
#include <maupertuis/mechanical_system.hpp>

#include <fmt/format.h>

#include <cmath>

namespace maupertuis::language {
namespace {

/// "energy (J)"; "m^3/s" where there is no word for it; empty in a model without units.
std::string dimension_text(const Dimension& dimension, const MechanicalSystem& system) {
  if (system.dimensionless) return {};
  const std::string name = physical_name(dimension), unit = to_string(dimension);
  if (unit == "1") return "a number";
  return name.empty() ? unit : fmt::format("{} ({})", name, unit);
}

std::string value_with_unit(double value, const Dimension& dimension, const MechanicalSystem& system) {
  const std::string unit = to_string(dimension);
  return short_number(value) + (system.dimensionless || unit == "1" ? "" : " " + unit);
}

std::string of_parameter(const Parameter& p, const MechanicalSystem& system) {
  std::string out = dimension_text(p.dimension, system);
  if (!out.empty()) out += ", ";
  return out + value_with_unit(p.si_value, p.dimension, system) + (system.dimensionless ? "" : " in SI");
}

/// Of a definition of parameters alone its value.
std::string of_definition(const Definition& d, const MechanicalSystem& system) {
  std::string out = dimension_text(d.dimension, system);
  if (d.is_vector) return out.empty() ? "a vector" : "a vector, " + out;
  if (!d.value) return out;
  for (const Expr& symbol : symbols_of({&d.value, 1}))
    if (symbol.role() != Role::Parameter && symbol.role() != Role::Constant) return out;
  const double value = evaluate(d.value, parameter_bindings(system));
  if (!std::isfinite(value)) return out;
  return out + (out.empty() ? "" : ", ") + value_with_unit(value, d.dimension, system);
}

template <class List>
const auto* find_named(const List& list, const std::string& name) {
  for (const auto& item : list)
    if (item.name == name) return &item;
  return static_cast<decltype(&list[0])>(nullptr);
}

std::string of_mass(const Expr& mass, const MechanicalSystem& system, const char* without) {
  if (!mass) return without;
  for (const Expr& symbol : symbols_of({&mass, 1}))
    if (symbol.role() != Role::Parameter && symbol.role() != Role::Constant) return {};
  return "mass " + value_with_unit(evaluate(mass, parameter_bindings(system)),
                                   system.dimensionless ? Dimension{} : dimensions::mass(), system);
}

}  // namespace

std::string short_number(double value) { return fmt::format("{:.6g}", value); }

std::string facts_of(const Declared& declared, Document& document) {
  const Model* model = document.readable_part();
  if (!model) return {};
  const MechanicalSystem& system = model->system;
  switch (declared.kind) {
    case NameKind::Parameter:
      if (const auto* p = find_named(system.parameters, declared.name)) return of_parameter(*p, system);
      return {};
    case NameKind::Coordinate:
      if (const auto* c = find_named(system.coordinates, declared.name)) return dimension_text(c->dimension, system);
      return {};
    case NameKind::Definition:
      if (const auto* d = find_named(system.definitions, declared.name)) return of_definition(*d, system);
      return {};
    case NameKind::Rate:
      if (const auto* r = find_named(system.rates, declared.name)) return dimension_text(r->dimension, system);
      return {};
    case NameKind::Input:
      if (const auto* u = find_named(system.inputs, declared.name)) return dimension_text(u->dimension, system);
      return {};
    case NameKind::Point:
      if (const auto* p = find_named(system.points, declared.name)) return of_mass(p->mass, system, "a marked point");
      return {};
    case NameKind::Body:
      if (const auto* b = find_named(system.bodies, declared.name))
        return of_mass(b->mass, system, "without mass: it only turns");
      return {};
    case NameKind::Constraint:
      if (const auto* c = find_named(system.constraints, declared.name))
        return c->level == Constraint::Level::Position ? "a relation of coordinates" : "a relation of velocities";
      return {};
    case NameKind::System:
    case NameKind::Frame:
    case NameKind::Contact:
    case NameKind::Event:
    case NameKind::Reaction:
    case NameKind::Field:
    case NameKind::Space:
    case NameKind::Independent:
      return {};
  }
  return {};
}

std::string item_of(const Declared& declared, Document& document) {
  const syntax::TextReading& reading = document.reading();
  const syntax::TextStatement& statement = reading.statements[declared.statement];
  const std::string& word = reading.tokens[statement.begin].text;
  const bool list = word == "param" || word == "let" || word == "coord" || word == "rates";
  Span span{reading.tokens[list ? declared.token : statement.begin].span.begin, 0, 0};
  int depth = 0;
  std::size_t i = list ? declared.token : statement.begin;
  for (; i < statement.end; ++i) {
    const syntax::TextToken& token = reading.tokens[i];
    depth += token.is("(") || token.is("[") ? 1 : token.is(")") || token.is("]") ? -1 : 0;
    if (list && depth == 0 && token.is(",")) break;
    span.end = token.span.end;
  }
  std::string out = word == "param" || word == "let" || word == "coord" || word == "rates" ? word + " " : "";
  bool blank = false;
  for (const char c : document.source().slice(span)) {
    const bool white = c == ' ' || c == '\n' || c == '\r' || c == '\t';
    if (!white && blank) out += ' ';
    if (!white) out += c;
    blank = white;
    if (out.size() > 400) return out + "…";
  }
  return out;
}

std::string comment_of(const Declared& declared, Document& document) {
  const SourceText& source = document.source();
  const std::uint32_t line = source.locate(declared.span.begin).line;
  for (const syntax::Comment& comment : document.reading().comments) {
    if (comment.span.begin < declared.span.end) continue;
    if (source.locate(comment.span.begin).line != line) break;
    const std::size_t begin = comment.text.find_first_not_of("# \t");
    return begin == std::string::npos ? std::string() : comment.text.substr(begin);
  }
  return {};
}

}  // namespace maupertuis::language

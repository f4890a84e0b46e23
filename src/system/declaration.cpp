#include "system/declaration.hpp"

#include <maupertuis/field_statements.hpp>

#include <fmt/format.h>

namespace maupertuis::elaboration {

using Kind = Declaration::Kind;
using Which = syntax::EnergyStatement::Which;

const char* word_of(Kind kind) {
  switch (kind) {
    case Kind::Parameter:
      return "parameter";
    case Kind::Coordinate:
      return "coordinate";
    case Kind::Definition:
      return "definition";
    case Kind::Input:
      return "input";
    case Kind::Frame:
      return "frame";
    case Kind::Point:
      return "point";
    case Kind::Body:
      return "body";
    case Kind::Constraint:
      return "constraint";
    case Kind::Reaction:
      return "reaction";
    case Kind::Contact:
      return "contact";
    case Kind::Event:
      return "event";
    case Kind::Independent:
      return "variable";
    case Kind::Rate:
      return "rate";
    case Kind::Field:
      return "field";
    case Kind::Space:
      return "space variable";
    case Kind::Energy:
      return "energy";
  }
  return "";
}

const char* name_of_energy(Which which) {
  switch (which) {
    case Which::T:
      return "kinetic energy";
    case Which::V:
      return "potential energy";
    case Which::U:
      return "generalized potential";
    case Which::L:
      return "Lagrangian";
    case Which::D:
      return "dissipation function";
  }
  return "";
}

namespace {

constexpr const char* kShort[] = {"T", "V", "U", "L", "D"};
constexpr const char* kLong[] = {"kinetic", "potential", "generalized_potential", "lagrangian", "dissipation"};

}  // namespace

SymbolTable::SymbolTable(const syntax::SyntaxTree& tree, const SourceTexts& texts, Diagnostics& diagnostics)
    : diagnostics_(diagnostics), texts_(texts) {
  for (const char* name : kShort) {
    Declaration d;
    d.kind = Kind::Energy;
    d.name = name;
    declarations_.push_back(std::move(d));
  }
  for (const syntax::Statement& s : tree.statements) {
    const auto list = [&](const auto& items, Kind kind) {
      for (std::size_t i = 0; i < items.size(); ++i) add(kind, items[i].name, s, i);
    };
    if (const auto* p = std::get_if<syntax::ParamStatement>(&s.body)) list(p->items, Kind::Parameter);
    if (const auto* c = std::get_if<syntax::CoordStatement>(&s.body)) list(c->items, Kind::Coordinate);
    if (const auto* l = std::get_if<syntax::LetStatement>(&s.body)) list(l->items, Kind::Definition);
    if (const auto* i = std::get_if<syntax::InputStatement>(&s.body)) add(Kind::Input, i->name, s, 0);
    if (const auto* r = std::get_if<syntax::RatesStatement>(&s.body))
      for (std::size_t g = 0; g < r->groups.size(); ++g)
        for (std::size_t k = 0; k < r->groups[g].names.size(); ++k) add(Kind::Rate, r->groups[g].names[k], s, g, k);
    if (const auto* f = std::get_if<syntax::FrameStatement>(&s.body)) add(Kind::Frame, f->name, s, 0);
    if (const auto* p = std::get_if<syntax::PointStatement>(&s.body)) add(Kind::Point, p->name, s, 0);
    if (const auto* b = std::get_if<syntax::BodyStatement>(&s.body)) add(Kind::Body, b->name, s, 0);
    if (const auto* c = std::get_if<syntax::ConstraintStatement>(&s.body))
      if (c->name) add(Kind::Constraint, *c->name, s, 0);
    if (const auto* r = std::get_if<syntax::ReactionStatement>(&s.body)) add(Kind::Reaction, r->name, s, 0);
    if (const auto* c = std::get_if<syntax::ContactStatement>(&s.body))
      if (c->name) add(Kind::Contact, *c->name, s, 0);
    if (const auto* v = std::get_if<syntax::EventStatement>(&s.body)) add(Kind::Event, v->name, s, 0);
    if (const auto* v = std::get_if<syntax::IndependentStatement>(&s.body)) add(Kind::Independent, v->name, s, 0);
    if (const auto* f = std::get_if<syntax::FieldStatement>(&s.body)) add_fields(*f, s);
  }
  for (const syntax::Name& n : tree.lost_names) lost_.emplace(n.text, true);
}

/// The variables of several fields are the same ones. A clash with another name is told once.
void SymbolTable::add_fields(const syntax::FieldStatement& field, const syntax::Statement& statement) {
  const auto* declared = std::get_if<syntax::FieldDeclaration>(&field.said->body);
  if (!declared) return;
  for (std::size_t i = 0; i < declared->items.size(); ++i) {
    add(Kind::Field, declared->items[i].name, statement, i);
    for (const syntax::Name& x : declared->items[i].variables) {
      const auto found = by_name_.find(x.text);
      const bool again = found != by_name_.end() && declarations_[found->second].kind == Kind::Space;
      const bool told = !again && !clashing_variables_.insert(x.text).second;
      if (!again && !told) add(Kind::Space, x, statement, i);
    }
  }
}

void SymbolTable::add(Kind kind, const syntax::Name& name, const syntax::Statement& statement, std::size_t item,
                      std::size_t component) {
  Declaration d;
  d.kind = kind;
  d.name = name.text;
  d.span = name.span;
  d.statement = &statement;
  d.item = item;
  d.component = component;
  const bool stands_in_no_formula =
      kind == Kind::Constraint || kind == Kind::Reaction || kind == Kind::Contact || kind == Kind::Event;
  if (stands_in_no_formula)  // T and V do
    for (std::size_t i = 0; i < 5; ++i)
      if (name.text == kShort[i] || name.text == kLong[i]) {
        diagnostics_.error("E0202", name.span, fmt::format("`{}` is declared twice", name.text),
                           fmt::format("It is the {} already.", name_of_energy(static_cast<Which>(i))),
                           fmt::format("Give the {} another name.", word_of(kind)));
        return;
      }
  const auto [found, added] = by_name_.emplace(name.text, declarations_.size());
  if (added) {
    declarations_.push_back(std::move(d));
    return;
  }
  const Declaration& first = declarations_[found->second];
  const std::string_view word = word_of(first.kind);
  const bool vowel = std::string_view("aeiou").find(word[0]) != std::string_view::npos;
  diagnostics_.error(
      "E0202", name.span, fmt::format("`{}` is declared twice", name.text),
      fmt::format("It is already {} {} in line {}.", vowel ? "an" : "a", word, texts_.locate(first.span).line),
      "Give one of them another name.");
}

Declaration* SymbolTable::find(const std::string& name) {
  const auto found = by_name_.find(name);
  if (found != by_name_.end()) return &declarations_[found->second];
  if (is_lost(name)) return nullptr;
  for (std::size_t i = 0; i < 5; ++i)
    if (name == kShort[i] || name == kLong[i]) return &declarations_[i];
  return nullptr;
}

void SymbolTable::adopt(const SymbolTable& other) {
  declarations_ = other.declarations_;
  by_name_ = other.by_name_;
  lost_ = other.lost_;
}

std::vector<std::string> SymbolTable::names() const {
  std::vector<std::string> out;
  for (std::size_t i = 5; i < declarations_.size(); ++i) out.push_back(declarations_[i].name);
  return out;
}

}  // namespace maupertuis::elaboration

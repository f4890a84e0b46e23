#include "system/declaration.hpp"

#include <fmt/format.h>
#include <maupertuis/units.hpp>

#include <algorithm>

/// A depth-first walk over "is defined from", with a stack of its own: a text of 10 MB may hold a chain of definitions
/// as long as it likes.
namespace maupertuis::elaboration {
namespace {

using syntax::ExpressionPtr;
using Which = syntax::EnergyStatement::Which;
using Ids = std::vector<DeclarationId>;

class Dependencies {
 public:
  Dependencies(SymbolTable& table, const syntax::SyntaxTree& tree) : table_(table), of_(table.size()) {
    of_[static_cast<std::size_t>(Which::L)] = {0, 1, 2};  // T, V, U
    for (const syntax::Statement& s : tree.statements) energies(s);
    for (DeclarationId id = 5; id < table.size(); ++id) declaration(id);
  }
  const Ids& of(DeclarationId id) const { return of_[id]; }

 private:
  void name(Ids& out, const std::string& text) {
    if (Declaration* d = table_.find(text)) out.push_back(table_.id(*d));
  }
  void expression(Ids& out, const ExpressionPtr& e) {
    if (!e) return;
    if (e->kind == syntax::Expression::Kind::Name) name(out, e->text);
    if (e->unit && !e->unit_bracketed)  // its words may be names
      for (const auto& word : e->unit->factors) name(out, word.word);
    for (const ExpressionPtr& a : e->arguments) expression(out, a);
  }
  void rotation(Ids& out, const std::optional<syntax::Rotation>& r) {
    if (!r) return;
    expression(out, r->axis);
    for (const ExpressionPtr& v : r->values) expression(out, v);
  }
  void in(Ids& out, const std::optional<syntax::Name>& frame) {
    if (frame) name(out, frame->text);
  }
  Ids& energy(Which which) { return of_[static_cast<std::size_t>(which)]; }

  /// What the energies are made of: their statements, and the points and bodies that carry masses.
  void energies(const syntax::Statement& s) {
    if (const auto* e = std::get_if<syntax::EnergyStatement>(&s.body)) expression(energy(e->which), e->value);
    if (const auto* g = std::get_if<syntax::GravityStatement>(&s.body)) expression(energy(Which::V), g->vector);
    if (const auto* p = std::get_if<syntax::SpringStatement>(&s.body))
      for (const auto& e : {p->from, p->to, p->stiffness, p->length}) expression(energy(Which::V), e);
    if (const auto* p = std::get_if<syntax::TorsionSpringStatement>(&s.body)) {
      name(energy(Which::V), p->coordinate.text);
      for (const auto& e : {p->stiffness, p->rest}) expression(energy(Which::V), e);
    }
    if (const auto* d = std::get_if<syntax::DamperStatement>(&s.body))
      for (const auto& e : {d->from, d->to, d->coefficient}) expression(energy(Which::D), e);
    const auto mass = [&](const syntax::Name& n) {
      name(energy(Which::T), n.text);
      name(energy(Which::V), n.text);
    };
    if (const auto* p = std::get_if<syntax::PointStatement>(&s.body)) mass(p->name);
    if (const auto* b = std::get_if<syntax::BodyStatement>(&s.body)) mass(b->name);
  }

  void declaration(DeclarationId id) {
    const Declaration& d = table_[id];
    Ids& out = of_[id];
    if (const auto* l = std::get_if<syntax::LetStatement>(&d.statement->body)) expression(out, l->items[d.item].value);
    if (const auto* i = std::get_if<syntax::InputStatement>(&d.statement->body)) expression(out, i->value);
    if (const auto* r = std::get_if<syntax::RatesStatement>(&d.statement->body)) {
      expression(out, r->groups[d.item].value);
      if (d.component > 0) name(out, r->groups[d.item].names.front().text);
    }
    if (const auto* f = std::get_if<syntax::FrameStatement>(&d.statement->body)) {
      expression(out, f->at);
      rotation(out, f->rotation);
      in(out, f->in);
    }
    if (const auto* p = std::get_if<syntax::PointStatement>(&d.statement->body)) {
      expression(out, p->mass);
      expression(out, p->at);
      in(out, p->in);
    }
    if (const auto* b = std::get_if<syntax::BodyStatement>(&d.statement->body)) {
      expression(out, b->mass);
      for (const ExpressionPtr& i : b->inertia) expression(out, i);
      expression(out, b->at);
      rotation(out, b->rotation);
      in(out, b->in);
    }
  }

  SymbolTable& table_;
  std::vector<Ids> of_;
};

/// Where the text gives an energy.
std::optional<Span> span_of_energy(const syntax::SyntaxTree& tree, DeclarationId id) {
  for (const syntax::Statement& s : tree.statements)
    if (const auto* e = std::get_if<syntax::EnergyStatement>(&s.body))
      if (static_cast<DeclarationId>(e->which) == id) return e->name_span;
  return std::nullopt;
}

void report_cycle(SymbolTable& table, const syntax::SyntaxTree& tree, const Ids& path, DeclarationId again,
                  Diagnostics& diagnostics) {
  auto at = std::find(path.begin(), path.end(), again);
  const Ids members(at, path.end());
  const Declaration* first = nullptr;  // an energy has no place in the text of its own
  for (const DeclarationId id : members)
    if (table[id].statement && !first) first = &table[id];
  std::string chain;
  for (const DeclarationId id : members) {
    if (members.size() <= 8 || id == members.front() || id == members.back())
      chain += table[id].name + " → ";
    else if (id == members[1])
      chain += "… → ";
    table[id].value = Value::poison();
    table[id].done = true;
  }
  diagnostics.error("E0203", first ? std::optional<Span>(first->span) : span_of_energy(tree, again),
                    fmt::format("`{}` is defined by itself", first ? first->name : table[again].name),
                    fmt::format("The definitions go round in a circle: {}{}.", chain, table[again].name),
                    first && members.size() == 1 && find_unit(first->name)
                        ? fmt::format("For the unit write it in brackets: 12 [{}].", first->name)
                        : "Define one of them from names that do not lead back to it.");
}

}  // namespace

std::vector<DeclarationId> definition_order(SymbolTable& table, const syntax::SyntaxTree& tree,
                                            Diagnostics& diagnostics) {
  const Dependencies dependencies(table, tree);
  enum : char { Fresh, Open, Closed };
  std::vector<char> state(table.size(), Fresh);
  std::vector<std::size_t> next(table.size(), 0);
  Ids order, path;
  // Declarations of the text first, so that a cycle through an energy is told from its named members.
  for (std::size_t k = 0; k < table.size(); ++k) {
    const DeclarationId root = (k + 5) % table.size();
    if (state[root] != Fresh) continue;
    path.push_back(root);
    state[root] = Open;
    while (!path.empty()) {
      const DeclarationId id = path.back();
      if (next[id] == dependencies.of(id).size()) {
        state[id] = Closed;
        path.pop_back();
        if (!table[id].done) order.push_back(id);
        continue;
      }
      const DeclarationId other = dependencies.of(id)[next[id]++];
      if (state[other] == Fresh) {
        state[other] = Open;
        path.push_back(other);
      } else if (state[other] == Open && !table[other].done) {
        report_cycle(table, tree, path, other, diagnostics);
      }
    }
  }
  return order;
}

}  // namespace maupertuis::elaboration

#include "system/complex_fields.hpp"
#include "system/elaboration.hpp"

#include <fmt/format.h>

#include <algorithm>

/// elaborate : SyntaxTree → Model. The order of the text does not matter: declarations are elaborated in the order of
/// their dependence, then forces, then the experiment.
namespace maupertuis {
namespace elaboration {

Elaboration::Elaboration(const syntax::SyntaxTree& tree, const SourceTexts& texts, const ExperimentOverrides& overrides,
                         Diagnostics& diagnostics)
    : tree(tree),
      texts(texts),
      overrides(overrides),
      diagnostics(diagnostics),
      table(tree, texts, diagnostics),
      model{MechanicalSystem{}, Experiment{}},
      context(*(model.system.context = std::make_shared<Context>())) {}

namespace {

using syntax::Expression;
using Kind = Declaration::Kind;

// ---------------------------------------------------------------------------------------------- dimension of space

/// The first vector of a formula.
const Expression* first_vector(const syntax::ExpressionPtr& x) {
  if (!x) return nullptr;
  if (x->kind == Expression::Kind::Vector) return x.get();
  for (const syntax::ExpressionPtr& a : x->arguments)
    if (const Expression* v = first_vector(a)) return v;
  return nullptr;
}

struct SpaceClue {
  int dimension = 0;
  Span span;
};

void clue_of_vector(SpaceClue& clue, const syntax::ExpressionPtr& x) {
  if (clue.dimension) return;
  if (const Expression* v = first_vector(x)) clue = {static_cast<int>(v->arguments.size()), v->span};
}

void clue_of_rotation(SpaceClue& clue, const std::optional<syntax::Rotation>& r) {
  if (clue.dimension || !r) return;
  clue = {r->kind == syntax::Rotation::Kind::Angle ? 2 : 3, r->span};
}

SpaceClue clue_of(const syntax::Statement& s) {
  SpaceClue clue;
  if (const auto* p = std::get_if<syntax::PointStatement>(&s.body)) clue_of_vector(clue, p->at);
  if (const auto* g = std::get_if<syntax::GravityStatement>(&s.body)) clue_of_vector(clue, g->vector);
  if (const auto* f = std::get_if<syntax::FrameStatement>(&s.body)) {
    clue_of_vector(clue, f->at);
    clue_of_rotation(clue, f->rotation);
  }
  if (const auto* b = std::get_if<syntax::BodyStatement>(&s.body)) {
    if (b->inertia.size() > 1) clue = {3, b->inertia_span};
    clue_of_vector(clue, b->at);
    clue_of_rotation(clue, b->rotation);
  }
  if (const auto* l = std::get_if<syntax::LetStatement>(&s.body))
    for (const auto& item : l->items) clue_of_vector(clue, item.value);
  if (const auto* p = std::get_if<syntax::ParamStatement>(&s.body))
    for (const auto& item : p->items) clue_of_vector(clue, item.value);
  if (const auto* f = std::get_if<syntax::ForceStatement>(&s.body))
    if (f->target != syntax::ForceStatement::Target::Coordinate) clue_of_vector(clue, f->value);
  if (const auto* p = std::get_if<syntax::SpringStatement>(&s.body)) {
    clue_of_vector(clue, p->from);
    clue_of_vector(clue, p->to);
  }
  return clue;
}

// --------------------------------------------------------------------------------------------------------- headings

void headings(Elaboration& e) {
  for (const syntax::Statement& s : e.tree.statements) {
    if (const auto* h = std::get_if<syntax::SystemStatement>(&s.body)) {
      if (!e.system().name.empty()) continue;  // the grammar allows one, and said so
      e.system().name = h->name.text;
      e.system().title = h->title;
    }
    if (const auto* h = std::get_if<syntax::SourceStatement>(&s.body)) e.system().source = h->citation;
    if (std::get_if<syntax::DimensionlessStatement>(&s.body)) e.dimensionless = e.system().dimensionless = true;
  }
}

void elaborate_declaration(Elaboration& e, DeclarationId id) {
  Declaration& d = e.table[id];
  switch (d.kind) {
    case Kind::Parameter:
    case Kind::Coordinate:
    case Kind::Independent:
    case Kind::Field:
    case Kind::Space:
      return;  // they depend on nothing and came first
    case Kind::Definition:
      return elaborate_definition(e, d);
    case Kind::Input:
      return elaborate_input(e, d);
    case Kind::Rate:
      return elaborate_rate(e, d);
    case Kind::Frame:
      return elaborate_frame(e, d);
    case Kind::Point:
      return elaborate_point(e, d);
    case Kind::Body:
      return elaborate_body(e, d);
    case Kind::Constraint:
    case Kind::Reaction:
    case Kind::Contact:
    case Kind::Event:
      return;  // nothing is defined from them
    case Kind::Energy:
      return elaborate_energy(e, static_cast<syntax::EnergyStatement::Which>(id), d);
  }
}

template <typename Items>
void sort_by_place(Items& items) {
  std::stable_sort(items.begin(), items.end(),
                   [](const auto& a, const auto& b) { return a.span.begin < b.span.begin; });
}

/// As declared, whatever the order of dependence was; anonymous constants after the parameters.
void restore_order_of_text(MechanicalSystem& s) {
  sort_by_place(s.parameters);
  std::stable_partition(s.parameters.begin(), s.parameters.end(),
                        [](const Parameter& p) { return p.symbol.role() == Role::Parameter; });
  sort_by_place(s.inputs);
  sort_by_place(s.definitions);
  sort_by_place(s.frames);
  sort_by_place(s.points);
  sort_by_place(s.bodies);
}

void require_coordinates(Elaboration& e, bool any_declared) {
  if (any_declared || e.diagnostics.has_errors()) return;
  const bool empty = e.tree.statements.empty();
  e.diagnostics.error(
      "E0204", empty ? std::nullopt : std::optional<Span>(e.tree.statements.front().span),
      empty ? "the model is empty" : "the model has no coordinate",
      "Lagrange's equations are written in generalized coordinates: without one nothing can move.",
      empty ? "`maup new` writes a model to start from." : "Declare one, for example `coord θ : angle`.");
}

}  // namespace

void fix_space_dimension(Elaboration& e) {
  for (const syntax::Statement& s : e.tree.statements) {
    const SpaceClue clue = clue_of(s);
    if (!clue.dimension) continue;
    e.system().space_dimension = clue.dimension;
    e.dimension_from = clue.span;
    return;
  }
}

}  // namespace elaboration

std::optional<Model> elaborate(const syntax::SyntaxTree& written, const SourceText& source, Diagnostics& diagnostics,
                               const ExperimentOverrides& overrides) {
  using namespace elaboration;
  const std::optional<syntax::SyntaxTree> real_fields = in_real_fields(written, diagnostics);
  const syntax::SyntaxTree& tree = real_fields ? *real_fields : written;
  Elaboration e(tree, SourceTexts(source, overrides.texts()), overrides, diagnostics);
  headings(e);
  elaborate_notes(e);
  name_independent(e);
  fix_space_dimension(e);
  check_statement_counts(e);

  bool any_coordinate = false;
  for (Declaration& d : e.table.declarations()) {
    if (d.kind == Declaration::Kind::Parameter) elaborate_parameter(e, d);
    if (d.kind == Declaration::Kind::Coordinate) elaborate_coordinate(e, d);
    if (has_own_quaternion(d)) add_quaternion_coordinates(e, d);
    any_coordinate = any_coordinate || d.kind == Declaration::Kind::Coordinate || has_own_quaternion(d);
  }
  if (!elaborate_independent(e)) {
    diagnostics.sort_by_place();
    return std::nullopt;
  }
  override_parameters(e);
  any_coordinate = declare_fields(e) || any_coordinate;

  for (const DeclarationId id : definition_order(e.table, tree, diagnostics)) elaborate_declaration(e, id);
  elaborate_forces(e);
  elaborate_constraints(e);
  elaborate_gauges(e);
  check_rates(e);
  elaborate_contacts(e);
  elaborate_fields(e);
  elaborate_experiment(e);
  override_start(e);
  start_quaternions(e);

  require_coordinates(e, any_coordinate);
  if (!diagnostics.has_errors()) warn_unused(e);
  diagnostics.sort_by_place();
  if (diagnostics.has_errors()) return std::nullopt;
  restore_order_of_text(e.system());
  replace_higher_derivatives(e);
  if (diagnostics.has_errors()) return std::nullopt;
  if (e.fields) {
    e.fields->parameters = e.system().parameters;
    e.model.fields = e.fields;
  }
  if (!e.fields || e.fields->coupled) expand_definitions(e.model), replace_momenta(e.model);
  take_roots_off_conditions(e.experiment());
  set_normal_forces(e.system(), diagnostics);
  if (diagnostics.has_errors()) return std::nullopt;
  return std::move(e.model);
}

}  // namespace maupertuis

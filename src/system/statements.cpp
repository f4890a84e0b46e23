#include "system/elaboration.hpp"

#include <fmt/format.h>

/// Statements as a whole: those that may stand once.
namespace maupertuis::elaboration {
namespace {

void once(Elaboration& e, std::optional<Span>& first, Span span, const char* what) {
  if (!first) {
    first = span;
    return;
  }
  e.diagnostics.error("E0208", span, fmt::format("{} is given twice", what),
                      fmt::format("It is already given in line {}.", e.texts.locate(*first).line), "Keep one of them.");
}

}  // namespace

void check_statement_counts(Elaboration& e) {
  std::optional<Span> gravity, run, output, method, precision, source, sweep, path, independent, impact;
  for (const syntax::Statement& s : e.tree.statements) {
    if (std::get_if<syntax::GravityStatement>(&s.body)) once(e, gravity, s.span, "gravity");
    if (std::get_if<syntax::RunStatement>(&s.body)) once(e, run, s.span, "the run");
    if (std::get_if<syntax::OutputStatement>(&s.body)) once(e, output, s.span, "the interval of output");
    if (std::get_if<syntax::MethodStatement>(&s.body)) once(e, method, s.span, "the method");
    if (std::get_if<syntax::PrecisionStatement>(&s.body)) once(e, precision, s.span, "the precision");
    if (std::get_if<syntax::SweepStatement>(&s.body)) once(e, sweep, s.span, "the sweep");
    if (std::get_if<syntax::PathStatement>(&s.body)) once(e, path, s.span, "the path");
    if (std::get_if<syntax::IndependentStatement>(&s.body)) once(e, independent, s.span, "the independent variable");
    if (std::get_if<syntax::ImpactStatement>(&s.body)) once(e, impact, s.span, "the law of impacts");
    if (std::get_if<syntax::SourceStatement>(&s.body)) once(e, source, s.span, "the source");
  }
}

namespace {

/// `L = …` is the whole Lagrangian: a T or V beside it has an effect only if L names it.
void warn_idle_energies(Elaboration& e) {
  using Which = syntax::EnergyStatement::Which;
  if (!e.system().lagrangian_given) return;
  for (const syntax::Statement& s : e.tree.statements) {
    const auto* x = std::get_if<syntax::EnergyStatement>(&s.body);
    if (!x || x->which == Which::L || x->which == Which::D || e.table.energy(x->which).used) continue;
    e.diagnostics.warning("W0418", x->name_span, fmt::format("this {} has no effect", name_of_energy(x->which)),
                          "The Lagrangian is given whole, and it does not name it.",
                          "Write L = T - V …, or leave one of them out.");
  }
}

}  // namespace

void warn_unused(Elaboration& e) {
  warn_idle_energies(e);
  for (const Declaration& d : e.table.declarations()) {
    const bool definition = d.kind == Declaration::Kind::Definition;
    if (d.kind != Declaration::Kind::Parameter && d.kind != Declaration::Kind::Input && !definition) continue;
    if (d.used) continue;
    e.diagnostics.warning(definition ? "W0416" : "W0415", d.span,
                          fmt::format("the {} `{}` is never used", word_of(d.kind), d.name),
                          definition ? "No formula of the model names it." : "Nothing in the model depends on it.",
                          "Remove it, or check the formula that should contain it.");
  }
  const auto named = [&](const std::string& name) {
    const Declaration* d = e.table.find(name.substr(0, name.find('.')));  // v.x is a component of v
    return d && d->used;
  };
  for (Parameter& p : e.system().parameters) p.used = p.used || named(p.name);
  for (Definition& f : e.system().definitions) f.used = named(f.name);
}

}  // namespace maupertuis::elaboration

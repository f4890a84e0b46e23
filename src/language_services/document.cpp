#include <maupertuis/codes.hpp>
#include <maupertuis/constraint_analysis.hpp>
#include <maupertuis/language_services.hpp>
#include <maupertuis/study.hpp>

#include "language_services/roles.hpp"

#include <map>

namespace maupertuis::language {

struct Document::Implementation {
  Implementation(SourceText source, const Interrupt& asked) : study(std::move(source), asked), interrupt(asked) {}

  Study study;
  Interrupt interrupt;
  std::optional<syntax::TextReading> reading;
  std::optional<Roles> roles;
  std::map<std::uint32_t, bool> names_at;    // by the beginning of the place
  std::optional<std::optional<Model>> part;  // of a text with mistakes; looked for once
};

Document::Document(SourceText source, const Interrupt& interrupt)
    : implementation_(std::make_unique<Implementation>(std::move(source), interrupt)) {}
Document::~Document() = default;
Document::Document(Document&&) noexcept = default;

const SourceText& Document::source() const { return implementation_->study.source(); }
const Interrupt& Document::interrupt() const { return implementation_->interrupt; }

const syntax::TextReading& Document::reading() {
  if (!implementation_->reading) implementation_->reading = syntax::read_text(source());
  return *implementation_->reading;
}

const Roles& Document::roles() {
  if (!implementation_->roles) implementation_->roles.emplace(reading());
  return *implementation_->roles;
}

bool Document::reads_names(Span place, const std::function<bool()>& probe) {
  const auto known = implementation_->names_at.find(place.begin);
  if (known != implementation_->names_at.end()) return known->second;
  return implementation_->names_at[place.begin] = probe();
}

const Model* Document::model() { return implementation_->study.model(); }

namespace {

/// Blanks in the place of the statements in which these mistakes are; false where they are in none.
bool blank_out(std::string& text, const syntax::TextReading& reading, const Diagnostics& found) {
  bool any = false;
  for (const Diagnostic& d : found.items()) {
    if (d.severity != Severity::Error || !d.span || d.span->source != 0) continue;
    for (const syntax::TextStatement& s : reading.statements) {
      if (s.begin == s.end) continue;
      const std::uint32_t begin = reading.tokens[s.begin].span.begin, end = reading.tokens[s.end - 1].span.end;
      if (d.span->begin > end || d.span->end < begin) continue;
      for (std::uint32_t k = begin; k < end && k < text.size(); ++k)
        if (text[k] != '\n' && text[k] != ' ') text[k] = ' ', any = true;
    }
  }
  return any;
}

}  // namespace

const Model* Document::readable_part() {
  if (const Model* whole = model()) return whole;
  if (implementation_->part) return *implementation_->part ? &**implementation_->part : nullptr;
  implementation_->part.emplace();
  std::string text(source().text());
  Diagnostics found = diagnostics();
  // What names a statement that was left out is a mistake of the next round.
  constexpr int most_rounds = 6;
  for (int round = 0; round < most_rounds; ++round) {
    if (!blank_out(text, reading(), found)) return nullptr;
    interrupt().throw_if_asked();
    const SourceText rest(source().name(), text);
    found = Diagnostics();
    const syntax::SyntaxTree tree = syntax::parse(rest, found);
    if (found.has_errors()) continue;
    auto model = elaborate(tree, rest, found);
    if (!model || found.has_errors()) continue;
    implementation_->part->emplace(std::move(*model));
    return &**implementation_->part;
  }
  return nullptr;
}

const Diagnostics& Document::diagnostics() {
  implementation_->study.model();
  return implementation_->study.diagnostics();
}

Diagnostics diagnose_derivation(const SourceText& source, const Interrupt& interrupt) {
  Study study(source, interrupt);
  if (study.has_fields()) {
    study.field_equations();
  } else if (const EquationsOfMotion* equations = study.equations()) {
    const InterruptScope scope = study.interruptible();
    look_into_start(*study.model(), *equations, study.diagnostics());
  }
  return study.diagnostics();
}

const CodeEntry* find_code(std::string_view code) {
  for (const auto entries :
       {syntax_codes(), system_codes(), equations_codes(), simulation_codes(), verification_codes(), invariants_codes(),
        hamiltonian_codes(), action_codes(), linearization_codes(), orbits_codes(), study_codes(), fields_codes()})
    for (const CodeEntry& entry : entries)
      if (entry.code == code) return &entry;
  return nullptr;
}

}  // namespace maupertuis::language

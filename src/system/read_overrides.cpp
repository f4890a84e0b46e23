#include "system/override_messages.hpp"

#include <maupertuis/overrides.hpp>

#include <fmt/format.h>

#include <algorithm>

/// Texts beside a model into parts of statements.
namespace maupertuis {
namespace elaboration {

void refuse_override(const SourceText& text, Span span, const std::string& message, std::string reason,
                     std::string help, Diagnostics& diagnostics) {
  diagnostics.error("E0224", span.source == text.id() ? span : text.whole(),
                    fmt::format("{} {}: {}", text.name(), text.text(), message), std::move(reason), std::move(help));
}

bool tell_of_override(const Diagnostics& found, const SourceText& text, Diagnostics& diagnostics) {
  for (const Diagnostic& d : found.items()) {
    if (d.severity != Severity::Error) continue;
    refuse_override(text, d.span.value_or(text.whole()), d.message, d.reason, d.help, diagnostics);
    return true;
  }
  return false;
}

}  // namespace elaboration

SourceId ExperimentOverrides::add_text(std::string label, std::string text) {
  const auto id = static_cast<SourceId>(texts_.size() + 1);
  texts_.emplace_back(std::move(label), std::move(text), id);
  return id;
}

SourceId ExperimentOverrides::add(OverrideKind kind, std::string label, std::string text) {
  const SourceId id = add_text(std::move(label), std::move(text));
  unread_.push_back({kind, id});
  return id;
}

void ExperimentOverrides::read(const syntax::SyntaxTree& model, Diagnostics& diagnostics) {
  // A limit belongs to a run, whichever was said first.
  std::stable_partition(unread_.begin(), unread_.end(),
                        [](const Said& said) { return said.kind != OverrideKind::Within; });
  for (const Said& said : unread_) read(said.kind, texts_[said.text - 1], model, diagnostics);
  unread_.clear();
}

namespace {

/// What a list of values says; its mistakes are told as E0224.
template <class Part>
void read_values(const SourceText& text, const syntax::SyntaxTree& model, std::vector<Part>& out,
                 Diagnostics& diagnostics,
                 std::optional<Part> (*parse)(const SourceText&, const syntax::SyntaxTree&, Diagnostics&)) {
  Diagnostics found;
  auto part = parse(text, model, found);
  if (!elaboration::tell_of_override(found, text, diagnostics) && part) out.push_back(std::move(*part));
}

}  // namespace

void ExperimentOverrides::read(OverrideKind kind, const SourceText& text, const syntax::SyntaxTree& model,
                               Diagnostics& diagnostics) {
  switch (kind) {
    case OverrideKind::Parameters:
      return read_values(text, model, parameters, diagnostics, syntax::parse_parameters);
    case OverrideKind::Constants:
      return read_values(text, model, constants, diagnostics, syntax::parse_parameters);
    case OverrideKind::Start:
      return read_values(text, model, start, diagnostics, syntax::parse_start);
    case OverrideKind::At:
      return read_values(text, model, at, diagnostics, syntax::parse_start);
    case OverrideKind::Run:
      run = syntax::parse_run(text, model, diagnostics);
      return;
    case OverrideKind::Until:
      if (const auto condition = syntax::parse_equation(text, model, diagnostics))
        run = syntax::RunStatement{nullptr, condition->left, condition->right, nullptr};
      return;
    case OverrideKind::Within: {
      const auto limit = syntax::parse_quantity(text, model, diagnostics);
      if (limit && run && run->until_left) run->within = limit;
      return;
    }
    case OverrideKind::Sweep:
      sweep = syntax::parse_sweep(text, model, diagnostics);
      return;
    case OverrideKind::Path:
      path = syntax::parse_path(text, model, diagnostics);
      return;
    case OverrideKind::Section:
      section = syntax::parse_equation(text, model, diagnostics);
      return;
    case OverrideKind::Formula:
      if (auto formula = syntax::parse_formula(text, model, diagnostics)) formulas.push_back(std::move(formula));
      return;
    case OverrideKind::GivenPath:
      if (auto assignments = syntax::parse_assignments(text, model, diagnostics)) given_path = std::move(*assignments);
      return;
    case OverrideKind::GivenFrom:
      given_from = syntax::parse_quantity(text, model, diagnostics);
      if (!given_from) given_path.clear();  // one whose end was not understood is not one without ends
      return;
    case OverrideKind::GivenTo:
      given_to = syntax::parse_quantity(text, model, diagnostics);
      if (!given_to) given_path.clear();
      return;
  }
}

}  // namespace maupertuis

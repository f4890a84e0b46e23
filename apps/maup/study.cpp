#include "study.hpp"

#include "read_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <maupertuis/require.hpp>

namespace maupertuis::app {

Study::Study(const std::string& path, Overrides overrides)
    : source_(display_name(path), read_file(path, diagnostics_)), overrides_(std::move(overrides)) {}

Study::Study(SourceText source, Overrides overrides) : source_(std::move(source)), overrides_(std::move(overrides)) {}

const syntax::SyntaxTree* Study::tree() {
  if (!tree_ && !wrong()) tree_ = syntax::parse(source_, diagnostics_);
  return tree_ ? &*tree_ : nullptr;
}

namespace {

void add(const Diagnostic& d, Diagnostics& to) {
  switch (d.severity) {
    case Severity::Error: to.error(d.code, d.span, d.message, d.reason, d.help); break;
    case Severity::Warning: to.warning(d.code, d.span, d.message, d.reason, d.help); break;
    case Severity::Note: to.note(d.code, d.span, d.message, d.reason, d.help); break;
  }
}

}  // namespace

/// In the place of the first statement of its kind, or at the end of the text. Lines that follow keep their numbers.
template <class Kind>
void Study::replace(const OptionStatement& statement) {
  MAUP_REQUIRE(!elaborated_);
  const syntax::SyntaxTree* parsed = tree();
  if (!parsed || wrong()) return;
  const auto own = std::find_if(parsed->statements.begin(), parsed->statements.end(),
                                [](const syntax::Statement& s) { return std::holds_alternative<Kind>(s.body); });
  if (own == parsed->statements.end()) return add_statements({statement});
  const std::string_view before = source_.text();
  const Span place = own->span;
  const auto lines = static_cast<std::size_t>(std::count(before.begin() + place.begin, before.begin() + place.end, '\n'));
  std::string text(before);
  text.replace(place.begin, place.end - place.begin, statement.text() + std::string(lines, '\n'));
  placed_.push_back({place.begin, statement});
  source_ = SourceText(source_.name(), std::move(text));
  tree_.reset();
}

void Study::replace_run(const OptionStatement& statement) { replace<syntax::RunStatement>(statement); }
void Study::replace_path(const OptionStatement& statement) { replace<syntax::PathStatement>(statement); }
void Study::replace_sweep(const OptionStatement& statement) { replace<syntax::SweepStatement>(statement); }

void Study::add_statements(const std::vector<OptionStatement>& statements) {
  MAUP_REQUIRE(!elaborated_);
  if (!tree() || wrong() || statements.empty()) return;
  std::string text(source_.text());
  for (const OptionStatement& statement : statements) {
    text += "\n";
    placed_.push_back({static_cast<std::uint32_t>(text.size()), statement});
    text += statement.text();
  }
  source_ = SourceText(source_.name(), text + "\n");
  tree_.reset();
}

namespace {

constexpr std::uint32_t kBehindAllTexts = 1u << 30;   // places of refuse_option, by its numbers; a model has 8 MiB at most

}  // namespace

/// --set, --start, --at: lines behind the text, in the order of Overrides (see system/overrides.cpp).
std::optional<OptionPlace> Study::override_at(Span span) const {
  auto begin = static_cast<std::uint32_t>(source_.text().size() + 1);
  if (span.begin < begin) return std::nullopt;
  for (const auto& [option, texts] : {std::pair("--set", &overrides_.parameters), std::pair("--start", &overrides_.start),
                                      std::pair("--at", &overrides_.at)})
    for (const std::string& text : *texts) {
      const auto end = begin + static_cast<std::uint32_t>(text.size());
      if (span.begin <= end) return OptionPlace{SourceText(option, text), {span.begin - begin, std::min(span.end, end) - begin}};
      begin = end + 1;
    }
  return std::nullopt;
}

void Study::refuse_option(const std::string& option, const std::string& typed, std::string message, std::string reason,
                          std::string help, std::optional<Span> piece) {
  const auto place = kBehindAllTexts + static_cast<std::uint32_t>(refused_.size());
  refused_.push_back({SourceText(option, typed), piece.value_or(Span{0, static_cast<std::uint32_t>(typed.size())})});
  diagnostics_.error("E0809", Span{place, place}, std::move(message), std::move(reason), std::move(help));
}

bool Study::only_options_are_wrong() const {
  const auto items = diagnostics_.items();
  // A search for paths that fails between the ends of an option was asked for rightly: E12 are codes of searches.
  const auto is_mistake_of_option = [&](const Diagnostic& d) { return d.span && option_at(*d.span) && d.code.rfind("E12", 0) != 0; };
  return wrong() && std::none_of(items.begin(), items.end(), [&](const Diagnostic& d) {
    return d.severity == Severity::Error && !is_mistake_of_option(d);
  });
}

/// A place in the words around what was typed is taken for all of it.
std::optional<OptionPlace> Study::option_at(Span span) const {
  if (span.begin >= kBehindAllTexts) return refused_.at(span.begin - kBehindAllTexts);
  if (const auto place = override_at(span)) return place;
  for (const auto& [begin, statement] : placed_) {
    if (span.begin < begin || span.begin > begin + statement.text().size() || statement.pieces().empty()) continue;
    const std::uint32_t at = span.begin - begin;
    const auto inside = std::find_if(statement.pieces().begin(), statement.pieces().end(), [&](const auto& p) { return at >= p.begin && at < p.end; });
    const OptionStatement::Piece& piece = inside != statement.pieces().end() ? *inside : statement.pieces().front();
    const std::uint32_t length = piece.end - piece.begin;
    Span place{0, length};
    if (inside != statement.pieces().end()) place = {at - piece.begin, std::min(span.end - begin, piece.end) - piece.begin};
    return OptionPlace{SourceText(piece.option, statement.text().substr(piece.begin, length)), place};
  }
  return std::nullopt;
}

std::vector<Study::Told> Study::told() const {
  std::vector<Told> out;
  for (Diagnostic d : diagnostics_.items()) {
    const auto place = d.span ? option_at(*d.span) : std::nullopt;
    if (place) d.span = place->span;
    const SourceText& source = place ? place->source : source_;
    if (out.empty() || out.back().of_option || place) out.push_back({source, {}, place.has_value()});
    add(d, out.back().diagnostics);
  }
  return out;
}

void Study::admit_singular_mass_matrix() {
  MAUP_REQUIRE(!elaborated_);
  admits_singular_ = true;
}

namespace {

void add_lint(const Diagnostics& lint, bool admits_singular, Diagnostics& diagnostics) {
  for (const Diagnostic& d : lint.items())
    if (!admits_singular || (d.code != "E0407" && d.code != "E0408")) add(d, diagnostics);
}

}  // namespace

const Model* Study::model() {
  if (elaborated_) return model_.get();
  elaborated_ = true;
  const syntax::SyntaxTree* parsed = tree();
  // All mistakes of a file at once: after a wrong statement the others are still looked at. The tree knows the names
  // that were lost with it, so that their absence is not reported again.
  if (!parsed || parsed->statements.empty()) return nullptr;
  if (auto model = elaborate(*parsed, source_, diagnostics_, overrides_); model && !wrong()) {
    const InterruptScope scope(*model->system.context, interrupt_);
    Diagnostics found;
    lint(*model, source_, found);
    add_lint(found, admits_singular_, diagnostics_);
    if (!wrong()) model_ = std::make_shared<const Model>(std::move(*model));
  }
  diagnostics_.sort_by_place();
  return model_.get();
}

const EquationsOfMotion* Study::equations() {
  if (!derived_ && model()) {
    const InterruptScope scope = interruptible();
    equations_ = euler_lagrange(std::shared_ptr<const MechanicalSystem>(model_, &model_->system), diagnostics_);
    derived_ = true;
  }
  return equations_ && !wrong() ? &*equations_ : nullptr;
}

const Derivation* Study::derivation(bool with_steps) {
  if (!equations()) return nullptr;
  if (!derivation_ || (with_steps && !has_steps_)) {
    const InterruptScope scope = interruptible();
    derivation_ = readable_derivation(*equations_, with_steps);
    has_steps_ = with_steps;
  }
  return &*derivation_;
}

const Certificate* Study::certificate(const CertifyOptions& options) {
  if (certificate_ || !equations()) return certificate_ ? &*certificate_ : nullptr;
  const InterruptScope scope = interruptible();
  certificate_ = certify(*equations_, derivation_ ? &*derivation_ : nullptr, options);
  for (const CertificateCheck& check : certificate_->checks) {
    if (!check.applies || check.verdict == Verdict::Zero) continue;
    const std::string row = check.row < model_->system.coordinates.size()
                                ? fmt::format(" (equation of {})", model_->system.coordinates[check.row].name)
                                : std::string();
    if (check.verdict == Verdict::Nonzero)
      diagnostics_.error("E0690", {}, fmt::format("The derivation failed its check `{}`{}.", check.name, row),
                         check.statement,
                         "The equations are not shown, because they are wrong. Please report this model.");
    else
      diagnostics_.warning("W0691", {}, fmt::format("The check `{}`{} could not be decided.", check.name, row),
                           check.reason, "The equations are shown, but they are not certified.");
  }
  return wrong() ? nullptr : &*certificate_;
}

bool refuse_held_integrals(Study& study) {
  const Model* model = study.model();
  if (!model || model->system.integral_constraints.empty()) return false;
  study.diagnostics().error("E0244", model->system.integral_constraints.front().span, "the model holds an integral of its paths",
                            "Its equations are those of L + λ G with one λ for a whole path, which only the two ends of the path determine: "
                            "there is no motion from a start.",
                            "`maup action` finds the paths between two ends, and λ.");
  return true;
}

bool moves_in_time(const MechanicalSystem& system) {
  return system.dimensionless || system.independent_dimension.same_as(dimensions::time());
}

bool refuse_without_time(Study& study) {
  const Model* model = study.model();
  if (!model || moves_in_time(model->system)) return false;
  study.diagnostics().error("E0245", std::nullopt, fmt::format("the independent variable of this model is {}, no time", model->system.independent),
                            "Equilibria, frequencies, periods and exponents belong to motions in time.",
                            "`maup derive`, `maup simulate` and `maup action` work for such models.");
  return true;
}

}  // namespace maupertuis::app

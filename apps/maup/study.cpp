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

/// The text with a statement in the place of the first one of a kind, or at its end.
template <class Kind>
SourceText with_statement(const SourceText& source, const syntax::SyntaxTree& tree, const std::string& statement) {
  std::string text(source.text());
  const auto own = std::find_if(tree.statements.begin(), tree.statements.end(),
                                [](const syntax::Statement& s) { return std::holds_alternative<Kind>(s.body); });
  if (own != tree.statements.end())
    text.replace(own->span.begin, own->span.end - own->span.begin, statement);
  else
    text += "\n" + statement + "\n";
  return SourceText(source.name(), std::move(text));
}

}  // namespace

void Study::replace_run(const std::string& statement) {
  MAUP_REQUIRE(!elaborated_);
  const syntax::SyntaxTree* parsed = tree();
  if (!parsed || wrong()) return;
  source_ = with_statement<syntax::RunStatement>(source_, *parsed, statement);
  tree_.reset();
}

void Study::replace_path(const std::string& statement) {
  MAUP_REQUIRE(!elaborated_);
  const syntax::SyntaxTree* parsed = tree();
  if (!parsed || wrong()) return;
  source_ = with_statement<syntax::PathStatement>(source_, *parsed, statement);
  tree_.reset();
}

void Study::replace_sweep(const std::string& statement) {
  MAUP_REQUIRE(!elaborated_);
  const syntax::SyntaxTree* parsed = tree();
  if (!parsed || wrong()) return;
  source_ = with_statement<syntax::SweepStatement>(source_, *parsed, statement);
  tree_.reset();
}

void Study::add_statements(const std::vector<std::string>& statements) {
  MAUP_REQUIRE(!elaborated_);
  if (!tree() || wrong() || statements.empty()) return;
  std::string text(source_.text());
  for (const std::string& statement : statements) text += "\n" + as_one_line(statement);
  source_ = SourceText(source_.name(), text + "\n");
  tree_.reset();
}

void Study::admit_singular_mass_matrix() {
  MAUP_REQUIRE(!elaborated_);
  admits_singular_ = true;
}

namespace {

void add_lint(const Diagnostics& lint, bool admits_singular, Diagnostics& diagnostics) {
  for (const Diagnostic& d : lint.items()) {
    if (admits_singular && (d.code == "E0407" || d.code == "E0408")) continue;
    Diagnostics one;
    switch (d.severity) {
      case Severity::Error: one.error(d.code, d.span, d.message, d.reason, d.help); break;
      case Severity::Warning: one.warning(d.code, d.span, d.message, d.reason, d.help); break;
      case Severity::Note: one.note(d.code, d.span, d.message, d.reason, d.help); break;
    }
    diagnostics.append(one);
  }
}

}  // namespace

std::string as_one_line(std::string statement) {
  for (char& c : statement)
    if (c == '\n' || c == '\r' || c == '#') c = ' ';
  return statement;
}

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

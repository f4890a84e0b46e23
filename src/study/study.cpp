#include <maupertuis/arguments.hpp>
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/field_verification.hpp>
#include <maupertuis/higher_order.hpp>
#include <maupertuis/study.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {

Study::Study(SourceText source, const Interrupt& interrupt) : source_(std::move(source)), interrupt_(interrupt) {}

// ------------------------------------------------------------------------------------------------------ beside the
// text

SourceId Study::override_with(OverrideKind kind, std::string label, std::string text) {
  check_argument(!elaborated_, "Study::override_with, Study::ask: the model was asked for before");
  if (kind == OverrideKind::Formula) ++asked_;
  return overrides_.add(kind, std::move(label), std::move(text));
}

std::size_t Study::ask(std::string label, std::string formula) {
  override_with(OverrideKind::Formula, std::move(label), std::move(formula));
  return asked_ - 1;
}

void Study::fix_mode(std::string text) {
  check_argument(!elaborated_, "Study::fix_mode: the model was asked for before");
  mode_ = std::move(text);
}

void Study::enter_mode(Model& model, Diagnostics& found) const {
  std::string trouble;
  auto mode = read_mode(model.system, *mode_, trouble);
  if (mode_->find_first_not_of(' ') == std::string::npos) {
    mode.reset();
    trouble = "It names nothing.";
  }
  if (!mode) {
    found.error("E0269", std::nullopt, fmt::format("`{}` is no mode of this model", *mode_), trouble,
                "`maup check` lists its contacts and frictions; `free` is the mode without any.");
    return;
  }
  const auto free = euler_lagrange(std::make_shared<const MechanicalSystem>(model.system), found);
  if (!free) return;
  for (Friction& f : model.system.frictions)
    if (f.normal) f.normal = with_reactions(*free, {&f.normal, 1}).front();
  model.system = system_in_mode(model.system, *mode);
}

namespace {

bool is_singular_mass(const Diagnostic& d) { return d.code == "E0407" || d.code == "E0408" || d.code == "E0417"; }

}  // namespace

void Study::admit_singular_mass_matrix() {
  check_argument(!elaborated_, "Study::admit_singular_mass_matrix: the model was asked for before");
  admits_singular_ = true;
}

// ----------------------------------------------------------------------------------------------------------- the
// stages

const syntax::SyntaxTree* Study::tree() {
  if (!tree_ && !wrong()) tree_ = syntax::parse(source_, diagnostics_);
  return tree_ ? &*tree_ : nullptr;
}

/// All mistakes of a text at once: after a wrong statement the others are still looked at. The tree knows the names
/// that were lost with it, so that their absence is not reported again.
bool Study::elaborate_model(Diagnostics& found, std::optional<Model>& model) {
  model = elaborate(*tree_, source_, found, overrides_);
  if (!model || found.has_errors()) return false;
  if (model->fields) return true;  // the lint is about coordinates
  const InterruptScope scope(*model->system.context, interrupt_);
  Diagnostics lints;
  lint(*model, source_, lints);
  Diagnostics unheard;
  const bool degenerate = admit_degenerate(*model, lints, admits_singular_ ? unheard : found);
  const bool admitted = admits_singular_ || degenerate;
  for (const Diagnostic& d : lints.items())
    if (!admitted || !is_singular_mass(d)) found.append(d);
  return !found.has_errors();
}

/// A singular M is no mistake where the constraint algorithm finds a motion all the same. Masses that were forgotten
/// are one: where points and bodies alone give T, what they leave open stays an error.
bool Study::admit_degenerate(const Model& model, const Diagnostics& lints, Diagnostics& found) {
  const bool singular = std::any_of(lints.items().begin(), lints.items().end(), is_singular_mass);
  const MechanicalSystem& system = model.system;
  if (!singular && system.gauges.empty()) return false;
  const bool other = std::any_of(lints.items().begin(), lints.items().end(), [](const Diagnostic& d) {
    return d.severity == Severity::Error && !is_singular_mass(d);
  });
  if (other || system.has_modes() || !system.integral_constraints.empty()) return false;
  const auto equations = euler_lagrange(std::make_shared<const MechanicalSystem>(system), found);
  if (!equations) return false;
  const Bindings start = written_start(model);
  DegenerateAnalysis analysis = analyse_degenerate(*equations, generic_state(model), true, true, &start);
  const bool from_masses =
      !system.lagrangian_given && system.lagrangian_extra.empty() &&
      std::none_of(system.kinetic.begin(), system.kinetic.end(), [](const EnergyTerm& t) { return t.origin == "T"; });
  if (singular && from_masses && (!analysis.closed() || !analysis.free.empty())) return false;
  if (report_degenerate(model, *equations, analysis, found))
    degenerate_ = std::make_shared<const DegenerateAnalysis>(std::move(analysis));
  return true;
}

const Model* Study::model() {
  if (elaborated_) return model_.get();
  if (tree() && !tree_->statements.empty()) {
    overrides_.read(*tree_, diagnostics_);
    Diagnostics found = diagnostics_;  // kept when the stage is complete
    std::optional<Model> model;
    const bool complete = elaborate_model(found, model);
    if (complete && mode_) enter_mode(*model, found);
    if (complete && !found.has_errors()) model_ = std::make_shared<const Model>(std::move(*model));
    found.sort_by_place();
    diagnostics_ = std::move(found);
  }
  elaborated_ = true;
  return model_.get();
}

const FieldEquations* Study::field_equations() {
  if (!has_fields()) return nullptr;
  if (!fields_derived_) {
    const InterruptScope scope = interruptible();
    Diagnostics found;  // an interrupt leaves nothing behind, and the next use does the work again
    auto equations = maupertuis::field_equations(model_->fields, found);
    if (equations) attach_bodies(*equations, model_, found);
    std::optional<Certificate> certificate;
    if (equations && !broken() && !found.has_errors()) certificate = certify(*equations);
    diagnostics_.append(found);
    field_equations_ = std::move(equations), field_certificate_ = std::move(certificate);
    fields_derived_ = true;
    if (field_certificate_)
      for (const CertificateCheck& check : field_certificate_->checks) report(check);
  }
  return field_equations_ && !broken() ? &*field_equations_ : nullptr;
}

void Study::refuse_coordinates() {
  Diagnostics found;
  found.error(
      "E0507", model_->fields->system.density_span, "this question is about coordinates, and the model has fields",
      "Of fields there are derivations, conservation laws, runs, modes, dispersion relations and pictures.",
      "`maup check`, `derive`, `invariants`, `simulate`, `test`, `modes`, `plot`, `animate` and `report` work for "
      "fields.");
  tell(found);
}

const EquationsOfMotion* Study::equations() {
  if (has_fields()) {
    if (!derived_) refuse_coordinates();
    derived_ = true;
    return nullptr;
  }
  if (!derived_ && model()) {
    const InterruptScope scope = interruptible();
    equations_ = euler_lagrange(std::shared_ptr<const MechanicalSystem>(model_, &model_->system), diagnostics_);
    if (equations_) equations_->degenerate = degenerate_;
    if (equations_ && degenerate_)
      if (auto determined = determined_equations(*equations_, *degenerate_))
        equations_->determined = std::make_shared<const EquationsOfMotion>(std::move(*determined));
    derived_ = true;
  }
  return equations_ && !broken() ? &*equations_ : nullptr;
}

const DegenerateAnalysis* Study::degenerate() { return model() ? degenerate_.get() : nullptr; }

const Derivation* Study::derivation(bool with_steps) {
  if (!equations()) return nullptr;
  if (!derivation_ || (with_steps && !has_steps_)) {
    const InterruptScope scope = interruptible();
    derivation_ = readable_derivation(*equations_, with_steps);
    has_steps_ = with_steps;
  }
  return &*derivation_;
}

void Study::report(const CertificateCheck& check) {
  if (!check.applies || check.verdict == Verdict::Zero) return;
  const auto& coordinates = model_->system.coordinates;
  const std::string row =
      check.row < coordinates.size() ? fmt::format(" (equation of {})", coordinates[check.row].name) : std::string();
  if (check.verdict == Verdict::Nonzero)
    diagnostics_.error("E0690", {}, fmt::format("The derivation failed its check `{}`{}.", check.name, row),
                       check.statement,
                       "The equations are not shown, because they are wrong. Please report this model.");
  else
    diagnostics_.warning("W0691", {}, fmt::format("The check `{}`{} could not be decided.", check.name, row),
                         check.reason, "The equations are shown, but they are not certified.");
}

const Certificate* Study::certificate(const CertifyOptions& options) {
  if (certificate_ || !equations()) return certificate_ ? &*certificate_ : nullptr;
  const InterruptScope scope = interruptible();
  Certificate found = certify(*equations_, derivation_ ? &*derivation_ : nullptr, options);
  if (!model_->system.higher.empty())
    for (const HigherOrderProof& proof : higher_order_proofs(*equations_)) {
      const ZeroTest& test = proof.test;
      found.checks.push_back({proof.name, proof.statement, test.verdict, true, test.points, test.error_bound,
                              test.reason, model_->system.coordinates.size()});
    }
  certificate_ = std::move(found);
  for (const CertificateCheck& check : certificate_->checks) report(check);
  return broken() ? nullptr : &*certificate_;
}

// -------------------------------------------------------------------------------------------------------- what they
// tell

/// The errors of a question are told, and do not stand in the way of the next one.
void Study::tell(const Diagnostics& found) {
  diagnostics_.append(found);
  for (const Diagnostic& d : found.items()) told_ += d.severity == Severity::Error;
}

bool Study::broken() const {
  std::size_t errors = 0;
  for (const Diagnostic& d : diagnostics_.items()) errors += d.severity == Severity::Error;
  return errors > told_;
}

std::optional<SimulationResult> Study::motion(const SimulationOptions& options) {
  if (broken() || refuse_held_integrals() || !certificate()) return std::nullopt;
  Diagnostics found;
  auto result = simulate(*model_, *equations_, options, found);
  tell(found);
  return result;
}

std::optional<ExtendedResult> Study::motion(const ExtendedSimulationOptions& options) {
  if (broken() || refuse_held_integrals() || !certificate()) return std::nullopt;
  Diagnostics found;
  auto result = simulate_extended(*model_, *equations_, options, found);
  tell(found);
  return result;
}

std::optional<Verification> Study::verification(const SimulationOptions& options) {
  if (!tree()) return std::nullopt;
  if (has_fields()) return field_verification(options);
  equations();
  if (auto of_errors = verify_errors(*tree_, source_, diagnostics_)) return of_errors;
  if (broken() || !certificate()) return std::nullopt;
  const InterruptScope scope = interruptible();
  Diagnostics found;
  Verification out = verify(*model_, *equations_, source_, options, found);
  tell(found);
  verify_with_other_values(options, out);
  return out;
}

/// `expect … with s = -1`: a study of its own for each such text, whose lines take their places among the others.
void Study::verify_with_other_values(const SimulationOptions& options, Verification& out) {
  std::vector<std::string> texts;
  for (const Expectation& e : model_->experiment.expectations)
    if (!e.with.empty() && std::find(texts.begin(), texts.end(), e.with) == texts.end()) texts.push_back(e.with);
  for (const std::string& with : texts) {
    Study other(source_, interrupt_);
    other.override_with(OverrideKind::Constants, "with", with);
    other.equations();
    std::optional<Verification> found;
    if (!other.wrong() && other.certificate())
      found = verify(*other.model_, *other.equations_, source_, options, other.diagnostics_, with);
    for (const Diagnostic& d : other.diagnostics_.items())
      if (d.severity == Severity::Error) diagnostics_.append(d);
    if (found) out.results.insert(out.results.end(), found->results.begin(), found->results.end());
  }
  std::stable_sort(out.results.begin(), out.results.end(),
                   [](const ExpectationResult& a, const ExpectationResult& b) { return a.line < b.line; });
}

std::optional<Verification> Study::field_verification(const SimulationOptions& options) {
  field_equations();
  if (auto of_errors = verify_errors(*tree_, source_, diagnostics_)) return of_errors;
  if (!field_equations()) return std::nullopt;
  const InterruptScope scope = interruptible();
  Diagnostics found;
  Verification out = verify_fields(*model_, *field_equations_, source_, options, found);
  tell(found);
  return out;
}

bool Study::refuse_held_integrals() {
  if (!model() || model_->system.integral_constraints.empty()) return false;
  Diagnostics found;
  found.error(
      "E0244", model_->system.integral_constraints.front().span, "the model holds an integral of its paths",
      "Its equations are those of L + λ G with one λ for a whole path, which only the two ends of the path determine: "
      "there is no motion from a start.",
      "`maup action` finds the paths between two ends, and λ.");
  tell(found);
  return true;
}

bool Study::refuse_modes() {
  if (!model()) return false;
  const MechanicalSystem& system = model_->system;
  if (!system.has_modes()) return false;
  const Span span = system.contacts.empty() ? system.frictions.front().span : system.contacts.front().span;
  Diagnostics found;
  found.error("E0270", span, "this question is about one set of equations, and the model has several modes",
              "Contacts that open and close and friction that sticks and slides change the equations on the way.",
              fmt::format("Ask it of one mode: --mode free, or such as --mode \"{}\".", some_mode(system)));
  tell(found);
  return true;
}

namespace {

const ModelEvent* first_event(const Model& model, std::initializer_list<ModelEvent::Action> actions) {
  const auto& events = model.experiment.events;
  const auto found = std::find_if(events.begin(), events.end(), [&](const ModelEvent& e) {
    return std::find(actions.begin(), actions.end(), e.action) != actions.end();
  });
  return found == events.end() ? nullptr : &*found;
}

}  // namespace

bool Study::refuse_acting_events() {
  if (!model()) return false;
  const ModelEvent* const event = first_event(*model_, {ModelEvent::Action::Set, ModelEvent::Action::Stop});
  if (!event) return false;
  Diagnostics found;
  found.error(
      "E0271", event->span,
      fmt::format("the event `{}` acts on the motion, and this question follows one smooth motion", event->name),
      "What an event sets, or where it stops the run, does not follow from the equations of motion.",
      "`maup simulate` and `maup orbits` carry events out; leave the event out to ask of the equations alone.");
  tell(found);
  return true;
}

void Study::tell_events_left_out() {
  if (!model()) return;
  const ModelEvent* const event = first_event(*model_, {ModelEvent::Action::Set});
  if (!event) return;
  Diagnostics found;
  found.note("N0272", event->span, fmt::format("what the event `{}` sets is left out of account here", event->name),
             "Equilibria, their stability and stationary paths are those of the equations of motion alone.",
             "`maup simulate` and `maup orbits` carry events out.");
  tell(found);
}

bool moves_in_time(const MechanicalSystem& system) {
  return system.dimensionless || system.independent_dimension.same_as(dimensions::time());
}

bool Study::refuse_without_time() {
  if (!model() || moves_in_time(model_->system)) return false;
  Diagnostics found;
  found.error("E0245", std::nullopt,
              fmt::format("the independent variable of this model is {}, no time", model_->system.independent),
              "Equilibria, frequencies, periods and exponents belong to motions in time.",
              "`maup derive`, `maup simulate` and `maup action` work for such models.");
  tell(found);
  return true;
}

}  // namespace maupertuis

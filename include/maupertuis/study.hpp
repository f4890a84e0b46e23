#pragma once
#include <maupertuis/certificate.hpp>
#include <maupertuis/constraint_analysis.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/extended_simulation.hpp>
#include <maupertuis/field_run.hpp>
#include <maupertuis/fields.hpp>
#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/verification.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace maupertuis {

/// What a run of fields keeps.
struct FieldMotionOptions {
  bool rows = false;                                      // its trajectory
  bool pictured = false;                                  // as many rows and places as a picture wants
  std::vector<double> moments = {};                       // s; rows at these times beside the others
  const FieldCurrents* currents = nullptr;                // whose charges are followed; null: none
  std::function<void(const std::string&)> announce = {};  // as in FieldRunOptions
  std::vector<FieldQuestion> questions = {};              // FieldRunResult::answers
  bool errors = false;                                    // of the answers, by further runs
};

/// A model text on its way through the stages: tree → model → equations → derivation, certificate; and what they are
/// asked for.
///
/// Each stage runs once, at first use, and is kept; it returns null when an earlier one failed. What went wrong
/// collects in diagnostics(), whose places are in texts(). The text stays as it is: what is to be different is said
/// beside it, before the model is asked for. After an edit there is a new Study of the new text; two share nothing.
///
/// Ownership: a study owns its texts and what its stages made. Pointers that it returns live as long as it does.
/// Threads: one at a time uses a study, its copies and whatever is made of its model, since all share the context of
/// its expressions (ExpressionLock says what waits by itself). Several studies of their own texts may be used at the
/// same time; kernels may be shared, each with a workspace a thread; the flag of an interrupt may be set from anywhere.
///
/// override_with, ask, fix_mode and admit_singular_mass_matrix after model(): std::invalid_argument.
class Study {
 public:
  /// Takes a text without reading it. `interrupt`: see set_interrupt.
  explicit Study(SourceText source, const Interrupt& interrupt = {});

  const SourceText& source() const { return source_; }
  /// The model's text and those beside it, for `render` and for the places of diagnostics.
  SourceTexts texts() const { return {source_, overrides_.texts()}; }
  Diagnostics& diagnostics() { return diagnostics_; }
  const Diagnostics& diagnostics() const { return diagnostics_; }
  /// Whether any stage or any question has told an error. What a question was refused for does not stand in the way of
  /// the next one.
  bool wrong() const { return diagnostics_.has_errors(); }

  /// Stages end by Interrupted when this asks them to; the next use of the stage does its work again.
  void set_interrupt(const Interrupt& interrupt) { interrupt_ = interrupt; }
  /// The same for what is computed from the model outside of the stages, while the scope lives.
  /// Precondition: model() is there.
  InterruptScope interruptible() const { return {*model_->system.context, interrupt_}; }

  // ------------------------------------------------------------------------------- beside the text; before model()

  /// Says what the experiment does otherwise: `text` is a part of a statement, with the model's names and units,
  /// `label` what messages call it ("--until"). Its mistakes are found by model(), with places in it. Returns the
  /// number of the text.
  /// Precondition: model() was not asked for.
  SourceId override_with(OverrideKind kind, std::string label, std::string text);
  /// Asks for a formula; returns its index in Experiment::asked. Precondition as above.
  std::size_t ask(std::string label, std::string formula);
  /// A text that is no part of a statement, for places in it.
  SourceId add_text(std::string label, std::string text) {
    return overrides_.add_text(std::move(label), std::move(text));
  }
  /// The system in one mode of its contacts and frictions (see read_mode), without inequalities from then on. What is
  /// wrong with it is an error (E0269) of model(). Precondition as above.
  void fix_mode(std::string text);
  /// For questions that do not need accelerations: a mass matrix that is singular (E0407, E0408) is no mistake then.
  /// Precondition as above.
  void admit_singular_mass_matrix();

  // ---------------------------------------------------------------------------------------------------- the stages

  /// The statements of the text. Cost: linear in it.
  const syntax::SyntaxTree* tree();
  /// Elaborated, with all that was said beside the text, and past the physics lint.
  const Model* model();
  const EquationsOfMotion* equations();
  /// What a degenerate Lagrangian asks of the state and leaves open; null where M, with the constraints, determines the
  /// accelerations.
  const DegenerateAnalysis* degenerate();
  /// Of a model with fields: their equations, certified; null for any other model.
  const FieldEquations* field_equations();
  const Certificate* field_certificate() const { return field_certificate_ ? &*field_certificate_ : nullptr; }
  /// Whether the model has fields.
  bool has_fields() { return model() && model_->fields; }
  /// Readable form; `with_steps` adds the textbook path.
  const Derivation* derivation(bool with_steps);
  /// Certifies the equations, and the derivation if there is one. A failed check is an error (E0690): equations that
  /// are known to be wrong are not shown. An undecided one is a warning (W0691). The options of the first use count.
  const Certificate* certificate(const CertifyOptions& options = {});

  // ------------------------------------------------------------------------------------------------- what they tell

  /// The motion of the experiment (see `simulate`), once the equations are certified. Nothing where the model does not
  /// allow a run, and the diagnostics say why. Each call is a run of its own.
  std::optional<SimulationResult> motion(const SimulationOptions& options = {});
  /// The same in many digits.
  std::optional<ExtendedResult> motion(const ExtendedSimulationOptions& options);
  /// The motion of a model with fields, from t = 0 on; what concerns steps of coordinates is passed over. Nothing where
  /// there is none, and the diagnostics say why.
  std::optional<FieldRunResult> field_motion(const SimulationOptions& options, const FieldMotionOptions& kept);
  /// What becomes of the `expect` and `claim` lines. A text that expects errors is judged by its diagnostics, any other
  /// by its equations and runs. Nothing where it cannot be judged.
  std::optional<Verification> verification(const SimulationOptions& options = {});

  /// E0244 where the model holds an integral of its paths: there is no motion from a start then. For questions about
  /// motions.
  bool refuse_held_integrals();
  /// E0245 where another variable stands in the place of the time. For questions about motions in time.
  bool refuse_without_time();
  /// E0270 where the model has contacts or friction: for questions about the equations of one mode.
  bool refuse_modes();
  /// E0271 where an event sets or stops the motion: for questions about one smooth motion.
  bool refuse_acting_events();
  /// N0272 where an event sets the state: for questions about the equations alone.
  void tell_events_left_out();

 private:
  bool elaborate_model(Diagnostics& found, std::optional<Model>& model);
  bool admit_degenerate(const Model& model, const Diagnostics& lints, Diagnostics& found);
  void verify_with_other_values(const SimulationOptions& options, Verification& out);
  std::optional<Verification> field_verification(const SimulationOptions& options);
  void report(const CertificateCheck& check);
  void refuse_coordinates();
  void tell(const Diagnostics& found);
  bool broken() const;
  void enter_mode(Model& model, Diagnostics& found) const;

  SourceText source_;
  Interrupt interrupt_;
  ExperimentOverrides overrides_;
  Diagnostics diagnostics_;
  std::size_t told_ = 0;  // errors of questions: they do not break the stages
  std::size_t asked_ = 0;
  std::optional<syntax::SyntaxTree> tree_;
  std::shared_ptr<const Model> model_;
  bool elaborated_ = false;
  bool admits_singular_ = false;
  std::optional<std::string> mode_;
  std::shared_ptr<const DegenerateAnalysis> degenerate_;
  std::optional<EquationsOfMotion> equations_;
  std::optional<FieldEquations> field_equations_;
  std::optional<Certificate> field_certificate_;
  bool fields_derived_ = false;
  bool derived_ = false;
  std::optional<Derivation> derivation_;
  bool has_steps_ = false;
  std::optional<Certificate> certificate_;
};

/// What a look at the start finds.
struct StartFindings {
  std::optional<ConsistentStart> start;  // on the constraints; none where they clash
  ConstraintAnalysis constraints;        // there, or in general where there is no such state
  std::optional<ContactStart>
      contacts;  // of a model with contacts or friction that asks for a motion, by a start or a run
};

/// What the state at the start adds to the mistakes of the equations: clashing constraints, what they are, contacts
/// that cannot begin; all of it is told.
StartFindings look_into_start(const Model& model, const EquationsOfMotion& equations, Diagnostics& diagnostics);

/// Whether the independent variable is a time; without units nothing says that it is none.
bool moves_in_time(const MechanicalSystem& system);

}  // namespace maupertuis

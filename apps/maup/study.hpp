#pragma once
#include "interrupt.hpp"
#include "option_statement.hpp"

#include <maupertuis/certificate.hpp>
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/mechanical_system.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace maupertuis::app {

/// A model file on its way through the stages. Each stage runs once, at first use, and returns null when an earlier
/// one failed; what went wrong collects in diagnostics().
class Study {
 public:
  /// Reads the file, "-" for standard input.
  explicit Study(const std::string& path, Overrides overrides = {});
  /// A text that was read already.
  explicit Study(SourceText source, Overrides overrides = {});

  const SourceText& source() const { return source_; }
  Diagnostics& diagnostics() { return diagnostics_; }
  bool wrong() const { return diagnostics_.has_errors(); }

  /// Diagnostics with the text that their places are in: that of the model, or what an option said.
  struct Told {
    SourceText source;
    Diagnostics diagnostics;
    bool of_option = false;
  };
  std::vector<Told> told() const;
  /// E0809 about what an option said, or a piece of it.
  void refuse_option(const std::string& option, const std::string& typed, std::string message, std::string reason = {},
                     std::string help = {}, std::optional<Span> piece = {});
  /// Every error is one in what an option said: the model is as it should be.
  bool only_options_are_wrong() const;

  /// Stages end by Interrupted when this asks them to: Ctrl-C, if nothing else is said.
  void set_interrupt(const Interrupt& interrupt) { interrupt_ = interrupt; }
  /// The same for what a command goes on to compute from the model, while the scope lives. Precondition: model() is there.
  InterruptScope interruptible() const { return {*model_->system.context, interrupt_}; }

  const syntax::SyntaxTree* tree();
  /// Puts a `run …` statement in the place of the model's own. Precondition: no later stage was asked for.
  void replace_run(const OptionStatement& statement);
  /// The same for a `path …` statement.
  void replace_path(const OptionStatement& statement);
  /// The same for a `sweep …` statement.
  void replace_sweep(const OptionStatement& statement);
  /// Adds statements of the command line after the model's own, one a line. Precondition as above.
  void add_statements(const std::vector<OptionStatement>& statements);
  /// For questions that do not need accelerations: a mass matrix that is singular (E0407, E0408) is no mistake then.
  /// Precondition as above.
  void admit_singular_mass_matrix();
  /// Elaborated and past the physics lint.
  const Model* model();
  const EquationsOfMotion* equations();
  /// Readable form; `with_steps` adds the textbook path.
  const Derivation* derivation(bool with_steps);
  /// Certifies the equations, and the derivation if there is one. A failed check is an error (E0690): equations that
  /// are known to be wrong are not shown. An undecided one is a warning (W0691).
  const Certificate* certificate(const CertifyOptions& options = {});

 private:
  /// A statement that stands in source_ at `begin`.
  struct Placed {
    std::uint32_t begin;
    OptionStatement statement;
  };
  template <class Kind>
  void replace(const OptionStatement& statement);
  std::optional<OptionPlace> option_at(Span span) const;
  std::optional<OptionPlace> override_at(Span span) const;

  std::vector<Placed> placed_;
  std::vector<OptionPlace> refused_;   // by refuse_option
  Interrupt interrupt_ = &interrupt_flag();
  Diagnostics diagnostics_;
  SourceText source_;
  Overrides overrides_;
  std::optional<syntax::SyntaxTree> tree_;
  std::shared_ptr<const Model> model_;
  bool elaborated_ = false;
  bool admits_singular_ = false;
  std::optional<EquationsOfMotion> equations_;
  bool derived_ = false;
  std::optional<Derivation> derivation_;
  bool has_steps_ = false;
  std::optional<Certificate> certificate_;
};

/// E0244 where the model holds an integral of its paths: there is no motion then. For commands about motions.
bool refuse_held_integrals(Study& study);
/// Whether the independent variable is a time; without units nothing says that it is none.
bool moves_in_time(const MechanicalSystem& system);
/// E0245 where another variable stands in the place of the time. For commands about motions in time.
bool refuse_without_time(Study& study);

}  // namespace maupertuis::app

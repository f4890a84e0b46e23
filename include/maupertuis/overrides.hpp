#pragma once
#include <maupertuis/syntax_tree.hpp>

#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

/// What a text beside a model says, and how it is read.
enum class OverrideKind {
  Parameters,  // m = 2 kg, l = 1 m: values in the place of the model's; a dimension stays
  Constants,   // the same, and formulas hold the values in the place of the names: 4 and k are one where k = 4
  Start,       // θ = 60 deg, θ' = 0: replaces and adds
  At,          // θ = 0: fills Experiment::at
  Run,         // 10 s; until P.y = 0 within 60 s: in the place of the model's run
  Until,       // P.y = 0: the same for a condition alone
  Within,      // 60 s: the longest time of Until or Run; without one 60 units of the independent variable
  Sweep,       // Ω = 0 .. 12 rad/s steps 121: in the place of the model's; without a number 121 values
  Path,        // (0, 1) at 0 to (2, free) at 1: in the place of the model's
  Section,     // θ1 = 0: fills Experiment::section
  Formula,     // 1/2 m l^2 θ'^2: one of Experiment::asked, in this order
  GivenPath,   // x = 4 t + 7, y = 3 t + 5: fills Experiment::given_path
  GivenFrom,   // 0 s: where that path begins, in the place of where the model's does
  GivenTo,     // 10 s: where it ends
};

/// What an experiment is to do otherwise than its model says, and what is asked of it beside: options of a command
/// line, fields of a form, arguments of a call. Parts of statements of the model language, each a text of its own, in
/// which its mistakes have their places. The model text stays as it is.
class ExperimentOverrides {
 public:
  /// Takes up a text; `label` is what messages call it, "--until". Returns its number, which its places have. Nothing
  /// is read yet.
  SourceId add(OverrideKind kind, std::string label, std::string text);
  /// A text that holds no part of a statement, for places in it.
  SourceId add_text(std::string label, std::string text);
  /// Reads all texts with the names of `model`. What cannot be read is left out and told in `diagnostics`.
  void read(const syntax::SyntaxTree& model, Diagnostics& diagnostics);

  /// Text k has the number k + 1.
  const std::vector<SourceText>& texts() const { return texts_; }

  // What was read.
  std::vector<syntax::ParamStatement> parameters, constants;
  std::vector<syntax::StartStatement> start, at;
  std::optional<syntax::RunStatement> run;
  std::optional<syntax::SweepStatement> sweep;
  std::optional<syntax::PathStatement> path;
  std::optional<syntax::Equation> section;
  std::vector<syntax::ExpressionPtr> formulas;
  std::vector<syntax::Assignment> given_path;
  syntax::ExpressionPtr given_from, given_to;  // null: not said

 private:
  struct Said {
    OverrideKind kind;
    SourceId text;
  };
  void read(OverrideKind kind, const SourceText& text, const syntax::SyntaxTree& model, Diagnostics& diagnostics);

  std::vector<SourceText> texts_;
  std::vector<Said> unread_;
};

}  // namespace maupertuis

#pragma once
#include <maupertuis/layout.hpp>

#include <string>
#include <vector>

namespace maupertuis {

enum class Notation { Plain, Latex, Mathml };

/// A line of a result: left = right, right alone where left is empty, or a sentence alone. It may open a section, and
/// carry a note, the rule of a step or the name of a constraint.
struct FormulaLine {
  Layout left, right;
  std::string note, sentence, section;
  std::string declared;  // the word before it in the model language: "let"
  bool known = false;    // a definition that the model has itself: nothing to be declared again
};

/// The lines in one notation alone, for another program.
///
/// Plain text is the model language, a line each: equations as after `expect equation`, names as `let`, notes and what
/// the model has itself as comments. LaTeX is a document that compiles by itself, MathML one <math> element; both break
/// long lines.
std::string document(const std::vector<FormulaLine>& lines, Notation notation);

/// left = right for JSON.
std::string plain_text(const FormulaLine& line);
std::string latex_text(const FormulaLine& line);

/// A name that the language reads, of pieces that it may not: "M_θ1_θ2".
std::string identifier(std::string_view text);

}  // namespace maupertuis

#pragma once
#include "notation.hpp"
#include "study.hpp"

#include <string>
#include <vector>

namespace maupertuis::app {

enum class Form { Standard, Solved, Matrix, Residual, Eliminated };

/// One line `left = right` of a result; an empty left stands for `right = equal_to`, or `right = 0`.
struct EquationLine {
  std::string coordinate;  // whose equation it is; empty for a line of M
  std::string left_plain, left_latex, left_mathml;
  ReadableForm right;
  Expr equal_to;           // a force of constraint, the other side of a constraint; empty: 0
  std::string note;        // the name of a constraint
};

/// The equations of motion in one of their forms, each proved equal to the residual by the zero test before it is
/// shown; one that is not is an error (E0690) and the list is empty. E0692, E0693: too long for `Solved`, for `Eliminated`.
struct EquationForm {
  std::vector<EquationLine> lines;
  std::vector<EquationLine> constraints;   // as the model has them; in the forms that are equations of motion
  std::vector<Intermediate> intermediates;
};
EquationForm equation_form(Form form, Study& study);

/// c1 = value
EquationLine definition_line(const Intermediate& intermediate, const ReadingOrder& order);

/// `left = right`, with nothing around it.
std::string to_text(const EquationLine& line, Notation notation, const ReadingOrder& order);

}  // namespace maupertuis::app

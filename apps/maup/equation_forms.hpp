#pragma once
#include <maupertuis/formula_document.hpp>
#include "open_study.hpp"

#include <maupertuis/rates.hpp>

#include <memory>
#include <string>
#include <vector>

namespace maupertuis::app {

/// Shortest: in rates where these are named or shorter to read, else Standard.
enum class Form { Shortest, Standard, Solved, Matrix, Residual, Eliminated, Rates };

/// One line `left = right` of a result; an empty left stands for `right = equal_to`, or `right = 0`.
struct EquationLine {
  std::string coordinate;  // whose equation it is; empty for a line of M
  Layout left;
  ReadableForm right;
  Expr equal_to;     // a force of constraint, the other side of a constraint; empty: 0
  std::string note;  // the name of a constraint
  std::string name;  // what the language calls the left side where that is no name to it: M_θ1_θ2 for M[θ1, θ2]
  bool repeated =
      false;  // `name` has been declared by an earlier line: this one says that it is equal to the right side
};

/// The equations of motion in one of their forms, each proved equal to the residual by the zero test before it is
/// shown; one that is not is an error (E0690) and the list is empty. E0692, E0693: too long for `Solved`, for
/// `Eliminated`. E0694, E0695: no rates, or none in which the equations can be written.
struct EquationForm {
  std::vector<EquationLine> lines;
  std::vector<EquationLine> constraints;  // as the model has them; in the forms that are equations of motion
  std::vector<Intermediate> intermediates;
  std::vector<EquationLine> kinematics;              // q' by rates
  std::shared_ptr<const EquationsInRates> in_rates;  // of the form in rates

  /// How its names are ordered: rates are names as well.
  const ReadingOrder& order(const EquationsOfMotion& equations) const {
    return in_rates ? in_rates->order : equations.order;
  }
};
EquationForm equation_form(Form form, Study& study);

/// c1 = value; as known where `system` has a definition of this name.
FormulaLine definition_line(const Intermediate& intermediate, const MechanicalSystem& system,
                            const ReadingOrder& order);

/// The coordinates that print shows by another name than the model's: q_w for ball.qw.
std::vector<FormulaLine> symbol_legend(const MechanicalSystem& system, const ReadingOrder& order);

/// As it is shown to a reader.
FormulaLine shown_line(const EquationLine& line, const ReadingOrder& order);
/// As the model language reads it: a left side that is no name gets one, by `let`.
FormulaLine language_line(const EquationLine& line, const ReadingOrder& order);

}  // namespace maupertuis::app

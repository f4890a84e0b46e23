#pragma once
#include "equations/first_integral.hpp"

namespace maupertuis {

/// The part of a set of one-forms that is a combination of differentials dF.
struct IntegrablePart {
  struct Combination {
    std::vector<std::size_t> forms;
    OneForm form;
  };
  std::size_t rank = 0;                   // of the forms
  std::size_t integrable_rank = 0;        // of the terminal subsystem of their derived flag
  std::vector<bool> integrable;           // [forms] lies in it
  std::vector<Combination> combinations;  // span it, together with the forms that lie in it
};

/// `points`: values of all symbols at generic points; with relations between the variables, on them. What counts is the
/// behaviour near these points. Cost: brackets of the n + 1 − rank directions that the forms leave, until they close.
IntegrablePart integrable_part(const std::vector<OneForm>& forms, const ExprVector& variables,
                               const std::vector<Bindings>& points);

}  // namespace maupertuis

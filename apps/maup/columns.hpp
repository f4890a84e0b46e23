#pragma once
#include "numbers.hpp"
#include "open_study.hpp"

#include <maupertuis/trajectory.hpp>

#include <optional>
#include <string>
#include <vector>

namespace maupertuis::app {

/// The pieces of a list between commas outside of brackets, without the blanks around them: "θ1 - θ2, max(x, y)".
std::vector<Span> pieces_of(const std::string& text);

/// Columns that an option asks for: names of a trajectory (`energy`, `reaction(rod)`, `B.x`), or formulas of the model
/// language in q, q', q'', t, momenta and reactions, with units. Several texts are one list.
class AskedColumns {
 public:
  /// Tells coordinates from formulas by the tree of the study, and asks it for the formulas.
  /// Precondition: no stage after the tree was asked for.
  AskedColumns(const std::string& option, const std::vector<std::string>& texts, Study& study);

  bool empty() const { return names_.empty(); }
  /// As they were written.
  const std::vector<std::string>& names() const { return names_; }
  /// Those of them that are formulas, not columns of the trajectory. Precondition: `study` has a model.
  WrittenColumns formulas(Study& study) const;
  /// The trajectory with the formulas as further columns, their errors to first order where it has errors. Nothing, and
  /// E0811, where one of them has no value that the rows determine. Precondition: `study` has equations.
  std::optional<Trajectory> added_to(Trajectory rows, Study& study) const;
  /// The same with these columns alone, in this order; E0811 where there is no such one.
  std::optional<Trajectory> chosen_from(const Trajectory& rows, Study& study) const;

 private:
  struct Formula {
    std::string text;
    std::size_t asked;  // index in Experiment::asked
  };

  std::string option_;
  std::vector<std::string> names_;
  std::vector<Formula> formulas_;
};

}  // namespace maupertuis::app

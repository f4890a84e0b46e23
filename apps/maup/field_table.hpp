#pragma once
#include "columns.hpp"
#include "json.hpp"

#include <maupertuis/field_run.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/study.hpp>

#include <optional>
#include <string>
#include <vector>

namespace maupertuis::app {

/// Formulas of values of fields at places, `u(3 m) - u(1 m)`, at moments: those of --at, else the end, which are shown,
/// and, for a file, those of its rows.
class FieldTable {
 public:
  /// Precondition: as of AskedColumns.
  FieldTable(const std::vector<std::string>& formulas, Study& study) : columns_("--columns", formulas, study) {}

  bool empty() const { return columns_.empty(); }
  /// What is asked of the run. E0811 for names that only trajectories of coordinates have, E0809 for moments outside of
  /// the run.
  std::vector<FieldQuestion> questions(Study& study, const SimulationOptions& settings, bool rows);
  /// Each formula with its error, where it was estimated.
  std::string text(const FieldRunResult& run) const;
  Json json(const FieldRunResult& run) const;
  /// The rows of a file.
  Trajectory rows(const FieldRunResult& run, bool errors) const;

 private:
  bool has_formulas_alone(Study& study) const;

  AskedColumns columns_;
  std::vector<double> shown_, rows_;  // s
  std::vector<std::string> units_;    // [formulas]
};

}  // namespace maupertuis::app

#include "columns.hpp"

#include <maupertuis/along_motion.hpp>
#include <maupertuis/close_evaluation.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/momentum.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis::app {

std::vector<Span> pieces_of(const std::string& text) {
  std::vector<Span> out;
  std::uint32_t begin = 0;
  int depth = 0;
  const auto add = [&](std::uint32_t end) {
    while (begin < end && text[begin] == ' ') ++begin;
    std::uint32_t last = end;
    while (last > begin && text[last - 1] == ' ') --last;
    out.push_back({begin, last});
    begin = end + 1;
  };
  for (std::uint32_t i = 0; i < text.size(); ++i) {
    depth += (text[i] == '(') - (text[i] == ')');
    if (text[i] == ',' && depth == 0) add(i);
  }
  add(static_cast<std::uint32_t>(text.size()));
  return out;
}

namespace {

/// θ, θ', and what only a trajectory has names for. Any other name is a formula too, and is read as one.
bool is_column_name(const std::string& name, const syntax::SyntaxTree* tree) {
  const auto begins = [&](std::string_view head) { return name.compare(0, head.size(), head) == 0; };
  if (name == "t" || name == "energy" || begins("reaction(") || begins("friction(") || begins("error(") ||
      begins("λ") || begins("Λ"))
    return true;
  if (!tree) return false;
  for (const syntax::Statement& s : tree->statements) {
    if (const auto* independent = std::get_if<syntax::IndependentStatement>(&s.body);
        independent && independent->name.text == name)
      return true;
    if (const auto* coord = std::get_if<syntax::CoordStatement>(&s.body))
      for (const auto& item : coord->items)
        if (item.name.text == name || item.name.text + "'" == name) return true;
    if (const auto* point = std::get_if<syntax::PointStatement>(&s.body))
      for (const char* axis : {".x", ".y", ".z"})
        if (point->name.text + axis == name) return true;
  }
  return false;
}

/// A formula as the rows of a trajectory determine it: in q, q' and t.
class FormulaColumn {
 public:
  FormulaColumn(Expr formula, const EquationsOfMotion& equations) : system_(*equations.system) {
    ExprMap momenta;
    for (std::size_t i = 0; i < equations.momenta.size(); ++i)
      momenta.emplace(momentum_symbol(system_, i), equations.momenta[i]);
    const Expr of_state = substitute(formula, momenta);
    const Expr with_forces = with_reactions(equations, {&of_state, 1}).front();
    value_ = expand_time_derivatives(in_terms_of_motion(system_, {&with_forces, 1}).front());
    asked_ = value_;
    if (needs_motion() && has_free_functions(equations)) put_in_one_choice(*equations.degenerate);
    if (needs_motion() && !system_.constrained()) value_ = AlongMotion(equations).put_in(of_state);
    if (needs_motion()) put_in_motion(equations);
  }

  /// Accelerations and forces of constraints that nothing determines stand in it.
  bool needs_motion() const {
    for (const Expr& s : symbols_of({&value_, 1}))
      if (s.role() == Role::Multiplier || (s.role() == Role::Coordinate && s.order() == 2)) return true;
    return false;
  }

  /// Where functions of time are free: whether it is the same with each of them.
  bool is_determined(const EquationsOfMotion& equations) const {
    return !has_free_functions(equations) || equations.degenerate->is_determined(asked_);
  }

  /// The values of all rows; errors too, where there are any: those of the state, and what rounding makes of the
  /// formula.
  void append_to(const Trajectory& shown, std::vector<double>& values, std::vector<double>& errors) {
    const Trajectory& rows = shown.of_one_choice ? *shown.of_one_choice : shown;
    find_sources(rows);
    std::vector<Expr> roots{value_};
    const std::vector<Expr> slopes = rows.errors.empty() ? std::vector<Expr>() : gradient(value_, symbols_);
    roots.insert(roots.end(), slopes.begin(), slopes.end());
    Bindings at = parameter_bindings(system_);
    const CloseEvaluation formula({&value_, 1});
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      at[system_.context->time()] = rows.times[row];
      for (std::size_t i = 0; i < symbols_.size(); ++i) at[symbols_[i]] = rows.at(row, columns_[i]);
      const std::vector<double> found = evaluate(roots, at);
      values.push_back(found[0]);
      if (rows.errors.empty()) continue;
      double error = formula.in_double([&](Expr symbol) { return at.at(symbol); }).errors[0];
      for (std::size_t i = 0; i < slopes.size(); ++i)
        if (found[i + 1] != 0) error += std::abs(found[i + 1]) * rows.error(row, columns_[i]);
      errors.push_back(error);
    }
  }

 private:
  /// Free accelerations are 0: what does not depend on them is the same with any others.
  void put_in_one_choice(const DegenerateAnalysis& analysis) {
    value_ = substitute(value_, analysis.motion);
    ExprMap at_rest;
    for (const std::size_t i : analysis.free)
      at_rest.emplace(system_.coordinates[i].acceleration, system_.context->number(0));
    value_ = substitute(value_, at_rest);
  }

  void put_in_motion(const EquationsOfMotion& equations) {
    const auto motion = accelerations_and_multipliers(equations);
    if (!motion) return;
    ExprMap values;
    for (std::size_t i = 0; i < motion->accelerations.size(); ++i)
      values.emplace(system_.coordinates[i].acceleration, motion->accelerations[i]);
    for (std::size_t i = 0; i < motion->multipliers.size(); ++i)
      values.emplace(equations.multipliers[i], motion->multipliers[i]);
    const Expr put_in = substitute(value_, values);
    value_ = expand_time_derivatives(in_terms_of_motion(system_, {&put_in, 1}).front());
  }

  void find_sources(const Trajectory& rows) {
    for (const Coordinate& c : system_.coordinates)
      for (const auto& [symbol, name] : {std::pair(c.q, c.name), std::pair(c.velocity, c.name + "'")})
        if (const auto column = rows.column(name)) {
          symbols_.push_back(symbol);
          columns_.push_back(*column);
        }
  }

  const MechanicalSystem& system_;
  Expr asked_, value_;  // as it was asked for; and without accelerations and forces, as far as there is a formula
  std::vector<Expr> symbols_;  // q and q' that are columns
  std::vector<std::size_t> columns_;
};

/// E0631: there is no such column, or no such formula of a state, since functions of time are free.
void refuse_free(const std::string& what, Diagnostics& diagnostics) {
  diagnostics.error("E0631", {}, fmt::format("{} depends on functions that are free", what),
                    "The Lagrangian leaves them open, so that it has no value of its own.",
                    "`gauge EXPR = EXPR` makes a choice; differences and momenta may do without one.");
}

}  // namespace

AskedColumns::AskedColumns(const std::string& option, const std::vector<std::string>& texts, Study& study)
    : option_(option) {
  for (const std::string& text : texts)
    for (const Span piece : pieces_of(text)) {
      const std::string name = text.substr(piece.begin, piece.end - piece.begin);
      if (std::find(names_.begin(), names_.end(), name) != names_.end()) continue;
      names_.push_back(name);
      if (is_column_name(name, study.tree())) continue;
      formulas_.push_back({name, study.ask(option, name)});
    }
}

WrittenColumns AskedColumns::formulas(Study& study) const {
  WrittenColumns out;
  for (const Formula& f : formulas_) out.emplace(f.text, study.model()->experiment.asked.at(f.asked).span);
  return out;
}

std::optional<Trajectory> AskedColumns::added_to(Trajectory rows, Study& study) const {
  const Model& model = *study.model();
  for (const auto& [formula, index] : formulas_) {
    if (rows.column(formula)) continue;  // sat.qw is a coordinate
    if (const auto column = rows.column(asked_column(index))) {
      rows.columns[*column].name = formula;
      continue;
    }
    const AskedFormula& asked = model.experiment.asked.at(index);
    FormulaColumn column(asked.value, *study.equations());
    if (!column.is_determined(*study.equations())) {
      refuse_free(formula, study.diagnostics());
      return std::nullopt;
    }
    if (column.needs_motion()) {
      refuse_option(
          study, option_, formula, fmt::format("{} is not determined by the state in this model", formula),
          "Accelerations and forces of constraints follow from the state only where the equations have one solution.",
          "Ask for coordinates, velocities and what is made of them.");
      return std::nullopt;
    }
    std::vector<double> values, errors;
    column.append_to(rows, values, errors);
    Trajectory longer = rows;
    longer.columns.push_back({formula, model.system.dimensionless ? std::string() : to_string(asked.dimension)});
    longer.values.clear();
    longer.errors.clear();
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      for (std::size_t c = 0; c < rows.columns.size(); ++c) {
        longer.values.push_back(rows.at(row, c));
        if (!rows.errors.empty()) longer.errors.push_back(rows.error(row, c));
      }
      longer.values.push_back(values[row]);
      if (!rows.errors.empty()) longer.errors.push_back(errors[row]);
    }
    rows = std::move(longer);
  }
  return rows;
}

std::optional<Trajectory> AskedColumns::chosen_from(const Trajectory& all, Study& study) const {
  const auto rows = added_to(all, study);
  if (!rows) return std::nullopt;
  std::vector<std::size_t> chosen;
  std::vector<std::string> known;
  for (const Trajectory::Column& column : rows->columns) known.push_back(column.name);
  for (const std::string& name : names_) {
    if (const auto column = rows->column(name)) {
      chosen.push_back(*column);
    } else if (rows->of_one_choice && rows->of_one_choice->column(name)) {
      refuse_free(name, study.diagnostics());
      return std::nullopt;
    } else if (name != rows->independent.name) {  // which is always the first column
      const std::string near = did_you_mean(name, known);
      study.diagnostics().error(
          "E0811", {},
          fmt::format("there is no column {}{}", name, near.empty() ? "" : fmt::format("; did you mean {}?", near)));
      return std::nullopt;
    }
  }
  Trajectory out;
  out.independent = rows->independent;
  out.times = rows->times;
  out.metadata = rows->metadata;
  for (const std::size_t column : chosen) out.columns.push_back(rows->columns[column]);
  for (std::size_t row = 0; row < rows->rows(); ++row)
    for (const std::size_t column : chosen) {
      out.values.push_back(rows->at(row, column));
      if (!rows->errors.empty()) out.errors.push_back(rows->error(row, column));
    }
  return out;
}

}  // namespace maupertuis::app

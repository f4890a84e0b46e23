#include "equation_forms.hpp"
#include "rates_form.hpp"

#include <fmt/format.h>

#include <algorithm>

#include <maupertuis/higher_order.hpp>
#include <maupertuis/print.hpp>

namespace maupertuis::app {
namespace {

/// The values of a form's lines with their named intermediates put back.
Expr without_intermediates(Expr e, const std::vector<Intermediate>& intermediates) {
  for (auto it = intermediates.rbegin(); it != intermediates.rend(); ++it) e = substitute(e, {{it->symbol, it->value}});
  return e;
}

Expr acceleration(const EquationsOfMotion& equations, std::size_t i) {
  return equations.system->coordinates[i].acceleration;
}

void append(std::vector<Intermediate>& all, const std::vector<Intermediate>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// Nothing is shown that was not proved; `what` names the form in the message.
bool proved(const std::vector<Expr>& differences, const char* what, Study& study) {
  const ZeroTest test = zero_test(substitute(differences, study.model()->system.definition_values()));
  if (test.verdict == Verdict::Zero) return true;
  if (test.verdict == Verdict::Nonzero)
    study.diagnostics().error("E0690", {}, fmt::format("The {} form differs from the derived equations.", what), {},
                              "It is not shown, because it is wrong. Please report this model.");
  else
    study.diagnostics().warning("W0691", {},
                                fmt::format("The {} form could not be compared with the derivation.", what),
                                test.reason, "It is shown, but it is not certified.");
  return test.verdict == Verdict::Undecided;
}

std::vector<EquationLine> constraint_lines(const Derivation& derivation) {
  std::vector<EquationLine> lines;
  for (const ConstraintEquation& c : derivation.constraints) {
    EquationLine line;
    line.right.value = c.left;
    line.equal_to = c.right;
    line.note = c.name;
    lines.push_back(std::move(line));
  }
  return lines;
}

/// A name for the model language that the system has not given to anything.
std::string free_name(const std::string& wanted, const MechanicalSystem& system) {
  std::string name = identifier(wanted);
  const auto taken = [&](const auto& list) {
    return std::any_of(list.begin(), list.end(), [&](const auto& item) { return item.name == name; });
  };
  while (taken(system.parameters) || taken(system.definitions) || taken(system.coordinates) || taken(system.inputs) ||
         taken(system.points) || taken(system.bodies))
    name += "_";
  return name;
}

/// (Aᵀλ)[x]
Layout constraint_force(const Coordinate& c, const ReadingOrder& order) {
  const Layout both = layouts::product({layouts::power(layouts::name("A"), layouts::name("T")), layouts::name("λ")});
  return layouts::labelled(fmt::format("(Aᵀλ)[{}]", c.name), layouts::indexed(both, {lay_out(c.q, order)}));
}

/// R begins with −∂²L/∂q''² q'''': where that is negative the equation is shown as −R = 0.
bool shown_negative(const EquationsOfMotion& equations, std::size_t coordinate, Expr residual) {
  const auto& higher = equations.system->higher;
  const auto h =
      std::find_if(higher.begin(), higher.end(), [&](const HigherDerivative& x) { return x.coordinate == coordinate; });
  if (h == higher.end()) return false;
  const Coordinate& c = equations.system->coordinates[coordinate];
  const Expr fourth = residual.context().symbol(c.name, Role::Coordinate, 4);
  const Expr slope = readable(differentiate(residual, fourth), equations.order).value;
  return split_coefficient(slope).coefficient < Rational(0);
}

/// Equations of up to the fourth order, of the coordinates of the text alone.
EquationForm higher_order_rows(const EquationsOfMotion& equations, bool as_residual) {
  const HigherOrderForm shown = higher_order_form(equations.shown());
  EquationForm form;
  for (std::size_t k = 0; k < shown.coordinates.size(); ++k) {
    const Coordinate& c = equations.system->coordinates[shown.coordinates[k]];
    const bool negative = !as_residual && shown_negative(equations, shown.coordinates[k], shown.residual[k]);
    const Expr row = negative ? -shown.residual[k] : shown.residual[k];
    EquationLine line{c.name, {}, readable(row, equations.order), {}, {}, {}, false};
    append(form.intermediates, line.right.intermediates);
    if (as_residual) {
      line.left = layouts::indexed(layouts::name("R"), {lay_out(c.q, equations.order)});
      line.name = free_name("R_" + c.name, *equations.system);
    }
    form.lines.push_back(std::move(line));
  }
  return form;
}

/// Their readable forms are proved here; the certificate holds those of the system that is computed with.
EquationForm fourth_order_form(Study& study, bool as_residual) {
  const EquationsOfMotion& equations = *study.equations();
  EquationForm form = higher_order_rows(equations, as_residual);
  const HigherOrderForm derived = higher_order_form(equations), written = higher_order_form(equations.shown());
  std::vector<Expr> differences;
  for (std::size_t k = 0; k < form.lines.size(); ++k) {
    const ReadableForm& line = form.lines[k].right;
    const Expr value = without_intermediates(line.value, line.intermediates);
    const bool negative = !as_residual && shown_negative(equations, derived.coordinates[k], written.residual[k]);
    differences.push_back(negative ? value + derived.residual[k] : value - derived.residual[k]);
  }
  return proved(differences, as_residual ? "residual" : "standard", study) ? form : EquationForm{};
}

EquationForm standard_form(Study& study, bool as_residual) {
  const EquationsOfMotion& equations = *study.equations();
  const Derivation& derivation = *study.derivation(false);
  EquationForm form;
  for (std::size_t i = 0; i < derivation.equations.size(); ++i) {
    const std::string& name = equations.system->coordinates[i].name;
    EquationLine line{name, {}, derivation.equations[i], {}, {}, {}, false};
    if (!as_residual && equations.system->constrained()) line.equal_to = derivation.constraint_forces[i].value;
    if (as_residual) {
      line.left = layouts::indexed(layouts::name("R"), {lay_out(equations.system->coordinates[i].q, equations.order)});
      line.name = free_name("R_" + name, *equations.system);
    }
    form.lines.push_back(std::move(line));
  }
  if (as_residual)
    for (std::size_t i = 0; i < derivation.constraint_forces.size(); ++i) {
      const Coordinate& c = equations.system->coordinates[i];
      form.lines.push_back({c.name,
                            constraint_force(c, equations.order),
                            derivation.constraint_forces[i],
                            {},
                            {},
                            free_name("R_" + c.name, *equations.system),
                            true});
    }
  form.constraints = constraint_lines(derivation);
  form.intermediates = derivation.intermediates;
  return form;
}

void refuse_solved(Study& study, const SolvedAcceleration& solved) {
  const MechanicalSystem& system = study.model()->system;
  const std::string left = symbol_to_plain(system.coordinates[solved.coordinate].acceleration);
  const std::size_t others = solved.coupled_with.size() - 1;
  if (others <= 1)
    study.diagnostics().error(
        "E0692", {}, fmt::format("The mass matrix gives no {} by itself.", left),
        "It is singular: only the constraints together with it determine this acceleration.",
        "`--eliminate` shows the equations without multipliers, `--form matrix` shows M, h, A and b.");
  else
    study.diagnostics().error(
        "E0692", {}, fmt::format("{} is coupled with {} other accelerations.", left, others),
        "Written out, the inverse of their mass matrix would fill pages and help nobody; runs factor it numerically.",
        system.constrained() ? "`--form matrix` shows M, h, A and b of M q'' + h = Aᵀλ, A q'' = b."
                             : "`--form matrix` shows M and h of M q'' + h = 0.");
}

/// λ = …, one line each; false after an error.
bool add_multipliers(EquationForm& form, ExprMap& solution, Study& study) {
  const EquationsOfMotion& equations = study.equations()->shown();
  const std::vector<ReadableForm> solved = solved_multipliers(equations);
  constexpr std::size_t longest = 600;  // characters
  bool is_short = !solved.empty();
  for (const ReadableForm& value : solved)
    is_short &= value.intermediates.empty() && to_plain(value.value, equations.order).size() <= longest;
  if (!is_short) {
    study.diagnostics().error("E0692", {}, "The multipliers are long when they are written out.",
                              "They follow from A M⁻¹ Aᵀ λ = b + A M⁻¹ h; runs solve that numerically at every step.",
                              "`--form matrix` shows M, h, A and b; `--eliminate` the equations without multipliers.");
    return false;
  }
  for (std::size_t k = 0; k < solved.size(); ++k) {
    const Expr symbol = equations.multipliers[k];
    form.lines.push_back({{}, lay_out(symbol, equations.order), solved[k], {}, {}, {}, false});
    solution[symbol] = solved[k].value;
  }
  return true;
}

EquationForm solved_form(Study& study) {
  const EquationsOfMotion& equations = *study.equations();
  const bool constrained = equations.system->constrained();
  EquationForm form;
  ExprMap solution;
  for (const SolvedAcceleration& solved : solved_accelerations(equations.shown())) {
    const std::string& name = equations.system->coordinates[solved.coordinate].name;
    const Expr left = acceleration(equations, solved.coordinate);
    if (!solved.right.value) return refuse_solved(study, solved), EquationForm{};
    form.lines.push_back({name, lay_out(left, equations.order), solved.right, {}, {}, {}, false});
    append(form.intermediates, solved.right.intermediates);
    solution[left] = without_intermediates(solved.right.value, solved.right.intermediates);
  }
  ExprMap multipliers;
  if (constrained && !add_multipliers(form, multipliers, study)) return {};
  // Put into R − Aᵀλ and A q'' − b they must annihilate them.
  ExprVector rows = equations.balance();
  rows.insert(rows.end(), equations.constraint_accelerations.begin(), equations.constraint_accelerations.end());
  rows = substitute(expand_time_derivatives(rows), solution);
  return proved(substitute(rows, multipliers), "solved", study) ? form : EquationForm{};
}

EquationForm eliminated_form(Study& study) {
  const EquationsOfMotion& equations = *study.equations();
  if (!equations.system->constrained()) return standard_form(study, false);
  const auto eliminated = eliminate_multipliers(equations.shown());
  if (!eliminated) {
    study.diagnostics().error(
        "E0693", {}, "The multipliers cannot be eliminated in a few lines.",
        "The combinations of the equations in which they cancel are too long to be read, or some constraint repeats "
        "others.",
        "`--form matrix` shows M, h, A and b of M q'' + h = Aᵀλ, A q'' = b, which runs solve numerically.");
    return {};
  }
  EquationForm form;
  for (std::size_t i = 0; i < eliminated->rows.size(); ++i)
    form.lines.push_back(
        {equations.system->coordinates[eliminated->independent[i]].name, {}, eliminated->rows[i], {}, {}, {}, false});
  form.constraints = constraint_lines(*study.derivation(false));
  return form;
}

/// Lines `name[row, column] = value`, whose values put together must give what was derived.
class MatrixLines {
 public:
  explicit MatrixLines(const EquationsOfMotion& equations) : equations_(equations) {}

  /// The value as it is shown.
  Expr add(const std::string& letter, const std::string& names, const std::string& indices,
           const std::string& coordinate, Expr value) {
    ReadableForm shown = readable(value, equations_.order);
    append(form.intermediates, shown.intermediates);
    const Expr whole = without_intermediates(shown.value, shown.intermediates);
    const Layout left = layouts::labelled(fmt::format("{}[{}]", letter, names),
                                          layouts::indexed(layouts::name(letter), {layouts::number(indices)}));
    form.lines.push_back(
        {coordinate, left, std::move(shown), {}, {}, free_name(letter + "_" + names, *equations_.system), false});
    return whole;
  }

  EquationForm form;

 private:
  const EquationsOfMotion& equations_;
};

std::string index_pair(std::size_t i, std::size_t j) { return fmt::format("{},{}", i + 1, j + 1); }

/// A and b, beside the differences A q'' − b of what is shown and what was derived.
void add_constraint_matrix(MatrixLines& lines, const EquationsOfMotion& equations, ExprVector& differences) {
  const auto& coordinates = equations.system->coordinates;
  const ExprMatrix a = constraint_matrix(equations.shown());
  const ExprVector b = constraint_bias(equations.shown());
  ExprVector rows;
  for (std::size_t k = 0; k < a.rows; ++k) {
    rows.push_back(-equations.constraint_accelerations[k]);
    for (std::size_t j = 0; j < a.columns; ++j) {
      if (a.at(k, j).is_zero()) continue;
      const std::string names = fmt::format("{}, {}", equations.system->constraint_label(k), coordinates[j].name);
      rows[k] = rows[k] + lines.add("A", names, index_pair(k, j), {}, a.at(k, j)) * acceleration(equations, j);
    }
  }
  for (std::size_t k = 0; k < a.rows; ++k)
    rows[k] = rows[k] - lines.add("b", equations.system->constraint_label(k), std::to_string(k + 1), {}, b[k]);
  differences.insert(differences.end(), rows.begin(), rows.end());
}

EquationForm matrix_form(Study& study) {
  const EquationsOfMotion& equations = *study.equations();
  const auto& coordinates = equations.system->coordinates;
  const std::size_t n = coordinates.size();
  const ExprMatrix m = mass_matrix(equations.shown());
  const ExprVector h = bias(equations.shown());
  MatrixLines lines(equations);
  std::vector<Expr> rows(n, equations.system->context->number(0));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j) {
      const std::string names = fmt::format("{}, {}", coordinates[i].name, coordinates[j].name);
      const Expr entry = lines.add("M", names, index_pair(i, j), coordinates[i].name, m.at(i, j));
      rows[i] = rows[i] + entry * acceleration(equations, j);
      if (j != i) rows[j] = rows[j] + entry * acceleration(equations, i);
    }
  for (std::size_t i = 0; i < n; ++i)
    rows[i] = rows[i] + lines.add("h", coordinates[i].name, std::to_string(i + 1), coordinates[i].name, h[i]) -
              equations.residual[i];
  if (equations.system->constrained()) add_constraint_matrix(lines, equations, rows);
  return proved(rows, "matrix", study) ? std::move(lines.form) : EquationForm{};
}

/// The definitions of the model that the lines use, before their named sub-expressions.
EquationForm with_definitions(EquationForm form, Study& study) {
  std::vector<Expr> roots;
  for (const EquationLine& line : form.lines) roots.push_back(line.right.value);
  for (const EquationLine& line : form.constraints) roots.insert(roots.end(), {line.right.value, line.equal_to});
  for (const Intermediate& i : form.intermediates) roots.push_back(i.value);
  if (roots.empty()) return form;
  std::vector<Intermediate> legend = definitions_used(*study.equations()->shown().system, roots);
  append(legend, form.intermediates);
  form.intermediates = std::move(legend);
  return form;
}

}  // namespace

EquationForm equation_form(Form form, Study& study) {
  if (!study.equations()) return {};
  const bool higher = !study.equations()->system->higher.empty();
  switch (form) {
    case Form::Shortest:
      if (higher) return with_definitions(fourth_order_form(study, false), study);
      return form_in_rates_if_shorter(study, standard_form(study, false));
    case Form::Standard:
      if (higher) return with_definitions(fourth_order_form(study, false), study);
      return standard_form(study, false);
    case Form::Solved:
      return with_definitions(solved_form(study), study);
    case Form::Matrix:
      return with_definitions(matrix_form(study), study);
    case Form::Residual:
      if (higher) return with_definitions(fourth_order_form(study, true), study);
      return standard_form(study, true);
    case Form::Eliminated:
      return with_definitions(eliminated_form(study), study);
    case Form::Rates:
      return rates_form(study);
  }
  return {};
}

FormulaLine definition_line(const Intermediate& intermediate, const MechanicalSystem& system,
                            const ReadingOrder& order) {
  FormulaLine line;
  line.left = lay_out(intermediate.symbol, order);
  line.right = lay_out(intermediate.value, order);
  line.declared = "let";
  for (const Definition& d : system.definitions) line.known |= d.symbol && d.symbol == intermediate.symbol;
  return line;
}

std::vector<FormulaLine> symbol_legend(const MechanicalSystem& system, const ReadingOrder& order) {
  std::vector<FormulaLine> lines;
  for (const Coordinate& c : system.coordinates) {
    if (c.name.find('.') == std::string::npos) continue;
    FormulaLine line;
    line.left = lay_out(c.q, order);
    line.right = layouts::words(c.name);
    line.note = "in the model";
    lines.push_back(std::move(line));
  }
  return lines;
}

FormulaLine shown_line(const EquationLine& line, const ReadingOrder& order) {
  FormulaLine shown;
  shown.left = line.left;
  shown.right = lay_out(line.right, order);
  shown.note = line.note;
  if (!line.left.empty()) return shown;
  shown.left = std::move(shown.right);
  shown.right = line.equal_to ? lay_out(line.equal_to, order) : layouts::number("0");
  return shown;
}

FormulaLine language_line(const EquationLine& line, const ReadingOrder& order) {
  FormulaLine shown = shown_line(line, order);
  if (line.name.empty()) return shown;
  shown.left = layouts::name(line.name);
  if (!line.repeated) shown.declared = "let";
  return shown;
}

}  // namespace maupertuis::app

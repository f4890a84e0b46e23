#include "equation_forms.hpp"

#include <fmt/format.h>

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
    study.diagnostics().warning("W0691", {}, fmt::format("The {} form could not be compared with the derivation.", what),
                                test.reason, "It is shown, but it is not certified.");
  return test.verdict == Verdict::Undecided;
}

EquationForm standard_form(Study& study, bool as_residual) {
  const EquationsOfMotion& equations = *study.equations();
  const Derivation& derivation = *study.derivation(false);
  EquationForm form;
  for (std::size_t i = 0; i < derivation.equations.size(); ++i) {
    const std::string& name = equations.system->coordinates[i].name;
    EquationLine line{name, {}, {}, {}, derivation.equations[i]};
    if (as_residual) {
      line.left_plain = fmt::format("R[{}]", name);
      line.left_latex = fmt::format("R_{{{}}}", symbol_to_latex(equations.system->coordinates[i].q));
      line.left_mathml = fmt::format("<msub><mi>R</mi>{}</msub>", to_mathml(equations.system->coordinates[i].q, {}));
    }
    form.lines.push_back(std::move(line));
  }
  form.intermediates = derivation.intermediates;
  return form;
}

EquationForm solved_form(Study& study) {
  const EquationsOfMotion& equations = *study.equations();
  EquationForm form;
  ExprMap solution;
  for (const SolvedAcceleration& solved : solved_accelerations(equations.shown())) {
    const std::string& name = equations.system->coordinates[solved.coordinate].name;
    const Expr left = acceleration(equations, solved.coordinate);
    if (!solved.right.value) {
      study.diagnostics().error(
          "E0692", {}, fmt::format("{} is coupled with {} other accelerations.", symbol_to_plain(left), solved.coupled_with.size() - 1),
          "Written out, the inverse of their mass matrix would fill pages and help nobody; runs factor it numerically.",
          "`--form matrix` shows M and h of M q'' + h = 0.");
      return {};
    }
    form.lines.push_back({name, symbol_to_plain(left), symbol_to_latex(left), to_mathml(left, equations.order),
                          solved.right});
    append(form.intermediates, solved.right.intermediates);
    solution[left] = without_intermediates(solved.right.value, solved.right.intermediates);
  }
  // Put into R they must annihilate it.
  std::vector<Expr> residual = expand_time_derivatives(std::span<const Expr>(equations.residual));
  return proved(substitute(residual, solution), "solved", study) ? form : EquationForm{};
}

EquationForm matrix_form(Study& study) {
  const EquationsOfMotion& equations = *study.equations();
  const auto& coordinates = equations.system->coordinates;
  const std::size_t n = coordinates.size();
  const ExprMatrix m = mass_matrix(equations.shown());
  const ExprVector h = bias(equations.shown());
  EquationForm form;
  const auto add = [&](std::size_t i, EquationLine line, Expr value) -> Expr {
    ReadableForm shown = readable(value, equations.order);
    append(form.intermediates, shown.intermediates);
    const Expr whole = without_intermediates(shown.value, shown.intermediates);
    line.coordinate = coordinates[i].name;
    line.right = std::move(shown);
    form.lines.push_back(std::move(line));
    return whole;
  };
  std::vector<Expr> rows(n, equations.system->context->number(0));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j) {
      EquationLine line{{}, fmt::format("M[{}, {}]", coordinates[i].name, coordinates[j].name),
                        fmt::format("M_{{{},{}}}", i + 1, j + 1),
                        fmt::format("<msub><mi>M</mi><mrow><mn>{}</mn><mo>,</mo><mn>{}</mn></mrow></msub>", i + 1, j + 1), {}};
      const Expr entry = add(i, std::move(line), m.at(i, j));
      rows[i] = rows[i] + entry * acceleration(equations, j);
      if (j != i) rows[j] = rows[j] + entry * acceleration(equations, i);
    }
  for (std::size_t i = 0; i < n; ++i) {
    EquationLine line{{}, fmt::format("h[{}]", coordinates[i].name), fmt::format("h_{{{}}}", i + 1),
                      fmt::format("<msub><mi>h</mi><mn>{}</mn></msub>", i + 1), {}};
    rows[i] = rows[i] + add(i, std::move(line), h[i]) - equations.residual[i];
  }
  return proved(rows, "matrix", study) ? form : EquationForm{};
}

/// The definitions of the model that the lines use, before their named sub-expressions.
EquationForm with_definitions(EquationForm form, Study& study) {
  std::vector<Expr> roots;
  for (const EquationLine& line : form.lines) roots.push_back(line.right.value);
  for (const Intermediate& i : form.intermediates) roots.push_back(i.value);
  if (roots.empty()) return form;
  std::vector<Intermediate> legend = definitions_used(*study.equations()->shown().system, roots);
  append(legend, form.intermediates);
  form.intermediates = std::move(legend);
  return form;
}

/// The letters and signs of rules and sentences that pdflatex does not know by itself.
std::string unicode_declarations() {
  constexpr std::pair<const char*, const char*> signs[] = {
      {"03B1", "\\alpha"}, {"03B2", "\\beta"}, {"03B3", "\\gamma"}, {"03B4", "\\delta"}, {"03B5", "\\varepsilon"},
      {"03B6", "\\zeta"}, {"03B7", "\\eta"}, {"03B8", "\\theta"}, {"03B9", "\\iota"}, {"03BA", "\\kappa"},
      {"03BB", "\\lambda"}, {"03BC", "\\mu"}, {"03BD", "\\nu"}, {"03BE", "\\xi"}, {"03BF", "o"}, {"03C0", "\\pi"},
      {"03C1", "\\rho"}, {"03C3", "\\sigma"}, {"03C4", "\\tau"}, {"03C5", "\\upsilon"}, {"03C6", "\\varphi"},
      {"03C7", "\\chi"}, {"03C8", "\\psi"}, {"03C9", "\\omega"}, {"0393", "\\Gamma"}, {"0394", "\\Delta"},
      {"0398", "\\Theta"}, {"039B", "\\Lambda"}, {"039E", "\\Xi"}, {"03A0", "\\Pi"}, {"03A3", "\\Sigma"},
      {"03A5", "\\Upsilon"}, {"03A6", "\\Phi"}, {"03A8", "\\Psi"}, {"03A9", "\\Omega"}, {"2202", "\\partial"},
      {"2211", "\\sum"}, {"2212", "-"}, {"22C5", "\\cdot"}, {"2248", "\\approx"}, {"2261", "\\equiv"},
      {"2260", "\\ne"}, {"1E59", "\\dot{r}"}, {"1E8B", "\\dot{x}"}, {"1E8F", "\\dot{y}"}, {"0307", "\\dot{}"},
      {"0308", "\\ddot{}"}, {"2080", "{}_0"}, {"2081", "{}_1"}, {"2082", "{}_2"}, {"1D40", "{}^{T}"},
      {"1D62", "{}_i"}, {"2C7C", "{}_j"}, {"2192", "\\to"}};
  std::string out;
  for (const auto& [code, command] : signs)
    out += fmt::format("\\DeclareUnicodeCharacter{{{}}}{{\\ensuremath{{{}}}}}\n", code, command);
  return out;
}

}  // namespace

EquationForm equation_form(Form form, Study& study) {
  if (!study.equations()) return {};
  switch (form) {
    case Form::Standard: return standard_form(study, false);
    case Form::Solved: return with_definitions(solved_form(study), study);
    case Form::Matrix: return with_definitions(matrix_form(study), study);
    case Form::Residual: return standard_form(study, true);
  }
  return {};
}

EquationLine definition_line(const Intermediate& intermediate, const ReadingOrder& order) {
  const Expr name = intermediate.symbol;
  EquationLine line{{}, to_plain(name, order), to_latex(name, order), to_mathml(name, order), {}};
  line.right.value = intermediate.value;
  return line;
}

std::string to_text(const EquationLine& line, Notation notation, const ReadingOrder& order) {
  const bool residual = line.left_plain.empty();
  switch (notation) {
    case Notation::Plain: {
      const std::string right = to_plain(line.right, order);
      return residual ? right + " = 0" : line.left_plain + " = " + right;
    }
    case Notation::Latex: {
      const std::string right = to_latex(line.right, order);
      return residual ? right + " &= 0" : line.left_latex + " &= " + right;
    }
    case Notation::Mathml: {
      const std::string right = to_mathml(line.right, order);
      return residual ? right + "<mo>=</mo><mn>0</mn>" : line.left_mathml + "<mo>=</mo>" + right;
    }
  }
  return {};
}

std::string latex_document(const std::vector<std::string>& lines) {
  return fmt::format(
      "\\documentclass{{article}}\n\\usepackage[a3paper,landscape,margin=2cm]{{geometry}}\n\\usepackage{{amsmath}}\n"
      "\\allowdisplaybreaks\n{}\\begin{{document}}\n\\begin{{align*}}\n{}\n\\end{{align*}}\n\\end{{document}}\n",
      unicode_declarations(), fmt::join(lines, " \\\\\n"));
}

std::string mathml_document(const std::vector<std::string>& rows) {
  std::string out = "<math xmlns=\"http://www.w3.org/1998/Math/MathML\" display=\"block\">\n<mtable columnalign=\"left\">\n";
  for (const std::string& row : rows) out += "<mtr><mtd><mrow>" + row + "</mrow></mtd></mtr>\n";
  return out + "</mtable>\n</math>\n";
}

}  // namespace maupertuis::app

#include "questions.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

/// Errors that runs of fields tell, beside what they are: of all models with closed forms, on meshes that rounding does
/// not hide, of values, slopes and velocities at borders of cells and between them.
using namespace maupertuis;

namespace {

/// A model of models/fields on another mesh; errors below `rounding` are not told apart.
struct Case {
  const char *model, *mesh;
  double rounding;
  double above = 5;  // what is told beside what is, at most
};

std::string text_of(const Case& c) {
  std::ifstream file(std::string(PROJECT_DIR) + "/models/fields/" + c.model + ".lag");
  std::stringstream text;
  text << file.rdbuf();
  const std::regex mesh("cells \\d+(, \\d+)?( order \\d+)?");
  return std::regex_replace(text.str(), mesh, c.mesh, std::regex_constants::format_first_only);
}

/// Values, slopes and velocities of the first field at places x (in the plane on a line y = const), and what they are.
struct Asked {
  std::vector<FieldQuestion> questions;
  std::vector<double> exact;
  std::vector<std::size_t> kinds;
};

double number(const FieldModel& m, Expr e) {
  Bindings values;
  for (const Parameter& p : m.parameters) values[p.symbol] = p.si_value;
  return evaluate(m.system.expanded(e), values);
}

std::vector<double> place_in(const FieldModel& m, double part) {
  std::vector<double> out;
  for (const SpaceVariable& x : m.system.space) {
    const double from = number(m, x.from), to = number(m, x.to);
    out.push_back(from + (to - from) * (out.empty() ? part : 0.4071));
  }
  return out;
}

Asked asked_of(const FieldModel& m, const std::vector<AskedFormula>& formulas, const std::vector<double>& parts) {
  const field_expectation::Solution* solution = nullptr;
  for (const FieldExpectationLine& line : m.expectations)
    if (const auto* s = std::get_if<field_expectation::Solution>(&line.kind)) solution = s;
  REQUIRE(solution);
  Asked out;
  const Expr x = m.system.space[0].symbol, t = m.system.context->time();
  const Expr u = m.system.expanded(solution->values[0]), values[] = {u, differentiate(u, x), differentiate(u, t)};
  for (std::size_t i = 0; i < formulas.size(); ++i)
    for (const double time : {0.31, 0.77}) {
      Bindings at;
      for (const Parameter& p : m.parameters) at[p.symbol] = p.si_value;
      const std::vector<double> place = place_in(m, parts[i / 3]);
      for (std::size_t d = 0; d < place.size(); ++d) at[m.system.space[d].symbol] = place[d];
      at[t] = time;
      out.questions.push_back({m.system.expanded(formulas[i].value), false, time});
      out.exact.push_back(evaluate(values[i % 3], at));
      out.kinds.push_back(i % 3);
    }
  return out;
}

void ask_for(Study& study, const std::string& text, const std::vector<double>& parts) {
  Study first(SourceText("field.lag", text));
  REQUIRE(first.model());
  const FieldModel& m = *first.model()->fields;
  for (const double part : parts) {
    std::string at;
    const std::vector<double> place = place_in(m, part);
    for (std::size_t d = 0; d < place.size(); ++d)
      at += fmt::format("{}{:.17g}{}", d ? ", " : "", place[d],
                        to_string(m.system.space[d].dimension) == "m" ? " m" : "");
    const std::string name = m.system.fields[0].name, x = m.system.space[0].name;
    for (const std::string& jet : {name, name + "_" + x, name + "_t"})
      study.ask("column", fmt::format("{}({})", jet, at));
  }
}

}  // namespace

TEST_CASE("the error of a mass at the tip of a beam is told by its own motion, not by the waves beside it") {
  const char* text =
      "dimensionless\nfield w(x) : number on x = 0 .. 1 cells {} order {}\ndensity = 1/2 w'^2 - 1/2 w_xx^2\n"
      "boundary left : w = 0, w_x = 0\nT = 1/4 w(1)'^2\nstart w = 0.01 (3 x^2 - x^3)/6\nrun 0.3\n"
      "expect w(1) at 0.1 = 0 ± 1\nexpect w(1) at 0.3 = 0 ± 1\n";
  const double exact[] = {3.254925177592999e-3, 2.736546166432753e-3};  // the sum over 110 modes, models/fields
  for (const auto& [cells, order] : {std::pair{4, 9}, std::pair{5, 9}, std::pair{3, 11}}) {
    CAPTURE(cells);
    CAPTURE(order);
    Study study(SourceText("test.lag", fmt::format(fmt::runtime(text), cells, order)));
    REQUIRE(study.field_equations());
    FieldRunOptions options;
    options.duration = 0.3;
    const auto run =
        run_coupled(*study.model(), *study.field_equations(), questions_of(study), options, study.diagnostics());
    REQUIRE(run);
    for (std::size_t i = 0; i < 2; ++i) {
      const double off = std::abs(run->answers[i].value - exact[i]);
      CHECK(off < run->answers[i].error);
      CHECK(run->answers[i].error < 6 * off);
    }
  }
}

TEST_CASE("errors that are told beside those that are: between a fifth and five times, of values, slopes, velocities") {
  const Case cases[] = {
      {"sine_gordon_kink", "cells 400 order 4", 1e-13}, {"sine_gordon_kink", "cells 175 order 5", 1e-13},
      {"maxwell_cavity", "cells 20 order 4", 1e-13},    {"maxwell_cavity", "cells 8 order 6", 1e-13},
      {"maxwell_cavity", "cells 12 order 3", 1e-13},    {"maxwell_cavity", "cells 40 order 2", 1e-13},
      {"timoshenko_beam", "cells 24 order 4", 1e-12},   {"membrane", "cells 10, 10 order 4", 1e-12},
      {"damped_string", "cells 10 order 4", 1e-14},     {"euler_bernoulli", "cells 8 order 7", 2e-11},
      {"euler_bernoulli", "cells 16 order 5", 2e-11},   {"rayleigh_beam", "cells 10 order 7", 2e-11},
      {"mkdv", "cells 150 order 7", 1e-9, 16},          {"hinged_plate", "cells 4, 3 order 6", 1e-12}};
  for (const Case& c : cases) {
    const std::string text = text_of(c);
    const std::vector<double> parts = {0.25, 0.3371, 0.61};
    Study study(SourceText("field.lag", text));
    ask_for(study, text, parts);
    REQUIRE(study.field_equations());
    const FieldModel& m = *study.model()->fields;
    const Asked asked = asked_of(m, study.model()->experiment.asked, parts);
    FieldRunOptions options;
    options.duration = 0.77;
    Diagnostics diagnostics;
    const auto run = run_fields(*study.field_equations(), asked.questions, options, diagnostics);
    REQUIRE(run);
    double largest[3] = {};
    for (std::size_t i = 0; i < asked.exact.size(); ++i)
      largest[asked.kinds[i]] = std::max(largest[asked.kinds[i]], std::abs(run->answers[i].value - asked.exact[i]));
    for (std::size_t i = 0; i < asked.exact.size(); ++i) {
      const double error = std::abs(run->answers[i].value - asked.exact[i]), told = run->answers[i].error;
      CAPTURE(std::string(c.model));
      CAPTURE(std::string(c.mesh));
      CAPTURE(i);
      CAPTURE(error);
      CAPTURE(told);
      CHECK(error < 5 * told);
      // An error may go through zero; a tenth of the largest of its kind counts for it.
      const double size = std::max(error, largest[asked.kinds[i]] / 10);
      CHECK(told < c.above * std::max(size, c.rounding));
    }
  }
}

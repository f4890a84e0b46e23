#include "questions.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/field_run.hpp>
#include <maupertuis/study.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

/// Ends that are moved, turned or pushed by what switches at a moment, against d'Alembert's solution.
using namespace maupertuis;

namespace switching_test {
namespace {

struct Asked {
  double x, t, expected;
};

/// Errors lie within their estimates, which are not larger than `most`; the codes that were told.
std::string check_run(const std::string& model, const std::vector<Asked>& asked, double most) {
  std::string text = "dimensionless\n" + model + "start u = 0\nrun 1.5\n";
  const std::string y = model.find("u(x, y)") == std::string::npos ? "" : ", 0.2";
  for (const Asked& a : asked) text += fmt::format("expect u({}{}) at {} = 0 ± 1\n", a.x, y, a.t);
  Study study(SourceText("switching.lag", text));
  REQUIRE(study.field_equations());
  const std::vector<FieldQuestion> questions = questions_of(study);
  FieldRunOptions options;
  options.duration = 1.5;
  const auto run = run_fields(*study.field_equations(), questions, options, study.diagnostics());
  REQUIRE(run);
  REQUIRE(run->answers.size() == asked.size());
  for (std::size_t i = 0; i < asked.size(); ++i) {
    CAPTURE(model);
    CAPTURE(asked[i].x);
    CHECK(std::abs(run->answers[i].value - asked[i].expected) <= run->answers[i].error);
    CHECK(run->answers[i].error <= most);
  }
  std::string out;
  for (const Diagnostic& d : study.diagnostics().items()) out += d.code + " ";
  return out;
}

const std::string string = "field u(x) : number on x = 0 .. 1 cells 40\ndensity = 1/2 u'^2 - 1/2 u_x^2\n";

/// What runs in from the left and comes back from a held right end until t = 2.
std::vector<Asked> waves_from_left(const std::function<double(double)>& given) {
  std::vector<Asked> out;
  for (const auto& [x, t] : {std::pair{0.0, 1.2}, {0.2, 1.0}, {0.47, 1.3}, {0.2, 1.45}})
    out.push_back({x, t, given(t - x) - given(t - 2 + x)});
  return out;
}

}  // namespace

TEST_CASE("an end that is moved by a motion with kinks") {
  const auto moved = [](const std::string& motion, double most, const std::function<double(double)>& given) {
    return check_run(string + "boundary left : u = " + motion + "\nboundary right : u = 0\n", waves_from_left(given),
                     most);
  };
  const auto ramp = [](double s) { return std::max(s - 0.4, 0.0); };
  CHECK(moved("piecewise(t < 0.4 : 0, else : t - 0.4)", 2e-3, ramp) == "W0650 ");
  CHECK(moved("0.5*(t - 0.4 + abs(t - 0.4))", 2e-3, ramp) == "W0650 ");
  CHECK(moved("min(t, 0.5)^2", 2e-3, [](double s) { return s > 0 ? std::pow(std::min(s, 0.5), 2) : 0; }) == "W0650 ");
  CHECK(moved("piecewise(t < 0.4 : 0, else : 1)", 0.2, [](double s) { return s > 0.4 ? 1.0 : 0.0; }) == "W0650 ");
  CHECK(moved("max(0, sin(5 t))^2", 5e-3,
              [](double s) { return s > 0 ? std::pow(std::max(0.0, std::sin(5 * s)), 2) : 0; }) == "");
  CHECK(moved("piecewise(t < 0.4 : 0, else : (t - 0.4)^2)", 1e-4, [&](double s) { return ramp(s) * ramp(s); }) == "");
  CHECK(moved("(t - 0.4)^3*step(t - 0.4)", 1e-5, [&](double s) { return std::pow(ramp(s), 3); }) == "");
}

TEST_CASE("slopes and forces at an end that set in with a kink") {
  const auto sent = [](double s) { return std::pow(std::max(s - 0.4, 0.0), 2) / 2; };
  CHECK(check_run(string + "boundary left : u_x = piecewise(t < 0.4 : 0, else : 0.4 - t)\nboundary right : u = 0\n",
                  waves_from_left(sent), 1e-4) == "");
  CHECK(check_run(string + "boundary right : u = 0\nforce u(0) = piecewise(t < 0.4 : 0, else : t - 0.4)\n",
                  waves_from_left(sent), 1e-4) == "");
}

TEST_CASE("a side of a membrane that is moved by a motion with a kink") {
  const std::string membrane =
      "field u(x, y) : number on x = 0 .. 1, y = 0 .. 0.5 cells 12\ndensity = 1/2 u'^2 - 1/2 u_x^2 - 1/2 u_y^2\n"
      "boundary left : u = piecewise(t < 0.4 : 0, else : t - 0.4)\nboundary right : u = 0\n";
  CHECK(check_run(membrane, waves_from_left([](double s) { return std::max(s - 0.4, 0.0); }), 2e-2) == "W0650 ");
}

TEST_CASE("no error is known where a pulse is shorter than a step") {
  Study study(SourceText("pulse.lag", "dimensionless\n" + string +
                                          "boundary left : u = exp(-((t - 0.4321)/1e-6)^2)\nstart u = 0\nrun 1\n"
                                          "expect u(0.5) at 1 = 0 ± 0.1\n"));
  const auto found = study.verification({});
  REQUIRE(found);
  CHECK_FALSE(found->results.at(0).passed);
}

}  // namespace switching_test

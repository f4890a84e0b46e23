#include <maupertuis/field_run.hpp>
#include <maupertuis/study.hpp>
#include "../under_sanitizers.hpp"

#include <doctest/doctest.h>

#include <cmath>

/// Fields in the plane against closed forms, and against fields of one variable where nothing changes along the other.
using namespace maupertuis;

namespace {

struct Answers {
  std::vector<double> values, errors;
  double drift = 0;
};

/// Values of what the `expect` lines name as places, in their order.
Answers answers_of(const std::string& text, double time, bool errors = false, double every = 0) {
  Study study(SourceText("field.lag", text));
  const FieldEquations* equations = study.field_equations();
  REQUIRE_MESSAGE(equations, text);
  std::vector<FieldQuestion> questions;
  for (const PlaceValue& place : study.model()->fields->places) questions.push_back({place.symbol, false, time});
  FieldRunOptions options;
  options.duration = time, options.errors = errors, options.every = every;
  Diagnostics diagnostics;
  const auto run = run_fields(*equations, questions, options, diagnostics);
  REQUIRE_MESSAGE(run, text);
  Answers out;
  for (const auto& answer : run->answers) out.values.push_back(answer.value), out.errors.push_back(answer.error);
  out.drift = run->energy_drift;
  return out;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

constexpr double pi = 3.14159265358979323846;

}  // namespace

TEST_CASE("a membrane swings with its closed form, and the estimate tells the error") {
  const Answers found = answers_of(
      "dimensionless\nparam c = 2\nfield u(x, y) : number on x = 0 .. 1, y = -1 .. 0.5 cells 9, 12 order 4 boundary u "
      "= 0\ndensity = 1/2 u'^2 - 1/2 c^2 (u_x^2 + u_y^2)\nstart u = sin(2 pi x) sin(2 pi (y + 1)/3)\nrun 1\n"
      "expect u(0.3, 0.2) at 1 = 0 ± 1\nexpect u(1/3, -0.5) at 1 = 0 ± 1\nexpect u_y(0.3, 0.2) at 1 = 0 ± 1\n",
      1, true);
  const double swing = std::cos(2 * pi * std::sqrt(4 + 4.0 / 9));
  const double expected[] = {std::sin(0.6 * pi) * std::sin(0.8 * pi) * swing,
                             std::sin(2 * pi / 3) * std::sin(pi / 3) * swing,
                             std::sin(0.6 * pi) * 2 * pi / 3 * std::cos(0.8 * pi) * swing};
  for (std::size_t i = 0; i < 3; ++i) {
    const double error = std::abs(found.values[i] - expected[i]);
    CHECK(error < (i == 1 ? 1e-6 : 1e-4));
    CHECK(error < 5 * found.errors[i]);
  }
  CHECK(found.drift < 1e-14);
}

TEST_CASE("a field alone, whose stiffness is one matrix, moves as by its stresses and beside another field") {
  // With ε = 1e-300 the factors are 1 in every digit, and the stresses are no plain slopes any more.
  const auto moved = [](const std::string& fields, const std::string& factor, int order, int cells,
                        const std::string& more) {
    return answers_of(
        "dimensionless\nparam ε = 1e-300\nfield " + fields + " : number on x = 0 .. 1, y = 0 .. 2 cells " +
            std::to_string(cells) + ", 3 order " + std::to_string(order) +
            "\nboundary left : u = 0\nboundary right : u_x = 1/5\ndensity = u'^2 - 3/2 " + factor + " u_x^2 - 1/2 " +
            factor + " u_y^2" + more + "\nstart u = x exp(x - y), u' = sin(x y)\nrun 1\n" +
            "expect u(0.4, 0.3) at 1 = 0 ± 1\nexpect u(0.9, 1.7) at 1 = 0 ± 1\n",
        1);
  };
  for (const int order : {2, 3, 4, 5, 7})
    for (const int cells : {3, 9})
      for (const std::string more : {"", " - cosh(u)", " - 1/10 cos(x) u u_y"}) {
        if (cells == 9 && !more.empty()) continue;  // more rows of elements than lanes: once an order is enough
        const Answers one = moved("u(x, y)", "", order, cells, more),
                      by_stresses = moved("u(x, y)", "(1 + ε x)", order, cells, more),
                      of_two = moved("u(x, y), v(x, y)", "", order, cells, more + " + 1/2 v'^2 - 1/2 v_x^2");
        for (std::size_t i = 0; i < 2; ++i) {
          CHECK(one.values[i] == doctest::Approx(by_stresses.values[i]).epsilon(1e-12));
          CHECK(one.values[i] == doctest::Approx(of_two.values[i]).epsilon(1e-12));
        }
      }
}

TEST_CASE("the plane converges with the power 2p where elements meet") {
  const auto error = [](int cells) {
    const Answers found = answers_of(
        "dimensionless\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1 cells " + std::to_string(cells) + ", " +
            std::to_string(cells) +
            " order 2 boundary u = 0\ndensity = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2)\nstart u = sin(pi x) sin(pi y)\nrun "
            "1\nexpect u(0.5, 0.5) at 0.5 = 0 ± 1\n",
        0.5);
    return std::abs(found.values[0] - std::cos(pi / std::sqrt(2)));
  };
  CHECK(std::log2(error(8) / error(16)) > 3.7);
}

TEST_CASE("a wave runs around a periodic plane") {
  const Answers found = answers_of(
      "dimensionless\nparam m = 3\nlet w = sqrt(20 pi^2 + m^2)\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1 cells "
      "8, "
      "12 order 6 boundary periodic\ndensity = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2 + m^2 u^2)\n"
      "start u = cos(2 pi (x + 2 y)), u' = w sin(2 pi (x + 2 y))\nrun 1\nexpect u(0, 0) at 0.7 = 0 ± 1\n"
      "expect u(0.125, 0.5) at 0.7 = 0 ± 1\n",
      0.7);
  const double w = std::sqrt(20 * pi * pi + 9);
  CHECK(std::abs(found.values[0] - std::cos(0.7 * w)) < 1e-7);
  CHECK(std::abs(found.values[1] - std::cos(2 * pi * 1.125 - 0.7 * w)) < 1e-7);
  CHECK(found.drift < 1e-12);
}

TEST_CASE("a wave runs around a strip that is closed along one direction") {
  const std::string text =
      "dimensionless\nlet w = sqrt(1 + pi^2)\nfield u(x, y) : number on x = 0 .. 2 pi, y = 0 .. 1 cells 8, 5 order 6 "
      "boundary periodic x\nboundary u = 0\ndensity = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2)\n"
      "start u = sin(pi y) cos(x), u' = w sin(pi y) sin(x)\nrun 1\nexpect u(1/2, 3/10) at 1 = 0 ± 1\n"
      "expect u(0, 1/2) at 1 = 0 ± 1\nexpect u(2 pi, 1/2) at 1 = 0 ± 1\n";
  std::string turned = replaced(text, "x = 0 .. 2 pi, y = 0 .. 1 cells 8, 5", "x = 0 .. 1, y = 0 .. 2 pi cells 5, 8");
  turned = replaced(replaced(turned, "periodic x", "periodic y"), "sin(pi y)", "sin(pi X)");
  turned = replaced(replaced(turned, "cos(x)", "cos(y)"), "sin(x)", "sin(y)");
  turned = replaced(replaced(turned, "sin(pi X)", "sin(pi x)"), "u(1/2, 3/10)", "u(3/10, 1/2)");
  turned = replaced(replaced(turned, "u(0, 1/2)", "u(1/2, 0)"), "u(2 pi, 1/2)", "u(1/2, 2 pi)");
  for (const std::string& one : {text, turned}) {
    const Answers found = answers_of(one, 1, true);
    const double w = std::sqrt(1 + pi * pi);
    const double expected[] = {std::sin(0.3 * pi) * std::cos(0.5 - w), std::cos(w), std::cos(w)};
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(std::abs(found.values[i] - expected[i]) < 1e-6);
      CHECK(std::abs(found.values[i] - expected[i]) < 5 * found.errors[i]);
    }
    CHECK(found.drift < 1e-13);
  }
}

TEST_CASE("a plate and a field of first order on a cylinder") {
  // ω = k² + l² of a hinged plate, (k² + l²)/2 of a free particle in a waveguide
  const std::string strip = " on x = 0 .. 2 pi, y = 0 .. 1 cells 4, 2 order 7 boundary periodic x\n";
  const double w = 1 + pi * pi;
  const Answers plate = answers_of("dimensionless\nlet w0 = 1 + pi^2\nfield w(x, y) : number" + strip +
                                       "boundary w = 0\ndensity = 1/2 w'^2 - 1/2 (w_xx + w_yy)^2\n"
                                       "start w = sin(pi y) cos(x), w' = w0 sin(pi y) sin(x)\nrun 0.2\n"
                                       "expect w(1, 1/2) at 0.2 = 0 ± 1\n",
                                   0.2);
  CHECK(std::abs(plate.values[0] - std::cos(1 - 0.2 * w)) < 1e-5);
  const Answers wave = answers_of("dimensionless\nfield a(x, y), b(x, y) : number" + strip +
                                      "boundary a = 0, b = 0\n"
                                      "density = a' b - b' a - 1/2 (a_x^2 + a_y^2 + b_x^2 + b_y^2)\n"
                                      "start a = sin(pi y) cos(x), b = sin(pi y) sin(x)\nrun 0.3\n"
                                      "expect a(1, 1/2) at 0.3 = 0 ± 1\n",
                                  0.3);
  const double turn = 0.3 * w / 2;
  CHECK(std::min(std::abs(wave.values[0] - std::cos(1 - turn)), std::abs(wave.values[0] - std::cos(1 + turn))) < 1e-5);
}

TEST_CASE("a mass that changes with the field: e^u is a free wave") {
  const Answers found = answers_of(
      "dimensionless\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1 cells 6, 5 order 6 boundary u = log(2)\n"
      "density = 1/2 exp(2 u) (u'^2 - u_x^2 - u_y^2)\nstart u = log(2 + sin(pi x) sin(pi y))\nrun 1\n"
      "expect u(0.5, 0.4) at 0.6 = 0 ± 1\n",
      0.6);
  const double phi = 2 + std::sin(0.4 * pi) * std::cos(0.6 * pi * std::sqrt(2));
  CHECK(std::abs(found.values[0] - std::log(phi)) < 1e-7);
  CHECK(found.drift < 1e-12);
}

TEST_CASE("two fields with a common kinetic term swing in their sum and their difference") {
  const Answers found = answers_of(
      "dimensionless\nfield a(x, y), b(x, y) : number on x = 0 .. 1, y = 0 .. 1 cells 6, 6 order 6\n"
      "boundary left : a = 0, b = 0\nboundary right : a = 0, b = 0\nboundary bottom : a = 0, b = 0\n"
      "boundary top : a = 0, b = 0\n"
      "density = 1/2 a'^2 + 1/2 b'^2 + 1/2 a' b' - 1/2 (a_x^2 + a_y^2 + b_x^2 + b_y^2)\n"
      "start a = sin(pi x) sin(pi y)\nrun 1\nexpect a(0.5, 0.5) at 0.8 = 0 ± 1\nexpect b(0.5, 0.5) at 0.8 = 0 ± 1\n",
      0.8);
  const double sum = std::cos(0.8 * pi * std::sqrt(2 / 1.5)), difference = std::cos(0.8 * pi * std::sqrt(2 / 0.5));
  CHECK(std::abs(found.values[0] - (sum + difference) / 2) < 1e-7);
  CHECK(std::abs(found.values[1] - (sum - difference) / 2) < 1e-7);
}

TEST_CASE("what does not change along one direction is the field of the other" * doctest::skip(under_sanitizers)) {
  const std::string line[] = {
      // a kink
      "dimensionless\nfield u(x) : number on x = -6 .. 6 cells 60 order 4\ndensity = 1/2 u'^2 - 1/2 u_x^2 - (1 - cos "
      "u)\n"
      "start u = 4 atan(exp(x/0.8)), u' = -1.5 sech(x/0.8)\nrun 2\nexpect u(0.4) at 2 = 0 ± 1\n"
      "expect u(6) at 2 = 0 ± 1\n",
      // a density that changes along x, internal and external friction, a force, ends that are driven and pulled
      "dimensionless\nfield u(x) : number on x = -6 .. 6 cells 20 order 5\nboundary left : u = 1/10 sin(2 t)^2\n"
      "boundary right : u_x = 1/5 sin(t)\ndensity = 1/2 (2 + sin(x)) u'^2 - 1/2 (1 + x^2/40) u_x^2 - u^4\n"
      "dissipation density = 1/20 u'^2\nforce density u = x cos(t)\nrun 2\n"
      "expect u(0.4) at 2 = 0 ± 1\nexpect u(6) at 2 = 0 ± 1\n",
      // inertia that changes with the slope and the place
      "dimensionless\nfield u(x) : number on x = -6 .. 6 cells 20 order 5 boundary u = 0\n"
      "density = 1/2 (1 + x^2/50 + u_x^2/5) u'^2 - 1/2 u_x^2\ndissipation density = 1/200 u_tx^2\nstart u = sin(pi "
      "x/6)\nrun 2\n"
      "expect u(0.4) at 2 = 0 ± 1\nexpect u(3) at 2 = 0 ± 1\n"};
  constexpr double every = 0.01;  // so that none of them sees the lengths of its steps
  for (const std::string& text : line) {
    const Answers along = answers_of(text, 2, false, every);
    // Both ends of the line are given where it says `boundary u = 0`; in the plane two sides stay natural.
    std::string plane = replaced(replaced(text, "u(x)", "u(x, y)"), " cells ", ", y = 0 .. 3 cells ");
    plane = replaced(replaced(plane, "60 order", "60, 2 order"), "20 order", "20, 2 order");
    plane = replaced(plane, " boundary u = 0", "\nboundary left : u = 0\nboundary right : u = 0");
    for (const char* place : {"0.4", "6", "3"})
      plane = replaced(plane, "u(" + std::string(place) + ")", "u(" + std::string(place) + ", 1.1)");
    plane = replaced(plane, "- 1/2 u_x^2", "- 1/2 (u_x^2 + u_y^2)");
    plane = replaced(plane, "+ u_x^2/5", "+ u_x^2/5 + u_y^2/5");
    plane = replaced(plane, "1/200 u_tx^2", "1/200 (u_tx^2 + u_ty^2)");
    plane = replaced(plane, "x^2/40) u_x^2", "x^2/40) (u_x^2 + u_y^2)");
    const Answers across = answers_of(plane, 2, false, every);
    // The same with x and y exchanged.
    std::string turned = replaced(replaced(replaced(plane, "left", "bottom"), "right", "top"), "exp(", "EXP(");
    turned = replaced(replaced(turned, "boundary top : u_x", "boundary top : u_y"), "x", "X");
    turned =
        replaced(replaced(turned, "y = 0 .. 3", "x = 0 .. 3"), "X = -6 .. 6, x = 0 .. 3", "x = 0 .. 3, y = -6 .. 6");
    turned = replaced(replaced(turned, "u(X, y)", "u(x, y)"), "u_X^2 + u_y^2", "u_x^2 + u_y^2");
    turned = replaced(replaced(turned, "u_X^2/5 + u_y^2/5", "u_x^2/5 + u_y^2/5"), "u_tX^2 + u_ty^2", "u_tx^2 + u_ty^2");
    turned = replaced(replaced(turned, "EXP(", "exp("), "eXpect", "expect");
    for (const char* place : {"0.4", "6", "3"})
      turned = replaced(turned, "u(" + std::string(place) + ", 1.1)", "u(1.1, " + std::string(place) + ")");
    turned = replaced(replaced(turned, "cells 60, 2", "cells 2, 60"), "cells 20, 2", "cells 2, 20");
    turned = replaced(turned, "X", "y");
    const Answers upwards = answers_of(turned, 2, false, every);
    REQUIRE(along.values.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
      CAPTURE(text);
      CHECK(std::abs(along.values[i]) > 1e-3);
      CHECK(std::abs(across.values[i] - along.values[i]) < 2e-10);
      CHECK(std::abs(upwards.values[i] - along.values[i]) < 2e-10);
    }
  }
}

TEST_CASE("a plane that does not fit into the memory is told before it is made, and narrow bumps are") {
  const auto code_of = [](const std::string& text) {
    Study study(SourceText("field.lag", "dimensionless\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1 " + text));
    const FieldEquations* equations = study.field_equations();
    REQUIRE(equations);
    FieldRunOptions options;
    options.duration = 0.01;
    Diagnostics diagnostics;
    const auto run = run_fields(*equations, {}, options, diagnostics);
    return run ? std::string() : diagnostics.items().front().code;
  };
  // sixty fields' worth of pasts: terabytes
  std::string density = "density = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2)";
  for (int i = 1; i < 60; ++i) density += " + cos(" + std::to_string(i) + " u)";
  CHECK(code_of("cells 1000, 1000 order 20\n" + density + "\n") == "E0649");
  const std::string wave = "density = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2)\nstart u = ";
  CHECK(code_of("cells 10, 10\n" + wave + "exp(-((x - 0.4877)^2 + (y - 0.2311)^2)/1e-6)\n") == "E0647");
  CHECK(code_of("cells 10, 10\n" + wave + "exp(-((x - 0.4877)^2 + (y - 0.2311)^2)/0.05)\n").empty());
}

TEST_CASE("steps follow waves that become faster than at the start, and the estimate tells it") {
  struct Case {
    const char* text;
    double time, expected, most;
  };
  // q'' = −q³ of a uniform field, q'' = −π² exp(2 t) q, q'' = −r q' − π² q: by Runge and Kutta with 20,000 steps, and
  // in closed form.
  const Case cases[] = {
      {"field u(x) : number on x = 0 .. 10 cells 4 order 4 boundary periodic\ndensity = 1/2 u'^2 - 1/2 u_x^2 - 1/4 "
       "u^4\n"
       "start u = 10\nrun 3\nexpect u(5) at 3 = 0 ± 1\n",
       3, 9.454722525301229, 1e-5},
      {"field u(x) : number on x = 0 .. 1 cells 10 order 6 boundary u = 0\ndensity = 1/2 u'^2 - 1/2 exp(2 t) u_x^2\n"
       "start u = sin(pi x)\nrun 1\nexpect u(0.5) at 1 = 0 ± 1\n",
       1, 0.32562085579529954, 1e-10},
      {"field u(x) : number on x = 0 .. 1 cells 6 order 6 boundary u = 0\ndensity = 1/2 u'^2 - 1/2 u_x^2\n"
       "dissipation density = 450 u'^2\nstart u = sin(pi x)\nrun 0.5\nexpect u(0.5) at 0.5 = 0 ± 1\n",
       0.5, 0.9945439433394054, 1e-7}};
  for (const Case& c : cases) {
    CAPTURE(c.text);
    const Answers found = answers_of(std::string("dimensionless\n") + c.text, c.time, true);
    const double error = std::abs(found.values[0] - c.expected);
    CHECK(error < c.most);
    CHECK(error < 10 * found.errors[0]);
  }
}

TEST_CASE("waves of the plane that become faster in time: steps follow, and the estimate tells") {
  // u = a(t) sin(pi x) sin(pi y), a'' = -2 pi^2 (1 + 400 t) a: as of a line with twice the stiffness.
  const auto run = [](const std::string& field, const std::string& density, const std::string& start) {
    const std::string place = field.find("y") == std::string::npos ? "u(0.5)" : "u(0.5, 0.5)";
    Study asked(SourceText("asked.lag", "dimensionless\nfield " + field + " boundary u = 0\ndensity = 1/2 u'^2 - " +
                                            density + "\nstart u = " + start + "\nrun 1\nexpect " + place +
                                            " at 1 = 0 ± 9\n"));
    REQUIRE(asked.field_equations());
    FieldRunOptions options;
    options.duration = 1;
    Diagnostics diagnostics;
    const auto found = run_fields(*asked.field_equations(), {{asked.model()->fields->places[0].symbol, false, 1}},
                                  options, diagnostics);
    REQUIRE(found);
    return found->answers[0];
  };
  const auto line = run("u(x) : number on x = 0 .. 1 cells 40 order 6", "(1 + 400 t) u_x^2", "sin(pi x)");
  const auto plane = run("u(x, y) : number on x = 0 .. 1, y = 0 .. 1 cells 6, 6 order 4",
                         "1/2 (1 + 400 t) (u_x^2 + u_y^2)", "sin(pi x) sin(pi y)");
  CHECK(std::abs(line.value) < 1);
  CHECK(std::abs(plane.value - line.value) < 10 * plane.error);
  CHECK(plane.error < 1e-2);
}

#include <maupertuis/field_run.hpp>
#include <maupertuis/study.hpp>

#include "fields/collocation.hpp"
#include "fields/element.hpp"
#include "linear_algebra/banded.hpp"
#include "linear_algebra/mesh_matrix.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

using namespace maupertuis;

namespace {

constexpr double fundamental = std::numbers::pi * std::numbers::pi;  // frequency of the hinged beam of length 1

Study study_of_text(const std::string& text) { return Study(SourceText("field.lag", text)); }

/// The value of the only place of a model, at the end of its run.
FieldRunResult::Value value_at_end(const std::string& text, double end, bool errors = false) {
  Study study = study_of_text(text);
  REQUIRE(study.field_equations());
  REQUIRE(study.model()->fields->places.size() == 1);
  Diagnostics diagnostics;
  FieldRunOptions options;
  options.duration = end, options.errors = errors;
  const auto run = run_fields(*study.field_equations(), {{study.model()->fields->places[0].symbol, false, end}},
                              options, diagnostics);
  REQUIRE(run);
  return run->answers[0];
}

std::size_t steps_until(double end, const std::string& text) {
  Study study = study_of_text(text);
  REQUIRE(study.field_equations());
  Diagnostics diagnostics;
  FieldRunOptions options;
  options.duration = end, options.errors = false;
  const auto run = run_fields(*study.field_equations(), {}, options, diagnostics);
  REQUIRE(run);
  return run->steps;
}

/// All expectations of a model hold.
void holds(const std::string& text) {
  Study study = study_of_text(text);
  const auto verification = study.verification();
  REQUIRE(verification);
  for (const ExpectationResult& r : verification->results)
    CHECK_MESSAGE(r.passed, r.text << ": " << r.actual << " for " << r.expected << ". " << r.message);
  for (const Diagnostic& d : study.diagnostics().items()) CHECK_MESSAGE(d.code == "", d.code << " " << d.message);
}

std::string codes_of_run(const std::string& text) {
  Study study = study_of_text(text);
  study.verification();
  std::string out;
  for (const Diagnostic& d : study.diagnostics().items()) out += d.code;
  return out;
}

/// A travelling wave of a hinged beam w'' + w_xxxx = 0.
std::string beam(int cells, int order) {
  return "dimensionless\nfield w(x) : number on x = 0 .. 1 cells " + std::to_string(cells) + " order " +
         std::to_string(order) +
         " boundary w = 0\ndensity = 1/2 w'^2 - 1/2 w_xx^2\nstart w = sin(pi x)\nrun 1\nexpect w(0.5) at 0.2 = 0 ± 9\n";
}

/// A discrete field in motion, by hand.
struct Motion {
  Study study;
  std::optional<DensityForm> form;
  std::unique_ptr<CollocationMotion> motion;
  Motion(const std::string& text, int cells, int degree, int stages) : study(study_of_text(text)) {
    REQUIRE(study.field_equations());
    Diagnostics diagnostics;
    form = density_form(*study.field_equations(), diagnostics);
    REQUIRE(form);
    motion =
        std::make_unique<CollocationMotion>(*study.field_equations(), *form, std::vector<int>{cells}, degree, stages);
    motion->start();
    REQUIRE(motion->trouble() == "");
  }
  double at_end(int steps, double end, double x) {
    for (int i = 0; i < steps; ++i) REQUIRE(motion->step(end / steps));
    return motion->field_at(0, {0, {0}, 0}, {x});
  }
};

}  // namespace

TEST_CASE("functions of elements: derivatives, shared ends, projection of polynomials") {
  for (const bool smooth : {false, true})
    for (const int degree : {3, 7, 10}) {
      const Element e(smooth, degree);
      std::vector<double> low(e.size()), high(e.size()), slope(e.size());
      for (int k = 0; k < 3; ++k) {
        constexpr double x = 0.37, h = 1e-5;
        e.at(x - h, k, low.data()), e.at(x + h, k, high.data()), e.at(x, k + 1, slope.data());
        for (std::size_t i = 0; i < e.size(); ++i)
          CHECK((high[i] - low[i]) / (2 * h) == doctest::Approx(slope[i]).epsilon(1e-6).scale(10));
      }
      for (const double end : {-1.0, 1.0})
        for (int k = 0; k < (smooth ? 2 : 1); ++k) {
          e.at(end, k, low.data());
          for (std::size_t i = 0; i < e.size(); ++i) {
            const std::size_t own = (end < 0 ? 0 : e.at_end()) + static_cast<std::size_t>(k);
            CHECK(std::abs(low[i] - (i == own ? 1 : 0)) < 1e-13);
          }
        }
      // u = ξ^degree
      const GaussRule rule(degree + 2);
      std::vector<double> highest, c(e.size(), 0);
      const int order = smooth ? 2 : 1;
      for (const double x : rule.x)
        highest.push_back((smooth ? degree * (degree - 1) : degree) * std::pow(x, degree - order));
      c[0] = degree % 2 ? -1 : 1, c[e.at_end()] = 1;
      if (smooth) c[1] = degree * (degree % 2 ? 1 : -1), c[3] = degree;
      e.project(rule, highest, c.data() + 2 * e.at_end());
      e.at(0.61, 0, low.data());
      double u = 0;
      for (std::size_t i = 0; i < e.size(); ++i) u += c[i] * low[i];
      CHECK(u == doctest::Approx(std::pow(0.61, degree)).epsilon(1e-12));
    }
}

TEST_CASE("banded factors with pivoting solve what a dense product made") {
  constexpr std::size_t n = 23, below = 3, above = 2;
  BandedMatrix<std::complex<double>> a(n, below, above);
  std::vector<std::complex<double>> x(n), b(n, 0);
  for (std::size_t j = 0; j < n; ++j) {
    x[j] = {std::sin(3.0 * j), std::cos(2.0 * j)};
    for (std::size_t i = a.first_row(j); i < a.end_row(j); ++i)  // small on the diagonal
      a.at(i, j) = {i == j ? 1e-9 : std::cos(7.0 * i + j), std::sin(1.0 * i * j)};
  }
  a.add_product(x.data(), b.data());
  REQUIRE(a.factor());
  a.solve(b.data());
  for (std::size_t i = 0; i < n; ++i) CHECK(std::abs(b[i] - x[i]) < 1e-11);
  BandedMatrix<double> singular(2, 1, 1);
  singular.at(0, 0) = singular.at(0, 1) = singular.at(1, 0) = singular.at(1, 1) = 1;
  CHECK_FALSE(singular.factor());
}

TEST_CASE("collocation is of order 2s in the step, and its coefficients are Gauss's") {
  for (const int stages : {1, 2, 3, 4}) {
    const CollocationTableau t(stages);
    const auto s = static_cast<std::size_t>(stages);
    double ends = 1;  // R(∞) = 1 − Σ d = (−1)^s
    for (std::size_t i = 0; i < s; ++i) {
      ends -= t.d[i];
      for (std::size_t j = 0; j < s; ++j)  // symplectic: b_i a_ij + b_j a_ji = b_i b_j
        CHECK(std::abs(t.b[i] * t.a[i * s + j] + t.b[j] * t.a[j * s + i] - t.b[i] * t.b[j]) < 1e-15);
    }
    CHECK(ends == doctest::Approx(stages % 2 ? -1 : 1));
  }
  for (const int stages : {2, 3}) {
    const auto error = [&](int steps) {
      return Motion(beam(4, 9), 4, 9, stages).at_end(steps, 0.8, 0.5) - std::cos(fundamental * 0.8);
    };
    CHECK(std::log2(std::abs(error(16) / error(32))) == doctest::Approx(2 * stages).epsilon(0.1));
  }
}

TEST_CASE("a beam converges with the power 2p − 2 at the borders of elements") {
  const double exact = std::cos(fundamental * 0.2);
  const double coarse = value_at_end(beam(2, 4), 0.2).value - exact;
  const double fine = value_at_end(beam(4, 4), 0.2).value - exact;
  CHECK(std::log2(std::abs(coarse / fine)) == doctest::Approx(6).epsilon(0.1));
  const auto told = value_at_end(beam(4, 7), 0.2, true);
  CHECK(std::abs(told.value - exact) < 1e-11);
  CHECK(std::abs(told.value - exact) < 5 * told.error);
}

TEST_CASE("a beam whose cells hold half-waves on half the mesh: the estimate tells the error") {
  // w = sin 3πx cos ωt on three cells is even in each, and nearer than belongs to their width: 8.7 times too low
  const double a = 3 * std::numbers::pi, turned = std::cos(a * a * 0.3);
  const std::pair<const char*, double> asked[] = {{"w_x(0.25)", a * std::cos(a * 0.25) * turned},
                                                  {"w_xx(0.37)", -a * a * std::sin(a * 0.37) * turned}};
  for (const auto& [what, exact] : asked) {
    const auto told = value_at_end(
        fmt::format("dimensionless\nfield w(x) : number on x = 0 .. 1 cells 6 order 8 boundary w = 0\n"
                    "density = 1/2 w'^2 - 1/2 w_xx^2\nstart w = sin(3 pi x)\nrun 0.3\nexpect {} at 0.3 = 0 ± 99\n",
                    what),
        0.3, true);
    CHECK(std::abs(told.value - exact) < 2 * told.error);
    CHECK(std::abs(told.value - exact) > told.error / 50);
  }
}

TEST_CASE("beams in motion: clamped and free end, rotary inertia, moment and force at an end") {
  holds(
      "dimensionless\nparam b = 1.87510406871196116645\n"
      "field w(x) : number on x = 0 .. 1 cells 8 order 8\ndensity = 1/2 w'^2 - 1/2 w_xx^2\n"
      "boundary left : w = 0, w_x = 0\nlet s = (cosh(b) + cos(b))/(sinh(b) + sin(b))\n"
      "start w = cosh(b x) - cos(b x) - s (sinh(b x) - sin(b x))\nrun 2\n"
      "expect w(1) at 2 = 2 cos(2*b^2) ± 1e-9\nexpect energy conserved rel 1e-13\n");
  holds(
      "dimensionless\nparam ρ = 1.1, I = 0.02, B = 0.9\nlet k = 3*pi/2, ω1 = k^2 sqrt(B/(ρ + I k^2))\n"
      "field w(x) : number on x = 0 .. 2 cells 8 order 9 boundary w = 0\n"
      "density = 1/2 ρ w'^2 + 1/2 I w_tx^2 - 1/2 B w_xx^2\nstart w = sin(k x)\nrun 1\n"
      "expect w(1) at 1 = -cos(ω1) ± 1e-9\nexpect energy conserved rel 1e-13\n");
  // Damped to rest under a force and a moment at the free end, w = F x²(3 − x)/6 + m x²/2. The force comes suddenly:
  // the highest frequencies are not damped away, which the estimates tell.
  const std::string loaded =
      "dimensionless\nfield w(x) : number on x = 0 .. 1 cells 4 order 5\ndensity = 1/2 w'^2 - 1/2 w_xx^2\n"
      "dissipation density = 4 w'^2\nboundary left : w = 0, w_x = 0\nforce w(1) = 0.3\nforce w_x(1) = 0.7\nrun 30\n";
  const auto end = value_at_end(loaded + "expect w(1) at 30 = 0 ± 9\n", 30, true);
  const auto slope = value_at_end(loaded + "expect w_x(1) at 30 = 0 ± 9\n", 30, true);
  CHECK(end.value == doctest::Approx(0.3 / 3 + 0.7 / 2).epsilon(1e-3));
  CHECK(slope.value == doctest::Approx(0.3 / 2 + 0.7).epsilon(1e-2));
  CHECK(std::abs(end.value - 0.45) < 3 * end.error);
  CHECK(std::abs(slope.value - 0.85) < 3 * slope.error);
  // An end that is moved: w = x² t² needs the force 2 x² along the beam
  holds(
      "dimensionless\nfield w(x) : number on x = 0 .. 1 cells 2 order 5\ndensity = 1/2 w'^2 - 1/2 w_xx^2\n"
      "force density w = 2 x^2\nboundary left : w = 0, w_x = 0\nboundary right : w = t^2, w_x = 2*t^2\nrun 1\n"
      "expect w(0.5) at 1 = 0.25 ± 1e-11\nexpect w_x(0.5) at 1 = 1 ± 1e-10\n");
}

TEST_CASE("solitons of fields of first order in time, with their charges") {
  holds(
      "dimensionless\nparam η = 1.3, v = 0.4\nfield a(x), b(x) : number on x = -16 .. 18 cells 60 order 9\n"
      "density = b a' - a b' - 1/2 (a_x^2 + b_x^2) + 1/2 (a^2 + b^2)^2\n"
      "start a = η sech(η x) cos(v x), b = η sech(η x) sin(v x)\nrun 2\n"
      "expect a(1) at 2 = η sech(η (1 - 2*v)) cos(v + η^2 - v^2) ± 1e-8\n"
      "expect b(1) at 2 = η sech(η (1 - 2*v)) sin(v + η^2 - v^2) ± 1e-8\n"
      "expect total a^2 + b^2 at 2 = 2*η ± 1e-8\nexpect total a b_x - b a_x at 2 = 2*η v ± 1e-8\n"
      "expect total a_x^2 + b_x^2 at 2 = 2*η v^2 + 2/3 η^3 ± 1e-8\nexpect energy conserved rel 1e-13\n");
  holds(
      "dimensionless\nfield w(x) : number on x = -36 .. 40 cells 76 order 9\ndensity = 1/2 w' w_x + w_x^3 - 1/2 "
      "w_xx^2\n"
      "boundary left : w = 0, w_x = 0\nboundary right : w = 2, w_x = 0\nstart w = 2/(1 + exp(-x))\nrun 2\n"
      "expect w(3) at 2 = 2/(1 + exp(-1)) ± 1e-8\nexpect w_x(3) at 2 = 1/2 sech(1/2)^2 ± 1e-7\n"
      "expect energy conserved rel 1e-13\n");
}

TEST_CASE("a potential on a ring keeps its constant, which is told") {
  // w_tx + w_xxxx = 0, waves ω = −k³: of u = w_x
  const std::string ring =
      "dimensionless\nfield w(x) : number on x = 0 .. 2*pi cells 6 order 10 boundary periodic\n"
      "density = 1/2 w' w_x - 1/2 w_xx^2\nstart w = cos(2*x)\nrun 1\nexpect w_x(1) at 1 = -2 sin(2 + 8) ± 1e-8\n";
  CHECK(codes_of_run(ring) == "N0648");
  Study study = study_of_text(ring);
  REQUIRE(study.verification());
  CHECK(study.verification()->failed() == 0);
  CHECK(codes_of_run("dimensionless\nfield w(x) : number on x = -20 .. 20 cells 40 order 7\n"
                     "density = 1/2 w' w_x + w_x^3 - 1/2 w_xx^2\nboundary left : w = 0, w_x = 0\n"
                     "boundary right : w_x = 0\nstart w = 2/(1 + exp(-x)) - 2/(1 + exp(20))\nrun 1\n"
                     "expect w_x(1) at 1 = 0 ± 9\n")
            .find("E0642") != std::string::npos);
}

TEST_CASE("an end that asks for two conditions where the equation takes one is refused") {
  // u u_xx = (u u_x)_x - u_x²: the equation is u'' = 3 u_xx, and free ends ask for u_x = 0 and u = 0.
  const auto codes = [](const std::string& ends, const std::string& more, const std::string& ask) {
    return codes_of_run("dimensionless\nfield u(x) : number on x = 0 .. 1 cells 4 order 7\n" + ends +
                        "density = 1/2 u'^2 - 1/2 u_x^2" + more +
                        "\nstart u = " + (ends.empty() ? "cos(pi x)" : "sin(pi x)") + "\nrun 1\n" + ask + "\n");
  };
  CHECK(codes("", " + u u_xx", "expect u(0.5) at 1 = 0 ± 9") == "E0642");
  CHECK(codes("", " + u u_xx", "expect frequencies of u : 1 rel 9").find("E0642") == 0);
  CHECK(codes("boundary left : u = 0\nboundary right : u = 0.1\n", " + u u_xx", "expect u(0.5) at 1 = 0 ± 9") ==
        "E0642");
  CHECK(codes("", " + u_x u_xx", "expect u(0) at 1 = -1 ± 1e-6") == "E0642");
  // Ends that are held at 0 say what the moment says.
  CHECK(codes("boundary left : u = 0\nboundary right : u = 0\n", " + u u_xx",
              "expect u(0.5) at 1 = cos(pi sqrt(3)) ± 1e-6") == "");
  // On a hinged square curvatures along its sides vanish with the deflection.
  CHECK(codes_of_run("dimensionless\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1 cells 2 order 5 boundary u = 0\n"
                     "density = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2) - 0.1 (u_xx u_yy - u_xy^2)\n"
                     "expect frequencies of u : pi sqrt(2) rel 1e-9\n") == "");
}

TEST_CASE("sparse factors of a mesh, within a band and without, solve what a product made") {
  // A line, whose band is narrow, and a square of 9 × 9 cells with a node at each corner.
  std::vector<std::vector<std::size_t>> line, square;
  for (std::size_t i = 0; i < 40; ++i) line.push_back({i, i + 1});
  for (std::size_t y = 0; y < 9; ++y)
    for (std::size_t x = 0; x < 9; ++x)
      square.push_back({10 * y + x, 10 * y + x + 1, 10 * y + x + 10, 10 * y + x + 11});
  for (const auto& groups : {line, square}) {
    const std::size_t n = &groups == &line ? 41 : groups.size() == 81 ? 100 : 41;
    const auto pattern = std::make_shared<SparsityPattern>(SparsityPattern::of_groups(n, groups));
    for (const bool singular : {false, true}) {
      MeshMatrix<std::complex<double>> a(pattern);
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t k = pattern->first[j]; k < pattern->first[j + 1]; ++k) {
          const std::size_t i = pattern->rows[k];
          a.values[k] = {std::cos(7.0 * i + 3.0 * j), i == j ? 1e-9 : std::sin(1.0 * i * j)};
          if (singular && (i == 5 || j == 5)) a.values[k] = 0;
        }
      std::vector<std::complex<double>> x(n), b(n, 0);
      for (std::size_t j = 0; j < n; ++j) x[j] = {std::sin(3.0 * j), std::cos(2.0 * j)};
      a.add_product(x.data(), b.data());
      CHECK(a.factor() == !singular);
      if (singular) continue;
      a.solve(b.data());
      for (std::size_t i = 0; i < n; ++i) CHECK(std::abs(b[i] - x[i]) < 1e-9);
    }
  }
}

TEST_CASE("a velocity that cannot be chosen and fields without motion are refused") {
  const std::string head = "dimensionless\nfield a(x), b(x) : number on x = 0 .. 1 cells 4 boundary a = 0, b = 0\n";
  const std::string ask = "start a = sin(pi x)\nrun 1\nexpect a(0.5) at 1 = 0 ± 9\n";
  CHECK(codes_of_run(head + "density = b a' - a b' - 1/2 (a_x^2 + b_x^2)\n" + ask) == "");
  CHECK(codes_of_run(head + "density = b a' - a b' - 1/2 (a_x^2 + b_x^2)\nstart b' = 1\n" + ask) == "E0642");
  CHECK(codes_of_run(head + "density = 1/2 a'^2 - 1/2 a_xx^2 - b a - b^2\n" + ask) == "E0642");
  CHECK(codes_of_run(head + "density = a^2 (b a' - a b') - 1/2 (a_x^2 + b_x^2)\n" + ask) == "E0508");
  CHECK(codes_of_run("dimensionless\nfield w(x) : number on x = 0 .. 1 cells 1000000 order 20\n"
                     "density = 1/2 w'^2 - 1/2 w_xx^2\nstart w = x^2\nrun 1\nexpect w(0.5) at 1 = 0 ± 9\n") == "E0649");
  // w'' = 4 w³ at the middle: no value after a finite time
  CHECK(codes_of_run("dimensionless\nfield w(x) : number on x = 0 .. 1 cells 4 boundary w_x = 0\n"
                     "density = 1/2 w'^2 + w^4 - 1/2 w_xx^2\nstart w = 10\nrun 1\nexpect w(0.5) at 1 = 0 ± 9\n") ==
        "E0643");
}

// ------------------------------------------------------------------------------------------------------------ plates

TEST_CASE("a plate that moves as a beam does, with supports that move") {
  // Without Poisson's ratio and with two sides free, nothing depends on y.
  const auto value = [](const std::string& text) {
    Study study = study_of_text(text);
    REQUIRE(study.verification());
    for (const Diagnostic& d : study.diagnostics().items()) CHECK_MESSAGE(d.code == "", d.code << " " << d.message);
    REQUIRE(study.verification()->results.size() == 1);
    return std::stod(study.verification()->results[0].actual);
  };
  const std::string end =
      "start w = 0.1*x^2*(3 - 2*x), w' = 1 - 3*x^2 + 2*x^3\nrun 0.1\nexpect w(0.4AT) at 0.1 = 0 ± 9\n";
  const std::string left = "boundary left : w = sin(t), w_x = 0\n",
                    right = "boundary right : w = 0.1, w_x = 0.05*t^2\n";
  const auto placed = [&](const std::string& at) {
    std::string out = end;
    return out.replace(out.find("AT"), 2, at);
  };
  const double beam = value("dimensionless\nfield w(x) : number on x = 0 .. 1 cells 3 order 7\n" + left + right +
                            "density = 1/2 w'^2 - 1/2 w_xx^2\n" + placed(""));
  const double plate =
      value("dimensionless\nfield w(x, y) : number on x = 0 .. 1, y = 0 .. 0.7 cells 3, 2 order 7\n" + left + right +
            "density = 1/2 w'^2 - 1/2 (w_xx^2 + w_yy^2 + 2 w_xy^2)\n" + placed(", 0.3"));
  const double turned = value(
      "dimensionless\nfield w(y, x) : number on y = 0 .. 0.7, x = 0 .. 1 cells 2, 3 order 7\n"
      "boundary bottom : w = sin(t), w_x = 0\nboundary top : w = 0.1, w_x = 0.05*t^2\n"
      "density = 1/2 w'^2 - 1/2 (w_xx^2 + w_yy^2 + 2 w_xy^2)\n" +
      std::string(placed("")).replace(placed("").find("w(0.4)"), 6, "w(0.3, 0.4)"));
  CHECK(std::abs(beam) > 0.01);
  CHECK(std::abs(plate - beam) < 1e-9);
  CHECK(std::abs(turned - beam) < 1e-9);
}

TEST_CASE("plates on hinges, with conditions that change along a side") {
  holds(
      "dimensionless\nparam ν = 0.3\nfield w(x, y) : number on x = 0 .. 1, y = 0 .. 1 cells 2, 2 order 9\n"
      "boundary w = 0\n"
      "density = 1/2 w'^2 - 1/2 ((w_xx + w_yy)^2 - 2 (1 - ν) (w_xx w_yy - w_xy^2))\n"
      "start w = sin(2*pi*x) sin(pi*y)\nrun 0.03\nexpect energy conserved rel 1e-12\n"
      "expect w(0.3, 0.4) at 0.03 = sin(0.6*pi) sin(0.4*pi) cos(5*pi^2*0.03) ± 1e-5\n");
  // The ends of elements are nodes of this shape: it is large beside what the mesh adds there, which no step follows.
  CHECK(steps_until(0.03,
                    "dimensionless\nfield w(x, y) : number on x = 0 .. 1, y = 0 .. 1 cells 2, 2 order 7\n"
                    "boundary w = 0\ndensity = 1/2 w'^2 - 1/2 (w_xx + w_yy)^2\nstart w = sin(2*pi*x) sin(2*pi*y)\n") <=
        300);
  // w = x y sin t under the force density that it needs, its natural conditions by hand: none, all sides are given.
  holds(
      "dimensionless\nfield w(x, y) : number on x = 0 .. 1, y = 0 .. 1 cells 1, 2 order 7\n"
      "boundary left : w = 0\nboundary right : w = y sin(t)\nboundary bottom : w = 0\nboundary top : w = x sin(t)\n"
      "density = 1/2 w'^2 - 1/2 (w_xx + w_yy)^2\nforce density w = -x y sin(t)\n"
      "start w' = x y\nrun 0.5\nexpect w(0.3, 0.7) at 0.5 = 0.21*sin(0.5) ± 1e-9\n");
}

TEST_CASE("a field of first order in time in the plane") {
  holds(
      "dimensionless\nfield ψ(x, y) : complex on x = 0 .. 2*pi, y = 0 .. 2*pi cells 2, 2 order 8 boundary periodic\n"
      "density = i/2 (conj(ψ) ψ' - ψ conj(ψ')) - 1/2 (abs(ψ_x)^2 + abs(ψ_y)^2) + 1/2 abs(ψ)^4\n"
      "start ψ = 0.5*exp(i (x + y))\nrun 0.2\nexpect energy conserved rel 1e-12\n"
      "expect total re(ψ) cos(x + y) at 0.2 = pi^2 cos((1 - 0.25)*0.2) ± 1e-5\n");
}

TEST_CASE("given slopes of a field of first order act along the sides of a rectangle as at the ends of a line") {
  // a and b of ψ = a + i b; nothing depends on the other variable. 3/4 of a side, so that its length counts.
  const auto value = [](const std::string& text) {
    Study study = study_of_text(text);
    REQUIRE(study.verification());
    for (const Diagnostic& d : study.diagnostics().items()) CHECK_MESSAGE(d.code == "", d.code << " " << d.message);
    return std::stod(study.verification()->results[0].actual);
  };
  const std::string line = "density = b a' - a b' - 1/2 (a_x^2 + b_x^2)\n";
  const std::string plane = "density = b a' - a b' - 1/2 (a_x^2 + b_x^2 + a_y^2 + b_y^2)\n";
  const std::string start = "start a = cos(pi*x), b = 0.5*x^2\nrun 0.05\n";
  const auto ends = [](const std::string& near, const std::string& far) {
    return "boundary " + near + " : b_x = 0\nboundary " + far + " : b_x = 1\n";
  };
  const double on_line = value("dimensionless\nfield a(x), b(x) : number on x = 0 .. 1 cells 3 order 8\n" +
                               ends("left", "right") + line + start + "expect a(0.8) at 0.05 = 0 ± 9\n");
  const double along_x =
      value("dimensionless\nfield a(x, y), b(x, y) : number on x = 0 .. 1, y = 0 .. 0.75 cells 3, 1 order 8\n" +
            ends("left", "right") + plane + start + "expect a(0.8, 0.3) at 0.05 = 0 ± 9\n");
  const double along_y =
      value("dimensionless\nfield a(y, x), b(y, x) : number on y = 0 .. 0.75, x = 0 .. 1 cells 1, 3 order 8\n" +
            ends("bottom", "top") + plane + start + "expect a(0.3, 0.8) at 0.05 = 0 ± 9\n");
  CHECK(std::abs(along_x - on_line) < 1e-8);
  CHECK(std::abs(along_y - on_line) < 1e-8);
}

TEST_CASE("given slopes of a field of first order, by closed forms") {
  // 2 a' + b_xx = 0, 2 b' = a_xx: b = x²/2 and −(1 − x)²/2 stay, a = ∓t/2.
  const std::string line = "dimensionless\nfield a(x), b(x) : number on x = 0 .. 1 cells 2 order 6\n";
  const std::string density = "density = b a' - a b' - 1/2 (a_x^2 + b_x^2)\n";
  holds(line + "boundary right : b_x = 1\n" + density +
        "start b = 1/2 x^2\nrun 0.2\nexpect a(0.8) at 0.2 = -0.1 ± 1e-11\nexpect b(0.8) at 0.2 = 0.32 ± 1e-11\n");
  holds(line + "boundary left : b_x = 1\n" + density +
        "start b = -1/2 (1 - x)^2\nrun 0.2\nexpect a(0.8) at 0.2 = 0.1 ± 1e-11\n");
}

TEST_CASE("Radau's steps are of order 2s - 1, and leave nothing of what decays faster than they are") {
  for (const int stages : {1, 2, 3, 4}) {
    const CollocationTableau t(stages, CollocationTableau::Points::Radau);
    CHECK(t.order == 2 * stages - 1);
    double ends = 1;  // R(∞) = 1 − Σ d
    for (const double d : t.d) ends -= d;
    CHECK(std::abs(ends) < 1e-13);
    for (int k = 1; k <= t.order; ++k) {  // ∫ x^(k−1) = 1/k
      double sum = 0;
      for (std::size_t i = 0; i < t.stages; ++i) sum += t.b[i] * std::pow(t.c[i], k - 1);
      CHECK(sum == doctest::Approx(1.0 / k).epsilon(1e-13));
    }
  }
}

TEST_CASE("a string with internal friction runs by implicit steps, by its closed form") {
  // u'' − s u_txx − u_xx = 0: sin πx decays with δ = s π²/2; s = 0.3 below the critical one, 2 above.
  for (const double s : {0.3, 2.0}) {
    CAPTURE(s);
    Study study = study_of_text("dimensionless\nparam s = " + std::to_string(s) +
                                "\nfield u(x) : number on x = 0 .. 1 cells 20 order 7 boundary u = 0\n"
                                "density = 1/2 u'^2 - 1/2 u_x^2\ndissipation density = 1/2 s u_tx^2\n"
                                "start u = sin(pi x)\nrun 1\nexpect u(0.5)' at 0.5 = 0 ± 9\n");
    REQUIRE(study.field_equations());
    FieldRunOptions options;
    options.duration = 0.5;
    Diagnostics diagnostics;
    const auto run = run_fields(*study.field_equations(), {{study.model()->fields->places[0].symbol, false, 0.5}},
                                options, diagnostics);
    REQUIRE(run);
    const double delta = s * fundamental / 2, omega = std::sqrt(std::abs(delta * delta - fundamental));
    const double swing = delta * delta > fundamental ? std::sinh(omega / 2) : std::sin(omega / 2);
    const double exact = -std::exp(-delta / 2) * fundamental / omega * swing;
    CHECK(run->steps < 1000);
    CHECK(std::abs(run->answers[0].value - exact) < 3 * run->answers[0].error);
    CHECK(run->answers[0].error < 1e-10);
  }
}

TEST_CASE("heat conduction: friction alone moves the field") {
  holds(
      "dimensionless\nfield u(x) : number on x = 0 .. 1 cells 10 order 8 boundary u = 0\ndensity = -1/2 u_x^2\n"
      "dissipation density = 1/2 u'^2\nstart u = sin(pi x)\nrun 0.1\n"
      "expect u(0.5) at 0.1 = exp(-0.1*pi^2) ± 1e-12\nexpect u(0.5)' at 0.1 = -pi^2 exp(-0.1*pi^2) ± 1e-8\n");
  // One that does not fit the ends: what is short there is gone soon. x (1 − x) = Σ 8/(nπ)³ sin nπx, n odd.
  for (const double time : {0.001, 0.05}) {
    const auto found = value_at_end(
        "dimensionless\nfield u(x) : number on x = 0 .. 1 cells 10 order 8 boundary u = 0\ndensity = -1/2 u_x^2\n"
        "dissipation density = 1/2 u'^2\nstart u = x (1 - x)\nrun 1\nexpect u(0.3) at 0.05 = 0 ± 9\n",
        time, true);
    double exact = 0;
    for (int n = 1; n < 400; n += 2)
      exact += 8 / std::pow(n * std::numbers::pi, 3) * std::sin(0.3 * n * std::numbers::pi) *
               std::exp(-n * n * fundamental * time);
    CAPTURE(time);
    CHECK(std::abs(found.value - exact) < 2 * found.error);
    CHECK(found.error < 1e-6);
  }
}

TEST_CASE("a ring of first order whose energy holds no curvature is told so") {
  CHECK(codes_of_run("dimensionless\nfield w(x) : number on x = 0 .. 1 cells 20 boundary periodic\n"
                     "density = -1/2 w' w_x - 1/6 w_x^3\nstart w = -0.3 cos(2 pi x)/(2 pi)\nrun 1\n"
                     "expect w_x(0.2) at 0.3 = 0 ± 9\n")
            .find("E0508") != std::string::npos);
}

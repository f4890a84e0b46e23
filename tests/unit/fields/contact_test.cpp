#include <maupertuis/field_run.hpp>
#include <maupertuis/study.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

/// Contacts, impacts and dry friction of bodies that fields hold, against waves in closed form.
using namespace maupertuis;

namespace {

std::string codes_of(Study& study) {
  std::string out;
  for (const Diagnostic& d : study.diagnostics().items()) out += d.code + " ";
  return out;
}

/// A bar of length 1, ρ = E A = 1 and so of impedance 1, that flies with a mass at its right end.
std::string bar(double mass, const std::string& more, int cells = 12) {
  return fmt::format(
      "dimensionless\nfield u(x) : number on x = 0 .. 1 cells {} order 8\n"
      "density = 1/2 u'^2 - 1/2 u_x^2\n{}\nstart u' = 1\n",
      cells, (mass > 0 ? fmt::format("T = {} u(1)'^2\n", mass / 2) : "") + more);
}

FieldRunResult run_of(const std::string& text, double duration, const std::vector<FieldQuestion>& questions = {}) {
  Study study(SourceText("contact.lag", text));
  REQUIRE(study.field_equations());
  FieldRunOptions options;
  options.duration = duration;
  const auto run = run_coupled(*study.model(), *study.field_equations(), questions, options, study.diagnostics());
  REQUIRE(run);
  CHECK(run->trouble.empty());
  return *run;
}

void check_passes(const std::string& text) {
  Study study(SourceText("contact.lag", text));
  const auto verification = study.verification();
  REQUIRE(verification);
  REQUIRE(!verification->results.empty());
  for (const ExpectationResult& r : verification->results) {
    INFO(r.text, ": ", r.actual, " ", r.uncertainty, " ", r.message);
    CHECK(r.passed);
  }
}

const Happening& the(const FieldRunResult& run, Happening::Kind kind, std::size_t number = 0) {
  for (const Happening& h : run.happenings)
    if (h.kind == kind && number-- == 0) return h;
  FAIL("it does not happen");
  return run.happenings.front();
}

/// When the mass is back at the wall: m v' = −(v − 1) after it left with −e, so that τ = (1 + e) m (1 − exp(−τ/m)).
double flight(double mass, double e) {
  double a = 1e-3, b = 10;
  for (int k = 0; k < 200; ++k) {
    const double middle = (a + b) / 2;
    (middle > (1 + e) * mass * (1 - std::exp(-middle / mass)) ? b : a) = middle;
  }
  return a;
}

}  // namespace

TEST_CASE("a bar with a mass at its end bounces off a wall as its waves say") {
  constexpr double m = 0.5, e = 0.5, gap = 0.1;
  const FieldRunResult run = run_of(bar(m, fmt::format("contact u(1) <= {} restitution {} name wall", gap, e)), 0.6);
  REQUIRE(run.happenings.size() == 2);
  const Happening &first = run.happenings[0], &second = run.happenings[1];
  CHECK(std::abs(first.t - gap) < 1e-14);
  CHECK(std::abs(first.impulse - m * (1 + e)) < 1e-12);  // of the mass alone, not of a piece of the bar
  const double back = flight(m, e), speed = 1 - (1 + e) * std::exp(-back / m);
  CHECK(std::abs(second.t - (gap + back)) < 1e-4);
  CHECK(std::abs(second.t - (gap + back)) < second.error);
  CHECK(second.error < 2e-3);
  CHECK(std::abs(second.speed - speed) < 0.02);
  REQUIRE(run.books);
  CHECK(std::abs(run.books->impacts - (m / 2 * (1 - e * e) * (1 + second.speed * second.speed))) < 1e-12);
  CHECK(run.energy_drift < 1e-13);
}

TEST_CASE("estimates behind the front that an impact sends into a bar hold its waves") {
  constexpr double m = 0.5, e = 0.5, gap = 0.1, end = 0.5;
  const std::string contact = fmt::format("contact u(1) <= {} restitution {} name wall", gap, e);
  const double places[] = {1, 0.9, 0.75, 0.7, 0.62, 0.5, 0.3};
  for (const int cells : {6, 12}) {
    CAPTURE(cells);
    std::string text = bar(m, contact, cells) + "run 0.5\n";
    for (const double x : places) text += fmt::format("expect u({}) at 0.5 = 0 ± 1\n", x);
    Study study(SourceText("contact.lag", text));
    REQUIRE(study.field_equations());
    std::vector<FieldQuestion> questions;
    for (const double x : places) {
      static_cast<void>(x);
      const auto& line = std::get<expectation::ValueAt>(study.model()->experiment.expectations[questions.size()].kind);
      questions.push_back({line.subject, false, end});
    }
    FieldRunOptions options;
    options.duration = end;
    const auto run = run_coupled(*study.model(), *study.field_equations(), questions, options, study.diagnostics());
    REQUIRE(run);
    for (std::size_t i = 0; i < questions.size(); ++i) {
      const double since = end - (1 - places[i]) - gap;  // the mass left the wall
      const double exact = end + (since > 0 ? (1 + e) * (m - m * std::exp(-since / m)) * -1 : 0);
      CHECK(std::abs(run->answers[i].value - exact) < 2 * run->answers[i].error);
      CHECK(run->answers[i].error < 0.03);
    }
  }
}

TEST_CASE("a bar with a mass stays at the wall until the wave from its free end is back") {
  const FieldRunResult run = run_of(bar(0.5, "contact u(1) <= 0.1 restitution 0 name wall", 6), 3);
  CHECK(std::abs(the(run, Happening::Kind::Made).t - 0.1) < 1e-14);
  const Happening& lost = the(run, Happening::Kind::Lost);
  CHECK(std::abs(lost.t - 2.1) < 5e-3);
  // The mass leaves with m v' = −(v + 1).
  check_passes(bar(0.5, "contact u(1) <= 0.1 restitution 0 name wall", 6) +
               "run 3\nexpect u(1) at 3 = 0.1 - 0.9 + 1/2 * (1 - exp(-1.8)) ± 1e-2\n"
               "expect event wall impact = 1\nexpect event wall impact 1 at 0.1 ± 1e-12\n");
  for (const int cells : {3, 5, 8})
    CHECK(run_of(bar(0.5, "contact u(1) <= 0.1 restitution 0 name wall", cells), 0.2).happenings.size() == 2);
}

TEST_CASE("a wall that gives everything back leaves the energy of bar and mass") {
  check_passes(bar(0.2, "contact u(1) <= 0.05 restitution 1 name wall") + "run 1\nexpect energy conserved rel 1e-12\n");
  Study study(SourceText(
      "contact.lag", bar(0.2, "contact u(1) <= 0.05 restitution 1/2") + "run 1\nexpect energy conserved rel 1e-12\n"));
  CHECK(!study.verification()->passed());  // impacts take some, whatever the books say of the rest
}

TEST_CASE("dry friction brings the end of a bar to rest as its waves say") {
  // m v' = −(v − 1) − F: v = 0 at m log(F/(F − 1)), and then the bar presses with 1 until its wave is back.
  constexpr double m = 0.3, limit = 1.5;
  const FieldRunResult run = run_of(bar(m, "friction u(1) limit 1.5"), 1.5);
  const Happening& stick = the(run, Happening::Kind::Stick);
  CHECK(std::abs(stick.t - m * std::log(limit / (limit - 1))) < 3e-4);
  CHECK(std::abs(stick.t - m * std::log(limit / (limit - 1))) < stick.error);
  CHECK(stick.error < 2e-3);
  CHECK(run.happenings.size() == 1);
  // A point without mass has its speed at once: a limit below the impedance leaves 1 − F, one above stops it.
  check_passes(bar(0, "friction u(1) limit 1/4") + "run 1\nexpect u(1) at 1 = 0.75 ± 2e-3\n");
  check_passes(bar(0, "friction u(1) limit 2") + "run 1\nexpect u(1) at 1 = 0 ± 2e-3\n");
}

TEST_CASE("a beam without much mass of its own bounces as the spring that it is") {
  // 3 EI/L³ = 3 holds a mass of 1/3: ω = 3; from the rest at −0.1 it meets the stop at 0 after a quarter of a period.
  const std::string text =
      "dimensionless\nparam μ = 1e-5\nfield w(x) : number on x = 0 .. 1 cells 1 order 7\n"
      "boundary left : w = 0, w_x = 0\ndensity = 1/2 μ w'^2 - 1/2 w_xx^2\nT = 1/6 w(1)'^2\n"
      "contact w(1) <= 0 restitution 1/2 name stop\nstart w = -0.05 x^2 (3 - x)\n";
  const FieldRunResult run = run_of(text, 1.8);
  const double quarter = std::acos(-1.0) / 6;
  REQUIRE(run.happenings.size() >= 2);
  CHECK(std::abs(run.happenings[0].t - quarter) < 1e-3);
  CHECK(std::abs(run.happenings[0].impulse - 0.3 / 3 * 1.5) < 1e-3);
  CHECK(std::abs(run.happenings[1].t - 3 * quarter) < 3e-3);
}

TEST_CASE("a bead on a string and a block beside it: contacts and friction of coordinates") {
  check_passes(
      "dimensionless\nfield u(x) : number on x = 0 .. 1 cells 3 order 8\nboundary u = 0\n"
      "density = 1/2 u'^2 - 1/2 u_x^2\ncoord y, z : number\nT = 1/2 u(1/2)'^2 + y'^2 + z'^2\nV = 4 y\n"
      "contact y >= 0 restitution 1/2 name floor\nfriction z limit 1\nstart y = 2, z' = 1, u = sin(pi x)\nrun 2.5\n"
      "expect event floor impact 1 at sqrt(2) ± 1e-9\nexpect event z stick 1 at 2 ± 1e-9\n");
  check_passes(  // the bead slides on a string at rest and hits a stop
      "dimensionless\nfield u(x) : number on x = 0 .. 1 cells 3 order 8\nboundary u = 0\ncoord s : number\n"
      "density = 1/2 u'^2 - 1/2 u_x^2\nT = 1/2 (s'^2 + u(s)'^2)\ncontact s <= 3/4 restitution 1 name stop\n"
      "start s = 1/4, s' = 1\nrun 1\nexpect event stop impact 1 at 1/2 ± 1e-12\nexpect s at 1 = 1/4 ± 1e-9\n");
}

TEST_CASE("what the mesh decides is not said to be known") {
  // A plastic impact on elements of high order rattles; on half of them otherwise.
  Study study(SourceText("contact.lag",
                         "dimensionless\nfield w(x) : number on x = 0 .. 1 cells 2 order 7\n"
                         "boundary left : w = 0, w_x = 0\ndensity = 1/2 w'^2 - 1/2 w_xx^2\nT = 1/2 w(1)'^2\n"
                         "contact w(1) <= 0 restitution 0 name stop\nstart w = -0.05 x^2 (3 - x)\nrun 1.1\n"
                         "expect event stop impact 1 at 1 ± 0.1\nexpect event stop lost 4 at 1 ± 0.2\n"));
  const auto verification = study.verification();
  REQUIRE(verification);
  CHECK(verification->results[0].passed);
  CHECK(!verification->results[1].passed);
}

TEST_CASE("a start that touches a contact up to rounding of its formula is none that violates it") {
  const FieldRunResult run = run_of(
      "dimensionless\nfield u(x) : number on x = 0 .. 1 cells 3 order 6\ndensity = 1/2 u'^2 - 1/2 u_x^2\n"
      "T = 1/2 u(1)'^2\ncontact u(1) <= 0 restitution 0 name stop\nforce u(1) = 10\nstart u = sin(pi x)\n",
      0.1);
  CHECK(run.first_mode == "stop");
}

TEST_CASE("impacts on a field without a mass are refused, modes say what they leave out") {
  Study without(SourceText("contact.lag", bar(0, "contact u(1) <= 0.1 restitution 1/2")));
  without.field_equations();
  CHECK(codes_of(without) == "E0657 ");
  Study elsewhere(SourceText("contact.lag", bar(1, "contact u(1/2) <= 0.1 restitution 1/2")));
  elsewhere.field_equations();
  CHECK(codes_of(elsewhere) == "E0657 ");
  Study let_go(SourceText("contact.lag", bar(0, "friction u(1) limit 0.2 static 0.3")));
  let_go.field_equations();
  CHECK(codes_of(let_go) == "E0659 ");
  Study rides(SourceText("contact.lag", bar(0,
                                            "coord s : number\nT = 1/2 (s'^2 + u(s)'^2)\ncontact u(s) <= 0.1\n"
                                            "run 1\nexpect s at 1 = 0 ± 1")));
  rides.verification();
  CHECK(codes_of(rides) == "E0508 ");
  Study tied(SourceText("contact.lag", bar(0,
                                           "coord y : number\nT = 1/2 y'^2\nconstraint y = u(1)\n"
                                           "contact u(1) <= 0.1 restitution 1/2")));
  tied.field_equations();
  CHECK(codes_of(tied).empty());
  Study modes(SourceText("contact.lag", bar(1, "contact u(1) <= 0.1 restitution 1/2")));
  REQUIRE(modes.field_equations());
  CHECK(field_frequencies(*modes.field_equations(), 3, modes.diagnostics()).size() == 3);
  CHECK(codes_of(modes) == "W0658 ");
  Study along(SourceText("contact.lag", bar(1, "friction u limit 0.1")));
  CHECK(!along.field_equations());
  CHECK(codes_of(along) == "E0299 ");
  Study loose(SourceText("contact.lag", bar(1, "contact u <= 0.1 restitution 1/2")));
  CHECK(!loose.field_equations());
  CHECK(codes_of(loose) == "E0299 ");
}

TEST_CASE("a string without mass that is not linear says what is missing") {
  // By its density, or by a parameter that is 0.
  for (const char* density :
       {"density = -10 (sqrt(1 + u_x^2) - 1)", "param r = 0\ndensity = 1/2 r u'^2 - 10 (sqrt(1 + u_x^2) - 1)"}) {
    CAPTURE(density);
    Study study(
        SourceText("string.lag", std::string("dimensionless\nfield u(x) : number on x = 0 .. 1 cells 4 order 3\n"
                                             "boundary u = 0\n") +
                                     density + "\nT = 0.1 u(1/2)'^2\nstart u = 0.3 min(x, 1 - x)\n"));
    REQUIRE(study.field_equations());
    FieldRunOptions options;
    options.duration = 1;
    const auto run = run_coupled(*study.model(), *study.field_equations(), {}, options, study.diagnostics());
    REQUIRE(run);
    CHECK(run->trouble.find("no inertia") != std::string::npos);
  }
}

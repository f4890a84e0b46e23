#include <maupertuis/study.hpp>

#include <doctest/doctest.h>

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/ensemble.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/simulation.hpp>

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace maupertuis;

namespace {

const std::string kPendulum =
    "system pendulum\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\npoint bob mass m at l (sin θ, -cos θ)\n"
    "gravity (0, -g)\n";
const std::string kExperiment = "start θ = 60 deg\nrun 1 s\n";

Study pendulum(const std::string& experiment = kExperiment) {
  return Study(SourceText("pendulum.lag", kPendulum + experiment));
}

std::string told(const Study& study) { return render(study.diagnostics(), study.texts()); }

/// The state at the end of the motion.
State end_of(Study& study) {
  const auto result = study.motion();
  REQUIRE_MESSAGE(result, told(study));
  REQUIRE(result->ok());
  return result->final;
}

void check_same(const State& a, const State& b) {
  CHECK(a.t == b.t);
  CHECK(a.q == b.q);
  CHECK(a.v == b.v);
}

}  // namespace

TEST_CASE("from a text to its equations, their certificate and a motion; each stage once") {
  Study study = pendulum();
  const EquationsOfMotion* equations = study.equations();
  REQUIRE_MESSAGE(equations, told(study));
  const Derivation* derivation = study.derivation(false);
  CHECK(to_plain(derivation->equations.at(0), equations->order) == "m l^2 θ'' + m g l sin θ");
  CHECK(study.certificate()->passed());
  CHECK(study.tree() == study.tree());
  CHECK(study.model() == study.model());
  CHECK(study.equations() == equations);
  CHECK(study.derivation(false) == derivation);
  CHECK(study.certificate() == study.certificate());
  CHECK(end_of(study).t == 1);
  CHECK(study.diagnostics().empty());
}

TEST_CASE("the same stage asked twice tells its mistakes once") {
  Study study = pendulum("start θ = 60 kg\nlet a = b\n");
  CHECK_FALSE(study.model());
  const std::size_t mistakes = study.diagnostics().items().size();
  CHECK(mistakes == 2);
  CHECK_FALSE(study.model());
  CHECK_FALSE(study.equations());
  CHECK_FALSE(study.certificate());
  CHECK_FALSE(study.motion());
  CHECK(study.diagnostics().items().size() == mistakes);
}

TEST_CASE("what is said beside the text is what the text would say, and the text stays") {
  Study beside = pendulum();
  beside.override_with(OverrideKind::Parameters, "length", "l = 2 m");
  beside.override_with(OverrideKind::Start, "start", "θ = 90 deg, θ' = 1 rad/s");
  beside.override_with(OverrideKind::Run, "run", "3 s");
  Study edited(
      SourceText("pendulum.lag",
                 "system pendulum\nparam m = 1 kg, l = 2 m, g = 9.81 m/s^2\ncoord θ : angle\n"
                 "point bob mass m at l (sin θ, -cos θ)\ngravity (0, -g)\nstart θ = 90 deg, θ' = 1 rad/s\nrun 3 s\n"));
  check_same(end_of(beside), end_of(edited));
  CHECK(beside.source().text() == kPendulum + kExperiment);

  Study until = pendulum();
  until.override_with(OverrideKind::Until, "end", "θ = 0");
  until.override_with(OverrideKind::Within, "limit", "5 s");
  Study written = pendulum("start θ = 60 deg\nrun until θ = 0 within 5 s\n");
  const State passed = end_of(until);
  check_same(passed, end_of(written));
  CHECK(passed.t < 1);
}

TEST_CASE("a mistake beside the text has its place in what was said") {
  Study study = pendulum();
  study.override_with(OverrideKind::Parameters, "mass", "m = 2 kg");
  const SourceId wrong = study.override_with(OverrideKind::Until, "end of the run", "bob.y = 2 kg");
  CHECK_FALSE(study.model());
  REQUIRE(study.diagnostics().items().size() == 1);
  const Diagnostic& d = study.diagnostics().items()[0];
  CHECK(d.code == "E0304");
  REQUIRE(d.span);
  CHECK(d.span->source == wrong);
  CHECK(study.texts().slice(*d.span) == "2 kg");
  CHECK(told(study).find("end of the run:1:9") != std::string::npos);
  CHECK(told(study).find("1 | bob.y = 2 kg\n") != std::string::npos);
}

TEST_CASE("mistakes of the text and beside it are told together, those of the text first") {
  Study study = pendulum("start θ = 60 kg\n");
  study.override_with(OverrideKind::Run, "run", "3 kg");
  CHECK_FALSE(study.model());
  REQUIRE(study.diagnostics().items().size() == 2);
  CHECK(study.texts().slice(*study.diagnostics().items()[0].span) == "60 kg");
  CHECK(study.texts().slice(*study.diagnostics().items()[1].span) == "3 kg");
}

TEST_CASE("formulas that are asked for, in the order of asking") {
  Study study = pendulum();
  CHECK(study.ask("first", "bob.x") == 0);
  study.override_with(OverrideKind::Run, "run", "2 s");
  CHECK(study.ask("second", "1/2 m l^2 θ'^2") == 1);
  REQUIRE_MESSAGE(study.model(), told(study));
  const auto& asked = study.model()->experiment.asked;
  REQUIRE(asked.size() == 2);
  CHECK(to_string(asked[0].dimension) == "m");
  CHECK(to_string(asked[1].dimension) == "J");
  CHECK(study.texts().of(asked[1].span).name() == "second");
}

TEST_CASE("an interrupted stage tells nothing and does its work when it is asked again") {
  std::atomic<bool> stop = true;
  std::string text = "system chain\ncoord ";
  std::string energy = "0", start;
  constexpr int links = 40;
  for (int i = 1; i <= links; ++i) {
    text += "x" + std::to_string(i) + (i < links ? ", " : " : number\n");
    energy += " + cos(x" + std::to_string(i) + "' + x" + std::to_string(i % links + 1) + ")^3 + x" + std::to_string(i) +
              "'^2";
  }
  Study study(SourceText("chain.lag", "dimensionless\n" + text + "L = " + energy + "\n"), &stop);
  CHECK_THROWS_AS(study.certificate(), Interrupted);
  const std::size_t before = study.diagnostics().items().size();
  CHECK_THROWS_AS(study.certificate(), Interrupted);
  CHECK(study.diagnostics().items().size() == before);
  stop = false;
  const Certificate* certificate = study.certificate();
  REQUIRE_MESSAGE(certificate, told(study));
  CHECK(certificate->passed());
}

TEST_CASE("what becomes of expectations, and of a text that expects a mistake") {
  Study study =
      pendulum(kExperiment + "expect energy conserved\nexpect equation l θ'' = -g sin θ\nclaim l θ'' = g sin θ\n");
  const auto verification = study.verification();
  REQUIRE_MESSAGE(verification, told(study));
  CHECK(verification->passed() == 2);
  CHECK(verification->failed() == 1);
  Study wrong = pendulum("start θ = 60 kg\nexpect error E0304\n");
  const auto of_errors = wrong.verification();
  REQUIRE(of_errors);
  CHECK(of_errors->passed() == 1);
}

TEST_CASE("questions that a model does not allow are refused with a reason") {
  Study curve(SourceText("curve.lag", "system curve\nindependent x : length\ncoord y : length\nL = sqrt(1 + y'^2)\n"));
  CHECK(curve.refuse_without_time());
  REQUIRE(curve.diagnostics().items().size() == 1);
  CHECK(curve.diagnostics().items()[0].code == "E0245");
  Study held(SourceText("held.lag", "dimensionless\ncoord y : number\nL = 1/2 y'^2\nconstraint integral y = 1\n"));
  CHECK_FALSE(held.motion());
  CHECK(held.diagnostics().items().back().code == "E0244");
}

TEST_CASE("lines about formulas hold at the values that they name") {
  Study study(SourceText("m.lag",
                         "dimensionless\nparam k = 1\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 k x^2\n"
                         "start x = 1\nrun 1\nexpect equation x'' + 4*x = 0 with k = 4\n"
                         "expect conserved x'^2 + 4*x^2 with k = 4\nexpect equation x'' + k x = 0 with k = 4\n"
                         "expect equation x'' + 4*x = 0\n"));
  const auto verified = study.verification();
  REQUIRE(verified);
  std::vector<bool> passed;
  for (const ExpectationResult& r : verified->results) passed.push_back(r.passed);
  CHECK(passed == std::vector<bool>{true, true, true, false});
}

TEST_CASE("a question that was refused does not stand in the way of the next one") {
  Study study = pendulum();
  SimulationOptions wrong;
  wrong.output_every = -1;
  CHECK_FALSE(study.motion(wrong));
  CHECK(study.wrong());
  const auto motion = study.motion();
  REQUIRE_MESSAGE(motion, told(study));
  CHECK(motion->final.t == 1);
  CHECK(study.equations());
  CHECK(study.verification());
  CHECK_FALSE(study.field_motion({}, {}));
  CHECK(study.diagnostics().items().back().code == "E0512");
  CHECK(study.motion());
}

TEST_CASE("a model with fields answers for its fields after a question about coordinates") {
  Study study(SourceText("string.lag",
                         "field u(x) : length on x = 0 m .. 1 m boundary u = 0\nparam ρ = 1 kg/m, T0 = 1 N\n"
                         "density = 1/2 ρ u'^2 - 1/2 T0 u_x^2\nstart u = 0.01 [m] sin(π x/1 [m])\nrun 1 s\n"));
  CHECK_FALSE(study.equations());
  CHECK_FALSE(study.motion());
  CHECK(study.diagnostics().items().front().code == "E0507");
  const auto motion = study.field_motion({}, {});
  REQUIRE_MESSAGE(motion, told(study));
}

TEST_CASE("what comes too late is told to the caller") {
  Study study = pendulum();
  REQUIRE(study.model());
  CHECK_THROWS_WITH_AS(study.override_with(OverrideKind::Parameters, "--set", "l = 2 m"),
                       doctest::Contains("override_with"), std::invalid_argument);
  CHECK_THROWS_AS(study.fix_mode("free"), std::invalid_argument);
}

TEST_CASE("threads that make things of one model wait for each other") {
  Study study = pendulum();
  const EquationsOfMotion* equations = study.equations();
  REQUIRE(equations);
  const Model& model = *study.model();
  std::vector<double> ends(4);
  std::vector<std::thread> threads;
  for (double& end : ends)
    threads.emplace_back([&] {
      for (int k = 0; k < 20; ++k) static_cast<void>(motion_kernel(*equations));
      Diagnostics diagnostics;
      end = simulate(model, *equations, {}, diagnostics)->final.q[0];
    });
  for (std::thread& thread : threads) thread.join();
  const double alone = end_of(study).q[0];
  for (const double end : ends) CHECK(end == alone);
}

TEST_CASE("kernels and flows of a degenerate Lagrangian are those of the equations that determine its motion") {
  // L = x y' - (x^2 + y^2)/2: y' = x, x' = -y.
  Study study(SourceText("plane.lag",
                         "system plane\ndimensionless\ncoord x, y : number\nL = x y' - (x^2 + y^2)/2\n"
                         "start x = 1, y = 0\nrun 2\n"));
  const EquationsOfMotion* equations = study.equations();
  REQUIRE_MESSAGE(equations, told(study));
  const MotionKernel motion = motion_kernel(*equations);
  const std::vector<double> q{1, 0}, v{0, 1}, end{2};
  EnsembleStart start;
  start.q = q, start.v = v, start.end = end, start.parameters = motion.parameters;
  const EnsembleResult result = advance_ensemble(motion.kernel, start);
  REQUIRE_MESSAGE(result.endings[0].ok(), result.endings[0].reason);
  CHECK(result.q[0] == doctest::Approx(std::cos(2.0)).epsilon(1e-13));
  CHECK(result.q[1] == doctest::Approx(std::sin(2.0)).epsilon(1e-13));
  const std::vector<double> still{0, 0};
  start.v = still;  // y' = x is a constraint here
  CHECK(advance_ensemble(motion.kernel, start).endings[0].ending == StepEnding::Refused);
}

TEST_CASE("a degenerate start that is moved leaves what no constraint asks of, and comes to zero itself") {
  for (const char* start : {"x = 1", "x = 1, x' = 1", "x = 1e-7, y = 3", "x = -2, y' = 0.5"}) {
    Study study(SourceText("d.lag", std::string("dimensionless\ncoord x, y : number\n"
                                                "L = 1/2 (x' + y')^2 - 1/2 x^2\nstart ") +
                                        start + "\n"));
    REQUIRE(study.equations());
    const auto found = consistent_start(*study.model(), *study.equations(), study.diagnostics());
    REQUIRE(found);
    CHECK_FALSE(found->searched);
    CHECK(found->state.q[0] == 0);
    CHECK(found->state.v[0] == 0);
    CHECK(found->state.q[1] == (std::string(start).find("y = 3") != std::string::npos ? 3 : 0));
    CHECK(found->state.v[1] == (std::string(start).find("y' = ") != std::string::npos ? 0.5 : 0));
  }
}

#include "support.hpp"

using namespace maupertuis;
using namespace maupertuis::test;
using doctest::Approx;

namespace {

const char* kModel =
    "param m = 1 kg, l = 60 cm, b = 0\nlet J = m l^2\ncoord θ : angle\nT = 1/2 J θ'^2\nD = 1/2 b θ'^2\nstart θ = 10 "
    "deg, θ' = 1 rad/s\n";

Elaborated with(const std::vector<std::string>& parameters, const std::vector<std::string>& start = {}) {
  Beside beside;
  for (const std::string& text : parameters) beside.push_back({OverrideKind::Parameters, "--set", text});
  for (const std::string& text : start) beside.push_back({OverrideKind::Start, "--start", text});
  return Elaborated(kModel, beside);
}

Elaborated saying(OverrideKind kind, const std::string& text) { return Elaborated(kModel, {{kind, "field", text}}); }

/// Code and text of the place of the only mistake.
std::string mistake(OverrideKind kind, const std::string& text) {
  const Elaborated e = saying(kind, text);
  REQUIRE_MESSAGE(e.diagnostics.items().size() == 1, e.messages());
  const Diagnostic& d = e.diagnostics.items()[0];
  REQUIRE(d.span);
  CHECK(d.span->source == 1);
  return d.code + " " + std::string(e.overrides.texts()[0].slice(*d.span));
}

}  // namespace

TEST_CASE("--set changes parameters and what is defined from them") {
  const Elaborated e = with({"m=2kg", "l = 1 m"});
  CHECK_MESSAGE(e.fine(), e.messages());
  CHECK(e.system().find_parameter("m")->si_value == 2);
  CHECK(value(e.system().kinetic_energy(), e.at({0}, {1})) == Approx(1));
}

TEST_CASE("a parameter that was 0 takes the dimension that it is given") {
  CHECK_MESSAGE(with({"b=0.1 N m s"}).fine(), with({"b=0.1 N m s"}).messages());
  CHECK(with({"b=0.1 kg"}).codes() == "E0304");
}

TEST_CASE("--start replaces and adds") {
  const Elaborated e = with({}, {"θ=1", "θ'=2 rad/s"});
  CHECK_MESSAGE(e.fine(), e.messages());
  REQUIRE(e.experiment().start.size() == 2);
  CHECK(evaluate(e.experiment().start[0].value, {}) == 1);
  CHECK(evaluate(e.experiment().start[1].value, {}) == 2);
}

TEST_CASE("mistakes in what was said have their places in its text") {
  for (const auto& [option, message] : std::vector<std::pair<std::string, std::string>>{
           {"k=2", "--set k=2: the model has no parameter `k`"},
           {"J=2", "--set J=2: `J` is a definition, not a parameter"},
           {"l=2 kg", "--set l=2 kg: `l` is a length (m), this is a mass (kg)"},
           {"l=2 mm2", "--set l=2 mm2: `mm2` is no unit"},
           {"m=-1 kg", "--set m=-1 kg: the mass `m` is negative"}}) {
    const Elaborated e = with({"b = 0", option});
    CHECK(e.codes() == "E0224");
    CHECK(e.first_message() == message);
    CHECK_FALSE(e.model);
    REQUIRE(e.diagnostics.items()[0].span);
    CHECK(e.diagnostics.items()[0].span->source == 2);
    CHECK(e.diagnostics.items()[0].span->end <= option.size());
    CHECK(e.messages().find("1 | " + option) != std::string::npos);
  }
  CHECK(with({"m 2"}).codes() == "E0224");
  CHECK(with({}, {"x=1"}).first_message() == "--start x=1: `x` is not declared");
  CHECK(with({}, {"θ=1 s"}).first_message() == "--start θ=1 s: `θ` is an angle (rad), this is a time (s)");
}

TEST_CASE("a run, a sweep, a section and formulas beside the model") {
  const Elaborated run = saying(OverrideKind::Run, "until θ' = 0 within 3 s");
  REQUIRE_MESSAGE(run.fine(), run.messages());
  CHECK(run.experiment().until == run.system().coordinates[0].velocity);
  CHECK(evaluate(run.experiment().within, {}) == 3);
  CHECK(evaluate(saying(OverrideKind::Run, "2 min").experiment().duration, {}) == 120);
  CHECK(evaluate(saying(OverrideKind::Until, "θ = 0").experiment().within, {}) == 60);
  const Elaborated limited(kModel, {{OverrideKind::Within, "limit", "7 s"}, {OverrideKind::Until, "end", "θ = 0"}});
  CHECK(evaluate(limited.experiment().within, {}) == 7);
  const Elaborated sweep = saying(OverrideKind::Sweep, "l = 1 .. 2 m");
  CHECK(sweep.experiment().sweep->steps == 121);
  CHECK(saying(OverrideKind::Sweep, "l = 1 .. 2 m steps 5").experiment().sweep->steps == 5);
  CHECK(saying(OverrideKind::Section, "θ = 10 deg").experiment().section);
  const Elaborated formula = saying(OverrideKind::Formula, "1/2 J θ'^2");
  REQUIRE(formula.experiment().asked.size() == 1);
  CHECK(physical_name(formula.experiment().asked[0].dimension) == "energy");
  CHECK(value(formula.experiment().asked[0].value, formula.at({0}, {1})) == Approx(0.18));
}

TEST_CASE("a text beside the model is one part, whatever its lines") {
  const Elaborated formula = saying(OverrideKind::Formula, "1/2 J\nθ'^2");
  REQUIRE_MESSAGE(formula.fine(), formula.messages());
  CHECK(physical_name(formula.experiment().asked.at(0).dimension) == "energy");
}

TEST_CASE("what stands in the place of the model's own is not looked at there") {
  const std::string text = std::string(kModel) + "run 2 kg\n";
  CHECK(Elaborated(text).codes() == "E0304");
  CHECK(Elaborated(text, {{OverrideKind::Run, "run", "2 s"}}).fine());
  const Elaborated until(std::string(kModel) + "run 2 s\nexpect until at 1 s ± 1\n",
                         {{OverrideKind::Until, "end", "θ = 0"}});
  CHECK_MESSAGE(until.fine(), until.messages());
}

TEST_CASE("every kind of text has its mistakes in it") {
  CHECK(mistake(OverrideKind::Run, "2 kg") == "E0304 2 kg");
  CHECK(mistake(OverrideKind::Until, "θ2 = 0") == "E0201 θ2");
  CHECK(mistake(OverrideKind::Until, "θ = 0 s") == "E0304 0 s");
  CHECK(mistake(OverrideKind::Until, "(θ = 0") == "E0106 (");
  CHECK(mistake(OverrideKind::Within, "") == "E0111 ");
  CHECK(mistake(OverrideKind::Sweep, "k = 1 .. 2") == "E0201 k");
  CHECK(mistake(OverrideKind::Sweep, "l = 1 m") == "E0111 ");
  CHECK(mistake(OverrideKind::Section, "θ + 1 s = 0") == "E0312 1 s");
  CHECK(mistake(OverrideKind::Formula, "θ +") == "E0111 ");
  CHECK(mistake(OverrideKind::Formula, "θ θ)") == "E0106 )");
  CHECK(mistake(OverrideKind::Path, "(0, 0) at 0 s to 1 at 1 s") == "E0241 (0, 0)");
}

TEST_CASE("a path by formulas: every coordinate once, in any order") {
  const std::string plane = "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n";
  const auto path = [&](const std::string& formulas) {
    return Elaborated(plane, {{OverrideKind::GivenPath, "path", formulas},
                              {OverrideKind::GivenFrom, "from", "1"},
                              {OverrideKind::GivenTo, "to", "1 + 2"}});
  };
  const Elaborated good = path("y = 2 t, x = 1");
  REQUIRE_MESSAGE(good.fine(), good.messages());
  const PathFormulas& given = *good.experiment().given_path;
  CHECK(evaluate(given.q[0], good.at({0, 0}, {0, 0}, 5)) == 1);
  CHECK(evaluate(given.q[1], good.at({0, 0}, {0, 0}, 5)) == 10);
  CHECK(evaluate(given.from, {}) == 1);
  CHECK(evaluate(given.to, {}) == 3);
  CHECK(path("x = 1").first_message() == "the path does not say what `y` is");
  CHECK(path("x = 1, z = 2").first_message() == "`z` is no coordinate");
  CHECK(path("x = 1, x = 2").first_message() == "`x` has its value along the path");
  CHECK(path("x = y, y = 2").codes() == "E0222");
  CHECK(Elaborated(plane, {{OverrideKind::GivenPath, "path", "x = t, y = t"}}).codes() == "E0243");
}

TEST_CASE("warnings about what was said are told once") {
  CHECK(with({}, {"θ=60"}).codes() == "W0310");
  CHECK(with({}, {"θ=60, θ'=1 rad/s"}).codes() == "W0310");
}

TEST_CASE("a constant stands for its name in formulas") {
  const Elaborated e = saying(OverrideKind::Constants, "m = 2 kg");
  CHECK_MESSAGE(e.fine(), e.messages());
  CHECK(e.system().find_parameter("m")->si_value == 2);
  const Expr j = e.system().definitions.front().value, l = e.system().find_parameter("l")->symbol;
  CHECK(j == 2 * pow(l, Rational(2)));
}

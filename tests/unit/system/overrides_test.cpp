#include "support.hpp"

using namespace maupertuis;
using namespace maupertuis::test;
using doctest::Approx;

namespace {

const char* kModel =
    "param m = 1 kg, l = 60 cm, b = 0\nlet J = m l^2\ncoord θ : angle\nT = 1/2 J θ'^2\nD = 1/2 b θ'^2\nstart θ = 10 "
    "deg, θ' = 1 rad/s\n";

Elaborated with(std::vector<std::string> parameters, std::vector<std::string> start = {}) {
  return Elaborated(kModel, Overrides{std::move(parameters), std::move(start)});
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

TEST_CASE("mistakes on the command line have their places behind the model, where the options count as lines") {
  for (const auto& [option, message] : std::vector<std::pair<std::string, std::string>>{
           {"k=2", "--set k=2: the model has no parameter `k`"},
           {"J=2", "--set J=2: `J` is a definition, not a parameter"},
           {"l=2 kg", "--set l=2 kg: `l` is a length (m), this is a mass (kg)"},
           {"l=2 mm2", "--set l=2 mm2: `mm2` is no unit"},
           {"m=-1 kg", "--set m=-1 kg: the mass `m` is negative"}}) {
    const Elaborated e = with({option});
    CHECK(e.codes() == "E0224");
    CHECK(e.first_message() == message);
    CHECK_FALSE(e.model);
    REQUIRE(e.diagnostics.items()[0].span);
    CHECK(e.diagnostics.items()[0].span->begin > e.source.text().size());
    CHECK(e.diagnostics.items()[0].span->end <= e.source.text().size() + 1 + option.size());
  }
  CHECK(with({"m 2"}).codes() == "E0224");
  CHECK(with({}, {"x=1"}).first_message() == "--start x=1: `x` is not declared");
  CHECK(with({}, {"θ=1 s"}).first_message() == "--start θ=1 s: `θ` is an angle (rad), this is a time (s)");
}

// Accelerations and momenta in places that take a state: refused, or made a formula of the state.
#include "support.hpp"

#include <maupertuis/evaluate.hpp>

using namespace maupertuis;
using namespace maupertuis::test;

namespace {

const std::string oscillator = "dimensionless\ncoord q : number\nT = 1/2 q'^2\nV = 1/2 q^2\nstart q = 1\nrun 1\n";

std::string codes_of(const std::string& text) {
  const Elaborated e(text);
  std::string out;
  for (const Diagnostic& d : e.diagnostics.items()) out += d.code + " ";
  return out;
}

}  // namespace

TEST_CASE("accelerations are no part of what an event sets or what friction takes") {
  CHECK(codes_of(oscillator + "event e when t = 0.5 : set q' = q''\n") == "E0401 ");
  CHECK(codes_of(oscillator + "let r = q'\nevent e when t = 0.5 : set q = r'\n") == "E0401 ");
  CHECK(codes_of(oscillator + "event e when q'' = 0 : set q' = q\n").empty());
  CHECK(codes_of(oscillator + "friction q limit 1 + q''\n") == "E0401 ");
  CHECK(codes_of(oscillator + "friction q limit 1 static 2 + q''\n") == "E0401 ");
  CHECK(codes_of(oscillator + "friction q coefficient 0.1 normal q''\n") == "E0401 ");
  CHECK(codes_of("dimensionless\ncoord q, z : number\nT = 1/2 (q'^2 + z'^2)\nconstraint z = 0 name rail\n"
                 "friction q coefficient 0.1 normal reaction(rail)\n")
            .empty());
  CHECK(codes_of("dimensionless\ncoord y : number\nL = 1/2 y''^2\nD = (y L)^2\n") == "E0401 ");
  CHECK(codes_of("dimensionless\ncoord y : number\nL = 1/2 y'^2\nD = (y L)^2\n").empty());
}

TEST_CASE("third derivatives are no part of what is asked along the motion, by rates neither") {
  const std::string sleigh =
      "dimensionless\ncoord x, ψ : number\nT = 1/2 (x'^2 + ψ'^2)\nrates v = x' cos(ψ), ω = ψ'\nrun 1\n";
  for (const char* asked : {"event e when v'' = 1 : record", "event e when 1 = v'' : record", "expect v'' at 1 = 0 ± 1",
                            "let a = v'\nexpect a' at 1 = 0 ± 1"})
    CHECK(codes_of(sleigh + asked + "\n") == "E0401 ");
  CHECK(codes_of(sleigh + "event e when v' = 1 : record\nexpect v' at 1 = 0 ± 1\n").empty());
}

TEST_CASE("an acceleration in the Lagrangian that masses contradict is told at its place") {
  CHECK(codes_of("dimensionless\ncoord y : number\nL = 1/2 y''^2 - y\npoint R mass 1 at (1, 0)\n") == "E0259 ");
}

TEST_CASE("momenta in events and in the end of a run are formulas of the state") {
  const Elaborated e(
      "dimensionless\ncoord q : number\nparam m = 3, a = 2\nlet w = q'\nL = 1/2 m w^2 + a q q'\nstart q = 1\n"
      "event e when p_q = 5 rising : record\nrun until p_q = 7 within 10\n");
  REQUIRE(e.model);
  const MechanicalSystem& s = e.model->system;
  Bindings at;
  for (const Parameter& p : s.parameters) at[p.symbol] = p.si_value;
  at[s.coordinates[0].q] = 0.5, at[s.coordinates[0].velocity] = 4;
  const Expr both[] = {e.model->experiment.events.front().function, e.model->experiment.until};
  const std::vector<double> values = evaluate(both, at);
  CHECK(values[0] == doctest::Approx(3 * 4 + 2 * 0.5 - 5));
  CHECK(values[1] == doctest::Approx(3 * 4 + 2 * 0.5 - 7));
}

#include "support.hpp"

#include <cmath>

using namespace maupertuis;
using maupertuis::test::Elaborated;

// Models whose independent variable is not the time, ends of paths, held integrals, and what is expected of paths.

namespace {

const std::string brachistochrone =
    "param g = 9.81 m/s^2\nindependent x : length\ncoord y : length\nL = sqrt((1 + y'^2)/(2 g y))\nstart y = 1 m\n";
const std::string two = "dimensionless\nparam l = 3\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2)\n";

std::string dimension_of(const Dimension& d) { return to_string(d); }

double number(Expr e) { return evaluate(e, Bindings{}); }

}  // namespace

TEST_CASE("x in the place of t: velocities, the integrand and times are measured by it") {
  const Elaborated m(brachistochrone);
  REQUIRE_MESSAGE(m.fine(), m.messages());
  CHECK(m.system().independent == "x");
  CHECK(m.system().context->time().name() == "x");
  CHECK(dimension_of(m.system().independent_dimension) == "m");
  CHECK(m.system().lagrangian_dimension.same_as(dimensions::time() / dimensions::length()));
  CHECK(m.system().independent_unit() == "m");
  CHECK(m.system().moment("3") == "x = 3 m");
  // y' has no dimension: a slope in m/s is wrong, and so is a bare length.
  CHECK(Elaborated(brachistochrone + "start y' = 2\n").fine());
  CHECK(Elaborated(brachistochrone + "start y' = 2 m/s\n").codes() == "E0304");
  CHECK(Elaborated(brachistochrone + "run 2 m\n").fine());
  const Elaborated seconds(brachistochrone + "run 2 s\n");
  CHECK(seconds.codes() == "E0304");
  CHECK(seconds.first_message() == "the duration of a run is a length (m), this is a time (s)");
  CHECK(Elaborated(brachistochrone + "start at 2 s\n").first_message() ==
        "the start x is a length (m), this is a time (s)");
  CHECK(Elaborated(brachistochrone + "expect y at 2 s = 1 m ± 1e-9\n").first_message() ==
        "x of an expectation is a length (m), this is a time (s)");
}

TEST_CASE("sums of different dimensions in an integrand are found with dq/dx") {
  CHECK(Elaborated("independent x : length\ncoord y : length\nL = sqrt(1 + y'^2)\n").fine());
  CHECK(Elaborated("coord y : length\nL = sqrt(1 + y'^2)\n").codes() == "E0302");
  CHECK(Elaborated("independent x : length\ncoord θ : angle\nL = sqrt(1 + θ'^2)\n").codes() == "E0302");
  CHECK(Elaborated("independent x : length\ncoord y : length\nL = y sqrt(1 + y'^2)\nL += x y'^2\n").fine());
  CHECK(Elaborated("independent x : length\ncoord y : length\nL = y sqrt(1 + y'^2)\nL += y'^2\n").codes() == "E0304");
}

TEST_CASE("kinds of the independent variable") {
  const auto unit = [](const std::string& line, const std::string& rest = "coord y : length\nL = y'^2\n") {
    return Elaborated(line + rest).system().independent_unit();
  };
  CHECK(unit("independent x\n") == "m");  // as the first coordinate
  CHECK(unit("independent x : number\n").empty());
  CHECK(unit("independent x : [m^2]\n") == "m^2");
  CHECK(unit("independent φ : angle\n") == "rad");
  CHECK(unit("independent τ : [s]\n", "param m = 1 kg\ncoord y : length\nT = 1/2 m y'^2\n") == "s");
  CHECK(unit("independent t\n", "param m = 1 kg\ncoord y : length\nT = 1/2 m y'^2\n") == "s");
  CHECK(unit("", "param m = 1 kg\ncoord y : length\nT = 1/2 m y'^2\n") == "s");
  CHECK(unit("independent x\n", "dimensionless\ncoord y : number\nT = 1/2 y'^2\n").empty());
  CHECK(Elaborated("independent x : [foo]\ncoord y : length\nL = y'^2\n").codes() == "E0301");
}

TEST_CASE("mechanics needs the time") {
  const std::string x = "independent x : length\ncoord y : length\nparam m = 1 kg, g = 9.81 m/s^2, k = 1 N/m\n";
  for (const char* line :
       {"T = 1/2 m y'^2\n", "V = m g y\n", "point P mass m at (0, y)\n", "gravity (0, -g)\n",
        "spring O - O stiffness k\n", "force y = 1 [N]\n", "D = 1/2 k y'^2\n", "frame F at (0, y)\n"}) {
    CAPTURE(line);
    const Elaborated m(x + line);
    CHECK(m.codes().find("E0240") != std::string::npos);
  }
  const Elaborated points(x + "point P mass m at (0, y)\ngravity (0, -g)\n");
  CHECK(points.codes() == "E0240");  // one mistake, one message
  CHECK(points.first_message() == "`point` stands in a model whose independent variable is x");
  CHECK(Elaborated("independent τ : [s]\ncoord y : length\nparam m = 1 kg\npoint P mass m at (0, y)\n").fine());
  CHECK(Elaborated("dimensionless\nindependent τ\ncoord y : number\nT = 1/2 y'^2\n").fine());
  CHECK(Elaborated("dimensionless\nindependent φ : angle\ncoord y : number\nT = 1/2 y'^2\n").codes() == "E0240");
}

TEST_CASE("names of the independent variable") {
  CHECK(Elaborated("independent x\ncoord x : length\nL = x'^2\n").codes().find("E0202") != std::string::npos);
  CHECK(Elaborated("param x = 1 m\nindependent x\ncoord y : length\nL = y'^2\n").codes().find("E0202") !=
        std::string::npos);
  CHECK(Elaborated("independent x\nindependent s\ncoord y : length\nL = y'^2\n").codes() == "E0208");
  const Elaborated t("independent x : length\ncoord y : length\nL = sqrt(1 + y'^2) + t\n");
  CHECK(t.codes() == "E0201");
  CHECK(t.diagnostics.items()[0].reason ==
        "The independent variable of this model is x: it stands in the place of the time.");
  const Elaborated spacetime("dimensionless\nindependent s\ncoord t, r : number\nL = 1/2 (r'^2 - t'^2)\n");
  REQUIRE_MESSAGE(spacetime.fine(), spacetime.messages());
  CHECK(spacetime.system().coordinates[0].name == "t");
  const Elaborated constant(brachistochrone + "let a = g'\n");
  CHECK(constant.first_message() == "`g` does not change in x");
}

TEST_CASE("the ends of a path") {
  const Elaborated m(two + "path from (0, 1) at 0 to (2 l, free) at l\n");
  REQUIRE_MESSAGE(m.fine(), m.messages());
  const PathEnds& path = *m.experiment().path;
  CHECK(number(path.from[1]) == 1);
  CHECK(!path.to[1]);
  const Bindings at = m.at({0, 0}, {0, 0});
  CHECK(evaluate(path.to[0], at) == 6);
  CHECK(evaluate(path.end, at) == 3);

  const Elaborated units(
      "param m = 1 kg\ncoord x : length, θ : angle\nT = 1/2 m x'^2 + 0.5 [kg m^2] θ'^2\n"
      "path from (10 cm, 90 deg) at 0 s to (free, 1 rad) at 500 ms\n");
  REQUIRE_MESSAGE(units.fine(), units.messages());
  CHECK(number(units.experiment().path->from[0]) == 0.1);
  CHECK(number(units.experiment().path->from[1]) == doctest::Approx(std::acos(0.0)).epsilon(1e-15));
  CHECK(number(units.experiment().path->end) == 0.5);
}

TEST_CASE("mistakes in a path, with their places") {
  const auto mistake = [](const std::string& line) {
    const Elaborated m(two + line + "\n");
    REQUIRE(!m.diagnostics.empty());
    const Diagnostic& d = m.diagnostics.items()[0];
    return m.codes() + " " + (d.span ? std::string(m.source.slice(*d.span)) : "");
  };
  CHECK(mistake("path from 0 at 0 to (1, 2) at 1") == "E0241 0");
  CHECK(mistake("path from (0, 0) at 0 to (1, 2, 3) at 1") == "E0241 (1, 2, 3)");
  CHECK(mistake("path from (0, 0) at 2 to (1, 2) at 1") == "E0242 1");
  CHECK(mistake("path from (0, 0) at l to (1, 2) at 3") == "E0242 3");
  CHECK(mistake("path from (0, x) at 0 to (1, 2) at 1") == "E0222 x");
  CHECK(mistake("path from (0, t) at 0 to (1, 2) at 1") == "E0222 t");
  CHECK(mistake("path from (0, b) at 0 to (1, 2) at 1") == "E0201 b");
  CHECK(mistake("path from (0, 0) at 0 to (1, 2) at 1\npath from (0, 0) at 0 to (1, 2) at 1") ==
        "E0208 path from (0, 0) at 0 to (1, 2) at 1");
  const Elaborated units("param m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\npath from 1 s at 0 s to 2 m at 1 s\n");
  CHECK(units.codes() == "E0304");
  CHECK(units.first_message() == "`x` at the end of a path is a length (m), this is a time (s)");
  CHECK(Elaborated("param m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\npath from 1 m at 0 s to 2 m at 1 m\n").codes() ==
        "E0304");
}

TEST_CASE("--set goes into the ends of a path") {
  const Elaborated m(two + "path from (0, 1) at 0 to (2 l, free) at l\n", {{OverrideKind::Parameters, "--set", "l=5"}});
  CHECK(evaluate(m.experiment().path->to[0], m.at({0, 0}, {0, 0})) == 10);
  CHECK(Elaborated(two + "path from (0, 1) at 0 to (2, free) at l\n", {{OverrideKind::Parameters, "--set", "l=-5"}})
            .codes() == "E0242");
}

TEST_CASE("definitions of parameters are expanded in ends, integrals and expectations") {
  const Elaborated m(two +
                     "let a = 2 l\npath from (0, 1) at 0 to (a, free) at a\nconstraint integral a y = a\n"
                     "expect action of (a t, 1) from 0 to a = 2 a ± 1e-9\nexpect path a x at a/2 = a ± 1e-9\n");
  REQUIRE_MESSAGE(m.fine(), m.messages());
  const Bindings at = m.at({7, 11}, {0, 0}, 1);
  const Experiment& x = m.experiment();
  const IntegralConstraint& held = m.system().integral_constraints.at(0);
  CHECK(evaluate(x.path->to[0], at) == 6);
  CHECK(evaluate(x.path->end, at) == 6);
  CHECK(evaluate(held.integrand, at) == 66);
  CHECK(evaluate(held.value, at) == 6);
  CHECK(evaluate(m.expected<expectation::ActionAlong>(0).along.q[0], at) == 6);
  CHECK(evaluate(m.expected<expectation::ActionAlong>(0).along.to, at) == 6);
  CHECK(evaluate(m.expected<expectation::PathAt>(1).subject, at) == 42);
  CHECK(evaluate(m.expected<expectation::PathAt>(1).time, at) == 3);
}

TEST_CASE("a held integral has the dimension of its integrand times that of the independent variable") {
  const std::string chain = "independent x : length\ncoord y : length\nL = y sqrt(1 + y'^2)\n";
  const Elaborated m(chain + "constraint integral sqrt(1 + y'^2) = 3 m name total\nconstraint integral y = 2 m^2\n");
  REQUIRE_MESSAGE(m.fine(), m.messages());
  REQUIRE(m.system().integral_constraints.size() == 2);
  CHECK(m.system().integral_constraints[0].name == "total");
  CHECK(dimension_of(m.system().integral_constraints[0].dimension) == "m");
  CHECK(dimension_of(m.system().integral_constraints[1].dimension) == "m^2");
  CHECK(m.system().constraints.empty());
  CHECK(Elaborated(chain + "constraint integral y = 3 m\n").codes() == "E0304");
  CHECK(Elaborated(chain + "constraint integral x = 3 m^2\n").codes() == "E0423");
  CHECK(Elaborated(chain + "constraint integral y'' = 3\n").codes() == "E0401");
  CHECK(Elaborated(chain + "constraint integral y = y^2\n").codes() == "E0222");
  CHECK(Elaborated(chain + "constraint integral (y, y) = 3\n").codes() == "E0210");
}

TEST_CASE("an integrand that a held integral curves is no singular model") {
  const std::string dido = "independent x : length\ncoord y : length\nL = y\n";
  CHECK(Elaborated(dido).codes() == "E0407");
  CHECK(Elaborated(dido).first_message() == "the integrand is not curved in `y'`");
  CHECK(Elaborated(dido + "constraint integral sqrt(1 + y'^2) = 3 m\n").fine());
  CHECK(Elaborated("independent s : number\ncoord x, y : length\nL = sqrt(x'^2 + y'^2)\n").codes().find("E0408") !=
        std::string::npos);
}

TEST_CASE("expectations of paths: dimensions, ends and counts") {
  const std::string m = "param m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n",
                    path = "path from 0 m at 0 s to 1 m at 2 s\n";
  const auto codes = [&](const std::string& line) { return Elaborated(m + line + "\n").codes(); };
  CHECK(codes(path + "expect action = 1 J s ± 1e-9") == "");
  CHECK(codes(path + "expect action = 1 J ± 1e-9") == "E0304");
  CHECK(codes(path + "expect action = 1 mJ s ± 1e-9") == "");
  CHECK(codes(path + "expect action of (0.5 [m/s] * t) = 0.25 J s rel 1e-9") == "");
  CHECK(codes(path + "expect action of (t) = 0.25 J s rel 1e-9") == "E0304");
  CHECK(codes(path + "expect action of (1 [m/s] * t, 2) = 0.25 J s rel 1e-9") == "E0241");
  CHECK(codes(path + "expect action of (x) = 0.25 J s rel 1e-9") == "E0222");
  CHECK(codes("expect action of (1 [m/s] * t) = 0.25 J s rel 1e-9") == "E0243");
  CHECK(codes("expect action of (1 [m/s] * t) from 0 s to 2 s = 0.25 J s rel 1e-9") == "");
  CHECK(codes("expect action of (1 [m/s] * t) from 2 s to 1 s = 0.25 J s rel 1e-9") == "E0242");
  CHECK(codes("expect action of (1 [m/s] * t) from 0 m to 1 s = 0.25 J s rel 1e-9") == "E0304");
  CHECK(codes("expect action = 0.25 J s rel 1e-9") == "E0243");
  CHECK(codes("expect index = 0") == "E0243");
  CHECK(codes(path + "expect index = 0") == "");
  CHECK(codes(path + "expect index = 1 kg") == "E0304");
  CHECK(codes(path + "expect path x at 1 s = 0.5 m ± 1e-9") == "");
  CHECK(codes(path + "expect path x' at 1 s = 0.5 m/s ± 1e-9") == "");
  CHECK(codes(path + "expect path x at 1 m = 0.5 m ± 1e-9") == "E0304");
  CHECK(codes(path + "expect path x'' at 1 s = 0.5 m/s^2 ± 1e-9") == "E0401");
  CHECK(codes("expect path x at 1 s = 0.5 m ± 1e-9") == "E0243");
  const Elaborated unit(m + path + "expect action = 2 mJ s ± 0.5\n");
  CHECK(unit.expected<expectation::Action>(0).expected.unit.name == "mJ s");
  CHECK(number(unit.expected<expectation::Action>(0).expected.tolerance.size) == doctest::Approx(0.5e-3));
}

TEST_CASE("where an integral is held, expectations are about paths") {
  const std::string m =
      "dimensionless\ncoord x : number\nL = 1/2 x'^2\nconstraint integral x = 1 name area\npath from 0 at 0 to 0 at "
      "1\n";
  CHECK(Elaborated(m + "expect path x at 1/2 = 3/2 ± 1e-9\nexpect action = 6 ± 1e-9\nexpect index = 0\n").fine());
  for (const char* line :
       {"expect x at 1 = 0 ± 1e-9", "expect energy conserved rel 1e-9", "claim x'' = 0", "expect freedoms = 1"}) {
    CAPTURE(line);
    CHECK(Elaborated(m + line + "\n").codes() == "E0244");
  }
  CHECK(Elaborated(m + "expect path reaction(area) at 1/2 = 3/2 ± 1e-9\n").diagnostics.has_errors());
}

TEST_CASE("the dump of a system names what stands in the place of t") {
  const std::string text = dump(Elaborated(brachistochrone + "constraint integral y = 2 m^2 name area\n").system());
  CHECK(text.find("independent x [m]\n") != std::string::npos);
  CHECK(text.find("integral constraint area: ∫ y dx = 2 [m^2]\n") != std::string::npos);
}

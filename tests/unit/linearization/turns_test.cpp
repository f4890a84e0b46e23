// Angles and numbers that the equations know modulo a turn.
#include "support.hpp"

using namespace maupertuis;

TEST_CASE("A turn that the equations do not see is proved, however soft a spring is that sees it") {
  const auto periodic = [](const std::string& potential) {
    return Linearized(
               "dimensionless\nparam K = 1e15, N = 2\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 1/2 K (x - 1)^2 "
               "+ " +
               potential + "\nstart x = 0\n")
        .at.periodic()[1];
  };
  for (const char* potential :
       {"cos y", "sin(y/2)^2", "tan(y/2)^2", "sin(N y + 0.3)", "sin(x - y)^2", "exp(cos(2 y)) x^2"})
    CHECK_MESSAGE(periodic(potential), potential);
  for (const char* potential :
       {"1/2 (y - 30)^2", "sin(y/2)", "cos(y/3)^2", "cos(y/4)^2", "cos(0.5 N y/2)", "1e-9 y^2 + cos y", "sin(y^2)"})
    CHECK_MESSAGE(!periodic(potential), potential);
  for (const std::string stiff : {"1e3", "1e12", "1e13", "1e15"}) {
    CAPTURE(stiff);
    const ModalStudy study =
        Linearized("dimensionless\nparam K = " + stiff +
                   "\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 K (x - 1)^2 - 1/2 (y - 30)^2\n"
                   "start x = 0\n")
            .study();
    REQUIRE(study.entries.size() == 1);
    CHECK(near(study.entries[0].equilibrium.point.q[1], 30, 1e-14));
  }
}

TEST_CASE("Whether turns are seen follows the values of parameters") {
  Linearized m("dimensionless\nparam N = 2\ncoord y : number\nT = 1/2 y'^2\nV = cos(N y)\nstart y = 0\n");
  CHECK(m.at.periodic()[0]);
  m.at.set_parameter(0, 1.5);
  CHECK_FALSE(m.at.periodic()[0]);
  m.at.set_parameter(0, 3);
  CHECK(m.at.periodic()[0]);
}

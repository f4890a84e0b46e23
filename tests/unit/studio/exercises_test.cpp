#include "session.hpp"

#include <doctest/doctest.h>

#include <filesystem>

namespace maupertuis::studio {
namespace {

TEST_CASE("what is true of every system, or is the equation of another coordinate, is not what is asked") {
  const auto judged = [](const char* name, const char* about, const char* text) {
    Asked page(file_text(std::string("studio/exercises/") + name + ".lag"));
    return page.ask({{"do", "claim"}, {"text", text}, {"about", about}, {"exercise", true}});
  };
  for (const char* nothing : {"0 = 0", "s'' = s''", "s'' + X'' = X'' + s''", "(s' + X')^2 = s'^2 + 2 s' X' + X'^2"}) {
    CAPTURE(nothing);
    Json answer = judged("20_wedge", "s", nothing);
    CHECK(answer["passed"] == false);
    CHECK(answer["pitfall"].get<std::string>().find("same formula") != std::string::npos);
  }
  for (const char* other : {"(M + m) X'' + m cos α s'' = 0", "2 (M + m) X'' + 2 m cos α s'' = 0"}) {
    CHECK(judged("20_wedge", "X", other)["passed"] == true);
    CHECK(judged("20_wedge", "s", other)["passed"] == false);
    CHECK(judged("20_wedge", "s", other)["pitfall"].get<std::string>().find("equation of X") != std::string::npos);
  }
  for (const char* right :
       {"s'' + cos α X'' = g sin α", "s'' = (M + m) g sin α / (M + m sin^2 α)", "m s'' + m cos α X'' - m g sin α = 0"})
    CHECK(judged("20_wedge", "s", right)["passed"] == true);
  CHECK(judged("20_wedge", "s", "X'' = -m g sin α cos α / (M + m sin^2 α)")["passed"] == false);
}

TEST_CASE("exercises take the right equations, and name known mistakes without the answer") {
  Json exercises = Json::parse(file_text("tests/studio/exercises.json"));
  std::size_t files = 0;
  for (const auto& file : std::filesystem::directory_iterator(std::string(PROJECT_DIR) + "/studio/exercises")) {
    if (file.path().extension() == ".lag") {
      CHECK(exercises.contains(file.path().stem().string()));
      ++files;
    }
  }
  CHECK(files == 20);
  for (const auto& [name, claims] : exercises.items()) {
    CAPTURE(name);
    Asked page(file_text("studio/exercises/" + name + ".lag"));
    CHECK(page.opened["diagnostics"] == Json::array());
    CHECK(page.ask("run")["ok"] == true);
    for (const Json& right : claims["right"]) {
      CAPTURE(right);
      CHECK(page.ask({{"do", "claim"}, {"text", right}, {"exercise", true}})["passed"] == true);
    }
    for (const Json& wrong : claims["wrong"]) {
      CAPTURE(wrong);
      Json judged = page.ask({{"do", "claim"}, {"text", wrong[0]}, {"exercise", true}});
      CHECK(judged["passed"] == false);
      CHECK(judged.contains("expected") == false);
      CHECK(judged["message"].get<std::string>().rfind("It does not follow from Lagrange's equations", 0) == 0);
      const std::string pitfall = judged.value("pitfall", "");
      CAPTURE(pitfall);
      CHECK((wrong[1] == "" ? pitfall.empty() : pitfall.find(wrong[1].get<std::string>()) != std::string::npos));
      for (const Json& right : claims["right"])
        CHECK(judged.dump().find(right.get<std::string>()) == std::string::npos);
    }
  }
}

TEST_CASE("an answer that is right where a distance is positive says where") {
  Asked page(
      "system turntable\nparam m = 1 kg, k = 30 N/m, L0 = 20 cm, Ω = 3 rad/s\ncoord r : length\n"
      "point P mass m at (r cos(Ω t), r sin(Ω t))\npoint O1 at (0, 0)\nspring O1 - P stiffness k length L0\n"
      "start r = 30 cm\nrun 1 s\n");
  Json judged = page.ask({{"do", "claim"}, {"text", "m r'' = m r Ω^2 - k (r - L0)"}, {"exercise", true}});
  CHECK(judged["passed"] == true);
  CHECK(judged["where"] == "r > 0");
}

TEST_CASE("claims that cannot be read are told at their place") {
  Asked page(file_text("studio/exercises/01_pendulum.lag"));
  Json judged = page.ask({{"do", "claim"}, {"text", "θ'' = -g/l sinn θ"}});
  CHECK(judged["ok"] == false);
  REQUIRE(judged["diagnostics"].size() >= 1);
  CHECK(judged["diagnostics"][0]["in_claim"] == true);
  CHECK(judged["diagnostics"][0]["from"] == 11);
  CHECK(page.ask({{"do", "claim"}, {"text", ""}})["kind"] == "refused");
  CHECK(page.ask({{"do", "claim"}, {"text", "θ'' = 0\nm = 3"}})["kind"] == "refused");
  // Without `exercise` the difference is told.
  CHECK(page.ask({{"do", "claim"}, {"text", "θ'' = g/l sin θ"}})["message"].get<std::string>().find("sin") !=
        std::string::npos);
}

}  // namespace
}  // namespace maupertuis::studio

// Contacts from outside: what check and derive say of them, and what files and pictures hold.
#include "json.hpp"

#include <doctest/doctest.h>

using namespace cli_test;

namespace {

std::string box(const std::string& start) {
  return "system box\nparam m = 1 kg, g = 10 m/s^2\ncoord x, z : length\npoint P mass m at (x, z)\ngravity (0, -g)\n"
         "contact z >= 0 restitution 0.5 friction 0.3 static 0.4 slip x' name floor\n"
         "contact x <= 3 [m] name wall\nstart " +
         start + "\nrun 1 s\ndraw circle P 5 cm\n";
}

}  // namespace

TEST_CASE("check lists contacts, which are closed, which are hit at once, and how the motion begins") {
  const Folder folder;
  const Outcome slides = maup({"check", folder.write("a.lag", box("x' = 1 m/s"))});
  CHECK_MESSAGE(slides.code == 0, slides.err);
  CHECK(contains(slides.out, "floor: z >= 0, restitution 0.5, friction 0.3, static 0.4; closed at the start"));
  CHECK(contains(slides.out, "open at the start, by 3 m"));
  CHECK(contains(slides.out, "in the mode floor sliding +"));

  const std::string falls = folder.write("b.lag", box("z' = -2 m/s"));
  CHECK(contains(maup({"check", falls}).out, "at the start it touches and closes: an impact at once"));
  const Json document = json_of(maup({"check", falls, "--json"}));
  CHECK(document["first_mode"] == "free");
  REQUIRE(document["contacts"].size() == 2);
  CHECK(document["contacts"][0]["start"]["impact"] == true);
  CHECK(document["contacts"][0]["start"]["rate"] == -2.0);
  CHECK(document["contacts"][1]["friction"].is_null());

  const Outcome below = maup({"check", folder.write("c.lag", box("z = -1 mm"))});
  CHECK(below.code == 1);
  CHECK(contains(below.err, "E0728"));
}

TEST_CASE("derive --modes: the equations of each mode, certified, that of the start first") {
  const Folder folder;
  const std::string model = folder.write("a.lag", box("x' = 1 m/s"));
  const Outcome told = maup({"derive", model, "--modes"});
  CHECK_MESSAGE(told.code == 0, told.err);
  CHECK(told.out.rfind("Mode floor sliding +, in which the motion begins\n", 0) == 0);
  for (const char* part : {"Mode free\n", "Mode floor sticking\n", "Mode floor sliding −\n", "Mode wall\n",
                           "Mode floor sticking, wall\n", "Certificate: passed"})
    CHECK(contains(told.out, part));
  const Json document = json_of(maup({"derive", model, "--modes", "--json"}));
  CHECK(document["number_of_modes"] == 8);
  REQUIRE(document["modes"].size() == 8);
  for (const Json& mode : document["modes"])
    if (mode.contains("certificate")) CHECK(mode["certificate"]["passed"] == true);
  // The same as the one mode alone.
  const Json alone = json_of(maup({"derive", model, "--mode", "floor sliding +", "--json"}));
  CHECK(document["modes"][0]["equations"] == alone["equations"]);

  // Eight derivations do not come in a thousandth of a second: those that do are shown, the others are told.
  const Json short_of_time = json_of(maup({"derive", model, "--modes", "--budget", "1ms", "--json"}));
  const std::size_t left_out = short_of_time["modes_left_out"];
  CHECK(left_out > 0);
  CHECK(short_of_time["modes"].size() + left_out == 8);
  CHECK(short_of_time["diagnostics"][0]["code"] == "W0827");
  CHECK(document["modes_left_out"] == 0);
  CHECK(maup({"derive", model, "--budget", "1s"}).code == 2);
  CHECK(maup({"derive", model, "--modes", "--budget", "soon"}).code == 2);

  CHECK(maup({"derive", model, "--modes", "--steps"}).code == 2);
  CHECK(maup({"derive", folder.write("p.lag", pendulum), "--modes"}).code == 2);
}

TEST_CASE("rows beside impacts, marks and bars in plots, surfaces and arrows in drawings") {
  const Folder folder;
  const std::string model = folder.write("a.lag", box("z = 0.2 m, x' = 1 m/s")), csv = folder.path("a.csv"),
                    plot = folder.path("a.svg"), still = folder.path("still.svg");
  REQUIRE(maup({"simulate", model, "-o", csv, "--every", "0.25s"}).code == 0);
  const std::string rows = read(csv);
  std::size_t at = 0;
  std::string before;
  bool twice = false;
  while ((at = rows.find("\r\n", at)) != std::string::npos) {
    const std::string time = rows.substr(at + 2, rows.find(',', at) - at - 2);
    twice = twice || (time == before && !time.empty());
    before = time;
    at += 2;
  }
  CHECK(twice);
  REQUIRE(maup({"plot", model, "-o", plot}).code == 0);
  CHECK(contains(read(plot), "class=\"mark\""));
  CHECK(contains(read(plot), "class=\"strip s3\""));
  CHECK(contains(read(plot), "sticking"));
  REQUIRE(maup({"animate", model, "--still", "0.95s", "-o", still}).code == 0);
  CHECK(contains(read(still), "</svg>"));
}

TEST_CASE("a coefficient of friction is shown as it was written, also where the multiplier is no normal force") {
  const Folder folder;
  const std::string bowl = folder.write(
      "bowl.lag",
      "coord x, y : length\nparam m = 1 kg, g = 9.81 m/s^2, a = 1/m\npoint P mass m at (x, y)\ngravity (0, -g)\n"
      "contact y >= a x^2 friction 0.3 static 0.4 slip (x' + 2 a x y')/sqrt(1 + 4 a^2 x^2) name bowl\n"
      "start x = 0.5 m, y = 0.25 m\n");
  const Outcome checked = maup({"check", bowl});
  CHECK_MESSAGE(checked.code == 0, checked.err);
  CHECK(contains(checked.out, "friction 0.3, static 0.4"));
  const Json document = json_of(maup({"check", bowl, "--json"}));
  CHECK(document["contacts"][0]["friction"]["kinetic"] == 0.3);
  CHECK(document["contacts"][0]["friction"]["static"] == 0.4);
}

TEST_CASE("a step of low order finds where a gap that swings within it closes") {
  // A flight is a polynomial of degree 2, one step at any order; the table swings seven times in it.
  const Outcome low = maup({"test", PROJECT_DIR "/models/ball_on_vibrating_table.lag", "--order", "4"});
  CHECK_MESSAGE(low.code == 0, low.err);
}

TEST_CASE("modes: a rest whose forces the balance leaves open is told with that, and sets that are left out") {
  const Folder folder;
  const std::string feet = folder.write(
      "feet.lag",
      "system feet\nparam m = 1 kg, g = 9.81 m/s^2, a = 0.1 m, α = 20 deg\ncoord x, z : length, θ : angle\n"
      "body b mass m inertia m a^2/6 at (x, z) rotation angle θ\ngravity (-g sin α, -g cos α)\n"
      "contact z + a/2*(-cos θ - sin θ) >= 0 friction 0.5 slip x' + a/2*(cos θ + sin θ) θ' name left\n"
      "contact z + a/2*(-cos θ + sin θ) >= 0 friction 0.5 slip x' + a/2*(cos θ - sin θ) θ' name right\n"
      "start z = a/2\n");
  const Outcome told = maup({"modes", feet});
  CHECK(contains(told.out, "Mode \"left sticking, right sticking\"\nz = 0.05 m, θ = 0\n  held by static friction"));
  CHECK(contains(told.out, "the balance does not determine these forces (statically indeterminate)"));
  CHECK_FALSE(contains(told.out, "were looked at"));
  const Json document = json_of(maup({"modes", feet, "--json"}));
  CHECK(document["sets_of_contacts"] == Json({{"looked_at", 4}, {"all", 4.0}}));
  CHECK(document["resting"].back()["points"][0]["forces_determined"] == false);

  std::string blocks = "system blocks\nparam m = 1 kg, g = 9.81 m/s^2, k = 40 N/m\ncoord x : length\n", kinetic,
              contacts;
  for (const char c : std::string("abcdefgh")) {
    const std::string z = std::string("z_") + c;
    blocks += "coord " + z + " : length\n";
    kinetic += " + 1/2 m " + z + "'^2";
    contacts += "V += m g " + z + "\ncontact " + z + " >= 0 name on_" + c + "\n";
  }
  const Outcome many =
      maup({"modes", folder.write("blocks.lag", blocks + "T = 1/2 m x'^2" + kinetic + "\nV = 1/2 k x^2\n" + contacts)});
  CHECK_MESSAGE(many.code == 0, many.err);
  CHECK(contains(many.out, "Mode \"on_a, on_b, on_c, on_d, on_e, on_f, on_g, on_h\"\n"));
  CHECK(contains(many.out, "64 of 256 sets of closed contacts were looked at"));
}

#include <doctest/doctest.h>

#include "json.hpp"
#include "program.hpp"

#include <sstream>

// Mistakes in an option are shown in the option; formulas stand wherever columns are asked for.

using namespace cli_test;

namespace {

const std::string kDouble =
    "system double_pendulum\nparam m1 = 1 kg, m2 = 1 kg, l1 = 1 m, l2 = 1 m, g = 9.81 m/s^2, Ω = 1 rad/s\ncoord θ1, θ2 "
    ": angle\n"
    "point A mass m1 at l1 (sin θ1, -cos θ1)\npoint B mass m2 at A + l2 (sin θ2, -cos θ2)\ngravity (0, -g)\n"
    "start θ1 = 0.3 rad, θ2 = 0.1 rad\nrun 0.2 s\n";

/// The numbers of a CSV text by rows; its first line is left out.
std::vector<std::vector<double>> numbers(const std::string& csv) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

struct Wrong {
  std::vector<std::string> arguments;
  const char *option, *text, *carets, *says;
};

}  // namespace

TEST_CASE("a mistake in an option is shown in the option, with carets below it, and exits with 2") {
  for (const Wrong& w : {
           Wrong{{"simulate", "-", "--until", "20s"}, "--until", "20s", "^^^", "Write --duration 20s"},
           Wrong{{"simulate", "-", "--until", "B.y"}, "--until", "B.y", "^^^", "B.y = 0"},
           Wrong{{"simulate", "-", "--until", "B.z = 0"}, "--until", "B.z = 0", "  ^", "two-dimensional"},
           Wrong{{"simulate", "-", "--until", "B.y = 0", "--within", "2 kgg"}, "--within", "2 kgg", "  ^^^", "no unit"},
           Wrong{{"plot", "-", "--until", "θ3 = 0"}, "--until", "θ3 = 0", "^^", "Did you mean"},
           Wrong{{"simulate", "-", "--set", "l1=2 mx"}, "--set", "l1=2 mx", "     ^^", "no unit"},
           Wrong{{"simulate", "-", "--set", "q=2"}, "--set", "q=2", "^", "no parameter"},
           Wrong{{"simulate", "-", "--set", "l1=2 kg"}, "--set", "l1=2 kg", "   ^^^^", "mass"},
           Wrong{{"simulate", "-", "--set", "l1=2m", "--set", "g=1 N"}, "--set", "g=1 N", "  ^^^", "force"},
           Wrong{{"simulate", "-", "--start", "θ1=2 s"}, "--start", "θ1=2 s", "   ^^^", "time"},
           Wrong{{"modes", "-", "--at", "θ9=0"}, "--at", "θ9=0", "^^", "not declared"},
           Wrong{
               {"modes", "-", "--sweep", "Ω = 0 .. 12 rad steps 3"}, "--sweep", "Ω = 0 .. 12 rad steps 3", "", "rad/s"},
           Wrong{{"modes", "-", "--at", "θ1=0", "--Q", "1, x, 3, 4"}, "--Q", "1, x, 3, 4", "   ^", "no number"},
           Wrong{{"plot", "-", "--y", "θ1 - θ3"}, "--y", "θ1 - θ3", "     ^^", "Did you mean"},
           Wrong{{"plot", "-", "--y", "θ1 - l1"}, "--y", "θ1 - l1", "     ^^", "angle"},
           Wrong{{"simulate", "-", "--columns", "θ1, cos θ1 - t", "-o", "never_written.csv"},
                 "--columns",
                 "cos θ1 - t",
                 "         ^",
                 "time"},
           Wrong{{"hamiltonian", "-", "--bracket", "θ1", "p_θ9"}, "--bracket", "p_θ9", "^^^^", "not declared"},
           Wrong{{"action", "-", "--path", "θ1 = t, θ2 = 3 m", "--from", "0s", "--to", "1s"},
                 "--path",
                 "θ1 = t, θ2 = 3 m",
                 "     ^",
                 "along the path"},
       }) {
    std::string command;
    for (const std::string& a : w.arguments) command += a + " ";
    CAPTURE(command);
    const Outcome outcome = maup(w.arguments, kDouble);
    INFO(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(contains(outcome.err, std::string(" ") + w.option + ":1:"));
    CHECK(contains(outcome.err, std::string("1 | ") + w.text + "\n"));
    CHECK(contains(outcome.err, std::string("| ") + w.carets));
    CHECK(contains(outcome.err, w.says));
    CHECK_FALSE(contains(outcome.err, "<stdin>:1"));
  }
}

TEST_CASE("JSON tells the option, and a mistake of the model keeps its line") {
  const auto wrong = json_of(maup({"simulate", "-", "--json", "--set", "l1=2 mx"}, kDouble));
  CHECK(wrong.at("diagnostics").at(0).at("option") == "--set");
  CHECK(wrong.at("diagnostics").at(0).at("column") == 6);
  const std::string model = "\n\nrun 3 s\n" + kDouble.substr(0, kDouble.find("run 0.2")) + "let a = b\n";
  const auto of_model = json_of(maup({"simulate", "-", "--json", "--until", "B.y = 0"}, model));
  CHECK(of_model.at("diagnostics").at(0).at("line") == 11);
  CHECK_FALSE(of_model.at("diagnostics").at(0).contains("option"));
}

TEST_CASE("--until takes the place of the model's own run") {
  const Outcome outcome = maup({"simulate", "-", "--json", "--until", "θ1 = 0", "--within", "5 s"}, kDouble);
  CHECK(outcome.code == 0);
  CHECK(json_of(outcome).at("ended").at("kind") == "until reached");
}

TEST_CASE("formulas are columns of a trajectory, with units, and the rows are what they say") {
  const Folder folder;
  const std::string file = folder.path("m.csv");
  const Outcome outcome = maup(
      {"simulate", "-", "-o", file, "--columns", "θ1 - θ2, θ1, θ2, max(θ1, θ2), 1/2 m1 (l1 θ1')^2, θ1'', energy, θ1'"},
      kDouble);
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  const std::string csv = read(file);
  CHECK(contains(csv, "θ1 - θ2 [rad],θ1 [rad],θ2 [rad],\"max(θ1, θ2) [rad]\",1/2 m1 (l1 θ1')^2 [J]"));
  const auto rows = numbers(csv.substr(csv.find('\n') - 1 + 1));
  REQUIRE(rows.size() > 5);
  for (const auto& row : rows) {
    REQUIRE(row.size() == 9);
    CHECK(row[1] == doctest::Approx(row[2] - row[3]));
    CHECK(row[4] == doctest::Approx(std::max(row[2], row[3])));
    CHECK(row[5] == doctest::Approx(0.5 * row[8] * row[8]));
  }
  // θ1'' is the slope of θ1'.
  const std::size_t k = rows.size() / 2;
  CHECK(rows[k][6] ==
        doctest::Approx((rows[k + 1][8] - rows[k - 1][8]) / (rows[k + 1][0] - rows[k - 1][0])).epsilon(1e-2));
}

TEST_CASE("formulas on both axes of a picture; with errors of their own") {
  const Outcome picture = maup({"plot", "-", "--x", "θ1 - θ2", "--y", "θ1' - θ2', sin(θ1)"}, kDouble);
  CHECK(picture.code == 0);
  CHECK(contains(picture.out, "<svg"));
  const Folder folder;
  const std::string file = folder.path("m.csv");
  REQUIRE(maup({"simulate", "-", "-o", file, "--errors", "--columns", "2 θ1, θ1"}, kDouble).code == 0);
  const auto rows = numbers(read(file));
  for (const auto& row : rows) CHECK(row[3] == doctest::Approx(2 * row[4]));
}

TEST_CASE("the errors of columns hold what rounding makes of their formulas") {
  const std::string still =
      "dimensionless\ncoord y, x : number\nL = 1/2 y'^2 + 1/2 x'^2\nstart y = 0.03, x = 1\nrun 1\n";
  const Folder folder;
  const std::string file = folder.path("m.csv");
  const auto outcome =
      maup({"simulate", "-", "-o", file, "--errors", "--columns", "1e5 (1 - cos(1e-4 y)), x"}, still);
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  const double right = 2e5 * std::pow(std::sin(0.5e-4 * 0.03), 2);
  for (const auto& row : numbers(read(file))) {
    REQUIRE(row.size() == 5);
    CHECK(std::abs(row[1] - right) <= row[3]);
    CHECK(row[3] > 1e-12);
    CHECK(row[3] < 1e-9);
    CHECK(row[4] < 1e-15);
  }
}

TEST_CASE("forces of constraints in formulas") {
  const std::string rod =
      "system rod\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at (x, y)\ngravity (0, "
      "-g)\n"
      "constraint x^2 + y^2 = l^2 name rod\nstart x = 0.6 m, y = -0.8 m\nrun 0.5 s\n";
  const Folder folder;
  const std::string file = folder.path("m.csv");
  const Outcome outcome =
      maup({"simulate", "-", "-o", file, "--columns", "reaction(rod), 2 reaction(rod)/(m g), multiplier(rod)"}, rod);
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  for (const auto& row : numbers(read(file))) CHECK(row[2] == doctest::Approx(2 * row[1] / 9.81));
}

TEST_CASE("accelerations of a block that slides on a floor and comes to rest are those of the mode that it is in") {
  const std::string block =
      "system block\nparam m = 1 kg, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at (x, y)\ngravity (0, -g)\n"
      "contact y >= 0 friction 0.3 slip x' name floor\nstart x' = 1 m/s\nrun 0.6 s\n";  // it stops at 0.34 s
  const Folder folder;
  const std::string file = folder.path("m.csv");
  const Outcome outcome =
      maup({"simulate", "-", "--every", "0.1 s", "-o", file, "--columns", "x'', y'', 2 reaction(floor), p_x"}, block);
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  const std::string csv = read(file);
  CHECK(contains(csv, "x'' [m/s^2],y'' [m/s^2],2 reaction(floor) [N],p_x"));
  for (const auto& row : numbers(csv)) {
    const bool slides = row[0] < 0.339;
    CHECK(row[1] == doctest::Approx(slides ? -2.943 : 0));
    CHECK(row[2] == doctest::Approx(0));
    CHECK(row[3] == doctest::Approx(19.62));
    CHECK(row[4] == doctest::Approx(slides ? 1 - 2.943 * row[0] : 0));
  }
}

TEST_CASE("--sweep with one unit and without its number of values") {
  const Outcome outcome = maup({"modes", "-", "--sweep", "l2 = 1 .. 2 m", "--json"}, kDouble);
  CHECK(outcome.code == 0);
}

TEST_CASE("a plot of a formula has a gap where it has no value; --x takes one") {
  const Folder folder;
  const std::string model = folder.write("pendulum.lag", pendulum), svg = folder.path("p.svg");
  for (const std::vector<std::string>& asked : {std::vector<std::string>{"plot", "--y"},
                                                {"plot", "--y", "θ", "--x"},
                                                {"simulate", "--plot", "-", "--columns"}}) {
    std::vector<std::string> line = asked;
    for (std::string& word : line)
      if (word == "-") word = folder.path("columns.svg");
    line.insert(line.begin() + 1, model);
    line.emplace_back("1/θ'");  // infinite at t = 0 alone
    if (line[0] == "plot") line.insert(line.end(), {"-o", svg});
    const Outcome gap = maup(line);
    CAPTURE(asked.back());
    CHECK(gap.code == 0);
    CHECK(contains(gap.err, "1/θ' at t = 0 is no finite number: its curve has a gap"));
    CHECK(contains(gap.err, "1 | 1/θ'\n"));
  }
  CHECK(maup({"plot", model, "--y", "1/(t - 1 [s])", "-o", svg}).code == 0);
  const Outcome columns =
      maup({"simulate", model, "--plot", folder.path("columns.svg"), "--columns", "θ, log(-1 - θ^2)"});
  CHECK(columns.code == 3);
  CHECK(contains(columns.err, "log(-1 - θ^2) at t = 0 is no finite number"));
  const Outcome none = maup({"plot", model, "--y", "sqrt(-1 - θ^2)", "-o", svg});
  CHECK(none.code == 3);
  CHECK(contains(none.err, "sqrt(-1 - θ^2) at t = 0 is no finite number"));
  CHECK(contains(none.err, "1 | sqrt(-1 - θ^2)\n"));
  const Outcome two = maup({"plot", model, "--x", "θ, θ'", "--y", "θ", "-o", svg});
  CHECK(two.code == 2);
  CHECK(contains(two.err, "--x names 2 columns."));
}

TEST_CASE("numbers and texts of options that mean nothing are told in words") {
  const Folder folder;
  const std::string model = folder.write("pendulum.lag", pendulum), henon = PROJECT_DIR "/models/henon_heiles.lag";
  struct Wrong {
    std::vector<std::string> line;
    const char* says;
  };
  for (const Wrong& w : {Wrong{{"orbits", model, "--lyapunov", "--exponents", "0"}, "0 is no positive number"},
                         Wrong{{"orbits", henon, "--section", "x = 0", "--crossings", "0"}, "0 is no positive number"},
                         Wrong{{"orbits", henon, "--section", "x = 0", "--longest", "0s"}, "is no time that passes"},
                         Wrong{{"orbits", henon, "--section", "x = 0", "--starts", "3", "--energy", "nan"},
                               "--energy is no finite number"},
                         Wrong{{"modes", model, "--sweep", ""}, "nothing is written"},
                         Wrong{{"modes", model, "--sweep", "m = -1 .. 1 kg steps 3"}, "makes the mass `m` negative"},
                         Wrong{{"simulate", model, "--until", "θ = θ"}, "does not depend on the motion"},
                         Wrong{{"simulate", model, "--until", "0 = 0"}, "does not depend on the motion"}}) {
    const Outcome outcome = maup(w.line);
    CAPTURE(w.says);
    CHECK(outcome.code == 2);
    CHECK_MESSAGE(contains(outcome.err, w.says), outcome.err);
    CHECK(outcome.err.size() < 1500);
  }
  const std::string broken = folder.write("broken.lag", "coord x \x1b\n");
  for (const char* command : {"simulate", "plot", "derive", "modes"}) CHECK(maup({command, broken}).code == 1);
}

TEST_CASE("a unit of an option that is a parameter of the model, too, is refused where both give a time") {
  const Folder folder;
  const std::string bare = folder.write("bare.lag",
                                        "system bare\ndimensionless\nparam s = 5\ncoord x : number\n"
                                        "T = 1/2 x'^2\nV = 1/2 s x^2\nstart x = 1\nrun 3 s\n");
  CHECK(contains(maup({"simulate", bare}).out, "t = 15"));  // 3 * s
  const std::string plain = folder.write("plain.lag",
                                         "system plain\ndimensionless\ncoord x : number\nT = 1/2 x'^2\n"
                                         "V = 5/2 x^2\nstart x = 1\nrun 3\n");
  for (const std::vector<std::string>& line : {std::vector<std::string>{"simulate", bare, "--duration", "3s"},
                                               {"simulate", bare, "--at", "1,2 s"},
                                               {"simulate", bare, "--precision", "quad", "--duration", "3s"},
                                               {"orbits", bare, "--floquet", "--period", "2 s"},
                                               {"compare", bare, plain, "--duration", "3s"},
                                               {"compare", plain, bare, "--duration", "3s"},
                                               {"orbits", bare, "--lyapunov", "--duration", "3 s"}}) {
    const Outcome refused = maup(line);
    CHECK(refused.code == 2);
    CHECK_MESSAGE(contains(refused.err, "`s` is a unit and also a parameter of this model."), refused.err);
  }
  CHECK(contains(maup({"simulate", bare, "--duration", "3"}).out, "t = 3"));
  CHECK(contains(maup({"simulate", bare, "--duration", "3000ms"}).out, "t = 3"));

  const std::string text = "system of_units\ncoord x : length\nparam m = 1 kg, k = 1 N/m, s = 5";
  const std::string rest = "\nT = 1/2 m x'^2\nV = 1/2 k x^2\nstart x = 1 m\nrun 3 [s]\n";
  CHECK(maup({"simulate", folder.write("number.lag", text + rest), "--duration", "3s"}).code == 0);
  const Outcome refused = maup({"simulate", folder.write("time.lag", text + " s" + rest), "--duration", "3s"});
  CHECK_MESSAGE(contains(refused.err, "`s` is a unit and also a parameter of this model."), refused.err);
}

TEST_CASE("an expectation that has no value with other parameters keeps nothing from being computed") {
  const std::string model =
      "system saddle\ndimensionless\nparam k = 1, Ω = 1.5\ncoord x, y : number\nframe F rotation angle Ω t\n"
      "point P mass 1 at (x, y) in F\nV = 1/2 k (x^2 - y^2)\nstart x = 0.1\nrun 1\n"
      "expect frequencies at x = 0, y = 0 : sqrt(Ω^2 - k), sqrt(Ω^2 + k) rel 1e-12\n";
  CHECK(maup({"test", "-"}, model).code == 0);
  for (const char* command : {"simulate", "derive", "modes", "check"}) {
    const Outcome outcome = maup({command, "-", "--set", "Ω=0.99"}, model);
    CAPTURE(command);
    CHECK_MESSAGE(outcome.code == 0, outcome.err);
    CHECK(contains(outcome.err, "N0252"));
  }
  const Outcome test = maup({"test", "-"},
                            "dimensionless\nparam k = 1, Ω = 0.99\ncoord x : number\n"
                            "L = 1/2 x'^2 - 1/2 k x^2\nstart x = 1\n"
                            "expect frequencies at x = 0 : sqrt(Ω^2 - k) rel 1e-9\n"
                            "expect eigenvalues at x = 0 : (0, sqrt(Ω^2 - k)) rel 1e-9\n");
  CHECK(test.code == 4);
  CHECK(contains(test.out, "0 of 2 expectations hold"));
  CHECK(contains(test.out, "has no value with these parameters"));
}

// Pictures, films and pages of fields: what was asked for is in them, and what has no meaning for fields is refused.
#include "program.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <set>

#include <cmath>

using namespace cli_test;

namespace {

const std::string string_text =
    "system s \"A string\"\ndimensionless\nfield u(x) : number on x = 0 .. 1 cells 10 order 5 boundary u = 0\n"
    "density = 1/2 u'^2 - 1/2 u_x^2\nstart u = sin(pi x)\nrun 2\nexpect u (0.5) at 2 = 1 ± 1e-6\n";
const std::string membrane_text =
    "system m \"A membrane\"\ndimensionless\nfield u(x, y) : number on x = 0 .. 2, y = 0 .. 1 cells 6, 4 order 4 "
    "boundary u = 0\ndensity = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2)\nstart u = sin(pi x/2) sin(pi y)\nrun 1\n";

std::size_t times_in(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++n;
  return n;
}

}  // namespace

TEST_CASE("fields are drawn at moments and over space and time") {
  const Outcome both = maup({"plot", "-"}, string_text), map = maup({"plot", "-", "--map"}, string_text),
                curves = maup({"plot", "-", "--curves"}, string_text), plane = maup({"plot", "-"}, membrane_text),
                rate = maup({"plot", "-", "--y", "u, u'", "--dark"}, string_text);
  for (const Outcome* one : {&both, &map, &curves, &plane, &rate}) {
    CHECK(one->code == 0);
    CHECK(contains(one->out, "</svg>"));
    CHECK_FALSE(contains(one->out, "nan"));
  }
  const std::string bar = "shape-rendering=\"crispEdges\"", curve = "class=\"curve";
  CHECK(times_in(both.out, bar) == 1);
  CHECK(times_in(map.out, bar) == 1);
  CHECK(times_in(curves.out, bar) == 0);
  CHECK(times_in(map.out, curve) == 0);
  CHECK(times_in(both.out, curve) == 18);  // six moments: curve, key, mark
  CHECK(times_in(curves.out, curve) == 12);
  CHECK(times_in(plane.out, "<g stroke=\"none\">") == 6);
  CHECK(times_in(rate.out, bar) == 2);
  CHECK(times_in(rate.out, "A string") == times_in(both.out, "A string"));  // one title
}

TEST_CASE("fields move, and their report has its parts") {
  const Folder folder;
  const std::string string = folder.write("s.lag", string_text), membrane = folder.write("m.lag", membrane_text);
  const std::string film = folder.path("s.svg"), still = folder.path("still.svg"), page = folder.path("m.html");
  CHECK(maup({"animate", string, "-o", film, "--speed", "1", "--fps", "10"}).code == 0);
  CHECK(times_in(read(film), "<animate ") == 21);
  CHECK(maup({"animate", string, "-o", still, "--still", "0.5"}).code == 0);
  CHECK(contains(read(still), "t = 0.5<"));
  CHECK(maup({"animate", membrane, "-o", page, "--speed", "0.5", "--fps", "5"}).code == 0);
  CHECK(times_in(read(page), "<animate ") == 11);
  CHECK(contains(read(page), "film-scrub"));
  const std::string report = folder.path("report.html");
  CHECK(maup({"report", string, "-o", report}).code == 0);
  for (const char* part : {"id=\"equations\"", "Density", "id=\"motion\"", "id=\"modes\"", "id=\"conserved\"",
                           "id=\"derivation\"", "id=\"certificate\"", "id=\"expectations\"", "✓ passed", "3.141592"})
    CHECK_MESSAGE(contains(read(report), part), part);
  CHECK(maup({"report", string, "-o", report, "--sections", "equations", "--no-run"}).code == 0);
  CHECK_FALSE(contains(read(report), "id=\"motion\""));
  CHECK(contains(read(report), "id=\"certificate\""));
}

TEST_CASE("options that have no meaning for fields are refused") {
  const std::vector<std::vector<std::string>> wrong{
      {"plot", "-", "--x", "u"},          {"plot", "-", "--until", "u = 0"},      {"plot", "-", "--y", "w"},
      {"plot", "-", "--map", "--curves"}, {"animate", "-", "--view", "1,2"},      {"animate", "-", "--plain"},
      {"report", "-", "--floquet"},       {"report", "-", "--sections", "orbits"}};
  for (const auto& arguments : wrong) {
    CAPTURE(arguments[2]);
    const Outcome told = maup(arguments, string_text);
    CHECK(told.code == 2);
    CHECK(contains(told.err, "error E08"));
  }
  CHECK(maup({"plot", "-", "--map"}, membrane_text).code == 2);
  CHECK(contains(maup({"plot", "-", "--map"}, pendulum).err, "--map is for fields"));
  CHECK(contains(maup({"plot", "-", "--y", "w"}, string_text).err, "`w` is no field"));
}

TEST_CASE("charges of currents of one name are told apart, and stand under their own in the report") {
  const Folder folder;
  const std::string model =
      folder.write("two.lag",
                   "dimensionless\nfield u(x) : number on x = 0 .. 2 cells 20 order 8 boundary periodic\n"
                   "density = 1/2 u'^2 - 1/2 u_x^2 + 0.3 u' u_x\nstart u = sin(pi x)^3\nrun 1\n");
  const auto charges = nlohmann::json::parse(maup({"simulate", model, "--json"}).out).at("charges");
  std::set<std::size_t> currents;
  std::size_t dilations = 0;
  for (const auto& c : charges)
    currents.insert(c.at("current").get<std::size_t>()), dilations += c["name"] == "dilation";
  CHECK(currents.size() == charges.size());
  CHECK(dilations == 2);
  CHECK(contains(maup({"simulate", model}).out, "dilation, current "));
  const std::string page = folder.path("two.html");
  REQUIRE(maup({"report", model, "-o", page}).code == 0);
  const std::string text = read(page);
  std::size_t sentences = 0;
  for (std::size_t at = 0; (at = text.find("In the run ∫ j^t is", at)) != std::string::npos; ++at) ++sentences;
  CHECK(sentences == charges.size());
}

TEST_CASE("simulate shows charges with what flowed out, derive the symmetric tensor") {
  const Outcome text = maup({"simulate", "-"}, string_text), json = maup({"simulate", "-", "--json"}, string_text);
  CHECK(text.code == 0);
  CHECK(contains(text.out, "conserved charges"));
  CHECK(contains(text.out, "momentum along x"));
  const auto charges = nlohmann::json::parse(json.out).at("charges");
  bool found = false;
  for (const auto& c : charges) {
    if (c.at("name") != "energy") continue;
    found = true;
    CHECK(std::abs(c.at("start").get<double>() - 0.25 * 9.869604401089358) < 1e-9);  // π²/4
    CHECK(c.at("imbalance").get<double>() < 1e-10);
    CHECK(c.at("outflow") == 0);
  }
  CHECK(found);
  const Outcome derived = maup({"derive", "-"}, string_text), document = maup({"derive", "-", "--json"}, string_text);
  CHECK(contains(derived.out, "Symmetric stress-energy tensor, Lorentz-invariant: speed^2 = 1"));
  CHECK(contains(derived.out, "S_x   = -u_x u'"));
  CHECK(nlohmann::json::parse(document.out).at("stress_energy").at("certified") == true);
  const Folder folder;
  const std::string page = folder.path("page.html");
  CHECK(maup({"report", folder.write("s.lag", string_text), "-o", page}).code == 0);
  CHECK(contains(read(page), "symmetric stress-energy tensor"));
  CHECK(contains(read(page), "What is left over is at most"));
  const nlohmann::json certificate = nlohmann::json::parse(document.out).at("certificate");
  CHECK(certificate.at("passed") == true);
  REQUIRE(certificate.at("checks").size() >= 2);
  for (const nlohmann::json& check : certificate.at("checks")) {
    CHECK(check.at("statement").get<std::string>().size() > 20);
    CHECK(check.at("verdict") == "zero");
  }
}

TEST_CASE("formulas at places are printed with their errors and written as columns") {
  const std::string wave =
      "dimensionless\nfield u(x) : number on x = 0 .. 1 cells 16 order 4 boundary u = 0\n"
      "density = 1/2 u'^2 - 1/2 u_x^2\nstart u = sin(pi*x)\nrun 1\n";
  const Outcome shown = maup({"simulate", "-", "--columns", "u(1/2), u(0.3) - u(0.7)", "--at", "0.25,1"}, wave);
  CHECK(shown.code == 0);
  CHECK(contains(shown.out, "at t = 0.25"));
  CHECK(contains(shown.out, "u(0.3) - u(0.7)"));
  const auto document = nlohmann::json::parse(
      maup({"simulate", "-", "--columns", "u(3/16), u_x(1/4)", "--at", "0.25", "--json"}, wave).out);
  const auto& at = document["at"][0];
  for (const auto& [name, exact] :
       {std::pair{"u(3/16)", std::sin(std::acos(-1.0) * 3 / 16) * std::sqrt(0.5)}, {"u_x(1/4)", std::acos(-1.0) / 2}}) {
    const double off = std::abs(at["values"][name].get<double>() - exact);
    CHECK(off < 5 * at["errors"][name].get<double>());
    CHECK(at["errors"][name].get<double>() < 1e-2);
  }
  CHECK(at["orders"]["u_x(1/4)"].get<double>() > 3);  // of slopes the power p at least
  const Folder folder;
  const std::string csv = folder.path("u.csv"), model = folder.write("u.lag", wave);
  CHECK(maup({"simulate", model, "--columns", "u(1/2)", "--every", "0.25", "--errors", "-o", csv}).code == 0);
  const std::string rows = read(csv);
  CHECK(contains(rows, "u(1/2),error(u(1/2))"));
  CHECK(times_in(rows, "\n") == 6);
  for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{
           {"--at", "1"}, {"--columns", "energy"}, {"--columns", "u(1/2)", "--at", "3"}, {"--errors"}}) {
    std::vector<std::string> arguments{"simulate", model};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    CHECK(maup(arguments).code == 2);
  }
}

TEST_CASE("errors of standing waves are told where two meshes agree by chance") {
  // At (10, 7) and (10, 5) the slope at 1/2 is one at a border of the finer mesh and in the middle of a cell of the
  // coarser, where that is exact beyond its power; at (16, 3) both errors go through zero together.
  const double pi = std::acos(-1.0), t = 1.3;
  for (const auto& [cells, order] : {std::pair{10, 7}, {10, 5}, {16, 3}}) {
    CAPTURE(cells);
    CAPTURE(order);
    const std::string wave = "dimensionless\nfield u(x) : number on x = 0 .. 1 cells " + std::to_string(cells) +
                             " order " + std::to_string(order) +
                             " boundary u = 0\ndensity = 1/2 u'^2 - 1/2 u_x^2\nstart u = sin(3*pi*x)\nrun 2\n";
    const auto at = nlohmann::json::parse(
        maup({"simulate", "-", "--columns", "u(1/2), u_x(1/2), u_t(1/2)", "--at", "1.3", "--json"}, wave).out)["at"][0];
    const std::pair<const char*, double> exact[] = {
        {"u(1/2)", -std::cos(3 * pi * t)}, {"u_x(1/2)", 0}, {"u_t(1/2)", 3 * pi * std::sin(3 * pi * t)}};
    for (const auto& [name, value] : exact)
      CHECK(std::abs(at["values"][name].get<double>() - value) < 5 * at["errors"][name].get<double>());
  }
}

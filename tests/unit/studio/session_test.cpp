#include "session.hpp"
#include "../under_sanitizers.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>
#include <maupertuis/study.hpp>

#include <cmath>
#include <numbers>
#include <span>
#include <thread>
#include <vector>

namespace maupertuis::studio {
namespace {

const std::string pendulum = R"(system pendulum "A pendulum"
note "It hangs."
param m = 2 kg, l = 50 cm, g = 9.81 m/s^2   # θ 🙂 stands here
coord θ : angle
note "The angle is all."
point O at (0, 0)
point P mass m at (l sin θ, -l cos θ)
gravity (0, -g)
start θ = 60 deg
run 3 s
note "It swings."
draw O - P
)";

const std::string oscillator = R"(system oscillator
param m = 1 kg, k = 4 N/m
coord x : length
T = 1/2 m x'^2
V = 1/2 k x^2
start x = 2 m, x' = 3 m/s
run 5 s
)";

/// What a text has between two offsets in UTF-16 units, by another way of counting.
std::string slice16(const std::string& text, std::size_t from, std::size_t to) {
  std::string out;
  std::size_t unit = 0;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t bytes = lead < 0x80 ? 1 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
    if (unit >= from && unit < to) out += text.substr(i, bytes);
    unit += bytes == 4 ? 2 : 1;
    i += bytes;
  }
  return out;
}

std::size_t units_before(const std::string& text, const std::string& what) {
  std::size_t unit = 0;
  for (std::size_t i = 0; i < text.find(what); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if ((c & 0xc0) != 0x80) unit += c >= 0xf0 ? 2 : 1;
  }
  return unit;
}

TEST_CASE("places are counted in UTF-16 units") {
  Asked page(pendulum);
  for (const Json& token : page.opened["tokens"]) {
    const std::string word = slice16(pendulum, token[0], token[1]);
    if (token[2] == "comment") CHECK(word == "# θ 🙂 stands here");
    if (token[2] == "coordinate") CHECK(word == "θ");
  }
  Json hover = page.ask({{"do", "hover"}, {"at", units_before(pendulum, "sin θ")}});
  CHECK(slice16(pendulum, hover["from"], hover["to"]) == "sin");
  std::string wrong = pendulum;
  wrong.replace(wrong.find("9.81"), 4, "9,81");
  Asked other(wrong);
  REQUIRE(other.opened["diagnostics"].size() >= 1);
  Json& d = other.opened["diagnostics"][0];
  CHECK(slice16(wrong, d["from"], d["to"]).find("9,81") == 0);
  CHECK(other.opened["readable"] == false);
  Json fixes = other.ask({{"do", "fixes"}, {"from", d["from"]}, {"to", d["to"]}});
  REQUIRE(fixes["fixes"].size() == 1);
  CHECK(fixes["fixes"][0]["edits"][0]["insert"] == "9.81");
}

TEST_CASE("the equations come with their certificate, notes and values") {
  Asked page(pendulum);
  Json e = page.ask({{"do", "equations"}, {"steps", true}});
  REQUIRE(e["ok"] == true);
  CHECK(e["certified"] == true);
  CHECK(e["equations"].size() == 1);
  CHECK(e["equations"][0]["mathml"].get<std::string>().find("<math") != std::string::npos);
  CHECK(e["first_notes"] == Json::array({"It hangs."}));
  CHECK(e["last_notes"] == Json::array({"It swings."}));
  bool noted = false;
  for (const Json& section : e["derivation"])
    if (section["title"] == "Coordinates") noted = section["notes"] == Json::array({"The angle is all."});
  CHECK(noted);
  CHECK(e["coordinates"][0]["q"].get<double>() == doctest::Approx(std::numbers::pi / 3));
  Json& l = e["parameters"][1];
  CHECK(l["name"] == "l");
  CHECK(l["value"].get<double>() == doctest::Approx(50));
  CHECK(l["unit"] == "cm");
  CHECK(l["si"].get<double>() == doctest::Approx(0.5));
  CHECK(page.ask("equations").contains("derivation") == false);
}

TEST_CASE("a model with contacts says when its equations hold, and has its modes in each of them") {
  Asked page(file_text("models/stick_slip.lag"));
  Json e = page.ask("equations");
  REQUIRE(e["ok"] == true);
  CHECK(e["modes"].size() > 1);
  CHECK(e["holds"].get<std::string>().find("without contact") != std::string::npos);
  for (const Json& mode : e["modes"]) {
    CAPTURE(mode);
    Json in_mode = page.ask({{"do", "equations"}, {"mode", mode}});
    REQUIRE(in_mode["ok"] == true);
    CHECK(in_mode["modes"] == e["modes"]);
    CHECK((mode == "free" || in_mode["holds"].get<std::string>().find(mode.get<std::string>()) != std::string::npos));
  }
  CHECK(Asked(pendulum).ask("equations").contains("holds") == false);
}

TEST_CASE("a body that turns has Euler's equations beside those of its quaternion, as derive has them") {
  Json e = Asked(file_text("models/tumbling_satellite.lag")).ask("equations");
  REQUIRE(e["ok"] == true);
  REQUIRE(e["in_rates"]["equations"].size() == 8);  // of ω, of the quaternion by ω, and its norm
  const std::string first = e["in_rates"]["equations"][0]["left"]["plain"];
  CHECK(first.find("ω1'") != std::string::npos);
  CHECK(first.find("q") == std::string::npos);
  CHECK(e["certificate"].back()["name"] == "rates_form");
  CHECK(Asked(pendulum).ask("equations").contains("in_rates") == false);
}

TEST_CASE("a run is the closed form, with the values beside the text") {
  Asked page(oscillator);
  Json r = page.ask({{"do", "run"}, {"set", {{"k", "9 N/m"}}}, {"start", {{"x'", "0 m/s"}}}, {"run", "2 s"}});
  REQUIRE(r["ok"] == true);
  REQUIRE(r["columns"][0]["name"] == "x");
  CHECK(r["times"].back().get<double>() == doctest::Approx(2));
  for (std::size_t i = 0; i < r["times"].size(); ++i)
    CHECK(r["values"][0][i].get<double>() == doctest::Approx(2 * std::cos(3 * r["times"][i].get<double>())));
  CHECK(r["ending"]["ok"] == true);
  for (const auto& [key, other] : {std::pair("start", Json{{"x", "1 m"}}), std::pair("set", Json{{"k", "1 N/m"}})})
    CHECK(page.ask({{"do", "run"}, {key, other}})["values"][0].back() != page.ask("run")["values"][0].back());
  CHECK(page.ask({{"do", "run"}, {"run", "1 s"}})["times"].back() == 1);
  Json plain = page.ask("run");
  CHECK(plain["values"][0].back().get<double>() == doctest::Approx(2 * std::cos(10.) + 1.5 * std::sin(10.)));
}

TEST_CASE("few frames stand for the whole run") {
  Asked page(pendulum);
  Json r = page.ask({{"do", "run"}, {"frames", 50}});
  CHECK(r["times"].size() <= 50);
  CHECK(r["times"].back() == 3);
  CHECK(r["drawing"]["times"].back() == 3);
  for (const int frames : {1, 2, 7, 999, 1000, 1001, 5000}) {
    Json few = page.ask({{"do", "run"}, {"frames", frames}});
    CHECK(few["times"].front() == 0);
    CHECK(few["times"].back() == 3);
    CHECK(few["times"].size() <= static_cast<std::size_t>(std::max(frames, 2)));
    CHECK(few["drawing"]["times"].back() == 3);
  }
}

TEST_CASE("an exported drawing has the arrows and the moment that are asked for") {
  Asked hanging(pendulum);
  const auto drawing = [](Asked& of, Json more) {
    more["do"] = "export";
    more["what"] = "drawing.svg";
    return of.ask(more)["text"].get<std::string>();
  };
  const std::string asked = drawing(hanging, Json::object());
  CHECK(drawing(hanging, {{"forces", true}}).size() > asked.size());  // the weight
  CHECK(drawing(hanging, {{"forces", false}}) == asked);              // it asks for no arrow
  CHECK(drawing(hanging, {{"t", 0.0}}) == asked);
  CHECK(drawing(hanging, {{"t", 0.5}}) != asked);
}

TEST_CASE("a brief run has the numbers of what is conserved, without the formulas") {
  Asked page(pendulum);
  const Json whole = page.ask({{"do", "run"}, {"frames", 10}})["conserved"];
  Json brief = page.ask({{"do", "run"}, {"frames", 10}, {"brief", true}})["conserved"];
  REQUIRE(whole.size() == 1);
  CHECK(whole[0]["formula"]["mathml"].get<std::string>().size() > 100);
  CHECK_FALSE(brief[0].contains("formula"));
  brief[0]["formula"] = whole[0]["formula"];
  CHECK(brief == whole);
}

TEST_CASE("a driven system has its section once in each period of the drive") {
  const std::string driven =
      "system driven\ndimensionless\nparam γ = 0.5, ω = 1.2\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\n"
      "force x = γ cos(ω t)\nstart x = 0.1\nrun 10\n";
  Asked page(driven);
  CHECK(page.ask("equations")["sections"] == Json{"sin(ω t) = 0 rising"});
  Json taken = page.ask({{"do", "section"}, {"at", "sin(ω t) = 0 rising"}, {"crossings", 5}});
  REQUIRE(taken["ok"] == true);
  for (std::size_t k = 1; k < taken["times"].size(); ++k)
    CHECK(taken["times"][k].get<double>() - taken["times"][k - 1].get<double>() ==
          doctest::Approx(2 * std::numbers::pi / 1.2));
  CHECK(Asked(pendulum).ask("equations")["sections"] == Json::array());
}

TEST_CASE("of several drives each period is offered once, and those with a common one have that") {
  const auto offered = [](const std::string& drive) {
    return Asked(
               "system driven\ndimensionless\nparam γ = 0.5, ω = 1.2, ν = 0.7\ncoord x : number\nT = 1/2 x'^2\n"
               "V = 1/2 x^2\nforce x = " +
               drive + "\nrun 10\n")
        .ask("equations")["sections"];
  };
  const std::string ω = "sin(ω t) = 0 rising", ν = "sin(ν t) = 0 rising";
  CHECK(offered("γ cos(ω t) + sin(ν t)") == Json{ω, ν});
  CHECK(offered("γ cos(2 ω t) + cos(3 ω t)") == Json{ω});
  CHECK(offered("γ cos(-ω t) + cos(1/2 ω t)") == Json{"sin(1/2 ω t) = 0 rising"});
  CHECK(offered("γ cos(ω t^2) + cos(ν t)") == Json::array());  // a drive without a period
  // What is written with t and does not depend on it has no period.
  CHECK(offered("γ (cos(ω t)^2 + sin(ω t)^2) x") == Json::array());
}

TEST_CASE("modes without a drawing, and about motions, move as beads") {
  Asked page(
      "system beads\nparam m = 2 kg, k = 50 N/m\ncoord x1, x2 : length\nT = 1/2 m (x1'^2 + x2'^2)\n"
      "V = 1/2 k (x1^2 + (x2 - x1)^2 + x2^2)\nstart x1 = 10 cm\nrun 1 s\n");
  Json shapes = page.ask("modes")["points"][0]["shapes"];
  REQUIRE(shapes.size() == 2);
  for (std::size_t k = 0; k < 2; ++k) {  // together, then against each other
    Json drawing = shapes[k]["drawing"];
    REQUIRE(drawing.is_object());
    std::vector<double> tips;
    for (Json& e : drawing["elements"])
      if (e["kind"] == "path" && e["still"] == false) tips.push_back(e["positions"][3]);
    REQUIRE(tips.size() == 2);
    CHECK(tips[1] / tips[0] == doctest::Approx(k == 0 ? 1 : -1));
    CHECK(drawing["times"].back().get<double>() ==
          doctest::Approx(2 * std::numbers::pi / (k == 0 ? 5 : 5 * std::sqrt(3.0))));
  }
}

TEST_CASE("the paths between the ends of a model are drawn") {
  Asked page(file_text("models/brachistochrone.lag"));
  Json found = page.ask("paths");
  REQUIRE(found["ok"] == true);
  REQUIRE(found["paths"].size() >= 1);
  CHECK(found["figures"][0]["svg"].get<std::string>().find("<svg") != std::string::npos);
  CHECK(Asked(pendulum).ask("paths")["kind"] == "refused");
}

TEST_CASE("help on the page does not speak of the command line") {
  Asked page("");
  Json nothing = page.ask({{"do", "open"}, {"text", "\n"}});
  CHECK(nothing.dump().find("maup new") == std::string::npos);
  Asked driven(
      "system driven\ndimensionless\nparam γ = 0.5, ω = 1.2\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\n"
      "force x = γ cos(ω t)\nrun 10\n");
  Json refused = driven.ask("modes");
  CHECK(refused.dump().find("--at") == std::string::npos);
}

TEST_CASE("a drawn point follows the pointer") {
  Asked page(pendulum);
  Json rest = page.ask("pose");
  REQUIRE(rest["ok"] == true);
  std::size_t element = 0, point = 0;
  for (std::size_t k = 0; k < rest["drawing"]["elements"].size(); ++k)
    if (rest["drawing"]["elements"][k]["kind"] == "path") element = k, point = 1;
  // Beyond the length of the rod: the nearest place of the circle.
  for (const double angle : {-2.5, -0.4, 0.9, 2.9}) {
    const Json to = {1.7 * std::sin(angle), -1.7 * std::cos(angle)};
    Json dragged = page.ask({{"do", "pose"}, {"drag", {{"element", element}, {"point", point}, {"to", to}}}});
    const double q = dragged["start"]["θ"];
    CHECK(std::remainder(q - angle, 2 * std::numbers::pi) == doctest::Approx(0).epsilon(1e-3).scale(1));
  }
}

TEST_CASE("a dragged mechanism keeps its constraints") {
  for (const char* model : {"parallelogram", "cartesian_pendulum", "spherical_pendulum"}) {
    CAPTURE(model);
    const std::string text = file_text(std::string("models/") + model + ".lag");
    Asked page(text);
    Json rest = page.ask("pose"), equations = page.ask("equations");
    REQUIRE(rest["ok"] == true);
    std::map<std::string, std::string> units;
    for (Json& c : equations["coordinates"]) {
      const std::string name = c["name"];
      units[name] = c["unit"], units[name + "'"] = c["velocity_unit"];
    }
    const std::size_t d = rest["drawing"]["dimension"];
    std::size_t moved = 0;
    Json& elements = rest["drawing"]["elements"];
    for (std::size_t k = 0; k < elements.size(); ++k) {
      if (elements[k]["kind"] != "path" || elements[k]["still"] == true) continue;
      for (std::size_t p = 0; p < elements[k]["points"].get<std::size_t>(); ++p) {
        Json to = Json::array();
        for (std::size_t i = 0; i < d; ++i) to.push_back(elements[k]["positions"][d * p + i].get<double>() + 0.04);
        Json dragged = page.ask({{"do", "pose"}, {"drag", {{"element", k}, {"point", p}, {"to", to}}}});
        REQUIRE(dragged["ok"] == true);
        // A study of its own says whether this start needs to be moved.
        Study study(SourceText("model.lag", text));
        for (const auto& [name, value] : dragged["start"].items())
          study.override_with(OverrideKind::Start, "start", name + " = " + value.dump() + " " + units[name]);
        REQUIRE(study.equations());
        Diagnostics said;
        const auto start = consistent_start(*study.model(), *study.equations(), said);
        REQUIRE(start);
        for (const StartAdjustment& a : start->adjustments) CHECK(a.from == doctest::Approx(a.to).epsilon(1e-9));
        for (const auto& [name, value] : dragged["start"].items())
          moved += std::abs(value.get<double>() - rest["start"][name].get<double>()) > 1e-3;
      }
    }
    CHECK(moved > 0);
  }
}

TEST_CASE("the same question has the same answer in a new session") {
  Asked first(pendulum), second(pendulum);
  first.ask({{"do", "run"}, {"set", {{"l", "1 m"}}}});
  first.ask("modes");
  Json a = first.ask("equations"), b = second.ask("equations");
  CHECK(a == b);
  a = first.ask("conserved"), b = second.ask("conserved");
  CHECK(a == b);
}

TEST_CASE("mistakes and wrong questions are told") {
  Asked page;
  CHECK(page.ask("equations")["kind"] == "request");
  CHECK(page.ask("nothing")["kind"] == "request");
  page.ask({{"do", "open"}, {"text", "system s\ncoord x : length\nT = 1/2 m x'^2\n"}});
  Json e = page.ask("equations");
  CHECK(e["ok"] == false);
  CHECK(e["kind"] == "model");
  REQUIRE(e["diagnostics"].size() >= 1);
  CHECK(!e["trouble"]["message"].get<std::string>().empty());
  page.ask({{"do", "open"}, {"text", oscillator}});
  Json set = page.ask({{"do", "run"}, {"set", {{"k", "4 kg"}}}});
  CHECK(set["kind"] == "model");
  CHECK(set["diagnostics"][0]["text"] == "k = 4 kg");
  CHECK(set["diagnostics"][0]["from"].is_null());
  CHECK(page.ask("run")["ok"] == true);  // the text itself has no mistake
  CHECK(page.ask({{"do", "open"}, {"text", std::string(1'100'000, '#')}})["kind"] == "refused");
  CHECK(page.ask({{"do", "export"}, {"what", "x"}})["kind"] == "request");
}

TEST_CASE("nothing that is sent ends a session") {
  Asked page(pendulum);
  rc::check("damaged requests", [&] {
    std::string request = R"({"do":"run","set":{"l":"1 m"},"frames":20,"drag":{"to":[1,2]},"at":3})";
    const auto at = *rc::gen::inRange<std::size_t>(0, request.size());
    request.replace(at, *rc::gen::inRange<std::size_t>(0, 6),
                    *rc::gen::container<std::string>(rc::gen::arbitrary<char>()));
    const Json answer = Json::parse(page.session.answer(request));
    RC_ASSERT(answer["ok"].is_boolean());
  });
  CHECK(page.ask("equations")["ok"] == true);
}

const std::string endless = R"(system endless
param m = 1 kg, k = 1 N/m
coord x : length
T = 1/2 m x'^2
V = 1/2 k x^2
start x = 1 m
run 1e12 s
output every 1e9 s
)";

TEST_CASE("work ends with its budget, or when nobody wants it") {
  Asked page(endless);
  Json over = page.ask({{"do", "run"}, {"budget", 0.2}});
  CHECK((over["ok"] == false ? over["kind"] == "budget" : over["ending"]["kind"] == "interrupted"));
  std::thread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    page.session.cancel();
  });
  Json cancelled = page.ask({{"do", "run"}, {"budget", 500}});
  other.join();
  CHECK((cancelled["ok"] == false ? cancelled["kind"] == "cancelled" : cancelled["ending"]["kind"] == "interrupted"));
  CHECK(page.ask("equations")["ok"] == true);
}

TEST_CASE("a cancel is heard by requests that wait, and by no later one") {
  Session session;
  const auto ask = [&](const Json& request, std::uint64_t since) {
    return Json::parse(session.answer(request.dump(), {}, since));
  };
  const Json open = {{"do", "open"}, {"text", endless}};
  CHECK(ask(open, session.cancels())["ok"] == true);
  const std::uint64_t before = session.cancels();
  session.cancel();
  CHECK(ask({{"do", "equations"}}, before)["kind"] == "cancelled");
  CHECK(ask({{"do", "equations"}}, session.cancels())["ok"] == true);
}

TEST_CASE("what was interrupted is done again from its beginning") {
  const char* const models[] = {"rattleback", "fields/membrane", "fields/maxwell", "squeezer"};
  for (const char* const model : std::span(models).first(under_sanitizers ? 2 : std::size(models))) {
    CAPTURE(model);
    Asked page(file_text(std::string("models/") + model + ".lag"));
    for (const int ms : under_sanitizers ? std::vector{10} : std::vector{1, 3, 10, 30, 100}) {
      std::thread other([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(ms));
        page.session.cancel();
      });
      page.ask("equations");
      other.join();
    }
    Json after = page.ask("equations"),
         fresh = Asked(file_text(std::string("models/") + model + ".lag")).ask("equations");
    CHECK(after == fresh);
  }
}

TEST_CASE("what is tiny or huge can be dragged") {
  for (const char* size : {"1e-9", "1", "1.5e11"}) {
    CAPTURE(size);
    const double scale = std::stod(size);
    Asked page("system free\nparam m = 1 kg\ncoord x, y : length\npoint P mass m at (x, y)\nstart x = " +
               std::string(size) + " m\nrun 1 s\n");
    for (const double to : {0.5, -2.0}) {
      Json dragged =
          page.ask({{"do", "pose"}, {"drag", {{"element", 0}, {"point", 0}, {"to", {to * scale, 0.25 * to * scale}}}}});
      REQUIRE(dragged["ok"] == true);
      CHECK(dragged["start"]["x"].get<double>() / scale == doctest::Approx(to).epsilon(1e-3));
      CHECK(dragged["start"]["y"].get<double>() / scale == doctest::Approx(0.25 * to).epsilon(1e-3));
    }
  }
}

TEST_CASE("modes, sections and conserved quantities") {
  Asked page(file_text("models/double_pendulum.lag"));
  Json modes = page.ask("modes");
  REQUIRE(modes["ok"] == true);
  CHECK(modes["points"].size() == 4);
  std::size_t stable = 0;
  for (const Json& point : modes["points"]) stable += point["stable"] == true;
  CHECK(stable == 1);
  CHECK(modes["points"][0]["shapes"][0]["drawing"]["times"].size() > 10);
  Json section = page.ask({{"do", "section"}, {"at", "θ1 = 0 rising"}, {"crossings", 60}});
  REQUIRE(section["ok"] == true);
  CHECK(section["times"].size() == 60);
  REQUIRE(page.messages.size() == 1);
  CHECK(page.messages[0]["section"]["times"].size() == 50);
  // A longer motion begins as the shorter one.
  for (std::size_t i = 0; i < 50; ++i) CHECK(page.messages[0]["section"]["times"][i] == section["times"][i]);
  std::size_t column = 0;
  while (section["columns"][column]["name"] != "θ1") ++column;
  for (const Json& value : section["values"][column])
    CHECK(std::remainder(value.get<double>(), 2 * std::numbers::pi) == doctest::Approx(0).scale(1));
  CHECK(page.ask({{"do", "section"}, {"at", "θ1"}})["kind"] == "model");
  CHECK(page.ask("conserved")["conserved"].size() >= 1);
}

TEST_CASE("files are those of the command line") {
  Asked page(pendulum);
  Json csv = page.ask({{"do", "export"}, {"what", "csv"}});
  CHECK(csv["name"] == "pendulum.csv");
  CHECK(csv["text"].get<std::string>().rfind("t [s],θ [rad],θ' [rad/s]", 0) == 0);
  Json latex = page.ask({{"do", "export"}, {"what", "latex"}});
  CHECK(latex["text"].get<std::string>().find("\\documentclass") != std::string::npos);
  CHECK(page.ask({{"do", "export"}, {"what", "report"}})["text"].get<std::string>().find("It swings.") !=
        std::string::npos);
  CHECK(page.ask({{"do", "export"}, {"what", "drawing.svg"}, {"t", 1}})["text"].get<std::string>().rfind("<svg", 0) ==
        0);
  for (const char* what : {"json", "plot.svg", "animation"})
    CHECK(page.ask({{"do", "export"}, {"what", what}})["ok"] == true);
}

TEST_CASE("a model of paths has a report, with its paths") {
  for (const char* name : {"brachistochrone", "great_circle", "hanging_chain", "oscillator_path", "soap_film"}) {
    CAPTURE(std::string(name));
    Asked page(file_text(std::string("models/") + name + ".lag"));
    Json report = page.ask({{"do", "export"}, {"what", "report"}, {"budget", 60}});
    CAPTURE(report.dump().substr(0, 300));
    REQUIRE(report["ok"] == true);
    CHECK(report["text"].get<std::string>().find("<h2>Stationary paths") != std::string::npos);
  }
}

TEST_CASE("fields have equations, runs and conserved quantities") {
  Asked page(file_text("models/fields/sine_gordon_kink.lag"));
  REQUIRE(page.opened["fields"] == true);
  CHECK(page.ask({{"do", "equations"}, {"steps", true}})["certified"] == true);
  Json run = page.ask("run");
  REQUIRE(run["ok"] == true);
  CHECK(run["places"].size() > 10);
  CHECK(run["figures"].size() >= 1);
  CHECK(page.ask("pose")["ok"] == false);
}

}  // namespace
}  // namespace maupertuis::studio

// How motions with contacts begin, and which modes are shown.
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/simulation.hpp>

#include "../model_text.hpp"

#include <algorithm>
#include <cmath>
#include <set>

using namespace maupertuis;

namespace {

ContactStart start_of(const ModelText& m) {
  Diagnostics diagnostics;
  const auto start = consistent_start(m.model, m.equations, diagnostics);
  REQUIRE(start);
  const auto found = contact_start(m.model, m.equations, start->state, diagnostics);
  REQUIRE(found);
  return *found;
}

std::string box(const std::string& start) {
  return "system s\nparam m = 1 kg, g = 10 m/s^2\ncoord x, z : length\npoint P mass m at (x, z)\ngravity (0, -g)\n"
         "contact z >= 0 restitution 0.5 friction 0.3 static 0.4 slip x' name floor\n"
         "contact x <= 3 [m] name wall\nstart " +
         start + "\nrun 1 s\n";
}

}  // namespace

TEST_CASE("closed, open and hit at the start, and the mode in which the motion begins") {
  const ContactStart slides = start_of(ModelText(box("x' = 1 m/s")));
  CHECK(slides.mode == "floor sliding +");
  CHECK(slides.closed == std::vector<bool>{true, false});
  CHECK(slides.gaps[1] == doctest::Approx(3));
  CHECK(slides.rates[1] == doctest::Approx(-1));
  CHECK(slides.impacts.empty());
  CHECK(slides.trouble.empty());

  CHECK(start_of(ModelText(box("x = 1 m"))).mode == "floor sticking");
  CHECK(start_of(ModelText(box("z = 1 m"))).mode.empty());

  const ContactStart hit = start_of(ModelText(box("z' = -2 m/s")));
  REQUIRE(hit.impacts.size() == 1);
  CHECK(hit.impacts[0].name == "floor");
  CHECK(hit.impacts[0].speed == doctest::Approx(2));
  CHECK(hit.impacts[0].impulse == doctest::Approx(3));  // (1 + e) m v
  CHECK(hit.closed == std::vector<bool>{false, false});
}

TEST_CASE("a start that violates a contact is an error with the contact's place") {
  const ModelText m(box("z = -1 mm"));
  Diagnostics diagnostics;
  const auto start = consistent_start(m.model, m.equations, diagnostics);
  REQUIRE(start);
  CHECK_FALSE(contact_start(m.model, m.equations, start->state, diagnostics));
  REQUIRE(diagnostics.items().size() == 1);
  CHECK(diagnostics.items()[0].code == "E0728");
}

TEST_CASE("a rod that slides the wrong way on rough ground begins no motion: Painlevé") {
  const auto rod = [](const std::string& speed) {
    return "system rod\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, z : length, θ : angle\n"
           "T = 1/2 m (x'^2 + z'^2) + 1/24 m l^2 θ'^2\nV = m g z\n"
           "contact z - l/2 sin θ >= 0 friction 3 slip x' + l/2 sin θ θ' name floor\n"
           "start z = l/2 sin(1), θ = 1 rad, x' = " +
           speed + " m/s\nrun 1 s\n";
  };
  CHECK(start_of(ModelText(rod("3"))).mode == "floor sliding +");
  const ModelText m(rod("-3"));
  Diagnostics diagnostics;
  const auto start = consistent_start(m.model, m.equations, diagnostics);
  const auto found = contact_start(m.model, m.equations, start.value().state, diagnostics);
  REQUIRE(found);
  CHECK(found->trouble.find("Painlevé") != std::string::npos);
  REQUIRE(diagnostics.items().size() == 1);
  CHECK(diagnostics.items()[0].code == "W0731");
}

TEST_CASE("modes to show: all where they are few, each once; else what one contact or friction makes of the first") {
  const ModelText m(box("x' = 1 m/s"));
  CHECK(number_of_modes(*m.system) == 8);  // the floor: open and three; the wall: two
  const auto texts = [&](std::size_t most) {
    std::string trouble;
    std::vector<std::string> out;
    for (const ContactMode& mode :
         modes_to_show(*m.system, read_mode(*m.system, "floor sliding +", trouble).value(), most))
      out.push_back(mode_text(*m.system, mode));
    return out;
  };
  const auto all = texts(8);
  CHECK(all.size() == 8);
  CHECK(std::set<std::string>(all.begin(), all.end()).size() == 8);
  CHECK(all[0] == "floor sliding +");
  CHECK(texts(7) ==
        std::vector<std::string>{"floor sliding +", "", "floor sticking", "floor sliding −", "floor sliding +, wall"});
}

TEST_CASE("the column of friction: -μ N where it slides, what holds where it sticks, 0 in flight") {
  const ModelText m(
      "system s\nparam m = 2 kg, g = 10 m/s^2, α = 0.4 rad, μ = 0.5\ncoord s, n : length\n"
      "point P mass m at s (cos α, sin α) + n (-sin α, cos α)\ngravity (0, -g)\n"
      "contact n >= 0 friction μ slip s' name plane\nstart s' = 2 m/s, n = 1 cm\nrun 1 s\n");
  Diagnostics diagnostics;
  SimulationOptions options;
  options.errors = ErrorEstimates::None;
  const auto result = simulate(m.model, m.equations, options, diagnostics);
  REQUIRE(result);
  const Trajectory& rows = result->trajectory;
  const std::size_t f = *rows.column("friction(plane)"), v = *rows.column("s'"), n = *rows.column("n");
  int seen[3] = {0, 0, 0};
  for (std::size_t r = 1; r + 1 < rows.rows(); ++r) {
    const bool flies = rows.at(r, n) > 1e-9, slides = rows.at(r, v) > 1e-9;
    if (rows.times[r] == rows.times[r + 1] || rows.times[r] == rows.times[r - 1]) continue;
    ++seen[flies ? 0 : slides ? 1 : 2];
    CHECK(rows.at(r, f) == doctest::Approx(flies ? 0 : slides ? -0.5 * 20 * std::cos(0.4) : 20 * std::sin(0.4)));
  }
  for (const int count : seen) CHECK(count > 10);
}

TEST_CASE("a run has the last row before an impact and the first one after it, at its time") {
  const ModelText m(
      "system s\nparam m = 1 kg, g = 10 m/s^2\ncoord z : length\npoint P mass m at (0, z)\n"
      "gravity (0, -g)\ncontact z >= 0 restitution 0.5 name floor\nstart z = 0.2 m\nrun 0.35 s\n");
  Diagnostics diagnostics;
  for (const ErrorEstimates errors : {ErrorEstimates::None, ErrorEstimates::Rows}) {
    SimulationOptions options;
    options.errors = errors;
    options.output_every = 0.03;
    const auto result = simulate(m.model, m.equations, options, diagnostics);
    REQUIRE(result);
    const Trajectory& rows = result->trajectory;
    CHECK((rows.errors.empty() || rows.errors.size() == rows.values.size()));
    const auto at = std::adjacent_find(rows.times.begin(), rows.times.end()) - rows.times.begin();
    REQUIRE(at + 1 < static_cast<std::ptrdiff_t>(rows.rows()));
    const auto row = static_cast<std::size_t>(at);
    const std::size_t v = *rows.column("z'");
    CHECK(rows.times[row] == doctest::Approx(0.2).epsilon(1e-12));
    CHECK(rows.at(row, v) == doctest::Approx(-2).epsilon(1e-12));
    CHECK(rows.at(row + 1, v) == doctest::Approx(1).epsilon(1e-12));
  }
}

TEST_CASE("two components of slip that are not at right angles are refused, turned ones are not") {
  const auto code_of = [](const std::string& slip) {
    ModelText m(
        "param m = 1 kg, g = 10 m/s^2, R = 0.1 m\ncoord x, y, z : length, ψ : angle\n"
        "T = 1/2 m (x'^2 + y'^2 + z'^2 + R^2 ψ'^2)\nV = m g z\n"
        "contact z >= 0 friction 0.3 slip " +
        slip + " name floor\nstart x' = 1 m/s\n");
    SimulationOptions options;
    options.duration = 0.1;
    options.errors = ErrorEstimates::None;
    static_cast<void>(simulate(m.model, m.equations, options, m.diagnostics));
    return m.diagnostics.items().empty() ? std::string() : m.diagnostics.items().back().code;
  };
  CHECK(code_of("(x', (x' + y')/sqrt(2))") == "E0265");
  CHECK(code_of("(x' cos ψ + y' sin ψ, y' cos ψ - x' sin ψ)").empty());
  CHECK(code_of("(x' - R sin ψ ψ', y' + R cos ψ ψ')").empty());
}

TEST_CASE("a start on a contact is kept though rounding puts it behind, however the inequality is written") {
  const std::string ladder =
      "dimensionless\ncoord x, y : length, th : angle\nT = 1/2*1.3*(x'^2 + y'^2) + 1/24*1.3*0.981^2*th'^2\n"
      "V = 9.81*1.3*y\nstart th = 1.2, y = 0.981/2*sin(1.2), x = 1 - 0.981/2*cos(1.2)\n"
      "contact y - 0.981/2*sin(th) >= 0 friction 0.9 slip x' + 0.981/2*sin(th)*th' name floor\n";
  const std::string slip = " friction 0.9 slip y' + 0.981/2*cos(th)*th' name wall\n";
  for (const char* wall : {"contact x + 0.981/2*cos(th) - 1 <= 0", "contact x + 0.981/2*cos(th) <= 1",
                           "contact 3*(1 - x - 0.981/2*cos(th)) >= 0"}) {
    CAPTURE(wall);
    ModelText m(ladder + wall + slip);
    SimulationOptions options;
    options.duration = 0.1;
    CHECK(simulate(m.model, m.equations, options, m.diagnostics));
  }
}

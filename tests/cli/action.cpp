// maup action, from outside: values, several paths, the contract of its JSON, bad input.
#include "json.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace cli_test;

namespace {

const double pi = std::acos(-1.0);

std::string gallery(const std::string& name) { return std::string(PROJECT_DIR) + "/models/" + name + ".lag"; }

/// L = ½ x'² − ½ x², from 0.4 at 0 to −1.1 at T.
std::string oscillator(const std::string& duration) {
  return "system oscillator\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\npath from 0.4 at 0 to -1.1 "
         "at " +
         duration + "\n";
}

double classical_action(double duration) {
  return ((0.16 + 1.21) * std::cos(duration) + 2 * 0.4 * 1.1) / (2 * std::sin(duration));
}

}  // namespace

TEST_CASE("action of the oscillator: its value, its index beyond each half period, and its conjugate points") {
  for (const int half_periods : {0, 1, 2, 3}) {
    const double duration = 2 + 3 * half_periods;  // 2, 5, 8, 11: between the multiples of π
    const int index = static_cast<int>(std::ceil(duration / pi)) - 1;
    CAPTURE(duration);
    const Outcome told = maup({"action", "-", "--json"}, oscillator(std::to_string(2 + 3 * half_periods)));
    CHECK_MESSAGE(told.code == 0, told.err);
    const Json paths = json_of(told)["stationary"]["paths"];
    REQUIRE(paths.size() == 1);
    CHECK(std::abs(paths[0]["action"].get<double>() - classical_action(duration)) < 1e-11);
    CHECK(paths[0]["index"] == index);
    CHECK(paths[0]["by_inertia"] == index);
    CHECK(paths[0]["by_fields"] == index);
    REQUIRE(paths[0]["conjugate_points"].size() == static_cast<std::size_t>(index));
    for (int k = 0; k < index; ++k)
      CHECK(std::abs(paths[0]["conjugate_points"][k]["t"].get<double>() - (k + 1) * pi) < 1e-9);
    CHECK(paths[0]["check"]["done"] == true);
    CHECK(paths[0]["check"]["missed"].get<double>() < 1e-10);
  }
}

TEST_CASE("the JSON of action: ends by name, momenta and energies at them") {
  const Json document = json_of(maup({"action", "-", "--json"}, oscillator("2")));
  CHECK(document["command"] == "action");
  CHECK(document["ok"] == true);
  const Json& found = document["stationary"];
  CHECK(found["start"] == 0.0);
  CHECK(found["end"] == 2.0);
  CHECK(found["from"]["x"] == 0.4);
  CHECK(found["to"]["x"] == -1.1);
  CHECK(found["bound"].is_string());
  const Json& path = found["paths"][0];
  // ∂S/∂x2 and −∂S/∂T of the closed form.
  const double s = std::sin(2.0), c = std::cos(2.0);
  CHECK(std::abs(path["end_momentum"]["x"].get<double>() - (-1.1 * c - 0.4) / s) < 1e-11);
  CHECK(std::abs(path["start_momentum"]["x"].get<double>() - (-1.1 - 0.4 * c) / s) < 1e-11);
  const double velocity = (-1.1 * c - 0.4) / s;
  CHECK(std::abs(path["end_energy"].get<double>() - (velocity * velocity + 1.21) / 2) < 1e-11);
  for (const char* key :
       {"action_error", "path_error", "residual", "kind", "nullity", "found_from", "multipliers", "variations"})
    CHECK(path.contains(key));
}

TEST_CASE("two films between two rings, the smaller area first; places are told in x") {
  const Outcome told = maup({"action", gallery("soap_film")});
  CHECK_MESSAGE(told.code == 0, told.err);
  CHECK(contains(told.out, "soap_film: 2 stationary paths"));
  CHECK(contains(told.out, "x = -0.01 m"));
  CHECK(!contains(told.out, "t ="));
  const Json paths = json_of(maup({"action", gallery("soap_film"), "--json"}))["stationary"]["paths"];
  REQUIRE(paths.size() == 2);
  CHECK(paths[0]["action"].get<double>() < paths[1]["action"].get<double>());
  CHECK(paths[0]["index"] == 0);
  CHECK(paths[1]["index"] == 1);
  const double a = 0.02, b = 0.01;
  CHECK(std::abs(paths[0]["action"].get<double>() - 2 * pi * a * (b + a / 2 * std::sinh(2 * b / a))) < 1e-14);
}

TEST_CASE("the chain of a given length: the multiplier is the height of the catenary's axis, times the weight") {
  const Json path = json_of(maup({"action", gallery("hanging_chain"), "--json"}))["stationary"]["paths"][0];
  REQUIRE(path["multipliers"].size() == 1);
  CHECK(path["index"] == 0);
  // y = a cosh(x/a) + c solves the equations of (w y + λ) sqrt(1 + y'²) where λ = −w c.
  const Outcome told = maup({"action", gallery("hanging_chain")});
  CHECK(contains(told.out, "λ_length_of_chain = "));
  const double expected = 20 * 0.6 * std::cosh(1 / 0.6);
  CHECK(std::abs(path["multipliers"][0].get<double>() - expected) < 1e-9);
}

TEST_CASE("a path that is given: its action, whether it is stationary, and where it misses the ends") {
  const std::string free = "system free\ndimensionless\nparam m = 3\ncoord x, y : number\nT = 1/2 m (x'^2 + y'^2)\n";
  const Outcome straight =
      maup({"action", "-", "--path", "x = 4 t + 7, y = 3 t + 5", "--from", "0", "--to", "10"}, free);
  CHECK_MESSAGE(straight.code == 0, straight.err);
  CHECK(contains(straight.out, "stationary          yes"));
  CHECK(std::abs(std::stod(straight.out.substr(straight.out.find(" S ") + 3)) - 375) < 1e-10);
  const Outcome bent =
      maup({"action", "-", "--path", "x = 4 t + 7 + t (t - 10), y = 3 t + 5", "--from", "0", "--to", "10"}, free);
  CHECK(bent.code == 0);
  CHECK(contains(bent.out, "stationary          no"));
  const Outcome off =
      maup({"action", "-", "--path", "x = 4 t + 8, y = 3 t + 5"}, free + "path from (7, 5) at 0 to (47, 35) at 10\n");
  CHECK(off.code == 3);
  CHECK(contains(off.err, "E1205"));
  CHECK(off.out.empty());
  const Outcome unknown = maup({"action", "-", "--path", "x = 4 t, z = 3 t", "--from", "0", "--to", "10"}, free);
  CHECK(unknown.code != 0);
  CHECK(contains(unknown.err, "z"));
}

TEST_CASE("the ends of a given path have the unit of the independent variable") {
  // Brachistochrone along the line y = x + a: the time is ∫ dx/√(g y) = 2 (√(1.5 m) − √(0.5 m))/√g.
  const std::string line =
      "param g = 9.81 m/s^2\nindependent x : length\ncoord y : length\nL = sqrt((1 + y'^2)/(2 g y))\n";
  const Outcome along = maup({"action", "-", "--path", "y = x + 0.5 [m]", "--from", "0m", "--to", "1m"}, line);
  CHECK_MESSAGE(along.code == 0, along.err);
  CHECK(along.out.rfind("the model: the path given", 0) == 0);
  const double time = 2 * (std::sqrt(1.5) - std::sqrt(0.5)) / std::sqrt(9.81);
  CHECK(std::abs(std::stod(along.out.substr(along.out.find(" S ") + 3)) - time) < 1e-10);
  const Outcome seconds = maup({"action", "-", "--path", "y = x + 0.5 [m]", "--from", "0s", "--to", "1s"}, line);
  CHECK(contains(seconds.err, "E0304"));
  const Outcome none = maup({"action", "-", "--path", "y = x + 0.5 [m]", "--from", "nan", "--to", "1m"}, line);
  CHECK(contains(none.err, "E0105"));
  CHECK_FALSE(contains(none.err, "E0243"));
}

TEST_CASE("ends that no path reaches, ends of the wrong kind, no ends") {
  const Outcome conjugate =
      maup({"action", "-"},
           "system o\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\npath from 0.4 at 0 to 0.7 at pi\n");
  CHECK(conjugate.code == 3);
  CHECK(contains(conjugate.err, "E1204"));
  CHECK(conjugate.out.empty());
  for (const std::string ends : {"(0.4, 1) at 0 to 1 at 2", "0.4 at 3 to 1 at 2", "0.4 at 0 to y at 2", "0.4 at 0"}) {
    CAPTURE(ends);
    const Outcome wrong = maup({"action", "-", "--ends", ends}, oscillator("2"));
    CHECK(wrong.code != 0);
    CHECK(!wrong.err.empty());
    CHECK(wrong.out.empty());
  }
  const Outcome none = maup({"action", "-"}, "system o\ndimensionless\ncoord x : number\nT = 1/2 x'^2\n");
  CHECK(none.code != 0);
  CHECK(!none.err.empty());
}

TEST_CASE("rates beyond the range of numbers are named as what they are") {
  for (const std::string duration : {"1e-300 s", "1e-160 s", "1e-153 s"}) {
    CAPTURE(duration);
    const Outcome told = maup({"action", gallery("oscillator_path"), "--ends", "(0 m) at 0 s to (1 m) at " + duration});
    CHECK(told.code == 3);
    CHECK(contains(told.err, "E1209"));
    CHECK(contains(told.err, "beyond the range of numbers"));
    CHECK(!contains(told.err, "L is infinite"));
    CHECK(told.out.empty());
  }
  const Outcome fast = maup({"action", gallery("oscillator_path"), "--ends", "(0 m) at 0 s to (1 m) at 1e-100 s"});
  CHECK_MESSAGE(fast.code == 0, fast.err);
  CHECK(contains(fast.out, "x' = 1e+100"));
}

TEST_CASE("models without a principle of stationary action are refused with the reason") {
  const Outcome damped = maup({"action", gallery("cart_pendulum")});
  CHECK(damped.code != 0);
  CHECK(contains(damped.err, "E1201"));
  CHECK(contains(damped.err, "no Lagrangian gives"));
  const Outcome rolling =
      maup({"action", gallery("rolling_disk"), "--ends", "(0, 0, 0, 0) at 0 s to (1 m, 0, 0, 0) at 1 s"});
  CHECK(rolling.code != 0);
  CHECK(contains(rolling.err, "E1201"));
  CHECK(contains(rolling.err, "between velocities"));
}

TEST_CASE("numbers that make no sense, and options beside what they do not belong to") {
  const auto refused = [](std::vector<std::string> options, const std::string& what) {
    CAPTURE(what);
    options.insert(options.begin(), {"action", "-"});
    const Outcome told = maup(options, oscillator("2") + "start x = 1\nrun 1\n");
    CHECK(told.code == 2);
    CHECK(told.out.empty());
    CHECK(contains(told.err, "E0809"));
    CHECK_MESSAGE(contains(told.err, what), told.err);
  };
  refused({"--turns", "-1"}, "--turns -1 is no number of turns.");
  refused({"--turns", "99999999999"}, "--turns 99999999999 is no number of turns.");
  refused({"--paths", "0"}, "--paths 0 is no number of paths");
  refused({"--paths", "-3"}, "--paths -3 is no number of paths");
  refused({"--paths", "1000000"}, "Write a whole number from 1 to 1000.");
  refused({"--motion", "--turns", "1"}, "--turns belongs to the search for paths between two ends.");
  refused({"--periodic", "--paths", "2"}, "--paths belongs to the search for paths between two ends.");
  refused({"--motion", "--ends", "0 at 0 to 1 at 1"}, "--ends belongs to paths between two ends");
  refused({"--motion", "--period", "2"}, "--period belongs to --periodic.");
  refused({"--from", "0"}, "--from belongs to --path.");
  refused({"--motion", "--to", "1"}, "--to belongs to --path.");
  refused({"--path", "x = t", "--from", "0"}, "--from needs --to beside it.");
  refused({"--path", "x = t", "--to", "1"}, "--to needs --from beside it.");
  refused({"--motion", "--periodic"}, "one thing at a time");
  refused({"--plot", "a.svg", "--plot-paths", "a.svg"}, "both ask for a.svg");
  const Outcome implied = maup({"action", "-", "--turns", "1"}, pendulum);  // no ends: the motion is looked at
  CHECK(implied.code == 2);
  CHECK(contains(implied.err, "--turns belongs to the search for paths between two ends, and there are none."));
  CHECK(maup({"action", "-", "--turns", "0", "--paths", "1"}, oscillator("2")).code == 0);
}

TEST_CASE("W1201: an end so close to a conjugate point that the two counts part, and no index is given") {
  const Outcome told = maup({"action", "-", "--ends", "0.4 at 0 to -0.4 at pi (1 + 1e-9)"}, oscillator("2"));
  CHECK_MESSAGE(told.code == 0, told.err);
  CHECK(contains(told.err, "W1201"));
  CHECK(contains(told.err, "1 by inertia, 0 by Jacobi fields"));
  CHECK(contains(told.out, "stationary, of unknown index"));
  CHECK(json_of(maup({"action", "-", "--json", "--ends", "0.4 at 0 to -0.4 at pi (1 + 1e-9)"},
                     oscillator("2")))["stationary"]["paths"][0]["index"]
            .is_null());
}

TEST_CASE("E1206 to E1208: no value on the path, nothing to look at, a motion that ends") {
  const std::string free = "system free\ndimensionless\ncoord x : number\nL = 1/2 x'^2 - sqrt(x)\n";
  const Outcome without_value = maup({"action", "-", "--path", "x = t - 2", "--from", "0", "--to", "1"}, free);
  CHECK(without_value.code == 3);
  CHECK(contains(without_value.err, "E1206"));
  CHECK(without_value.out.empty());
  const Outcome nothing = maup({"action", "-"}, free);
  CHECK(nothing.code == 3);
  CHECK(contains(nothing.err, "E1207"));
  CHECK(nothing.out.empty());
  const Outcome ends = maup(
      {"action", "-"}, "system fall\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = -1/x\nstart x = 1\nrun 5\n");
  CHECK(ends.code == 3);
  CHECK(contains(ends.err, "E1208"));
  CHECK(contains(ends.err, "t = 1.1107"));  // π/(2√2)
  CHECK(ends.out.empty());
}

TEST_CASE("Ctrl-C ends a long search soon, and nothing of it is shown as the answer") {
  const Folder folder;
  constexpr int links = 16;
  std::string text = maup({"new", "chain", "--links", std::to_string(links), "-o", "-"}).out, from, to;
  for (int i = 0; i < links; ++i) from += i ? ", 0.1" : "0.1", to += i ? ", 0.3" : "0.3";
  text.replace(text.find("run 10 s"), 8,
               "run 1 ms\npath from (" + from + ") at 0 s to (" + to + ") at 3 s\nexpect index = 0");
  const std::string model = folder.write("chain.lag", text);
  for (const std::string& command : {"action " + model + " -o " + folder.path("paths.csv"),
                                     "report " + model + " -o " + folder.path("page.html"), "test " + model}) {
    CAPTURE(command);
    const Outcome outcome = shell("timeout -s INT --preserve-status 5 \"$MAUP\" " + command);
    CHECK(outcome.code == 130);
    CHECK(contains(outcome.err + outcome.out, "nterrupted"));
    CHECK(folder.names() == std::vector<std::string>{"chain.lag"});
    CHECK(outcome.seconds < 30);
  }
}

TEST_CASE("the paths as a file, in x") {
  const Folder folder;
  const Outcome told = maup({"action", gallery("great_circle"), "-o", folder.path("way.csv")});
  CHECK_MESSAGE(told.code == 0, told.err);
  CHECK(read(folder.path("way.csv")).rfind("φ [rad],θ [rad],θ'\r\n", 0) == 0);
}

TEST_CASE("with x in the place of t a report has primes alone, also on left sides") {
  const Outcome told = maup({"report", gallery("brachistochrone"), "-o", "-", "--budget", "none"});
  CHECK_MESSAGE(told.code == 0, told.err);
  CHECK(contains(told.out, "&#x2032;"));
  for (const char* const dot : {"&#x02D9;", "&#x00A8;"}) CHECK(!contains(told.out, dot));
}

TEST_CASE("S along a motion has the unit of L times that of what stands in the place of t") {
  const Folder folder;
  const auto column = [&](const std::string& model) {
    const Outcome told = maup({"action", "-", "--motion", "-o", folder.path("s.csv")}, model);
    CHECK_MESSAGE(told.code == 0, told.err);
    const std::string rows = read(folder.path("s.csv"));
    return rows.substr(0, rows.find('\r'));
  };
  CHECK(
      column("system b\nparam g = 9.81 m/s^2\nindependent t : length\ncoord y : length\nL = sqrt((1 + y'^2)/(2 g y))\n"
             "start y = 1 m, y' = 1/2\nrun 20 cm\n") == "t [m],y [m],S [s]");
  CHECK(column(pendulum) == "t [s],θ [rad],S [J s]");
}

TEST_CASE("the paths of a model in its report, which needs no run") {
  const Outcome told = maup({"report", gallery("oscillator_path"), "-o", "-", "--budget", "none"});
  CHECK_MESSAGE(told.code == 0, told.err);
  CHECK(contains(told.out, "Stationary paths of the action"));
  CHECK(contains(told.out, "by the inertia of the second variation"));
  const Outcome unreachable = maup({"report", "-", "-o", "-", "--budget", "none"}, oscillator("3.14159265358979"));
  CHECK(unreachable.code != 0);
  CHECK(contains(unreachable.err, "E1204"));
}

TEST_CASE("S along the motion of a degenerate Lagrangian; where functions stay free there is none") {
  const std::string first = "system d\ndimensionless\ncoord x, y : number\n";
  const Outcome told = maup({"action", "-", "--motion", "--json"},
                            first + "L = 1/2 (x' + y')^2 - 1/2 x^2 - 1/2 y^2\nstart x = 1\nrun 3\n");
  CHECK_MESSAGE(told.code == 0, told.err);
  const Json motion = json_of(told)["motion"];
  // x = y = cos(t/√2): S = −∫ cos(√2 t) dt
  CHECK(std::abs(motion["action"].get<double>() + std::sin(3 * std::sqrt(2.0)) / std::sqrt(2.0)) < 1e-13);
  CHECK(motion["index"].is_null());
  CHECK(contains(motion["reason"].get<std::string>(), "degenerate"));
  // Of the first order in velocities: x = cos t, y = −sin t, and nothing measures curvature.
  const Outcome first_order =
      maup({"action", "-", "--motion", "--json"}, first + "L = y x' - 1/2 x^2 - 1/2 y^2\nstart x = 1\nrun 3\n");
  CHECK_MESSAGE(first_order.code == 0, first_order.err);
  CHECK(std::abs(json_of(first_order)["motion"]["action"].get<double>() + std::sin(6.0) / 4) < 1e-13);
  CHECK(json_of(first_order)["motion"]["check"]["missed"].get<double>() < 1e-12);
  const Outcome free_function = maup({"action", "-", "--motion"}, first + "L = 1/2 (x' - y)^2\nstart x = 1\nrun 3\n");
  CHECK(free_function.code == 3);
  CHECK(contains(free_function.err, "E0631"));
}

TEST_CASE("a brachistochrone: y' has no value at the start, and nothing is wrong with that") {
  const std::string model =
      "system b\nparam R = 1 m, g = 9.81 m/s^2\nindependent x : length\ncoord y : length\n"
      "L = sqrt((1 + y'^2)/(2 g y))\npath from 0 at 0 to R (1 - cos(3)) at R (3 - sin(3))\n";
  const Outcome told = maup({"action", "-", "--json"}, model);
  CHECK_MESSAGE(told.code == 0, told.err);
  CHECK(json_of(told)["ok"] == true);
  const Json path = json_of(told)["stationary"]["paths"][0];
  // The cycloid through its angle 3 takes 3 √(R/g).
  CHECK(std::abs(path["action"].get<double>() - 3 / std::sqrt(9.81)) < 1e-13);
  CHECK(path["start_velocity"]["y"].is_null());
}

TEST_CASE("a corner of a given path is told, with what jumps there") {
  const std::string model = "system s\ndimensionless\ncoord x : number\nL = 1/2 x'^2\n";
  const Outcome told = maup({"action", "-", "--path", "x = abs(t - 0.5)", "--from", "0", "--to", "1"}, model);
  CHECK_MESSAGE(told.code == 0, told.err);
  CHECK(contains(told.out, "no: a corner at t = 0.5 s, where p_x jumps from -1 to 1"));
  const Outcome as_json =
      maup({"action", "-", "--json", "--path", "x = abs(t - 0.5)", "--from", "0", "--to", "1"}, model);
  const Json given = json_of(as_json)["given"];
  CHECK(given["stationary"] == false);
  CHECK(given["corner"]["of"] == "p_x");
  CHECK(given["corner"]["before"] == -1.0);
  CHECK(given["corner"]["after"] == 1.0);
  const Json straight =
      json_of(maup({"action", "-", "--json", "--path", "x = 2 t", "--from", "0", "--to", "1"}, model))["given"];
  CHECK(straight["corner"].is_null());
  CHECK(straight["stationary"] == true);
}

TEST_CASE("ends that a degenerate Lagrangian does not join: no path, whatever Newton's method converges to") {
  const std::string model = "system d\ndimensionless\ncoord x, y : number\nL = 1/2 (x' + y')^2 - 1/2 x^2 - 1/2 y^2\n";
  const Outcome none = maup({"action", "-"}, model + "path from (1, 1) at 0 to (0.5, 0.7) at 3\n");
  CHECK(none.code == 3);
  CHECK(contains(none.err, "E1204"));
  CHECK(contains(none.err, "L is degenerate"));
  const Outcome one = maup({"action", "-", "--json"}, model + "path from (1, 1) at 0 to (0.5, 0.5) at 3\n");
  CHECK_MESSAGE(one.code == 0, one.err);
  const Json path = json_of(one)["stationary"]["paths"][0];
  // x = y = q, L = 2 q'² − q², ω = 1/√2: S = 2 ω ((1 + ¼) cos ωT − 1)/sin ωT
  const double w = std::sqrt(0.5);
  CHECK(std::abs(path["action"].get<double>() - 2 * w / std::sin(3 * w) * (1.25 * std::cos(3 * w) - 1)) < 1e-12);
  CHECK(path["check"]["missed"].get<double>() < 1e-9);
}

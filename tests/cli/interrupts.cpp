// Ctrl-C and SIGTERM end every command soon, with 130 and a word; files are whole or absent.
#include "json.hpp"

#include <doctest/doctest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <csignal>

using namespace cli_test;

namespace {

// A second is promised; a loaded machine may take several times that.
constexpr double soon = 20, moment = 0.25;

const char* const star_in_a_galaxy = PROJECT_DIR "/models/henon_heiles.lag";
const char* const hoop = PROJECT_DIR "/models/bead_on_hoop.lag";
const char* const driven = PROJECT_DIR "/models/double_pendulum.lag";

/// A chain of pendulums: its equations are far longer than its text.
std::string chain(int links) {
  std::string text = "system chain\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n", last;
  for (int i = 1; i <= links; ++i) {
    const std::string n = std::to_string(i);
    text += "coord a" + n + " : angle\npoint P" + n + " mass m at " + last + "l (sin a" + n + ", -cos a" + n + ")\n";
    last = "P" + n + " + ";
  }
  return text + "gravity (0, -g)\nstart a1 = 60 deg\nrun 10 s\n";
}

void check_end(const Outcome& outcome) {
  CHECK(outcome.code == 130);
  CHECK_MESSAGE(contains(outcome.err, "nterrupted"), outcome.err);
  CHECK(outcome.seconds < soon);
}

}  // namespace

TEST_CASE("every command ends soon after the signal") {
  const Folder folder;
  const std::string model = folder.write("pendulum.lag", pendulum), links = folder.write("chain.lag", chain(24)),
                    rich = folder.write("rich.lag", std::string(pendulum) + "expect θ at 100000000 s = 1 rad ± 1\n");
  const std::vector<std::vector<std::string>> commands{
      {"simulate", model, "--duration", "100000000s", "--every", "1000s"},
      {"simulate", model, "--duration", "100000000s", "--precision", "quad"},
      {"simulate", model, "--duration", "100000000s", "--method", "variational", "--step", "100ms"},
      {"plot", model, "--duration", "100000000s", "--every", "1000s", "-o", folder.path("motion.svg")},
      {"report", model, "--duration", "100000000s", "--every", "1000s", "--budget", "none", "-o",
       folder.path("page.html")},
      {"report", links, "--budget", "none", "-o", folder.path("page.html")},
      {"test", model, rich},
      {"invariants", links},
      {"hamiltonian", model, "--integrate", "--duration", "100000000s"},
      {"orbits", driven, "--lyapunov", "--duration", "100000000s"},
      {"orbits", star_in_a_galaxy, "--section", "x = 0 rising", "--crossings", "1000000000"},
      {"orbits", star_in_a_galaxy, "--section", "x = 0 rising", "--starts", "100000", "--energy", "0.125"},
      {"orbits", driven, "--strobe", "1000s", "--crossings", "1000000000"},
      {"modes", model, "--at", "100000000s"},
      {"compare", model, model, "--duration", "100000000s"},
  };
  int signal = SIGINT;
  for (const auto& command : commands) {
    std::string line;
    for (const std::string& word : command) line += word + " ";
    CAPTURE(line);
    check_end(interrupted(command, signal, moment));
    signal = signal == SIGINT ? SIGTERM : SIGINT;
  }
  for (const std::string& name : folder.names()) CHECK_MESSAGE(!contains(name, ".partial"), name);
}

TEST_CASE("an analysis that is interrupted says nothing about the motion") {
  for (const char* what : {"--lyapunov --duration 1e6s", "--floquet --period 1e5s"}) {
    CAPTURE(what);
    const Outcome outcome = shell("timeout -s INT 0.5 \"$MAUP\" orbits " + std::string(what) + " " + driven);
    CHECK(contains(outcome.err, "nterrupted"));
    CHECK_FALSE(contains(outcome.err, "E14"));
  }
}

TEST_CASE("what was found until then is printed and called partial") {
  const Folder folder;
  const Outcome section = interrupted(
      {"orbits", star_in_a_galaxy, "--section", "x = 0 rising", "--crossings", "1000000000", "--json"}, SIGINT, moment);
  check_end(section);
  const auto document = nlohmann::json::parse(section.out, nullptr, false);
  REQUIRE_FALSE(document.is_discarded());
  CHECK(document["interrupted"] == true);
  CHECK(document["ok"] == false);
  CHECK(document["section"]["crossings"].size() > 0);

  const Outcome sweep = interrupted({"modes", hoop, "--sweep", "Ω = 0 .. 12 rad/s steps 1000000"}, SIGINT, moment);
  check_end(sweep);
  CHECK(contains(sweep.out, "Ω = 0 … "));
  CHECK(contains(sweep.out, "further values are missing"));
  CHECK(contains(sweep.err, "what stands here is not the whole of it."));

  const std::string fine = folder.write("fine.lag", std::string(pendulum) + "expect freedoms = 1\n"),
                    endless =
                        folder.write("endless.lag", std::string(pendulum) + "expect θ at 100000000 s = 1 rad ± 1\n");
  const Outcome test = interrupted({"test", fine, endless, fine}, SIGTERM, moment);
  check_end(test);
  CHECK(contains(test.out, "fine.lag: 1 of 1 expectations hold"));
  CHECK(contains(test.err, "1 of 3 models were tested."));

  const std::string picture = folder.path("motion.svg");
  const Outcome plot = interrupted({"plot", fine, "--duration", "100000000s", "-o", picture}, SIGINT, moment);
  check_end(plot);
  CHECK(contains(plot.err, "motion.svg shows the motion up to t = "));
  CHECK(contains(read(picture), "interrupted at t = "));

  const std::string rows = folder.path("motion.csv");
  const Outcome run =
      interrupted({"simulate", fine, "--duration", "100000000s", "--every", "1000s", "-o", rows}, SIGINT, moment);
  check_end(run);
  CHECK(contains(run.out, "θ = "));
  const std::string text = read(rows);
  CHECK(std::count(text.begin(), text.end(), '\n') > 2);
  CHECK(text.substr(text.size() - 2) == "\r\n");
}

TEST_CASE("a hundred thousand events do not outlast the time that an interrupt leaves") {
  // Some nine hundred thousand impacts between two walls.
  const Folder folder;
  const std::string model = folder.write(
      "walls.lag",
      "param m = 1 kg, L = 10 m\ncoord x : length\nT = 1/2 m x'^2\ncontact x >= 0 restitution 1 name left\n"
      "contact x <= L restitution 1 name right\nstart x = 1 m, x' = 3 m/s\nrun 3e6 s\n");
  const Outcome text = interrupted({"simulate", model, "--no-errors"}, SIGINT, 2);
  check_end(text);
  CHECK(contains(text.out, "x' = "));
}

TEST_CASE("pipes that nobody reads or writes hold no command up") {
  const Folder folder;
  const std::string model = folder.write("pendulum.lag", pendulum), in = folder.path("model.lag"),
                    out = folder.path("rows.csv"), page = folder.path("page.html");
  for (const std::string& name : {in, out, page}) REQUIRE(::mkfifo(name.c_str(), 0600) == 0);
  const int writer = ::open(in.c_str(), O_RDWR);  // so that opening it for reading does not wait, and reading does
  for (const char* command : {"check", "derive", "simulate", "fmt", "test", "report"}) {
    CAPTURE(command);
    check_end(interrupted({command, in}, SIGINT, moment));
    check_end(interrupted({command, "-"}, SIGTERM, moment, in));
  }
  ::close(writer);
  check_end(interrupted({"simulate", model, "-o", out}, SIGINT, 10));
  check_end(interrupted({"report", model, "-o", page}, SIGTERM, 10));
}

TEST_CASE("a file that a killed run left beside its output goes with the next one") {
  const Folder folder;
  const std::string model = folder.write("pendulum.lag", pendulum), rows = folder.path("motion.csv");
  const std::string gone = folder.write("motion.csv.partial-999999999-0", "half a"),
                    alive = folder.write("motion.csv.partial-" + std::to_string(::getpid()) + "-0", "half a");
  CHECK(maup({"simulate", model, "-o", rows}).code == 0);
  CHECK(::access(gone.c_str(), F_OK) != 0);
  CHECK(::access(alive.c_str(), F_OK) == 0);
}

TEST_CASE("two motions of which one did not begin were not compared") {
  const Outcome run =
      interrupted({"hamiltonian", star_in_a_galaxy, "--integrate", "--duration", "100000000s"}, SIGINT, moment);
  check_end(run);
  CHECK(contains(run.out, "0 steps of order"));
  CHECK(contains(run.out, "the two motions were not compared"));
  CHECK_FALSE(contains(run.out, "to the last digit"));
}

TEST_CASE("times that an interrupted run did not reach are named, and states that it passed are kept") {
  const Outcome run =
      interrupted({"simulate", star_in_a_galaxy, "--duration", "1e7s", "--at", "10s", "--at", "9e6s"}, SIGINT, moment);
  check_end(run);
  CHECK(contains(run.out, "t = 10 s\n  x = "));
  CHECK(contains(run.out, "t = 9000000 s\n  not reached"));
  const Outcome many = interrupted(
      {"simulate", star_in_a_galaxy, "--duration", "1e7s", "--at", "1s", "--at", "9e6s", "--precision", "quad"}, SIGINT,
      2);
  check_end(many);
  CHECK(contains(many.out, "t = 1 s\n  x = "));
  CHECK(contains(many.out, "t = 9000000 s\n  not reached"));
  CHECK(contains(many.out, "How many of these digits are right is not known"));
  CHECK_FALSE(contains(many.out, "steps of order 0"));
}

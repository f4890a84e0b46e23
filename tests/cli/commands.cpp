// help, new, explain, fmt, doctor.
#include "program.hpp"

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <cmath>

using namespace cli_test;

TEST_CASE("--help of each command opens with three examples that name it") {
  for (const std::string command :
       {"check", "derive", "simulate", "test", "plot", "report", "fmt", "new", "explain", "doctor"}) {
    CAPTURE(command);
    const Outcome outcome = maup({command, "--help"});
    CHECK(outcome.code == 0);
    CHECK(outcome.out.rfind("Examples:\n", 0) == 0);
    std::size_t examples = 0;
    for (std::size_t at = 0; (at = outcome.out.find("  maup ", at)) != std::string::npos; ++at) ++examples;
    CHECK(examples >= 3);
    CHECK(contains(outcome.out, "--json"));
    CHECK(contains(maup({"--help"}).out, command));
  }
  CHECK(contains(maup({"--version"}).out, "maup 0."));
}

TEST_CASE("every starter is a right model, in canonical layout, whose expectations hold") {
  const auto names = nlohmann::json::parse(maup({"new", "--list", "--json"}).out).at("starters");
  CHECK(names.size() == 8);
  for (const std::string name : names) {
    CAPTURE(name);
    const Outcome text = maup({"new", name, "-o", "-"});
    CHECK(text.code == 0);
    const Outcome tested = maup({"test", "-"}, text.out);
    CHECK_MESSAGE(tested.code == 0, tested.out, tested.err);
    CHECK(tested.err.empty());
    const Outcome run = maup({"simulate", "-", "--duration", "1s"}, text.out);
    CHECK_MESSAGE(run.code == 0, run.err);
    const Outcome formatted = maup({"fmt", "-"}, text.out);
    CHECK(formatted.code == 0);
    CHECK(maup({"fmt", "-"}, formatted.out).out == formatted.out);
  }
}

TEST_CASE("a chain of any length") {
  for (const char* links : {"1", "2", "17", "100"}) {
    CAPTURE(links);
    const Outcome text = maup({"new", "chain", "--links", links, "-o", "-"});
    const Outcome check = maup({"check", "-", "--json"}, text.out);
    REQUIRE_MESSAGE(check.code == 0, check.out);
    CHECK(std::to_string(nlohmann::json::parse(check.out).at("freedoms").get<int>()) == links);
  }
}

TEST_CASE("new never overwrites") {
  const Folder folder;
  const std::string path = folder.write("pendulum.lag", "mine\n");
  const Outcome refused = maup({"new", "pendulum", "-o", path});
  CHECK(refused.code == 2);
  CHECK(contains(refused.err, "E0807"));
  CHECK(read(path) == "mine\n");
  CHECK(maup({"new", "pendulum", "-o", path, "--force"}).code == 0);
  CHECK(contains(read(path), "system pendulum"));
  CHECK(contains(maup({"new", "pendulm"}).err, "Did you mean pendulum?"));
  CHECK(contains(maup({"simulat", "x.lag"}).err, "`simulat` is no command of maup. Did you mean `simulate`?"));
  CHECK(contains(maup({"x.lag"}).err, "Write what to do with it: maup check x.lag"));
  CHECK(maup({"linearize", "x.lag"}).code == 2);
}

TEST_CASE("explain") {
  CHECK(contains(maup({"explain", "e0801"}).out, "E0801: a file cannot be read"));
  const Outcome near = maup({"explain", "E08011"});
  CHECK(near.code == 2);
  CHECK(contains(near.err, "Did you mean E0801?"));
  const Outcome list = maup({"explain"});
  CHECK(contains(list.out, "E0101"));
  CHECK(contains(list.out, "E0806"));
}

TEST_CASE("fmt is idempotent and keeps comments") {
  const std::string text =
      "system s   # why\nparam m=1 kg,k = 4 N/m\ncoord x:length\nT = 1/2 m dot(x)^2   # kinetic\nV=1/2 k x²\n";
  const Outcome once = maup({"fmt", "-"}, text);
  REQUIRE(once.code == 0);
  CHECK(contains(once.out, "# why"));
  CHECK(contains(once.out, "# kinetic"));
  CHECK(contains(once.out, "x'^2"));
  CHECK(maup({"fmt", "-"}, once.out).out == once.out);
  CHECK(maup({"fmt", "--check", "-"}, text).code == 1);
  CHECK(maup({"fmt", "--check", "-"}, once.out).code == 0);
  const Folder folder;
  const std::string path = folder.write("a.lag", text);
  CHECK(maup({"fmt", "-i", path}).code == 0);
  CHECK(read(path) == once.out);
}

TEST_CASE("files of a run") {
  const Folder folder;
  const std::string model = folder.write("pendulum.lag", pendulum);
  for (const char* name : {"m.csv", "m.npy", "m.json"}) {
    CAPTURE(name);
    CHECK(maup({"simulate", model, "-o", folder.path(name)}).code == 0);
    CHECK(read(folder.path(name)).size() > 1000);
  }
  CHECK(nlohmann::json::parse(read(folder.path("m.json")), nullptr, false).is_object());
  CHECK(maup({"simulate", model, "--plot", folder.path("m.svg")}).code == 0);
  CHECK(contains(read(folder.path("m.svg")), "<svg"));
  CHECK(contains(maup({"plot", model, "--x", "θ", "--y", "θ'"}).out, "<svg"));
  const Outcome wrong = maup({"plot", model, "--y", "w"});
  CHECK(wrong.code == 2);
  CHECK(contains(wrong.err, "E0201"));  // the option is read as a formula
}

TEST_CASE("memory for expectations grows with their number alone") {
  const Folder folder;
  const std::string oscillator = "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\nstart x = 1\nrun 1\n";
  std::string same = oscillator, different = oscillator;
  for (int k = 1; k <= 4000; ++k) {
    same += "expect x at 1 = 0.5403023058681398 rel 1e-9\n";
    const double t = k / 4000.0, value = k == 4000 ? 1 : k * std::cos(t);  // the last one is false
    different += fmt::format("expect {} x at {:.17g} = {:.17g} rel 1e-9\n", k, t, value);
  }
  // The one took 1.2 GB, the other as much: a table of all formulas at all times, once for each companion of the run.
  const std::string limited = "ulimit -v 700000; \"$MAUP\" test ";
  const Outcome of_same = shell(limited + folder.write("same.lag", same));
  CHECK(of_same.code == 0);
  CHECK(contains(of_same.out, "4000 of 4000 expectations hold"));
  const Outcome of_different = shell(limited + folder.write("different.lag", different));
  CHECK(of_different.code == 4);
  CHECK(contains(of_different.out, "3999 of 4000 expectations hold"));
}

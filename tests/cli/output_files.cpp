// Results never take the place of what they were made from, and a name says what a file holds.
#include "program.hpp"

#include <doctest/doctest.h>

#include <filesystem>

using namespace cli_test;

namespace {

const char* const bead =
    "system bead\ndimensionless\nparam Ω = 2\ncoord x : number\ncoord y : number\nT = 1/2 (x'^2 + y'^2)\nV = x^2 + "
    "y^2\nconstraint y = x\nstart x = 1, y = 1\nrun 1\n";

/// Every option of a command that writes a file.
const std::vector<std::vector<std::string>> writers{{"simulate", "-o"},
                                                    {"simulate", "--plot"},
                                                    {"plot", "-o"},
                                                    {"report", "-o"},
                                                    {"animate", "-o"},
                                                    {"animate", "--still", "1s", "-o"},
                                                    {"reduce", "-o"},
                                                    {"action", "--motion", "-o"},
                                                    {"action", "--motion", "--plot"},
                                                    {"hamiltonian", "--integrate", "-o"},
                                                    {"orbits", "--lyapunov", "-o"},
                                                    {"orbits", "--lyapunov", "--plot"},
                                                    {"modes", "--plot"},
                                                    {"modes", "--roots"},
                                                    {"modes", "--csv"}};

Outcome write(std::vector<std::string> command, const std::string& model, const std::string& file) {
  command.insert(command.begin() + 1, model);
  command.push_back(file);
  return maup(command);
}

}  // namespace

TEST_CASE("the model is never written over, under whatever name") {
  const Folder folder;
  const std::string model = folder.write("bead.lag", bead), link = folder.path("link.lag"),
                    twin = folder.path("twin.csv");
  std::filesystem::create_symlink(model, link);
  std::filesystem::create_hard_link(model, twin);
  for (const auto& writer : writers)
    for (const std::string& name : {model, link, twin, folder.path("./bead.lag")}) {
      CAPTURE(writer[0] + " " + writer.back() + " " + name);
      const Outcome outcome = write(writer, model, name);
      CHECK(outcome.code == 2);
      CHECK(contains(outcome.err, "E0812"));
      CHECK(read(model) == bead);
    }
}

TEST_CASE("a name of another kind is refused before anything is computed") {
  const Folder folder;
  const std::string model = folder.write("bead.lag", bead), other = folder.write("thesis.doc", "years of work");
  for (const auto& writer : writers)
    for (const std::string& name : {other, folder.path("new.jpg"), folder.path("noending")}) {
      CAPTURE(writer[0] + " " + writer.back() + " " + name);
      const Outcome outcome = write(writer, model, name);
      CHECK(outcome.code == 2);
      CHECK(contains(outcome.err, "E0810"));
    }
  CHECK(maup({"new", "pendulum", "--force", "-o", other}).code == 2);
  CHECK(read(other) == "years of work");
  CHECK(folder.names() == std::vector<std::string>{"bead.lag", "thesis.doc"});
}

TEST_CASE("two options that ask for one file; devices take what they are given") {
  const Folder folder;
  const std::string model = folder.write("bead.lag", bead);
  const Outcome outcome =
      maup({"action", model, "--motion", "--plot", folder.path("p.svg"), "--plot-paths", folder.path("p.svg")});
  CHECK(outcome.code == 2);
  CHECK(contains(outcome.err, "both ask for"));
  CHECK(maup({"report", model, "-o", "/dev/null"}).code == 0);
  CHECK(maup({"plot", model, "-o", "/dev/null"}).code == 0);
  CHECK(contains(maup({"reduce", model, "-o", "-"}).out, "system"));
}

TEST_CASE("the model of standard input, and another one behind a link, are not written over") {
  const Folder folder;
  const std::string input = folder.write("s.csv", bead), model = folder.write("bead.lag", bead),
                    other = folder.write("other.lag", pendulum), link = folder.path("link.svg");
  std::filesystem::create_symlink(other, link);
  const Outcome own = shell("\"$MAUP\" simulate - -o " + input + " < " + input);
  CHECK(own.code == 2);
  CHECK(contains(own.err, "E0812"));
  CHECK(read(input) == bead);
  for (const Outcome& outcome :
       {maup({"plot", model, "-o", link}), maup({"animate", model, "--still", "1s", "-o", link})}) {
    CHECK(outcome.code == 2);
    CHECK(contains(outcome.err, "is a link to the model other.lag"));
  }
  const Outcome reduced = maup({"reduce", model, "-o", other});
  CHECK(reduced.code == 2);
  CHECK(contains(reduced.err, "E0807"));
  CHECK(read(other) == pendulum);
  CHECK(maup({"reduce", model, "--force", "-o", other}).code == 0);
  CHECK(read(other) != pendulum);
}

TEST_CASE("a folder that is missing and a table without a format are told before the run") {
  const Folder folder;
  const std::string model = folder.write("bead.lag", bead);
  for (const auto& writer : writers) {
    const std::string ending =
        writer[0] == "report"   ? ".html"
        : writer[0] == "reduce" ? ".lag"
        : writer.back() == "--plot" || writer.back() == "--roots" || writer[0] == "plot" || writer[0] == "animate"
            ? ".svg"
            : ".csv";
    const Outcome outcome = write(writer, model, folder.path("no/such/result" + ending));
    CAPTURE(writer[0] + " " + writer.back() + outcome.err);
    CHECK(outcome.code == 2);
    CHECK(contains(outcome.err, "there is no folder"));
    CHECK(outcome.out.empty());
  }
  const Outcome device = maup({"simulate", model, "--duration", "100000000", "-o", "/dev/null"});
  CHECK(device.code == 2);
  CHECK(contains(device.err, "E0810"));
}

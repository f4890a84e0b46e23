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

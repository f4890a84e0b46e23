// 0 fine, 1 the model is wrong, 2 usage, 3 the run failed, 4 an expectation failed, 130 interrupted.
#include "program.hpp"

#include <doctest/doctest.h>

#include <algorithm>

using namespace cli_test;

TEST_CASE("0: a right model goes through every command") {
  const Folder folder;
  const std::string model = folder.write("pendulum.lag", std::string(pendulum) + "expect energy conserved rel 1e-12\n");
  for (const char* command : {"check", "derive", "simulate", "test", "plot", "fmt"}) {
    CAPTURE(command);
    const Outcome outcome = maup({command, model});
    CHECK_MESSAGE(outcome.code == 0, outcome.err);
    CHECK(!outcome.out.empty());
    CHECK(outcome.err.empty());
  }
  const Outcome report = maup({"report", model, "-o", folder.path("page.html"), "--budget", "none"});
  CHECK_MESSAGE(report.code == 0, report.err);
  CHECK(contains(read(folder.path("page.html")), "<math"));
}

TEST_CASE("1: a wrong model, with the place and one message") {
  const Outcome outcome = maup({"check", "-"}, std::string(pendulum) + "V = m g lenght\n");
  CHECK(outcome.code == 1);
  CHECK(outcome.out.empty());
  CHECK(contains(outcome.err, "standard input:8:9"));
  CHECK(contains(outcome.err, "-- error E"));
  CHECK(outcome.err.find("-- error E") == outcome.err.rfind("-- error E"));
}

TEST_CASE("1: statements and commands of later versions say so") {
  const Outcome statement = maup({"check", "-"},
                                 "dimensionless\nfield u(x) : number on x = 0 .. 1\ndensity = 1/2 u'^2 - 1/2 u_x^2\n"
                                 "coord y : number\nT = 1/2 y'^2\nrates w = y'\n");
  CHECK(statement.code == 1);
  CHECK(contains(statement.err, "not supported yet"));
  for (const char* command : {"sweep", "export"}) {
    CAPTURE(command);
    const Outcome outcome = maup({command, "x.lag", "--whatever"});
    CHECK(outcome.code == 1);
    CHECK(contains(outcome.err, std::string("not supported yet: maup ") + command));
    CHECK(contains(maup({"--help"}).out, command));
  }
}

TEST_CASE("2: usage") {
  CHECK(maup({}).code == 2);
  CHECK(maup({"nonsense"}).code == 2);
  CHECK(maup({"check"}).code == 2);
  CHECK(maup({"derive", "-", "--form", "round"}, pendulum).code == 2);
  CHECK(maup({"simulate", "-", "--method", "euler"}, pendulum).code == 2);
  CHECK(maup({"derive", "-", "--latex", "--mathml"}, pendulum).code == 2);
  for (const char* time : {"3kg", "soon", "nan", "inf", "1e999s", ""}) {
    CAPTURE(time);
    CHECK(maup({"simulate", "-", "--at", time}, pendulum).code != 0);
  }
  CHECK(contains(maup({"simulate", "-", "--at", "3kg"}, pendulum).err, "E0809"));
  CHECK(maup({"simulate", "-", "--at", "3kg"}, pendulum).code == 2);
  CHECK(maup({"simulate", "-", "--tol", "2"}, pendulum).code == 2);
  CHECK(maup({"simulate", "-", "-o", "motion.xls"}, pendulum).code == 2);
}

TEST_CASE("3: a run that cannot go on keeps what it computed") {
  const Folder folder;
  // Free fall into a centre of force: a collision at a finite time.
  const std::string model = folder.write("fall.lag",
                                         "system fall\ndimensionless\nparam k = 1\ncoord x : number\nT = 1/2 x'^2\n"
                                         "V = -k/x\nstart x = 1\nrun 10\n");
  const Outcome outcome = maup({"simulate", model, "-o", folder.path("fall.csv"), "--json"});
  CHECK(outcome.code == 3);
  CHECK(contains(outcome.out, "\"ok\": false"));
  const std::string rows = read(folder.path("fall.csv"));
  CHECK(std::count(rows.begin(), rows.end(), '\n') > 2);
  const Outcome text = maup({"simulate", model});
  CHECK(text.code == 3);
  CHECK(contains(text.err, "The run ended at t = 1.1"));  // π/(2√2) = 1.1107
}

TEST_CASE("4: an expectation that fails") {
  const Outcome outcome = maup({"test", "-"}, std::string(pendulum) + "expect θ at 1 s = 1 rad ± 1e-9\n");
  CHECK(outcome.code == 4);
  CHECK(contains(outcome.out, "standard input:8: expect θ at 1 s = 1 rad ± 1e-9 fails"));
  CHECK(maup({"test", "-"}, std::string(pendulum) + "expect freedoms = 1\n").code == 0);
  // A wrong model is worse than a failed expectation.
  CHECK(maup({"test", "-"}, std::string(pendulum) + "expect freedoms = 1\nV = q\n").code == 1);
}

TEST_CASE("130: Ctrl-C keeps what was computed") {
  const Folder folder;
  const std::string model = folder.write("pendulum.lag", pendulum);
  const Outcome outcome = shell("timeout -s INT --preserve-status 1 \"$MAUP\" simulate " + model +
                                " --duration 100000000s --every 1000s -o " + folder.path("motion.csv") + " --json");
  CHECK(outcome.code == 130);
  CHECK(contains(outcome.out, "\"kind\": \"interrupted\""));
  const std::string rows = read(folder.path("motion.csv"));
  CHECK(std::count(rows.begin(), rows.end(), '\n') > 2);
  CHECK(outcome.seconds < 30);
}

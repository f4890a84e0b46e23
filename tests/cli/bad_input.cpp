// Whatever comes in: a clear diagnostic, bounded time and memory, nothing overwritten.
#include "program.hpp"

#include <doctest/doctest.h>

using namespace cli_test;

namespace {

/// Refused with a coded message in a few seconds and 2 GB (see program.cpp), without a word of an internal error.
void refuses(const std::string& what, const std::string& text, const std::string& command = "derive") {
  CAPTURE(what);
  CAPTURE(command);
  const Outcome outcome = maup({command, "-"}, text);
  CHECK(outcome.code == 1);
  CHECK(contains(outcome.err, "-- error E"));
  CHECK(!contains(outcome.err, "internal error"));
  CHECK(outcome.out.empty());
  CHECK(outcome.err.size() < 100'000);
  CHECK(outcome.seconds < 10);
}

std::string repeated(const std::string& piece, std::size_t times) {
  std::string out;
  for (std::size_t i = 0; i < times; ++i) out += piece;
  return out;
}

/// The pendulum with one of its lines replaced.
std::string with(const std::string& line, const std::string& instead) {
  std::string text = pendulum;
  const auto at = text.find(line);
  REQUIRE(at != std::string::npos);
  return text.replace(at, line.size(), instead);
}

}  // namespace

TEST_CASE("texts that are no model") {
  for (const char* command : {"check", "derive", "simulate", "fmt"}) refuses("empty file", "", command);
  refuses("only a comment", "# nothing\n");
  refuses("zero bytes", std::string(1000, '\0'));
  std::string binary;
  for (int i = 0; i < 100'000; ++i) binary += static_cast<char>((i * 7919) >> 3);
  refuses("binary file", binary);
  refuses("a program", read(MAUP_PROGRAM).substr(0, 200'000));
  refuses("not UTF-8", std::string(pendulum) + "# caf\xe9\nparam \xff = 1 kg\n");
  refuses("10 MB of letters", std::string(10'000'000, 'a'));
  refuses("10 MB of statements", repeated("param m = 1 kg\n", 10'000'000 / 15));
  refuses("a line of a million characters", "system s\nlet a = " + repeated("1 + ", 250'000) + "1\n");
}

TEST_CASE("depth") {
  refuses("100,000 brackets",
          "system s\nlet a = " + std::string(100'000, '(') + "1" + std::string(100'000, ')') + "\n");
  refuses("100,000 open brackets", "system s\nlet a = " + std::string(100'000, '(') + "\n");
  refuses("100,000 minus signs", "system s\ncoord x : length\nlet a = " + std::string(100'000, '-') + "1\nT = a\n");
  refuses("100,000 powers", "system s\nlet a = " + repeated("2^", 100'000) + "2\n");
  refuses("100,000 primes", "system s\ncoord x : length\nT = x" + std::string(100'000, '\'') + "\n");
}

TEST_CASE("definitions that go round, or grow") {
  refuses("a cycle of lets", "system s\ncoord x : length\nlet a = b\nlet b = c\nlet c = a\nT = a x'^2\n");
  refuses("a let of itself", "system s\ncoord x : length\nlet a = a + 1\nT = a x'^2\n");
  std::string chain = "system s\ndimensionless\ncoord x : number\n";
  for (int i = 0; i < 5000; ++i) chain += "let a" + std::to_string(i) + " = a" + std::to_string(i + 1) + "\n";
  refuses("a long cycle", chain + "let a5000 = a0\nT = a0 x'^2\n");
}

TEST_CASE("numbers that are none") {
  refuses("nan", with("1 m,", "nan m,"));
  refuses("inf", with("1 m,", "inf m,"));
  refuses("1e400", with("1 m,", "1e400 m,"));
  refuses("1e999999999", with("1 m,", "1e999999999 m,"));
  refuses("a million digits", with("1 m,", std::string(1'000'000, '9') + " m,"));
  refuses("division by zero", with("1 m,", "1/0 m,"));
}

TEST_CASE("systems that are none") {
  refuses("two systems", std::string(pendulum) + pendulum);
  refuses("no system", "param m = 1 kg\n");
  refuses("zero mass", with("m = 1 kg", "m = 0 kg"));
  refuses("negative mass", with("m = 1 kg", "m = -1 kg"));
  refuses("zero length", with("l = 1 m", "l = 0 m"));
  refuses("no coordinates", "system s\nparam m = 1 kg\npoint P mass m at (0, 0)\n");
}

TEST_CASE("paths") {
  const Folder folder;
  const auto refused = [](const Outcome& outcome, const char* code) {
    CHECK(outcome.code == 2);
    CHECK(contains(outcome.err, code));
    CHECK(outcome.out.empty());
  };
  for (const char* command : {"check", "derive", "simulate", "plot", "report"}) {
    CAPTURE(command);
    refused(maup({command, folder.path("none.lag")}), "E0801");
    refused(maup({command, folder.path("")}), "E0802");
  }
  folder.write("pendulum.lag", pendulum);
  CHECK(contains(maup({"check", folder.path("pendulm.lag")}).err, "Did you mean " + folder.path("pendulum.lag")));
  refused(shell("timeout 20 \"$MAUP\" check /dev/zero"), "E0803");
}

TEST_CASE("results that cannot be written leave what was there") {
  const Folder folder;
  const std::string model = folder.write("pendulum.lag", pendulum);
  const std::string old = folder.write("old.csv", "precious\n");
  // A limit on the size of files stands for a full disk.
  const Outcome limited = shell("trap '' XFSZ; ulimit -f 1; \"$MAUP\" simulate " + model + " --every 1ms -o " + old);
  CHECK(limited.code == 3);
  CHECK(contains(limited.err, "E0804"));
  CHECK(read(old) == "precious\n");
  CHECK(folder.names() == std::vector<std::string>{"old.csv", "pendulum.lag"});

  CHECK(contains(maup({"simulate", model, "-o", folder.path("no/such/motion.csv")}).err, "E0804"));
  CHECK(maup({"simulate", model, "-o", folder.path("no/such/motion.csv")}).code == 2);
  const Outcome full = shell("\"$MAUP\" derive " + model + " >/dev/full");
  CHECK(full.code == 3);
  CHECK(contains(full.err, "E0805"));
  const Outcome closed = shell("{ \"$MAUP\" simulate " + model + " --json; echo code $? >&2; } | true");
  CHECK(!contains(closed.err, "internal error"));
  // An editor that sends and does not read.
  const Outcome deaf = shell(
      "printf 'Content-Length: 70\\r\\n\\r\\n"
      "{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"initialize\",\"params\":{\"rootUri\":\"\"}}' | \"$MAUP\" lsp "
      ">/dev/full");
  CHECK(deaf.code == 3);
  CHECK(contains(deaf.err, "E0805"));
}

TEST_CASE("a wrong model writes nothing") {
  const Folder folder;
  const std::string wrong = folder.write("wrong.lag", std::string(pendulum) + "V = q\n");
  const std::string old = folder.write("old.html", "precious\n");
  CHECK(maup({"report", wrong, "-o", old}).code == 1);
  CHECK(maup({"plot", wrong, "-o", folder.path("new.svg")}).code == 1);
  CHECK(maup({"fmt", "--in-place", folder.write("text.lag", "system s\nlet a = (\n")}).code == 1);
  CHECK(read(folder.path("text.lag")) == "system s\nlet a = (\n");
  CHECK(read(old) == "precious\n");
  CHECK(folder.names() == std::vector<std::string>{"old.html", "text.lag", "wrong.lag"});
}

TEST_CASE("a basis that would not fit is refused with its size, before anything is computed") {
  const Outcome outcome = maup({"invariants", PROJECT_DIR "/models/robot_arm.lag", "--degree", "4", "--no-drift"});
  CHECK(outcome.code == 1);
  CHECK(outcome.out.empty());
  CHECK(contains(outcome.err, "E1001"));
  CHECK(contains(outcome.err, "MB"));
  CHECK(contains(maup({"explain", "E1001"}).out, "--largest-basis"));
}

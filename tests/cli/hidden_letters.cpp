// Escape bytes, characters that turn the direction of writing, and letters that look alike: shown as what they are, and
// warned of.
#include "json.hpp"

#include <doctest/doctest.h>

using namespace cli_test;

namespace {

const char* const commands[] = {"check",  "derive", "simulate", "test",   "invariants", "hamiltonian", "modes",
                                "orbits", "action", "plot",     "report", "reduce",     "fmt"};

bool is_safe(const std::string& text) {
  for (const char c : text)
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7f) return false;
  return !contains(text, "\u202e") && !contains(text, "\xc2\x9b");
}

}  // namespace

TEST_CASE("a file name reaches no terminal as it is") {
  const Folder folder;
  const std::string name =
                        "a\x1b[31m\xc2\x9b"
                        "b\u202e.lag",
                    model = folder.write(name, pendulum);
  for (const char* command : commands) {
    CAPTURE(command);
    for (const std::string& path : {model, folder.path("none" + name)}) {
      std::vector<std::string> line{command, path, "--color", "never"};
      if (line[0] == "report") line.insert(line.end(), {"-o", folder.path("page.html")});  // not into the tree
      const Outcome outcome = maup(line);
      CHECK_MESSAGE(is_safe(outcome.out), outcome.out);
      CHECK_MESSAGE(is_safe(outcome.err), outcome.err);
    }
  }
  const Outcome missing = maup({"check", folder.path("x\x1b]0;t\x07.lag")});
  CHECK(missing.code == 2);
  CHECK(contains(missing.err, "x\\x1b]0;t\\x07.lag"));
  CHECK(contains(maup({"check", model}).err, "W0817"));
  CHECK(contains(maup({"check", folder.write("mаss.lag", pendulum)}).err, "W0817"));
  CHECK(is_safe(maup({"check", "--\x1b[31m"}).err));
  const Outcome line = maup({"check", folder.write("new\nline.lag", "coord x\n")});
  CHECK(contains(line.err, "W0817"));
  CHECK(contains(line.err, "new\\nline.lag:1"));
  const std::string page = folder.path("page.html");
  CHECK(maup({"report", folder.write("turned.lag", std::string("note \"\u202e\"\n") + pendulum), "-o", page}).code ==
        0);
  CHECK(read(page).find("\u202e") == std::string::npos);
}

TEST_CASE("a comment or a title that turns the direction of writing is warned of, and shown as it is") {
  const std::string text =
      "system p \"title \u202e\"\ndimensionless\ncoord x : number # \u2066 comment\nT = 1/2 x'^2\nV = x^2\n";
  const Outcome check = maup({"check", "-"}, text);
  CHECK(check.code == 0);
  CHECK(contains(check.err, "W0108"));
  CHECK(check.err.find("W0108") == check.err.rfind("W0108"));
  for (const char* command : {"check", "derive", "report"}) {
    const Outcome outcome = maup({command, "-", "--no-run", "-o", "-"}, text);
    CHECK(is_safe(outcome.out));
    CHECK(is_safe(outcome.err));
  }
  const Outcome json = maup({"check", "-", "--json"}, text);
  CHECK(is_safe(json.out));
  CHECK_FALSE(nlohmann::json::parse(json.out, nullptr, false).is_discarded());
  CHECK(maup({"fmt", "-"}, text).out.find("\u202e") != std::string::npos);  // the text of a file is not changed
}

TEST_CASE("names that look alike, and names of two alphabets") {
  const std::string head = "system p\ndimensionless\ncoord x : number\n";
  const Outcome twins = maup({"check", "-"}, head + "param а = 1, a = 2\nT = 1/2 a x'^2\nV = а x^2\n");
  CHECK(twins.code == 0);
  CHECK(contains(twins.err, "W0106"));
  CHECK(contains(twins.err, "line 4"));
  const Outcome mixed = maup({"check", "-"}, head + "param lоad = 1\nT = 1/2 lоad x'^2\nV = x^2\n");
  CHECK(contains(mixed.err, "W0107"));
  CHECK(contains(mixed.err, "U+043E"));
  for (const char* names : {"param ρ = 1, p = 2, ν = 3, v = 4, α = 5, a = 6", "param масса = 1, Δx = 2"}) {
    CAPTURE(names);
    const Outcome fine = maup({"check", "-"}, head + names + "\nT = 1/2 x'^2\nV = x^2\n");
    CHECK_FALSE(contains(fine.err, "W0106"));
    CHECK_FALSE(contains(fine.err, "W0107"));
  }
  // The name that was typed as it looks.
  const Outcome typed = maup({"check", "-"}, head + "param lоad = 1\nT = 1/2 load x'^2\nV = x^2\n");
  CHECK(typed.code == 1);
  CHECK(contains(typed.err, "looks the same"));
}

TEST_CASE("a dumb terminal is given no colour and no line that is drawn over") {
  const Folder folder;
  const std::string model = folder.write("wrong.lag", std::string(pendulum) + "V = q\n"),
                    slow = folder.write("slow.lag", pendulum);
  const auto in_terminal = [&](const std::string& term, const std::string& arguments) {
    return shell("script -qec \"TERM=" + term + " '$MAUP' " + arguments + "\" /dev/null </dev/null").out;
  };
  const std::string colored = in_terminal("xterm", "check " + model);
  if (!contains(colored, "error E")) return;  // no `script` here
  CHECK(contains(colored, "\x1b["));
  CHECK_FALSE(contains(in_terminal("dumb", "check " + model), "\x1b"));
  CHECK_FALSE(contains(in_terminal("dumb", "report " + slow + " -o " + folder.path("page.html")), "\x1b"));
  CHECK(contains(in_terminal("xterm", "report " + slow + " -o " + folder.path("page.html")), "\x1b[K"));
}

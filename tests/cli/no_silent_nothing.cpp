// Options that make no sense, numbers that are none and files that cannot be read are told, each with its code.
#include "json.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <functional>
#include <set>

using namespace cli_test;

namespace {

const char* const henon = PROJECT_DIR "/models/henon_heiles.lag";

Outcome lyapunov(std::vector<std::string> more) {
  more.insert(more.begin(), {"orbits", henon, "--lyapunov", "--duration", "20s"});
  return maup(more);
}

}  // namespace

TEST_CASE("averages over times out of proportion, and more exponents than there are") {
  for (const char* interval : {"1e-300s", "1e-9s", "30s"}) {
    CAPTURE(interval);
    const Outcome outcome = lyapunov({std::string("--interval=") + interval});
    CHECK(outcome.code == 3);
    CHECK((contains(outcome.err, "E1411") || contains(outcome.err, "E1406")));
    CHECK(outcome.out.empty());
  }
  for (const char* interval : {"0s", "-1s"}) {
    CAPTURE(interval);
    const Outcome outcome = lyapunov({std::string("--interval=") + interval});
    CHECK(outcome.code == 2);
    CHECK(contains(outcome.err, "E0809"));
  }
  for (const char* transient : {"1e300s", "1e15s"}) {
    CAPTURE(transient);
    const Outcome outcome = lyapunov({"--transient", transient});
    CHECK(outcome.code == 3);
    CHECK(contains(outcome.err, "E1411"));
  }
  const Outcome many = lyapunov({"--exponents", "1000000"});
  CHECK(many.code == 3);
  CHECK(contains(many.err, "this motion has 4 exponents, not 1000000"));
  CHECK(lyapunov({"--exponents", "4", "--interval", "1s", "--transient", "1s"}).code == 0);
  const Outcome starts = maup({"orbits", henon, "--section", "x = 0 rising", "--starts", "1000000000"});
  CHECK(starts.code == 3);
  CHECK(contains(starts.err, "E1407"));
}

TEST_CASE("an output without a name") {
  for (const char* command : {"simulate", "plot", "report", "animate"}) {
    CAPTURE(command);
    const Outcome outcome = maup({command, henon, "-o", ""});
    CHECK(outcome.code == 2);
    CHECK(contains(outcome.err, "no file is named"));
  }
}

TEST_CASE("an unknown word in the environment") {
  const Folder folder;
  const std::string model = folder.write("pendulum.lag", pendulum);
  for (const char* command : {"check", "simulate --json"}) {
    const Outcome wrong = shell("MAUPERTUIS_INSTRUCTIONS=sse9 \"$MAUP\" " + std::string(command) + " " + model);
    CHECK(wrong.code == 0);
    CHECK(contains(wrong.err, "W0815"));
    CHECK(contains(wrong.err, "sse9"));
  }
  for (const char* word : {"", "none", "avx2", "avx512"})
    CHECK(shell("MAUPERTUIS_INSTRUCTIONS=" + std::string(word) + " \"$MAUP\" check " + model).err.empty());
}

TEST_CASE("numbers that are none are a failure") {
  const Folder folder;
  // The observable √x has no value once x < 0; the energy of the second overflows.
  const std::string root =
      folder.write("root.lag",
                   "system root\ndimensionless\ncoord x : number\nlet r = sqrt(x)\nT = 1/2 x'^2\nV = x\nstart x = 1\n"
                   "point P at (r, 0)\nrun 3\n");
  const Outcome rows = maup({"simulate", root, "-o", folder.path("rows.csv")});
  CHECK(rows.code == 3);
  CHECK(contains(rows.err, "E0816"));
  CHECK(contains(rows.err, "P.x at t = "));
  CHECK(contains(rows.err, "left out of " + folder.path("rows.csv")));
  // The rest of the run is there, and nothing in it but numbers.
  const std::string kept = read(folder.path("rows.csv"));
  CHECK(contains(kept, ",x,x',P.y,"));
  for (const char* none : {"nan", "inf", "P.x"}) CHECK_FALSE(contains(kept, none));
  const Outcome alone = maup({"simulate", root, "-o", folder.path("alone.csv"), "--columns", "1/t"});
  CHECK(alone.code == 3);
  CHECK(contains(alone.err, "1/t at t = 0 is no finite number"));
  CHECK(contains(alone.err, "alone.csv was not written"));
  CHECK_FALSE(std::filesystem::exists(folder.path("alone.csv")));
  CHECK(maup({"simulate", root, "-o", folder.path("two.csv"), "--columns", "x, 1/t", "--errors"}).code == 3);
  const std::string two = read(folder.path("two.csv"));
  CHECK(contains(two, ",x,error(x)"));
  CHECK_FALSE(contains(two, "1/t"));
  const Outcome json = maup({"simulate", root, "--json"});
  CHECK(json.code == 3);
  CHECK(nlohmann::json::parse(json.out)["ok"] == false);
  CHECK(maup({"plot", root, "-o", folder.path("rows.svg")}).code == 3);
}

TEST_CASE("hamiltonian --json defines every name that it uses") {
  const Folder folder;
  std::string chain = "system chain\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n", last;
  for (const char* n : {"1", "2", "3", "4", "5"}) {
    chain += std::string("coord a") + n + " : angle\npoint P" + n + " mass m at " + last + "l (sin a" + n + ", -cos a" +
             n + ")\n";
    last = std::string("P") + n + " + ";
  }
  chain += "gravity (0, -g)\n";
  const Outcome told =
      maup({"hamiltonian", folder.write("chain.lag", chain), "--bracket", "a1'^2 + a2'^2", "p_a1 p_a2^3", "--json"});
  REQUIRE(told.code == 0);
  const auto document = nlohmann::json::parse(told.out);
  std::set<std::string> implicit;
  for (const auto& group : document["groups"])
    if (group["kind"] == "implicit")
      for (const auto& name : group["coordinates"]) implicit.insert(name);
  CHECK(implicit.size() == 5);
  CHECK(document["hamiltonian"]["plain"].is_string());
  for (const auto& row : document["velocities"]) {
    CHECK(row["plain"].is_string());
    CHECK(row["implicit"] == true);
    CHECK(row["left"].get<std::string>().rfind("p_a", 0) == 0);
  }
  // k1, k2, … are names of intermediates: each that is used stands in the list of its own form.
  const std::function<void(const nlohmann::json&)> look = [&](const nlohmann::json& value) {
    if (value.is_object() && value.contains("plain") && value.contains("intermediates")) {
      std::set<std::string> defined;
      std::string used = value["plain"];
      for (const auto& i : value["intermediates"])
        defined.insert(i["name"].get<std::string>()), used += " " + i["plain"].get<std::string>();
      for (std::size_t at = used.find('k'); at != std::string::npos; at = used.find('k', at + 1)) {
        std::size_t end = at + 1;
        while (end < used.size() && used[end] >= '0' && used[end] <= '9') ++end;
        if (end > at + 1) CHECK_MESSAGE(defined.count(used.substr(at, end - at)) == 1, used.substr(at, end - at));
      }
    }
    if (value.is_structured())
      for (const auto& part : value) look(part);
  };
  look(document);
}

TEST_CASE("2: a file that cannot be read, by every command") {
  const Folder folder;
  const std::string missing = folder.path("none.lag"),
                    there = folder.write("pendulum.lag", std::string(pendulum) + "expect freedoms = 1\n");
  for (const char* command : {"check", "derive", "simulate", "test", "invariants", "hamiltonian", "modes", "orbits",
                              "action", "plot", "report", "reduce", "fmt"})
    for (const std::string& path : {missing, folder.path("."), folder.path("none\x1b.lag")}) {
      CAPTURE(command);
      std::vector<std::string> line{command, path};
      if (line[0] == "orbits") line.push_back("--floquet");
      CHECK(maup(line).code == 2);
      line.push_back("--json");
      const Outcome json = maup(line);
      CHECK(json.code == 2);
      CHECK(contains(json.out, "E080"));
    }
  CHECK(maup({"compare", there, missing}).code == 2);
  CHECK(maup({"compare", missing, there}).code == 2);
  CHECK(maup({"test", there, missing}).code == 2);
  CHECK(contains(maup({"test", there, missing}).out, "1 of 1 expectations hold"));
  CHECK(maup({"fmt", "--check", there, missing}).code == 2);
  CHECK(maup({"test", there, folder.write("wrong.lag", "system x\nV = q\n")}).code == 1);
  CHECK(maup({"compare", there, folder.write("empty.lag", "")}).code == 1);
}

TEST_CASE("a mistake in an option is shown in what the option said, not in a line that nobody wrote") {
  const Folder folder;
  const std::string model = folder.write("pendulum.lag", pendulum);
  const Outcome time = maup({"simulate", model, "--until", "20s"});
  CHECK(time.code == 2);
  CHECK(contains(time.err, "Write --duration 20s"));
  CHECK_FALSE(contains(time.err, "run until"));
  const std::vector<std::vector<std::string>> lines{{"simulate", model, "--until", "θ = nonsense"},
                                                    {"simulate", model, "--until", "θ = 0", "--within", "3 kg"},
                                                    {"modes", model, "--sweep", "m = 1 .. 2 kgg"},
                                                    {"modes", model, "--y", "θ + nonsense"},
                                                    {"hamiltonian", model, "--bracket", "θ", "p_nothing"},
                                                    {"orbits", model, "--section", "q = 0 rising"},
                                                    {"action", model, "--ends", "(0 kg) at 0 to (1) at 1 s"}};
  for (const auto& line : lines) {
    CAPTURE(line[2]);
    const Outcome outcome = maup(line);
    CHECK(outcome.code != 0);
    CHECK_MESSAGE(contains(outcome.err, "- " + line[line.size() - (line[2] == "--bracket" ? 3 : 2)] + ":1:"),
                  outcome.err);
    for (const char* own : {"run until", "path from", "sweep m", "expect "})
      CHECK_FALSE(contains(outcome.err, std::string("| ") + own));
    std::vector<std::string> json = line;
    json.push_back("--json");
    const auto document = nlohmann::json::parse(maup(json).out);
    CHECK(document["diagnostics"][0]["option"] == line[line.size() - (line[2] == "--bracket" ? 3 : 2)]);
    CHECK(document["diagnostics"][0]["line"] == 1);
  }
}

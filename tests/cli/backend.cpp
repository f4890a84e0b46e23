// --backend, --no-cache and what doctor says of them, from outside.
#include "program.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include <cmath>

using namespace cli_test;
using Json = nlohmann::json;

namespace {

bool has_compiled_code() {
  return Json::parse(maup({"doctor", "--json"}).out).at("compiled code") == "works";
}

struct Run {
  int code;
  Json document;
  std::vector<std::string> codes;  // of the diagnostics
};

/// With a cache folder of its own; `environment`: assignments of the shell.
Run simulate(const Folder& folder, const std::string& options, const std::string& environment = {}) {
  const std::string model = folder.write("p.lag", pendulum);
  const Outcome outcome = shell("XDG_CACHE_HOME=" + folder.path("cache") + " " + environment + " $MAUP simulate " + model + " --json " + options);
  Run run{outcome.code, Json::parse(outcome.out), {}};
  for (const Json& d : run.document.at("diagnostics")) run.codes.push_back(d.at("code"));
  return run;
}

std::string backend_of(const Run& run) { return run.document.at("statistics").at("backend"); }
double angle_of(const Run& run) { return run.document.at("final").at("state").at("θ"); }

}  // namespace

TEST_CASE("compiled and interpreted runs agree to rounding; the second compiled run is the first to the bit, from the cache") {
  const Folder folder;
  const Run interpreted = simulate(folder, "--backend interpreter");
  CHECK(interpreted.code == 0);
  CHECK(backend_of(interpreted) == "interpreter");
  CHECK(interpreted.codes.empty());
  const Run first = simulate(folder, "--backend compiled"), second = simulate(folder, "--backend compiled");
  CHECK(first.code == 0);
  CHECK(std::abs(angle_of(first) - angle_of(interpreted)) < 1e-12);
  CHECK(angle_of(second) == angle_of(first));
  if (has_compiled_code()) {
    CHECK(backend_of(first) == "compiled");
    CHECK(first.codes.empty());
    CHECK(contains(shell("ls " + folder.path("cache") + "/maupertuis").out, ".o\n"));
  } else {
    CHECK(backend_of(first) == "interpreter");
    CHECK(first.codes == std::vector<std::string>{"W0703"});
  }
}

TEST_CASE("--no-cache leaves nothing on the disk") {
  const Folder folder;
  CHECK(simulate(folder, "--backend compiled --no-cache").code == 0);
  CHECK(shell("ls " + folder.path("cache")).code != 0);
}

TEST_CASE("a missing module: the run goes on with the interpreter and says so once") {
  const Folder folder;
  const Run run = simulate(folder, "--backend compiled", "MAUPERTUIS_LLVM_MODULE=/nowhere/module.so");
  CHECK(run.code == 0);
  CHECK(backend_of(run) == "interpreter");
  CHECK(run.codes == std::vector<std::string>{"W0703"});
  CHECK(angle_of(run) == angle_of(simulate(folder, "--backend interpreter")));
  const Run automatic = simulate(folder, "--duration 100000s", "MAUPERTUIS_LLVM_MODULE=/nowhere/module.so");
  CHECK(automatic.code == 0);
  CHECK(automatic.codes == std::vector<std::string>{"N0704"});
}

TEST_CASE("a cache that cannot be written: the run is as it would be, with one warning") {
  if (!has_compiled_code()) return;  // nothing is compiled, so nothing is to be kept; the test above is the one
  const Folder folder;
  const Run run = simulate(folder, "--backend compiled", "XDG_CACHE_HOME=" + folder.write("file", "x"));
  CHECK(run.code == 0);
  CHECK(backend_of(run) == "compiled");
  CHECK(run.codes == std::vector<std::string>{"W0705"});
}

TEST_CASE("methods that are not compiled say so when compiled code is asked for") {
  const Folder folder;
  const Run run = simulate(folder, "--backend compiled --method variational --step 10ms");
  CHECK(run.code == 0);
  CHECK(run.codes == std::vector<std::string>{"W0703"});
}

TEST_CASE("a backend that nobody knows is a mistake of usage") {
  CHECK(maup({"simulate", "-", "--backend", "abacus"}, pendulum).code == 2);
}

TEST_CASE("doctor tells of backends, vector instructions and the cache") {
  const Json document = Json::parse(shell("XDG_CACHE_HOME=/tmp/nowhere-at-all $MAUP doctor --json").out);
  CHECK(contains(document.at("backends"), "interpreter"));
  CHECK(document.at("vector instructions").is_string());
  CHECK(contains(document.at("cache"), "/tmp/nowhere-at-all/maupertuis, 0 objects"));
  const Json without = Json::parse(shell("MAUPERTUIS_LLVM_MODULE=/nowhere/module.so $MAUP doctor --json").out);
  CHECK(without.at("backends") == "interpreter");
  CHECK(without.at("compiled code") == "the module /nowhere/module.so is not here");
}

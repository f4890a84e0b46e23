// --backend, --no-cache and what doctor says of them, from outside.
#include "json.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace cli_test;

namespace {

bool has_compiled_code() { return json_of(maup({"doctor", "--json"})).at("compiled code") == "works"; }

struct Run {
  int code;
  Json document;
  std::vector<std::string> codes;  // of the diagnostics
};

/// With a cache folder of its own; `environment`: assignments of the shell.
Run simulate(const Folder& folder, const std::string& options, const std::string& environment = {}) {
  const std::string model = folder.write("p.lag", pendulum);
  const Outcome outcome = shell("XDG_CACHE_HOME=" + folder.path("cache") + " " + environment + " $MAUP simulate " +
                                model + " --json " + options);
  Run run{outcome.code, json_of(outcome), {}};
  for (const Json& d : run.document.at("diagnostics")) run.codes.push_back(d.at("code"));
  return run;
}

std::string backend_of(const Run& run) { return run.document.at("statistics").at("backend"); }
double angle_of(const Run& run) { return run.document.at("final").at("state").at("θ"); }

}  // namespace

TEST_CASE(
    "compiled and interpreted runs agree to rounding; the second compiled run is the first to the bit, from the "
    "cache") {
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

TEST_CASE("a run that goes over to machine code on its way is the same with new code and with kept code, to the bit") {
  const Folder folder;
  const Run first = simulate(folder, "--duration 3000s"), second = simulate(folder, "--duration 3000s");
  CHECK(first.code == 0);
  CHECK(backend_of(first) == (has_compiled_code() ? "compiled" : "interpreter"));
  CHECK(backend_of(second) == backend_of(first));
  CHECK(second.document.at("final") == first.document.at("final"));
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

TEST_CASE("a device that is full: the run is as it would be, with one warning, and nothing is left behind") {
  if (!has_compiled_code()) return;
  const Folder folder;
  const std::string command = "XDG_CACHE_HOME=" + folder.path("cache") + " $MAUP simulate " +
                              folder.write("p.lag", pendulum) + " --json --backend compiled";
  // No file may grow, as where no space is left; the pipe may.
  const Outcome outcome = shell("(trap '' XFSZ; ulimit -f 0; " + command + ") | cat");
  const Json document = json_of(outcome);
  CHECK(document.at("statistics").at("backend") == "compiled");
  REQUIRE(document.at("diagnostics").size() == 1);
  CHECK(document.at("diagnostics").at(0).at("code") == "W0705");
  CHECK(document.at("final") == simulate(folder, "--backend compiled --no-cache").document.at("final"));
  CHECK(shell("ls -A " + folder.path("cache") + "/maupertuis").out.empty());
}

TEST_CASE("a program too large to compile: the interpreter carries the run, and one warning says so") {
  if (!has_compiled_code()) return;  // the test of a missing module is the one
  std::string model = "system large\ndimensionless\ncoord x : number\nlet a0 = sin(x)\n";
  constexpr int steps = 8100;  // each waits for the one before, so that none shares a pack with another
  for (int i = 1; i < steps; ++i) model += "let a" + std::to_string(i) + " = sin(a" + std::to_string(i - 1) + " + x)\n";
  model += "force x = -x - a" + std::to_string(steps - 1) + "/10\nT = 1/2 x'^2\nstart x = 1\nrun 0.01\n";
  const Folder folder;
  const std::string command = " $MAUP simulate " + folder.write("large.lag", model) + " --json --no-cache --backend ";
  const Json compiled = json_of(shell(command + "compiled")), interpreted = json_of(shell(command + "interpreter"));
  CHECK(compiled.at("statistics").at("backend") == "interpreter");
  REQUIRE(compiled.at("diagnostics").size() == 1);
  CHECK(compiled.at("diagnostics").at(0).at("code") == "W0703");
  CHECK(contains(compiled.at("diagnostics").at(0).at("reason"), "too large to be compiled"));
  CHECK(compiled.at("final") == interpreted.at("final"));
  CHECK(interpreted.at("diagnostics").empty());
}

TEST_CASE("processors without AVX-512, and without AVX2: both backends agree with those of this one to rounding") {
  const Folder folder;
  const Run best = simulate(folder, "--backend interpreter");
  const Json here = json_of(maup({"doctor", "--json"}));
  const std::string widest = here.at("vector instructions"), backends = here.at("backends");
  struct Level {
    const char *set, *instructions, *processor;
    bool holds_back;  // where this processor has no more, code is for the processor itself, whatever it is called
  };
  for (const Level& level :
       {Level{"avx2", "AVX2", "for x86-64-v3)", widest == "AVX-512"},
        Level{"none", "none that are used", "for x86-64)", widest == "AVX-512" || widest == "AVX2"}}) {
    CAPTURE(level.set);
    const std::string environment = std::string("MAUPERTUIS_INSTRUCTIONS=") + level.set;
    const Json doctor = json_of(shell(environment + " $MAUP doctor --json"));
    CHECK(doctor.at("vector instructions") == (level.holds_back ? level.instructions : widest));
    CHECK(contains(doctor.at("backends"), level.holds_back && has_compiled_code() ? level.processor : backends));
    for (const char* const backend : {"interpreter", "compiled"}) {
      CAPTURE(backend);
      const Run run = simulate(folder, std::string("--backend ") + backend, environment);
      CHECK(run.code == 0);
      if (has_compiled_code()) CHECK(backend_of(run) == backend);
      CHECK(std::abs(angle_of(run) - angle_of(best)) < 1e-12);
    }
  }
}

// Large enough for vectors of every width.
const char* const double_pendulum =
    "system chain\n"
    "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
    "coord a, b : angle\n"
    "point upper mass m at l (sin a, -cos a)\n"
    "point lower mass m at l (sin a + sin b, -cos a - cos b)\n"
    "gravity (0, -g)\n"
    "start a = 60 deg, b = 20 deg\n"
    "run 1 s\n";

TEST_CASE(
    "other processors, emulated: no instruction that they lack, whatever LLVM calls them, and the same motion to "
    "rounding") {
  if (shell("command -v qemu-x86_64").code != 0) {
    MESSAGE("skipped: qemu-user is not installed");
    return;
  }
  const Folder folder;
  const std::string model = folder.write("d.lag", double_pendulum);
  const auto angle = [](const Outcome& outcome) {
    return json_of(outcome).at("final").at("state").at("b").get<double>();
  };
  const double expected = angle(maup({"simulate", model, "--json", "--backend", "interpreter"}));
  struct Processor {
    const char *emulated, *instructions, *name;
  };
  for (const Processor& p :
       {Processor{"EPYC-Milan", "AVX2", "for znver3)"},
        {"Haswell", "AVX2", "for haswell)"},
        {"Skylake-Server", "AVX2", "for skylake-avx512)"},  // the emulator lacks what the name promises
        {"Nehalem", "none that are used", "for nehalem)"}}) {
    CAPTURE(p.emulated);
    const std::string program = std::string("qemu-x86_64 -cpu ") + p.emulated + " $MAUP ";
    const Json doctor = json_of(shell(program + "doctor --json"));
    CHECK(doctor.at("vector instructions") == p.instructions);
    if (has_compiled_code()) CHECK(contains(doctor.at("backends"), p.name));
    for (const char* const backend : {"interpreter", "compiled"}) {
      CAPTURE(backend);
      const Outcome outcome = shell(program + "simulate " + model + " --json --no-cache --backend " + backend);
      REQUIRE(outcome.code == 0);
      CHECK(std::abs(angle(outcome) - expected) < 1e-12);
    }
  }
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
  const Json document = json_of(shell("XDG_CACHE_HOME=/tmp/nowhere-at-all $MAUP doctor --json"));
  CHECK(contains(document.at("backends"), "interpreter"));
  CHECK(document.at("vector instructions").is_string());
  CHECK(contains(document.at("cache"), "/tmp/nowhere-at-all/maupertuis, 0 objects"));
  const Json without = json_of(shell("MAUPERTUIS_LLVM_MODULE=/nowhere/module.so $MAUP doctor --json"));
  CHECK(without.at("backends") == "interpreter");
  CHECK(without.at("compiled code") == "the module /nowhere/module.so is not here");
}

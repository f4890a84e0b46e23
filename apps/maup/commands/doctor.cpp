#include "command.hpp"
#include "json.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <maupertuis/stiff.hpp>

#include <cfloat>
#include <clocale>
#include <thread>

namespace maupertuis::app {
namespace {

struct Finding {
  std::string what;
  std::string value;
};

/// What matters when a result or a speed is questioned.
std::vector<Finding> examine() {
  return {
      {"version", MAUPERTUIS_VERSION},
      {"compiler", __VERSION__},
      {"arithmetic", FLT_EVAL_METHOD == 0 ? "IEEE double, no excess precision" : "excess precision: results may differ"},
      {"processors", std::to_string(std::thread::hardware_concurrency())},
      {"backends", "interpreter"},
      {"integrators", has_stiff_method() ? "taylor, variational, stiff (SUNDIALS)" : "taylor, variational; stiff needs SUNDIALS"},
      {"trajectory formats", "csv, npy, json"},
      {"not in this version", "contacts, friction, events, fields, sweeps, LLVM backend, HDF5"},
  };
}

ExitCode doctor(Console& console) {
  Json document = json_document("doctor");
  for (const Finding& finding : examine()) {
    document[finding.what] = finding.value;
    if (!console.json()) console.print(fmt::format("{:<22}{}\n", finding.what, finding.value));
  }
  if (console.json()) console.print_document(document);
  return ExitCode::Fine;
}

}  // namespace

void add_doctor(CommandLine& line) {
  line.add("doctor", "What this installation can do",
           "  maup doctor\n"
           "  maup doctor --json\n"
           "  maup doctor --json | jq -r .compiler\n",
           [](Console& console) { return doctor(console); });
}

}  // namespace maupertuis::app

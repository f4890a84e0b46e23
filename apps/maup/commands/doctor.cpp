#include "command.hpp"
#include "json.hpp"
#include "video.hpp"

#include <fmt/format.h>
#include <maupertuis/backend.hpp>
#include <maupertuis/lanes.hpp>
#include <maupertuis/picture.hpp>
#include <maupertuis/regulator.hpp>
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

std::string vector_instructions() {
  return has_instruction_set(InstructionSet::Avx512) ? "AVX-512"
         : has_instruction_set(InstructionSet::Avx2) ? "AVX2"
                                                     : "none that are used";
}

/// What matters when a result or a speed is questioned.
std::vector<Finding> examine() {
  const BackendStatus backend = backend_status();
  const std::string cache = backend.cache_folder.empty()
                                ? "none: neither XDG_CACHE_HOME nor HOME is set"
                                : fmt::format("{}, {} objects, {:.1f} MB", backend.cache_folder, backend.cache_files,
                                              1e-6 * static_cast<double>(backend.cache_bytes));
  return {
      {"version", MAUPERTUIS_VERSION},
      {"compiler", __VERSION__},
      {"arithmetic",
       FLT_EVAL_METHOD == 0 ? "IEEE double, no excess precision" : "excess precision: results may differ"},
      {"processors", std::to_string(std::thread::hardware_concurrency())},
      {"backends", backend.compiled
                       ? fmt::format("interpreter, compiled ({} for {})", backend.compiler, backend.processor)
                       : "interpreter"},
      {"compiled code", backend.compiled ? "works" : backend.trouble},
      {"vector instructions", vector_instructions()},
      {"cache", cache},
      {"integrators", "taylor, variational, stiff"},
      {"regulator", has_lapack() ? "LAPACK" : "needs LAPACK"},
      {"trajectory formats", "csv, npy, json"},
      {"pictures", picture_problem().empty() ? "svg, png, pdf" : "svg; png and pdf need librsvg2-2"},
      {"films", picture_problem().empty() && !find_ffmpeg().empty()
                    ? "html, svg, mp4, gif"
                    : "html, svg; mp4 and gif need ffmpeg and librsvg2-2"},
      {"not in this version", "sweeps, HDF5"},
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

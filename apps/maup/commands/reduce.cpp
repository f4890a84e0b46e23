#include "command.hpp"
#include "comparison_text.hpp"
#include "outcome.hpp"
#include "output_files.hpp"
#include "quantity.hpp"

#include <fmt/format.h>

#include <maupertuis/comparison.hpp>

namespace maupertuis::app {
namespace {

struct ReduceOptions {
  std::string path, output;
  bool force = false;
};

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

/// What was done and on what ground it is believed.
std::string account(const Reduction& r) {
  std::string out;
  for (const std::string& step : r.steps) out += fmt::format("  {}\n", step);
  if (!r.proof) return out;
  out += fmt::format("  the same motion{}: {}\n", r.proof->proved() ? "" : ", by evidence and not proved",
                     ground_text(*r.proof));
  if (r.proof->run.ran)
    out += fmt::format("  run of both for {} s: they differ by {:.2g}\n", brief(r.proof->run.duration),
                       r.proof->run.difference);
  return out;
}

ExitCode reduce_model(const ReduceOptions& options, Console& console) {
  Study study = open_study(options.path);
  Json document = json_document("reduce");
  const bool readable_model = !study.wrong();
  const std::string output = options.output == "-" ? std::string() : options.output;
  check_output_files({{"-o", output, FileKind::Model}}, options.path, study.diagnostics());
  check_is_new(output, options.force, study.diagnostics());
  if (readable_model && study.wrong()) return finish_usage(console, study, "reduce");
  const EquationsOfMotion* equations = study.equations();
  if (!equations || study.refuse_held_integrals() || study.refuse_modes() || !study.certificate())
    return finish(console, study, document);
  const InterruptScope scope = study.interruptible();
  const Reduction r = reduce(*study.model(), *equations, *study.tree(), study.source(), study.diagnostics());
  document["dependent"] = r.dependent;
  document["independent"] = r.independent;
  document["steps"] = r.steps;
  document["text"] = r.text.empty() ? Json(nullptr) : Json(r.text);
  document["proof"] = nullptr;
  if (r.proof)
    document["proof"] = {{"points", r.proof->ground.points},
                         {"error_bound", r.proof->ground.error_bound},
                         {"run_difference", r.proof->run.ran ? Json(r.proof->run.difference) : Json(nullptr)}};
  if (!r.text.empty() && !output.empty()) {
    if (!write_result(output, r.text, study.diagnostics())) {
      finish(console, study, document);
      return ExitCode::RunFailed;
    }
    if (!console.json()) console.print(fmt::format("{}\n{}", output, account(r)));
  } else if (!r.text.empty() && !console.json()) {
    console.print_file(r.text);
    console.say(account(r));
  } else if (!console.json() && !r.dependent.empty()) {
    console.say(fmt::format("independent coordinates near the start: {}; dependent: {}\n", joined(r.independent),
                            joined(r.dependent)));
  }
  return finish(console, study, document);
}

}  // namespace

void add_reduce(CommandLine& line) {
  const auto options = std::make_shared<ReduceOptions>();
  Command& command = line.add("reduce", "Independent coordinates of a constrained model, and the model in them",
                              "  maup reduce cartesian_pendulum.lag\n"
                              "  maup reduce cartesian_pendulum.lag -o pendulum.lag\n"
                              "  maup reduce planetary_gear.lag --json\n",
                              [options](Console& console) { return reduce_model(*options, console); });
  command.add_option("MODEL", options->path, "The model file (.lag), or - for standard input")->required();
  command.add_option("-o,--output", options->output,
                     "Write the reduced model to this file (.lag), or - for standard output");
  command.add_flag("--force", options->force, "Overwrite a file that exists");
}

}  // namespace maupertuis::app

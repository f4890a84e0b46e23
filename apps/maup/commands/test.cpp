#include "outcome.hpp"
#include "run_options.hpp"

#include <fmt/format.h>

#include <maupertuis/verification.hpp>

namespace maupertuis::app {
namespace {

struct TestOptions {
  std::vector<std::string> paths;
  RunOptions run;
};

/// What came of one file.
struct FileOutcome {
  ExitCode code = ExitCode::Fine;
  std::vector<ExpectationResult> results;
};

std::string expectation_text(const ExpectationResult& r, const std::string& file) {
  if (!r.where.empty()) return fmt::format("{}:{}: {} holds where {}\n", file, r.line, r.text, r.where);
  if (r.passed && !r.beyond_digits) return {};
  std::string out = fmt::format("{}:{}: {} {}\n", file, r.line, r.text,
                                r.passed ? "holds, but asks for more digits than are known" : "fails");
  const auto and_then = [](const std::string& text) { return text.empty() ? text : " " + text; };
  if (!r.actual.empty())
    out += fmt::format("    found     {}{}\n", r.actual, and_then(r.beyond_digits ? r.uncertainty : ""));
  if (!r.actual.empty() && !r.expected.empty())
    out += fmt::format("    expected  {}{}\n", r.expected, and_then(r.tolerance));
  if (!r.message.empty()) out += fmt::format("    {}\n", r.message);
  if (!r.pitfall.empty()) out += fmt::format("    {}\n", r.pitfall);
  return out;
}

Json expectation_json(const ExpectationResult& r, const std::string& file) {
  return {{"file", file},
          {"line", r.line},
          {"text", r.text},
          {"passed", r.passed},
          {"actual", r.actual},
          {"expected", r.expected},
          {"tolerance", r.tolerance},
          {"uncertainty", r.uncertainty},
          {"beyond_digits", r.beyond_digits},
          {"message", r.message},
          {"pitfall", r.pitfall},
          {"where", r.where}};
}

/// What was decided before an interrupt came does not tell what the whole run would have: nothing is said of such a
/// model.
std::optional<Verification> verify_whole(Study& study, const SimulationOptions& settings) {
  auto verification = study.verification(settings);
  Interrupt(settings.interrupt).throw_if_asked();
  return verification;
}

FileOutcome test_file(const std::string& path, const SimulationOptions& settings, Console& console, Json& document) {
  Study study = open_study(path);
  FileOutcome outcome;
  const std::string& file = study.source().name();
  const auto verification = verify_whole(study, settings);
  if (verification) {
    outcome.results = verification->results;
    if (verification->failed() > 0) outcome.code = ExitCode::ExpectationFailed;
  }
  // Errors that the model expects are no errors of the test.
  const bool expected_errors = verification && !study.has_fields() && !study.equations();
  if (study.wrong() && !expected_errors)
    outcome.code = unreadable(study.diagnostics()) ? ExitCode::Usage : ExitCode::ModelWrong;

  for (const ExpectationResult& r : outcome.results) {
    document["expectations"].push_back(expectation_json(r, file));
    if (!console.json()) console.print(expectation_text(r, file));
  }
  if (!expected_errors) {
    console.show(study.diagnostics(), study.source());
    for (Json& d : app::to_json(study.diagnostics(), study.source())) {
      d["file"] = file;
      document["diagnostics"].push_back(std::move(d));
    }
  }
  if (!console.json() && (outcome.code == ExitCode::Fine || outcome.code == ExitCode::ExpectationFailed))
    console.print(fmt::format("{}: {} of {} expectations hold\n", file, verification ? verification->passed() : 0,
                              outcome.results.size()));
  return outcome;
}

ExitCode test_models(const TestOptions& options, Console& console) {
  Diagnostics wrong_options;
  const SimulationOptions settings = simulation_options(options.run, wrong_options);
  if (wrong_options.has_errors()) {
    const SourceText nowhere("maup test", "");
    console.show(wrong_options, nowhere);
    if (console.json()) {
      Json document = json_document("test");
      document["ok"] = false;
      document["diagnostics"] = app::to_json(wrong_options, nowhere);
      console.print_document(document);
    }
    return ExitCode::Usage;
  }
  Json document = json_document("test");
  document["expectations"] = Json::array();
  document["diagnostics"] = Json::array();
  ExitCode code = ExitCode::Fine;
  std::size_t tested = 0, passed = 0, failed = 0, wrong = 0;
  try {
    for (const std::string& path : options.paths) {
      Interrupt(settings.interrupt).throw_if_asked();
      const FileOutcome outcome = test_file(path, settings, console, document);
      ++tested;
      code = worse(code, outcome.code);
      wrong += outcome.code == ExitCode::ModelWrong || outcome.code == ExitCode::Usage;
      for (const ExpectationResult& r : outcome.results) ++(r.passed ? passed : failed);
    }
  } catch (const Interrupted&) {
    code = ExitCode::Interrupted;
    document["interrupted"] = true;
    if (!console.json() && options.paths.size() > 1)
      console.say(fmt::format("{} of {} models were tested.\n", tested, options.paths.size()));
  }
  document["passed"] = passed;
  document["failed"] = failed;
  document["ok"] = code == ExitCode::Fine;
  if (console.json())
    console.print_document(document);
  else if (options.paths.size() > 1)
    console.print(fmt::format("{} models: {} expectations hold, {} fail{}\n", tested, passed, failed,
                              wrong ? fmt::format(", {} models are wrong or could not be read", wrong) : ""));
  return code;
}

}  // namespace

void add_test(CommandLine& line) {
  const auto options = std::make_shared<TestOptions>();
  Command& command = line.add("test", "Run the expect and claim lines of models; exit 4 if one fails",
                              "  maup test pendulum.lag\n"
                              "  maup test models/*.lag\n"
                              "  maup test pendulum.lag --json\n",
                              [options](Console& console) { return test_models(*options, console); });
  command.add_option("MODEL", options->paths, "Model files, or - for standard input")->required();
  add_method_options(command, options->run);
  add_errors_option(command, options->run);
}

}  // namespace maupertuis::app

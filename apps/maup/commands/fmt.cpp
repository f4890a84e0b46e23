#include "command.hpp"
#include "open_study.hpp"
#include "outcome.hpp"

#include <fmt/format.h>

namespace maupertuis::app {
namespace {

struct FmtOptions {
  std::vector<std::string> paths;
  bool in_place = false;
  bool check = false;
};

/// One file; a file with a mistake in its text stays as it is.
ExitCode format_one(const std::string& path, const FmtOptions& options, Console& console, Json& files) {
  Study study = open_study(path);
  const syntax::SyntaxTree* tree = study.tree();
  std::string text;
  if (tree && !study.wrong()) text = syntax::format(*tree, study.source());
  const bool changed = !study.wrong() && text != study.source().text();
  if (!study.wrong() && options.in_place && changed) write_result(path, text, study.diagnostics());
  files.push_back({{"file", study.source().name()},
                   {"changed", changed},
                   {"diagnostics", to_json(study.diagnostics(), study.source())}});
  if (!console.json()) {
    console.show(study.diagnostics(), study.source());
    if (options.check && changed) console.say(fmt::format("{}: not in canonical layout\n", study.source().name()));
    if (!options.in_place && !options.check && !study.wrong()) console.print_file(text);
  } else if (!options.in_place && !options.check) {
    files.back()["text"] = text;
  }
  if (unreadable(study.diagnostics())) return ExitCode::Usage;
  return study.wrong() || (options.check && changed) ? ExitCode::ModelWrong : ExitCode::Fine;
}

ExitCode format_all(const FmtOptions& options, Console& console) {
  ExitCode worst = ExitCode::Fine;
  Json files = Json::array();
  for (const std::string& path : options.paths) {
    if (path == "-" && options.in_place) {
      console.say("maup fmt: standard input cannot be rewritten in place; leave --in-place away.\n");
      return ExitCode::Usage;
    }
    worst = worse(worst, format_one(path, options, console, files));
  }
  if (console.json()) {
    Json document = json_document("fmt");
    document["ok"] = worst == ExitCode::Fine;
    document["files"] = std::move(files);
    console.print_document(document);
  }
  return worst;
}

}  // namespace

void add_fmt(CommandLine& line) {
  const auto options = std::make_shared<FmtOptions>();
  Command& command = line.add("fmt", "Lay out models in the canonical way; comments stay",
                              "  maup fmt pendulum.lag                  # to standard output\n"
                              "  maup fmt --in-place models/*.lag\n"
                              "  maup fmt --check models/*.lag          # exit 1 if one would change\n",
                              [options](Console& console) { return format_all(*options, console); });
  command.add_option("MODEL", options->paths, "Model files, or - for standard input")->required();
  const auto in_place = command.add_flag("-i,--in-place", options->in_place, "Rewrite the files");
  command.add_flag("--check", options->check, "Write nothing; exit 1 if a file would change")->excludes(in_place);
}

}  // namespace maupertuis::app

// fuzz_commands: every command of the program, called within this process, on drawn models with drawn options.
//   fuzz_commands run [--seed S] [--first N] [--count N] [--seconds T] [--keep FOLDER]   draws inputs; failures are
//   made small and kept fuzz_commands replay FILE|FOLDER...                                               inputs that
//   were kept fuzz_commands show NUMBER [--seed S]                                              one drawn input
// Exit 0: all is well; 1: a failure, which is told with its input.
#include "codes.hpp"
#include "command_line.hpp"
#include "exit_code.hpp"
#include "interrupt.hpp"
#include "minimize.hpp"
#include "supervisor.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace {

namespace fs = std::filesystem;
using namespace maupertuis;
using namespace maupertuis::fuzz;

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<fs::path> files_in(const fs::path& from) {
  if (!fs::is_directory(from)) return {from};
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(from))
    if (entry.is_regular_file()) out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

/// The models of the project, those that are refused too; large ones are left out, which take their time.
std::vector<std::string> stored_models() {
  std::vector<std::string> out;
  for (const char* folder :
       {"models", "tests/problems", "tests/golden/accept", "tests/golden/reject", "tests/fuzz/corpus"})
    for (const fs::path& path : files_in(fs::path(PROJECT_DIR) / folder))
      if ((path.extension() == ".lag" || path.extension().empty()) && fs::file_size(path) < 3000)
        out.push_back(content(path));
  if (out.size() < 100) throw std::runtime_error("the stored models are not here");
  return out;
}

struct Rules {
  std::set<int> documented;
  std::set<std::string> catalogue;
};

Rules rules() {
  Rules out;
  for (const app::ExitCodeRow& row : app::exit_codes) out.documented.insert(static_cast<int>(row.code));
  out.documented.erase(static_cast<int>(app::ExitCode::Interrupted));  // nobody interrupts
  for (const CodeEntry& entry : app::all_codes()) out.catalogue.emplace(entry.code);
  return out;
}

struct Asked {
  std::uint64_t seed = 1744, first = 0, count = 1'000'000'000'000;
  double seconds = 1e18;
  std::string keep;
  std::vector<std::string> rest;
};

Asked read_arguments(int count, char** words) {
  Asked out;
  for (int i = 2; i < count; ++i) {
    const std::string word = words[i];
    const auto next = [&]() -> std::string {
      if (i + 1 >= count) throw std::runtime_error(word + " wants a value");
      return words[++i];
    };
    if (word == "--seed")
      out.seed = std::stoull(next());
    else if (word == "--first")
      out.first = std::stoull(next());
    else if (word == "--count")
      out.count = std::stoull(next());
    else if (word == "--seconds")
      out.seconds = std::stod(next());
    else if (word == "--keep")
      out.keep = next();
    else
      out.rest.push_back(word);
  }
  return out;
}

/// As a program of its own runs, up to the signals: Ctrl-C is not passed on to it.
int program(int count, char** words) {
  static const bool watched = (app::watch_interrupts(), true);
  static_cast<void>(watched);
  return app::run_command_line(count, words);
}

/// All commands but the server of editors, whose frames are tested by tests/lsp.
app::OptionTable commands_to_draw() {
  app::OptionTable table = app::option_table();
  const auto lsp = [](const app::CommandRow& row) { return row.name == "lsp"; };
  table.commands.erase(std::remove_if(table.commands.begin(), table.commands.end(), lsp), table.commands.end());
  return table;
}

Generator generator(std::uint64_t seed) {
  return {Grammar(content(fs::path(PROJECT_DIR) / "docs/manual/grammar.ebnf")), stored_models(), commands_to_draw(),
          seed};
}

void print(const Input& input) { std::printf("%s\n", to_text(input).c_str()); }

volatile std::sig_atomic_t asked_to_end = 0;

/// What was counted until then is told; the commands themselves have handlers of their own.
void end_in_good_order() {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { asked_to_end = 1; });
}

int draw(const Asked& asked) {
  end_in_good_order();
  const Generator drawn = generator(asked.seed);
  const Rules by = rules();
  const auto begin = std::chrono::steady_clock::now();
  const auto passed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  const auto judge = [&](const Input& input, const Outcome& outcome) {
    return failure(input, outcome, by.documented, by.catalogue);
  };
  std::map<std::string, std::uint64_t> failures;  // by what is wrong
  Supervisor supervisor(program, {});
  const auto tell = [&](std::uint64_t number, const std::string& wrong, const Outcome&) {
    if (failures[wrong]++ >= 2) return;
    const Input small = minimized(drawn.input(number), wrong, program, judge);
    std::printf("\n== input %llu of seed %llu: %s\n", static_cast<unsigned long long>(number),
                static_cast<unsigned long long>(asked.seed), wrong.c_str());
    print(small);
    std::fflush(stdout);
    if (asked.keep.empty()) return;
    fs::create_directories(asked.keep);
    std::ofstream(fs::path(asked.keep) / (std::to_string(asked.seed) + "_" + std::to_string(number) + ".fuzz"),
                  std::ios::binary)
        << to_text(small);
  };
  supervisor.run(
      asked.first, asked.count, [&](std::uint64_t number) { return drawn.input(number); }, judge, tell,
      [&] { return asked_to_end || passed() > asked.seconds; });
  const auto& counts = supervisor.counts();
  std::printf("\n%llu inputs in %.0f s; runs longer than 20 s that ended when asked: %llu; exit codes:",
              static_cast<unsigned long long>(counts.inputs), passed(),
              static_cast<unsigned long long>(counts.long_runs));
  for (const auto& [code, count] : counts.by_code)
    std::printf(" %d: %llu", code, static_cast<unsigned long long>(count));
  std::printf("\n");
  for (const auto& [wrong, count] : failures)
    std::printf("%8llu  %s\n", static_cast<unsigned long long>(count), wrong.c_str());
  return failures.empty() && counts.inputs > 0 ? 0 : 1;
}

int replay(const Asked& asked) {
  const Rules by = rules();
  std::vector<fs::path> paths;
  for (const std::string& from : asked.rest)
    for (const fs::path& path : files_in(from)) paths.push_back(path);
  std::vector<Input> inputs;
  for (const fs::path& path : paths) inputs.push_back(from_text(content(path)));
  if (inputs.empty()) throw std::runtime_error("nothing to replay");
  bool well = true;
  Supervisor(program, {})
      .run(
          0, inputs.size(), [&](std::uint64_t number) { return inputs[number]; },
          [&](const Input& input, const Outcome& outcome) {
            return failure(input, outcome, by.documented, by.catalogue);
          },
          [&](std::uint64_t number, const std::string& wrong, const Outcome& outcome) {
            well = false;
            std::printf("%s: %s\n%s\n", paths[number].c_str(), wrong.c_str(), outcome.err.c_str());
          },
          [] { return false; });
  std::printf("%zu inputs\n", inputs.size());
  return well ? 0 : 1;
}

int act(int count, char** words) {
  const std::string what = count > 1 ? words[1] : "";
  const Asked asked = read_arguments(count, words);
  if (what == "run") return draw(asked);
  if (what == "replay") return replay(asked);
  if (what == "show" && !asked.rest.empty()) return print(generator(asked.seed).input(std::stoull(asked.rest[0]))), 0;
  std::fprintf(stderr, "fuzz_commands run|replay|show …\n");
  return 2;
}

}  // namespace

int main(int count, char** words) {
  try {
    return act(count, words);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fuzz_commands: %s\n", error.what());
    return 2;
  }
}

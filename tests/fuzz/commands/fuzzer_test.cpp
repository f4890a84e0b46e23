// The fuzzer sees what it is made to see: a fuzzer that reports nothing proves nothing.
#include "command_line.hpp"
#include "minimize.hpp"
#include "worlds.hpp"

#include <maupertuis/study.hpp>

#include <doctest/doctest.h>

#include <unistd.h>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

using namespace maupertuis::fuzz;

namespace {

const std::set<int> documented{0, 1, 2, 3};
const std::set<std::string> catalogue{"E0101"};

std::optional<std::string> judge(const Input& input, const Outcome& outcome) {
  return failure(input, outcome, documented, catalogue);
}

/// A program that does what its first argument says.
int pretender(int count, char** words) {
  const std::string what = count > 1 ? words[1] : "";
  if (what == "crash") std::raise(SIGSEGV);
  if (what == "abort") std::fputs("maup: internal precondition broken: x (y:1)\n", stderr), std::abort();
  if (what == "leave") std::exit(0);
  if (what == "hang")
    for (std::atomic<int> i = 0;; ++i) {
    }
  if (what == "wait") ::sleep(60);
  if (what == "odd") return std::puts("word"), 77;
  if (what == "silent") return 3;
  if (what == "report") std::fputs("internal error. Please report it\n", stderr);
  if (what == "code") std::fputs("-- error E9999 ---- x\n", stderr);
  if (what == "number") std::puts("x = nan m");
  if (what == "file") std::ofstream("out.csv") << "t,x\n0,-inf\n";
  if (what == "json") std::puts("{\"a\": }");
  if (what == "escape") std::puts("\x1b[31m");
  if (what == "model") {
    std::string text;
    for (char c; read(0, &c, 1) == 1;) text += c;
    if (text.find("bad") != std::string::npos) std::puts("x = nan m");
  }
  return 0;
}

/// What is told of each, and how many inputs were counted.
std::map<std::string, std::string> told(const std::vector<Input>& inputs, std::uint64_t& counted) {
  std::map<std::string, std::string> out;
  Limits limits;
  limits.seconds = 0.3, limits.waiting = 1;
  Supervisor supervisor(pretender, limits);
  supervisor.run(
      0, inputs.size(), [&](std::uint64_t i) { return inputs[i]; }, judge,
      [&](std::uint64_t i, const std::string& wrong, const Outcome&) { out[inputs[i].arguments[0]] = wrong; },
      [] { return false; });
  counted = supervisor.counts().inputs;
  return out;
}

}  // namespace

TEST_CASE("each kind of failure is told, and what follows it still runs") {
  std::vector<Input> inputs;
  for (const char* what : {"fine", "crash", "abort", "leave", "hang", "wait", "odd", "silent", "report", "code",
                           "number", "file", "escape", "fine", "fine"})
    inputs.push_back({{what}, "system a\n"});
  inputs.push_back({{"json", "--json"}, ""});
  std::uint64_t counted = 0;
  const auto wrong = told(inputs, counted);
  CHECK(counted == inputs.size());
  CHECK(wrong.size() == 13);
  CHECK_FALSE(wrong.count("fine"));
  CHECK(wrong.at("crash") == "crash: ended by signal 11");
  CHECK(wrong.at("abort").find("internal precondition") != std::string::npos);
  CHECK(wrong.at("leave").find("ended by") != std::string::npos);
  CHECK(wrong.at("hang").find("takes too long") != std::string::npos);
  CHECK(wrong.at("wait") == "wait: waits, and computes nothing");
  CHECK(wrong.at("odd").find("undocumented exit code 77") != std::string::npos);
  CHECK(wrong.at("silent").find("without a word") != std::string::npos);
  CHECK(wrong.at("report").find("lease report") != std::string::npos);
  CHECK(wrong.at("code").find("E9999") != std::string::npos);
  CHECK(wrong.at("number").find("no number in the result") != std::string::npos);
  CHECK(wrong.at("file").find("no number in a file csv") != std::string::npos);
  CHECK(wrong.at("json").find("JSON") != std::string::npos);
  CHECK(wrong.at("escape").find("control bytes") != std::string::npos);
}

TEST_CASE("words that hold nan or inf are none, and who types them may read them") {
  Outcome outcome;
  outcome.out = "information: the covenant of nanometres\n";
  CHECK_FALSE(judge({{"derive"}, "system a"}, outcome));
  outcome.out = "x = -inf m\n";
  CHECK(judge({{"derive"}, "system a"}, outcome));
  CHECK_FALSE(judge({{"derive"}, "param inf = 1"}, outcome));
}

TEST_CASE("a failing input is made small") {
  const Input input{{"model", "--set", "m=1", "model.lag"}, "system a\nparam m = 1\nT = 1 + bad x\nrun 1\n"};
  Outcome outcome;
  outcome.out = "x = nan m\n";
  const std::string wrong = *judge(input, outcome);
  const Input small = minimized(input, wrong, pretender, judge);
  CHECK(small.arguments == std::vector<std::string>{"model"});
  CHECK(small.model.find("bad") != std::string::npos);
  CHECK(small.model.size() < 8);
}

TEST_CASE("inputs are kept as they were, whatever bytes they hold") {
  const Input input{{"simulate", "", "a\\n\nb", "\xff"}, "system a\n----\nx"};
  const Input again = from_text(to_text(input));
  CHECK(again.arguments == input.arguments);
  CHECK(again.model == input.model);
  CHECK(from_text(to_text({{}, "x"})).arguments.empty());
}

TEST_CASE("the drawn inputs use every rule's words, every command and every option") {
  std::ifstream in(std::string(PROJECT_DIR) + "/docs/manual/grammar.ebnf");
  const Grammar grammar(std::string{std::istreambuf_iterator<char>(in), {}});
  const maupertuis::app::OptionTable table = maupertuis::app::option_table();
  const Generator drawn(grammar, {"system a\nparam m = 1\ncoord x : length\nT = m x'^2\n"}, table, 1);
  std::string models;
  std::set<std::string> commands, options;
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    const Input input = drawn.input(i);
    models += input.model;
    if (!input.arguments.empty()) commands.insert(input.arguments[0]);
    for (const std::string& argument : input.arguments) options.insert(argument.substr(0, argument.find('=')));
  }
  for (const std::string& word : grammar.words()) CHECK_MESSAGE(models.find(word) != std::string::npos, word);
  for (const auto& command : table.commands) {
    CHECK_MESSAGE(commands.count(command.name), command.name);
    for (const auto& row : command.options)
      if (!row.positional) CHECK_MESSAGE(options.count(row.names.back()), row.names.back());
  }
  CHECK(drawn.input(17).model == drawn.input(17).model);
}

TEST_CASE("the worlds are models without a mistake, and most of what is drawn in them is read") {
  for (const std::string& text : sound_worlds()) {
    CAPTURE(text);
    maupertuis::Study study(maupertuis::SourceText("world.lag", text));
    CHECK(study.model());
    CHECK(!study.diagnostics().has_errors());
  }
  int read = 0;
  constexpr int drawn = 300;
  for (int i = 0; i < drawn; ++i) {
    Random random(1, static_cast<std::uint64_t>(i));
    maupertuis::Study study(maupertuis::SourceText("world.lag", model_of_a_world(random)));
    study.model();
    bool grammar = false;
    for (const maupertuis::Diagnostic& d : study.diagnostics().items()) grammar = grammar || d.code < "E0200";
    read += !grammar;
  }
  CHECK(read > drawn * 3 / 4);
}

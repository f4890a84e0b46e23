#include "program.hpp"

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace cli_test {
namespace {

std::string quoted(const std::string& word) {
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

Folder::Folder() {
  static std::atomic<int> count{0};
  path_ = std::filesystem::temp_directory_path() /
          ("maup_cli_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
  std::filesystem::create_directories(path_);
}

Folder::~Folder() {
  std::error_code error;
  std::filesystem::remove_all(path_, error);
}

std::string Folder::write(const std::string& name, const std::string& text) const {
  std::ofstream(path(name), std::ios::binary) << text;
  return path(name);
}

std::vector<std::string> Folder::names() const {
  std::vector<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(path_)) all.push_back(entry.path().filename().string());
  std::sort(all.begin(), all.end());
  return all;
}

std::string read(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

Outcome shell(const std::string& command) {
  const Folder folder;
  const std::string script = "MAUP=" + quoted(MAUP_PROGRAM) + "; ulimit -v 2000000; { " + command + "\n} >" +
                             quoted(folder.path("out")) + " 2>" + quoted(folder.path("err"));
  const auto begin = std::chrono::steady_clock::now();
  const int status = std::system(script.c_str());
  Outcome outcome;
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  outcome.out = read(folder.path("out"));
  outcome.err = read(folder.path("err"));
  return outcome;
}

namespace {

/// The program with its streams in files; the number of the process.
pid_t start(const std::vector<std::string>& arguments, const std::string& in, const std::string& out,
            const std::string& err) {
  const pid_t process = ::fork();
  if (process != 0) return process;
  std::vector<char*> words{const_cast<char*>(MAUP_PROGRAM)};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  const bool ready = std::freopen(in.c_str(), "r", stdin) && std::freopen(out.c_str(), "w", stdout) &&
                     std::freopen(err.c_str(), "w", stderr);
  if (ready) ::execv(MAUP_PROGRAM, words.data());
  ::_exit(127);
}

/// Whether it handles SIGINT: before that it has not begun.
bool has_begun(pid_t process) {
  std::istringstream status(read("/proc/" + std::to_string(process) + "/status"));
  for (std::string line; std::getline(status, line);)
    if (line.rfind("SigCgt:", 0) == 0) return (std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1)) & 1;
  return false;
}

void wait_until_busy(pid_t process, double processor_seconds) {
  const auto begin = std::chrono::steady_clock::now();
  for (int asleep = 0; asleep < 5 && std::chrono::steady_clock::now() - begin < std::chrono::seconds(60);) {
    ::usleep(20'000);
    if (!has_begun(process)) continue;
    const std::string line = read("/proc/" + std::to_string(process) + "/stat");
    std::istringstream stat(line.substr(line.rfind(')') + 2));
    std::string state, skipped;
    stat >> state;
    for (int i = 0; i < 10; ++i) stat >> skipped;
    double user = 0, system = 0;
    stat >> user >> system;
    if ((user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK)) >= processor_seconds || state == "Z") return;
    asleep = state == "S" ? asleep + 1 : 0;
  }
}

}  // namespace

Outcome interrupted(const std::vector<std::string>& arguments, int signal, double after, const std::string& input) {
  const Folder folder;
  const pid_t process = start(arguments, input, folder.path("out"), folder.path("err"));
  wait_until_busy(process, after);
  const auto begin = std::chrono::steady_clock::now();
  ::kill(process, signal);
  int status = 0;
  ::waitpid(process, &status, 0);
  Outcome outcome;
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  outcome.out = read(folder.path("out"));
  outcome.err = read(folder.path("err"));
  return outcome;
}

Outcome maup(const std::vector<std::string>& arguments, const std::string& input) {
  const Folder folder;
  std::string command = "timeout 60 \"$MAUP\"";
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  return shell(command + " <" + quoted(folder.write("in", input)));
}

}  // namespace cli_test

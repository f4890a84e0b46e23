#include "server.hpp"
#include "worker.hpp"

#include <maupertuis/diagnostic.hpp>

#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <thread>

// maup-studio is started by `maup studio`, which reads and checks what a person types.
//   maup-studio --page FOLDER --folder FOLDER [--open MODEL] [--port N] [--browser] [--json]
//   maup-studio --worker

namespace {

using namespace maupertuis;

/// Without a shell, and without waiting for it.
void open_browser(const std::string& address) {
  const pid_t child = fork();
  if (child != 0) {
    if (child > 0) waitpid(child, nullptr, 0);
    return;
  }
  if (fork() != 0) _exit(0);
  sigset_t none;  // what the server blocks and ignores is not for the browser
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  std::signal(SIGPIPE, SIG_DFL);
  if (!std::freopen("/dev/null", "w", stdout) || !std::freopen("/dev/null", "w", stderr)) _exit(1);
  execlp("xdg-open", "xdg-open", address.c_str(), static_cast<char*>(nullptr));
  _exit(127);
}

std::string own_path() {
  char path[4096];
  const ssize_t length = readlink("/proc/self/exe", path, sizeof path);
  return length > 0 ? std::string(path, static_cast<std::size_t>(length)) : std::string();
}

int fail(const std::string& message, const std::string& help) {
  Diagnostics diagnostics;
  diagnostics.error("E0851", {}, message + ".", {}, help);
  std::fputs(render(diagnostics, SourceText("maup studio", ""), {isatty(STDERR_FILENO) == 1}).c_str(), stderr);
  return 2;
}

int serve(const studio::ServerOptions& options, bool browser, bool json) {
  // Signals are waited for by a thread: nothing else of the program has to be safe for them.
  sigset_t ends;
  sigemptyset(&ends);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&ends, signal);
  pthread_sigmask(SIG_BLOCK, &ends, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  const std::string problem = studio::serve(options, [&](const std::string& address, int port,
                                                         std::function<void()> stop) {
    if (json)
      std::printf("{\"schema\":1,\"command\":\"studio\",\"address\":\"%s\",\"port\":%d}\n", address.c_str(), port);
    else
      std::printf("The studio is at %s\nThe address is good once, in one browser. Ctrl-C ends it.\n", address.c_str());
    std::fflush(stdout);
    if (browser) open_browser(address);
    std::thread([ends, stop = std::move(stop)] {
      int signal = 0;
      sigwait(&ends, &signal);
      stop();
      _exit(130);  // connections that a browser keeps open are waited for by nobody
    }).detach();
  });
  if (!problem.empty()) return fail(problem, "Give another one, such as --port 8766, or leave --port out.");
  return 130;
}

}  // namespace

int main(int argc, char** argv) {
  std::map<std::string, std::string> said;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--worker") return studio::work(STDIN_FILENO, STDOUT_FILENO);
    const bool flag = option == "--browser" || option == "--json";
    said[option] = flag ? "yes" : i + 1 < argc ? argv[++i] : "";
  }
  if (said["--page"].empty() || said["--folder"].empty()) {
    std::fputs("maup-studio is started by `maup studio`.\n", stderr);
    return 2;
  }
  studio::ServerOptions options;
  options.page = said["--page"];
  options.folder = said["--folder"];
  options.open = said["--open"];
  options.port = std::atoi(said["--port"].c_str());
  options.program = own_path();
  return serve(options, !said["--browser"].empty(), !said["--json"].empty());
}

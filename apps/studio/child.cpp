#include "child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string_view>

namespace maupertuis::studio {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds between_looks(50);  // whether anybody still waits

/// In the new process, between fork and exec: calls that are safe there.
[[noreturn]] void become_worker(const char* program, int in, int out, std::size_t memory) {
  // Of the thread that started it, which lives as long as the server: there is one for each connection, kept for reuse.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The server blocks signals for a thread that waits for them, and has no ear for a broken pipe: not so the worker.
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  signal(SIGPIPE, SIG_DFL);
  setpgid(0, 0);  // Ctrl-C at the terminal is for the server
  dup2(in, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  const rlimit space{memory, memory};
  setrlimit(RLIMIT_AS, &space);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  execl(program, program, "--worker", static_cast<char*>(nullptr));
  _exit(127);
}

}  // namespace

bool Child::begin() {
  int down[2], up[2];
  if (pipe2(down, O_CLOEXEC) != 0) return false;
  if (pipe2(up, O_CLOEXEC) != 0) {
    close(down[0]), close(down[1]);
    return false;
  }
  const pid_t born = fork();
  if (born == 0) become_worker(program_.c_str(), down[0], up[1], memory_);
  process_ = born;
  close(down[0]), close(up[1]);
  if (born < 0) {
    close(down[1]), close(up[0]);
    return false;
  }
  to_ = down[1], from_ = up[0];
  unread_.clear();
  return true;
}

void Child::end() {
  const pid_t gone = process_.exchange(-1);
  if (gone <= 0) return;
  kill(gone, SIGKILL);
  waitpid(gone, nullptr, 0);
  close(to_), close(from_);
}

void Child::kill_now() {
  if (const pid_t now = process_; now > 0) kill(now, SIGKILL);
}

void Child::wait_gone() {
  // Whoever waits for its answer may have done so before: then there is no such child any more, which is as good.
  if (const pid_t now = process_; now > 0) waitpid(now, nullptr, 0);
}

bool Child::send(const std::string& line) {
  for (std::size_t done = 0; done < line.size();) {
    const ssize_t more = write(to_, line.data() + done, line.size() - done);
    if (more <= 0) return false;
    done += static_cast<std::size_t>(more);
  }
  return true;
}

Child::Outcome Child::ask(const std::string& request, std::chrono::duration<double> longest,
                          const std::function<void(const std::string&)>& message, const std::function<bool()>& wanted) {
  if (!alive() && !begin()) return {Outcome::Kind::NotStarted, {}};
  // A line break in JSON stands between tokens, never in a text.
  std::string line = request;
  for (char& c : line)
    if (c == '\n' || c == '\r') c = ' ';
  const auto lost = [&](Outcome::Kind kind) {
    end();
    return Outcome{kind, {}};
  };
  if (!send(line + "\n")) return lost(Outcome::Kind::Died);
  auto until = Clock::now() + std::chrono::duration_cast<Clock::duration>(longest);
  auto look = Clock::now();
  bool cancelled = false;
  std::size_t searched = 0;  // of what is unread there is no end of a line before it
  for (;;) {
    for (std::size_t at; (at = unread_.find('\n', searched)) != std::string::npos;) {
      const std::string got = unread_.substr(0, at);
      unread_.erase(0, at + 1);
      searched = 0;
      if (got.rfind("answer ", 0) == 0) return {Outcome::Kind::Answered, got.substr(7)};
      if (got.rfind("message ", 0) == 0) message(got.substr(8));
    }
    searched = unread_.size();
    if (!cancelled && Clock::now() >= look && !wanted()) {
      cancelled = true;
      if (!send("cancel\n")) return lost(Outcome::Kind::Died);
      until = std::min(until, Clock::now() + std::chrono::seconds(2));
    }
    if (Clock::now() > until) return lost(Outcome::Kind::TooLong);
    if (Clock::now() >= look) look = Clock::now() + between_looks;
    pollfd ready{from_, POLLIN, 0};
    poll(&ready, 1, static_cast<int>(between_looks.count()));
    if (ready.revents != 0) {
      char buffer[65536];
      const ssize_t more = read(from_, buffer, sizeof buffer);
      if (more <= 0) return lost(Outcome::Kind::Died);
      unread_.append(buffer, static_cast<std::size_t>(more));
    }
  }
}

}  // namespace maupertuis::studio

#include "interrupt.hpp"

#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <ctime>

namespace maupertuis::app {
namespace {

// A signal handler has no argument to carry state in: the one place where globals are unavoidable.
std::atomic<bool> interrupted{false}, over{false};  // over: the deadline, if there is one, or interrupted
static_assert(std::atomic<bool>::is_always_lock_free);
std::atomic<long long> first_at{0};
static_assert(std::atomic<long long>::is_always_lock_free);
timer_t patience, deadline;

constexpr long long grace = 700, repeated = 500;  // milliseconds

long long milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return 1000LL * now.tv_sec + now.tv_nsec / 1'000'000;
}

/// 0 stops it.
void set_timer(timer_t timer, long long after) {
  const itimerspec once{{0, 0}, {after / 1000, (after % 1000) * 1'000'000}};
  timer_settime(timer, 0, &once, nullptr);
}

/// What does not look at the flag, or waits for a pipe that no one reads, is ended here. Files appear whole or not at
/// all.
[[noreturn]] void leave() {
  constexpr char words[] = "\nInterrupted: nothing more is computed, and what was not written yet is lost.\n";
  static_cast<void>(!write(STDERR_FILENO, words, sizeof words - 1));
  _exit(130);
}

extern "C" void on_patience(int) { leave(); }
extern "C" void on_deadline(int) { over = true; }

/// The first one asks the run to end in good order, within the grace; one that follows later, from an impatient user,
/// ends the program. What arrives at once is the same wish twice: shells and `timeout` signal the process and its
/// group.
extern "C" void on_interrupt(int) {
  const int error = errno;
  if (!interrupted.exchange(true)) {
    over = true;
    first_at = milliseconds();
    set_timer(patience, grace);
  } else if (milliseconds() - first_at >= repeated) {
    leave();
  }
  errno = error;
}

void install(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigaction(signal, &action, nullptr);
}

bool make_timer(int signal, timer_t& timer) {
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = signal;
  return timer_create(CLOCK_MONOTONIC, &event, &timer) == 0;
}

}  // namespace

void watch_interrupts() {
  // Two signals: one of the same kind that comes while another waits is lost.
  if (!make_timer(SIGALRM, patience) || !make_timer(SIGVTALRM, deadline))
    return;  // then a signal ends the program as it always does
  install(SIGALRM, on_patience);
  install(SIGVTALRM, on_deadline);
  for (const int signal : {SIGINT, SIGTERM}) install(signal, on_interrupt);
}

const std::atomic<bool>& interrupt_flag() { return interrupted; }

Deadline::Deadline(std::optional<double> seconds) {
  over = interrupted.load();
  if (seconds) set_timer(deadline, std::max(1LL, static_cast<long long>(1000 * *seconds)));
}
Deadline::~Deadline() { set_timer(deadline, 0); }
const std::atomic<bool>& Deadline::flag() const { return over; }

Saving::Saving(const std::string& path) {
  struct stat status {};
  is_file_ = stat(path.c_str(), &status) != 0 || S_ISREG(status.st_mode);
  if (is_file_ && interrupted) set_timer(patience, most);
}
Saving::Saving() : is_file_(true) {
  if (interrupted) set_timer(patience, most);
}
Saving::~Saving() {
  if (is_file_ && interrupted) set_timer(patience, grace);
}

}  // namespace maupertuis::app

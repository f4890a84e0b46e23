#include "interrupt.hpp"

#include <csignal>
#include <ctime>

namespace maupertuis::app {
namespace {

// A signal handler has no argument to carry state in: the one place where a global is unavoidable.
std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

std::atomic<long long> first_at{0};
static_assert(std::atomic<long long>::is_always_lock_free);

long long milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return 1000LL * now.tv_sec + now.tv_nsec / 1'000'000;
}

/// The first one ends the run in good order; one that follows later, from an impatient user, ends the program. What arrives
/// at once is the same wish twice: shells and `timeout` signal the process and its group.
extern "C" void on_interrupt(int signal) {
  if (!interrupted.exchange(true)) {
    first_at = milliseconds();
    return;
  }
  if (milliseconds() - first_at < 500) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

const std::atomic<bool>& interrupt_flag() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  return interrupted;
}

}  // namespace maupertuis::app

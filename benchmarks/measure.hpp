#pragma once
#include <ctime>
#include <stdexcept>
#include <string>

namespace bench {

/// Every benchmark asserts its result first; without an allocation, since some of it is timed.
inline void require(bool condition, const char* what) {
  if (!condition) throw std::runtime_error(std::string("wrong result: ") + what);
}

/// Seconds that this thread ran: others may share the machine.
inline double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace bench

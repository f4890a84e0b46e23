#pragma once
#include <algorithm>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace maupertuis {

/// As many threads as are wanted, 0: as the machine runs at once; no more than there are jobs.
inline std::size_t thread_count(int wanted, std::size_t jobs) {
  const std::size_t most = wanted > 0 ? static_cast<std::size_t>(wanted) : std::thread::hardware_concurrency();
  return std::clamp<std::size_t>(jobs, 1, std::max<std::size_t>(1, most));
}

/// Calls `work` on so many threads, of which the calling one is one. What one of them throws is thrown again when all
/// have come back; `failed()` is called at once, for the others to stop.
template <class Work, class Failed>
void on_threads(std::size_t threads, const Work& work, const Failed& failed) {
  std::exception_ptr thrown;
  std::mutex guard;
  const auto guarded = [&] {
    try {
      work();
    } catch (...) {
      failed();
      const std::lock_guard lock(guard);
      if (!thrown) thrown = std::current_exception();
    }
  };
  std::vector<std::thread> others;
  others.reserve(threads);
  try {
    for (std::size_t i = 1; i < threads; ++i) others.emplace_back(guarded);
  } catch (const std::system_error&) {  // no more threads are to be had: those that are there do the work
  }
  guarded();
  for (std::thread& thread : others) thread.join();
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace maupertuis

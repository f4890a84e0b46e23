#pragma once
#include <atomic>

// WebAssembly without shared memory has one thread. What differs for that reason is asked for by this name.
#if defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)
#define MAUP_ONE_THREAD
#include <functional>
#include <utility>
#endif

namespace maupertuis {

#ifndef MAUP_ONE_THREAD

/// What asks work to stop. Whoever works looks at it; a signal or another thread sets it.
using StopFlag = std::atomic<bool>;

#else

/// What asks work to stop. Nobody else runs who could set it while there is work: it looks for itself, at a clock or at
/// what it is told to watch, each time that it is looked at.
class StopFlag {
 public:
  StopFlag(bool set = false) : set_(set) {}
  StopFlag(const StopFlag&) = delete;
  StopFlag& operator=(const StopFlag&) = delete;

  bool load(std::memory_order = std::memory_order_seq_cst) const {
    if (!set_ && watch_ && watch_()) set_ = true;
    return set_;
  }
  operator bool() const { return load(); }
  bool operator=(bool set) { return set_ = set; }

  /// From now on the flag is set as soon as this says so. It costs a call a step of a motion.
  void watch(std::function<bool()> watch) { watch_ = std::move(watch); }

 private:
  mutable bool set_;
  std::function<bool()> watch_;
};

#endif

}  // namespace maupertuis

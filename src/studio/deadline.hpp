#pragma once
#include <maupertuis/stop_flag.hpp>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace maupertuis::studio {

/// Sets a flag when a time is over, unless it is gone by then. Where there is one thread the flag looks at the clock.
class Deadline {
 public:
  /// `cancelled` is asked where the flag looks for itself.
  Deadline(double seconds, StopFlag& flag, std::function<bool()> cancelled);
  ~Deadline();
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;

 private:
  std::atomic<bool> over_ = false;
#ifdef MAUP_ONE_THREAD
  StopFlag& flag_;
#else
  bool gone_ = false;
  std::mutex guard_;
  std::condition_variable wake_;
  std::thread clock_;
#endif
};

}  // namespace maupertuis::studio

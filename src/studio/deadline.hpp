#pragma once
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace maupertuis::studio {

/// Sets a flag when a time is over, unless it is gone by then.
class Deadline {
 public:
  Deadline(double seconds, std::atomic<bool>& flag);
  ~Deadline();
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;

  /// Whether it was this that set the flag.
  bool over() const { return over_; }

 private:
  std::atomic<bool> over_ = false;
  bool gone_ = false;
  std::mutex guard_;
  std::condition_variable wake_;
  std::thread clock_;
};

}  // namespace maupertuis::studio

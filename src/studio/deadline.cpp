#include "studio/deadline.hpp"

#include <chrono>

namespace maupertuis::studio {

Deadline::Deadline(double seconds, std::atomic<bool>& flag)
    : clock_([this, seconds, &flag] {
        std::unique_lock lock(guard_);
        if (wake_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return gone_; })) return;
        over_ = true;
        flag = true;
      }) {}

Deadline::~Deadline() {
  {
    const std::lock_guard lock(guard_);
    gone_ = true;
  }
  wake_.notify_all();
  clock_.join();
}

}  // namespace maupertuis::studio

#include "studio/deadline.hpp"

#include <chrono>
#include <utility>

namespace maupertuis::studio {

#ifdef MAUP_ONE_THREAD

Deadline::Deadline(double seconds, StopFlag& flag, std::function<bool()> cancelled) : flag_(flag) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  flag.watch([this, end, asked = std::move(cancelled)] {
    if (Clock::now() >= end) over_ = true;
    return over_ || asked();
  });
}

Deadline::~Deadline() { flag_.watch(nullptr); }

#else

Deadline::Deadline(double seconds, StopFlag& flag, std::function<bool()>)
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

#endif

}  // namespace maupertuis::studio

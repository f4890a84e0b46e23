#pragma once
#include <atomic>
#include <chrono>
#include <exception>

namespace maupertuis {

/// Thrown by work that has nothing to show yet when it is asked to stop. Whoever has set the interrupt catches it.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

/// When a long computation is to stop: as soon as a flag is set, which Ctrl-C does, or at a time. Steppers look at it once a
/// step, everything else at least a few times a second. What has a part to show returns it; what has none throws Interrupted.
class Interrupt {
 public:
  using Clock = std::chrono::steady_clock;

  Interrupt() = default;  // never
  /// Once the flag is set. It outlives whatever holds this; null: never.
  Interrupt(const std::atomic<bool>* flag) : flag_(flag) {}

  /// As this one, and at `time` at the latest.
  Interrupt until(Clock::time_point time) const {
    Interrupt out = *this;
    if (time < out.deadline_) out.deadline_ = time;
    return out;
  }

  bool asked() const {
    if (flag_ && flag_->load(std::memory_order_relaxed)) return true;
    return deadline_ != Clock::time_point::max() && Clock::now() >= deadline_;
  }
  void throw_if_asked() const {
    if (asked()) throw Interrupted();
  }

 private:
  const std::atomic<bool>* flag_ = nullptr;
  Clock::time_point deadline_ = Clock::time_point::max();
};

}  // namespace maupertuis

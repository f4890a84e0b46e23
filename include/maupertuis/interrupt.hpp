#pragma once
#include <maupertuis/stop_flag.hpp>

#include <exception>

namespace maupertuis {

/// Thrown by work that has nothing to show yet when it is asked to stop. Whoever gave it the flag catches it.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

/// When long work is to stop: as soon as a flag is set, by Ctrl-C or when its time is over. Steppers look at the flag
/// once a step, everything else at least a few times a second. What has a part to show returns it; what has none throws
/// Interrupted.
class Interrupt {
 public:
  /// The flag outlives whatever holds this; null: never.
  Interrupt(const StopFlag* flag = nullptr) : flag_(flag) {}

  operator const StopFlag*() const { return flag_; }
  bool asked() const { return flag_ && flag_->load(std::memory_order_relaxed); }
  void throw_if_asked() const {
    if (asked()) throw Interrupted();
  }

 private:
  const StopFlag* flag_;
};

}  // namespace maupertuis

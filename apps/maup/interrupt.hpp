#pragma once
#include <atomic>
#include <optional>
#include <string>

namespace maupertuis::app {

/// From here on Ctrl-C and SIGTERM set the flag. What has not ended 0.7 s later, or at a second Ctrl-C, is ended with
/// code 130.
void watch_interrupts();
const std::atomic<bool>& interrupt_flag();

/// A flag that is set when a time is over, or by Ctrl-C before; with no time by Ctrl-C alone. There is one at a time.
class Deadline {
 public:
  explicit Deadline(std::optional<double> seconds);
  ~Deadline();
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;
  const std::atomic<bool>& flag() const;
};

/// While a file is written that holds what was computed up to an interrupt: more time, but not without end, and none
/// for a pipe.
class Saving {
 public:
  explicit Saving(const std::string& path);
  /// While a document is made of it, which waits for nobody.
  Saving();
  ~Saving();
  Saving(const Saving&) = delete;
  Saving& operator=(const Saving&) = delete;

 private:
  static constexpr long long most = 20'000;  // milliseconds
  bool is_file_ = false;
};

}  // namespace maupertuis::app

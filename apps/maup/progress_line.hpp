#pragma once
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace maupertuis::app {

/// One line on the terminal that says what a command is at, and for how long, once it has taken a while:
///
///     hamiltonian: canonical equations, 3 s
///
/// A thread draws it, so that work tells what it is and nothing else. It leaves nothing behind.
class ProgressLine {
 public:
  using Clock = std::chrono::steady_clock;

  /// `draw` puts a text on the terminal; it is called before `patience` is over by tell_now() alone.
  ProgressLine(std::string command, Clock::duration patience, std::function<void(std::string_view)> draw);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// The part of the work that begins; empty: it has no name.
  void tell(std::string part);
  /// The same, drawn at once.
  void tell_now(std::string part);
  /// How far it is, in the place of the seconds, until the next part begins or this is empty.
  void measure(std::string how_far);
  /// Before other words are written: the line is taken away, and comes back.
  void wipe();

 private:
  void draw_now_and_then();
  void draw_line();  // of `mutex_` held
  std::string text() const;

  const std::string command_;
  const std::function<void(std::string_view)> draw_;
  const Clock::time_point patience_ends_;
  std::mutex mutex_;
  std::condition_variable over_;
  bool is_over_ = false, drawn_ = false;
  std::string part_, how_far_;
  Clock::time_point begin_ = Clock::now();  // of the part
  std::thread thread_;
};

}  // namespace maupertuis::app

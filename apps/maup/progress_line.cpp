#include "progress_line.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

namespace maupertuis::app {

ProgressLine::ProgressLine(std::string command, Clock::duration patience, std::function<void(std::string_view)> draw)
    : command_(std::move(command)), draw_(std::move(draw)), patience_ends_(Clock::now() + patience) {
  try {
    thread_ = std::thread([this] { draw_now_and_then(); });
  } catch (const std::system_error&) {
    // Without a second thread there is what tell_now() draws.
  }
}

ProgressLine::~ProgressLine() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  over_.notify_one();
  if (thread_.joinable()) thread_.join();
  wipe();
}

void ProgressLine::tell(std::string part) {
  const std::lock_guard lock(mutex_);
  part_ = std::move(part);
  how_far_.clear();
  begin_ = Clock::now();
}

void ProgressLine::tell_now(std::string part) {
  tell(std::move(part));
  const std::lock_guard lock(mutex_);
  draw_line();
}

void ProgressLine::measure(std::string how_far) {
  const std::lock_guard lock(mutex_);
  how_far_ = std::move(how_far);
}

void ProgressLine::wipe() {
  const std::lock_guard lock(mutex_);
  if (std::exchange(drawn_, false)) draw_("\r\x1b[K");
}

void ProgressLine::draw_now_and_then() {
  constexpr auto period = std::chrono::milliseconds(200);
  std::unique_lock lock(mutex_);
  over_.wait_until(lock, patience_ends_, [this] { return is_over_; });
  while (!is_over_) {
    draw_line();
    over_.wait_for(lock, period, [this] { return is_over_; });
  }
}

void ProgressLine::draw_line() {
  drawn_ = true;
  draw_("\r\x1b[K" + text());
}

std::string ProgressLine::text() const {
  const std::string what = part_.empty() ? command_ : fmt::format("{}: {}", command_, part_);
  if (!how_far_.empty()) return fmt::format("{}, {}", what, how_far_);
  return fmt::format("{}, {:.0f} s", what, std::chrono::duration<double>(Clock::now() - begin_).count());
}

}  // namespace maupertuis::app

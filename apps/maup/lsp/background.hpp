#pragma once
#include <maupertuis/diagnostic.hpp>
#include <maupertuis/source.hpp>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace maupertuis::app::lsp {

/// A text whose equations are derived beside the conversation with the editor.
struct Task {
  std::string uri, text;
  int version = 0;
};
struct Findings {
  std::string uri;
  int version = 0;
  /// Nothing: the derivation took longer than its time.
  std::optional<Diagnostics> diagnostics;
};

/// One thread that looks for the mistakes that show in the equations alone. A new task takes the place of the one
/// before it, which ends at once.
class Background {
 public:
  /// `found` is called on the thread. `budget`: of one task.
  Background(std::chrono::milliseconds budget, std::function<void(Findings)> found);
  ~Background();

  void begin(Task task);
  /// Ends what is done for this text, or for all where it is empty.
  void cancel(const std::string& uri);

 private:
  void work();
  void watch();

  const std::chrono::milliseconds budget_;
  const std::function<void(Findings)> found_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Task> waiting_;
  std::string running_;  // the text that is worked on; empty: none
  std::chrono::steady_clock::time_point since_;
  std::atomic<bool> stop_{false};  // of the work
  bool unwanted_ = false, ends_ = false;
  std::thread worker_, watcher_;
};

}  // namespace maupertuis::app::lsp

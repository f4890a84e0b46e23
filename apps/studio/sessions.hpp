#pragma once
#include "child.hpp"

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace maupertuis::studio {

/// What a request brings to the page: SSE events are made of these.
struct Told {
  std::function<void(const std::string& json)> message;
  std::function<bool()> wanted;  // whether the page still waits
};

/// A worker for each tab of the browser. The text that a tab opened last is kept here, so that a worker that died or
/// was idle can be replaced by a new one without a word.
class Sessions {
 public:
  struct Limits {
    std::size_t most = 128;                     // tabs
    std::size_t memory = std::size_t{4} << 30;  // bytes of addresses of a worker
    double longest = 602;                       // s of a request, whatever it says
  };
  Sessions(std::string program, const Limits& limits) : program_(std::move(program)), limits_(limits) {}

  /// The answer to a request, JSON. Requests of one tab come one after the other.
  std::string ask(const std::string& id, const std::string& request, const Told& told);
  /// Ends what the tab waits for.
  void cancel(const std::string& id);
  /// Ends all workers, at once, whatever they do; nothing is asked any more. From any thread.
  void end();

 private:
  struct Session {
    explicit Session(std::unique_ptr<Child> c) : child(std::move(c)) {}
    std::mutex turn;
    std::unique_ptr<Child> child;
    std::string opened;  // the request that opened its text; empty: none yet
    std::atomic<unsigned> cancels = 0;
    std::chrono::steady_clock::time_point used;
  };
  std::shared_ptr<Session> session(const std::string& id);
  void make_room();

  std::string program_;
  Limits limits_;
  std::atomic<bool> ended_ = false;
  std::mutex guard_;
  std::map<std::string, std::shared_ptr<Session>> sessions_;
};

}  // namespace maupertuis::studio

#pragma once
#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <string>

namespace maupertuis::studio {

/// One worker process. It begins with its first request and dies with the server, at the latest.
class Child {
 public:
  /// What a request brought: its answer, or why there is none.
  struct Outcome {
    enum class Kind { Answered, Died, TooLong, NotStarted } kind = Kind::Answered;
    std::string answer;  // JSON
  };

  /// `memory`: bytes of addresses that the process may have.
  Child(std::string program, std::size_t memory) : program_(std::move(program)), memory_(memory) {}
  ~Child() { end(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Sends a request and waits for its answer. `message` is told what comes before; `wanted` is asked now and then
  /// whether anybody still waits: where nobody does, the request is cancelled. A worker that does not answer within
  /// `longest`, or within two seconds of a cancel, is ended.
  Outcome ask(const std::string& request, std::chrono::duration<double> longest,
              const std::function<void(const std::string&)>& message, const std::function<bool()>& wanted);
  bool alive() const { return process_ > 0; }
  void end();
  /// From any thread: whoever waits for an answer hears that the process died.
  void kill_now();
  /// After kill_now(), until the process is gone: nothing is left for whoever inherits it.
  void wait_gone();

 private:
  bool begin();
  bool send(const std::string& line);

  std::string program_;
  std::size_t memory_;
  std::atomic<pid_t> process_ = -1;
  int to_ = -1, from_ = -1;
  std::string unread_;
};

}  // namespace maupertuis::studio

#pragma once
#include "lsp/answers.hpp"
#include "lsp/background.hpp"
#include "lsp/frames.hpp"
#include "lsp/open_text.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>

namespace maupertuis::app::lsp {

/// A conversation with an editor in the Language Server Protocol 3.17.
///
/// One thread reads, so that a request that is no longer wanted is known before its turn; one answers, in the order of
/// arrival; one derives equations (Background). A text is looked at when no message of it came for a while.
class Server {
 public:
  /// `stop`: set by a signal.
  Server(int in, int out, const std::atomic<bool>& stop);
  ~Server();

  /// Until `exit`, the end of the stream or a signal. True where the editor said `shutdown` before `exit`.
  bool run();
  /// Whether an answer could not be written.
  bool output_failed() const { return writer_.failed(); }

 private:
  using Clock = std::chrono::steady_clock;
  struct Event {
    enum class Kind { Message, Malformed, Findings, End } kind = Kind::End;
    Json message;
    std::string text;
    Findings findings;
  };

  // the reading thread
  void read();
  void note_cancellation(const Json& message);
  void push(Event event);

  // the answering thread
  void answer();
  std::optional<Event> next_event();
  void handle(Event& event);
  void handle_message(const Json& message);
  void request(const Json& id, const std::string& method, const Json& params);
  void notification(const std::string& method, const Json& params);
  Json result_of(const std::string& method, const Json& params);
  Json initialize(const Json& params);
  OpenText* open_text(const Json& params);
  void open(const Json& params);
  void change(const Json& params);
  void close(const Json& params);
  void look_later(const std::string& uri, std::chrono::milliseconds after);
  void look_at_what_is_due();
  void look_at(OpenText& text);
  void publish(OpenText& text, const Diagnostics& diagnostics);
  void take(const Findings& findings);

  void send(const Json& message);
  void reply(const Json& id, Json result);
  void refuse(const Json& id, int code, const std::string& message);
  void tell(const char* method, Json params);

  FrameWriter writer_;
  FrameReader reader_;
  const std::atomic<bool>& signal_;

  std::mutex mutex_;  // of the queue and of what is cancelled
  std::condition_variable arrived_;
  std::deque<Event> events_;
  std::set<std::string> cancelled_;  // ids as JSON texts
  std::string running_;              // the request that is answered
  std::string looking_;              // the text that is looked at
  std::atomic<bool> stop_{false};    // of its work

  Client client_;
  bool initialized_ = false, shut_down_ = false, ended_ = false, good_end_ = false, derives_ = true;
  std::chrono::milliseconds patience_{80}, later_patience_{300}, budget_{10'000};
  std::map<std::string, OpenText> texts_;
  std::map<std::string, Clock::time_point> due_;            // texts to look at
  std::map<std::string, Clock::time_point> due_equations_;  // texts whose equations are to be derived
  std::unique_ptr<Background> background_;
};

}  // namespace maupertuis::app::lsp

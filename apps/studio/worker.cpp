#include "worker.hpp"

#include <maupertuis/studio.hpp>

#include <unistd.h>

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

namespace maupertuis::studio {
namespace {

/// False where nobody reads any more.
bool write_line(int output, std::string_view word, std::string_view json) {
  std::string line(word);
  line += ' ';
  line += json;
  line += '\n';
  for (std::size_t done = 0; done < line.size();) {
    const ssize_t more = write(output, line.data() + done, line.size() - done);
    if (more <= 0) return false;
    done += static_cast<std::size_t>(more);
  }
  return true;
}

struct Request {
  std::string line;
  std::uint64_t cancels = 0;  // that were heard before it
};

/// Requests that came and are not answered. A thread of its own reads them, so that `cancel` is heard.
class Inbox {
 public:
  void put(Request line) {
    const std::lock_guard lock(guard_);
    lines_.push_back(std::move(line));
    changed_.notify_one();
  }
  void close() {
    const std::lock_guard lock(guard_);
    closed_ = true;
    changed_.notify_one();
  }
  /// The next one; false at the end.
  bool take(Request& line) {
    std::unique_lock lock(guard_);
    changed_.wait(lock, [this] { return closed_ || !lines_.empty(); });
    if (lines_.empty()) return false;
    line = std::move(lines_.front());
    lines_.pop_front();
    return true;
  }

 private:
  std::mutex guard_;
  std::condition_variable changed_;
  std::deque<Request> lines_;
  bool closed_ = false;
};

void read_lines(int input, Inbox& inbox, Session& session) {
  std::string line;
  char buffer[65536];
  for (;;) {
    const ssize_t more = read(input, buffer, sizeof buffer);
    if (more <= 0) break;
    for (ssize_t i = 0; i < more; ++i) {
      if (buffer[i] != '\n') {
        line += buffer[i];
        continue;
      }
      if (line == "cancel")
        session.cancel();
      else
        inbox.put({std::move(line), session.cancels()});
      line.clear();
    }
  }
  session.cancel();
  inbox.close();
}

}  // namespace

int work(int input, int output) {
  Session session;
  Inbox inbox;
  std::thread reader(read_lines, input, std::ref(inbox), std::ref(session));
  Request request;
  bool heard = true;
  while (heard && inbox.take(request)) {
    const std::string answer = session.answer(
        request.line, [&](std::string_view message) { heard = heard && write_line(output, "message", message); },
        request.cancels);
    heard = heard && write_line(output, "answer", answer);
  }
  if (!heard) _exit(1);  // the reader waits for an input that will not come
  reader.join();
  return 0;
}

}  // namespace maupertuis::studio

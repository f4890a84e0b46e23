#pragma once
#include <sys/types.h>
#include <nlohmann/json.hpp>

#include <deque>
#include <optional>
#include <string>

namespace lsp_test {

using Json = nlohmann::json;

/// An editor that has started `maup lsp`: frames over two pipes.
class Editor {
 public:
  Editor();
  ~Editor();
  Editor(const Editor&) = delete;
  Editor& operator=(const Editor&) = delete;

  void send_bytes(const std::string& bytes);
  void send(const Json& message);
  void notify(const std::string& method, const Json& params);
  /// Sends a request and returns its id.
  int ask(const std::string& method, const Json& params);
  /// The answer to a request, whatever else arrives before it; null after half a minute without one.
  Json answer(int id);
  Json result(const std::string& method, const Json& params) { return answer(ask(method, params))["result"]; }
  int error_code(const std::string& method, const Json& params) { return answer(ask(method, params))["error"]["code"]; }
  /// The next notification of this method.
  Json notification(const std::string& method);
  /// The diagnostics of this version of a text, the first or the last that come of it.
  Json diagnostics(const std::string& uri, int version);
  /// The next frame that answers no request: of something that was not understood.
  Json complaint();
  /// Whether one has arrived already that nobody asked for.
  bool complained() const;

  Json initialize(const Json& options = Json::object(), const Json& capabilities = Json::object());
  void open(const std::string& uri, const std::string& text, int version = 1);
  void change(const std::string& uri, int version, const Json& changes);

  void close_input();
  void signal(int number) const;
  /// The exit code; minus the number of the signal that ended it.
  int wait();

 private:
  std::optional<Json> receive();
  template <class Wanted>
  Json next(Wanted wanted);

  pid_t process_ = 0;
  int in_ = -1, out_ = -1, last_id_ = 0;
  std::string buffer_;
  std::deque<Json> received_;
};

Json place(int line, int character);
Json at(const std::string& uri, int line, int character);
Json about(const std::string& uri);

}  // namespace lsp_test

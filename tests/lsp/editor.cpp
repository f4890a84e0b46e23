#include "editor.hpp"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <stdexcept>

namespace lsp_test {

Editor::Editor() {
  std::signal(SIGPIPE, SIG_IGN);
  int to[2], from[2];
  if (pipe(to) != 0 || pipe(from) != 0) throw std::runtime_error("no pipe");
  process_ = fork();
  if (process_ == 0) {
    dup2(to[0], STDIN_FILENO);
    dup2(from[1], STDOUT_FILENO);
    for (const int end : {to[0], to[1], from[0], from[1]}) close(end);
    execl(MAUP_PROGRAM, "maup", "lsp", "--stdio", static_cast<char*>(nullptr));
    _exit(127);
  }
  close(to[0]);
  close(from[1]);
  in_ = to[1];
  out_ = from[0];
}

Editor::~Editor() {
  close_input();
  if (process_ > 0) {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  close(out_);
}

void Editor::send_bytes(const std::string& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t sent = write(in_, bytes.data() + at, bytes.size() - at);
    if (sent <= 0) return;
    at += static_cast<std::size_t>(sent);
  }
}

void Editor::send(const Json& message) {
  const std::string text = message.dump(-1, ' ', false, Json::error_handler_t::replace);
  send_bytes("Content-Length: " + std::to_string(text.size()) + "\r\n\r\n" + text);
}

void Editor::notify(const std::string& method, const Json& params) {
  send({{"jsonrpc", "2.0"}, {"method", method}, {"params", params}});
}

int Editor::ask(const std::string& method, const Json& params) {
  send({{"jsonrpc", "2.0"}, {"id", ++last_id_}, {"method", method}, {"params", params}});
  return last_id_;
}

/// Nothing at the end of the stream, and after half a minute of silence.
std::optional<Json> Editor::receive() {
  while (true) {
    const std::size_t end = buffer_.find("\r\n\r\n");
    if (end != std::string::npos) {
      const std::size_t length = std::stoul(buffer_.substr(buffer_.find(':') + 1));
      if (buffer_.size() >= end + 4 + length) {
        Json message = Json::parse(buffer_.substr(end + 4, length));
        buffer_.erase(0, end + 4 + length);
        return message;
      }
    }
    pollfd waiting{out_, POLLIN, 0};
    if (poll(&waiting, 1, 30'000) <= 0) return std::nullopt;
    char bytes[65536];
    const ssize_t got = read(out_, bytes, sizeof bytes);
    if (got <= 0) return std::nullopt;
    buffer_.append(bytes, static_cast<std::size_t>(got));
  }
}

template <class Wanted>
Json Editor::next(Wanted wanted) {
  for (auto it = received_.begin(); it != received_.end(); ++it)
    if (wanted(*it)) {
      Json found = *it;
      received_.erase(it);
      return found;
    }
  while (auto message = receive()) {
    if (wanted(*message)) return *message;
    received_.push_back(std::move(*message));
  }
  return nullptr;
}

Json Editor::answer(int id) {
  return next([id](const Json& m) { return m.contains("id") && m["id"] == id; });
}

Json Editor::notification(const std::string& method) {
  return next([&](const Json& m) { return m.contains("method") && m["method"] == method; })["params"];
}

Json Editor::diagnostics(const std::string& uri, int version) {
  const Json found = next([&](const Json& m) {
    return m.contains("method") && m["method"] == "textDocument/publishDiagnostics" && m["params"]["uri"] == uri &&
           m["params"].contains("version") && m["params"]["version"] == version;
  });
  return found.is_null() ? Json() : found["params"]["diagnostics"];
}

Json Editor::complaint() {
  return next([](const Json& m) { return m.contains("error") && m["id"].is_null(); });
}

bool Editor::complained() const {
  return std::any_of(received_.begin(), received_.end(),
                     [](const Json& m) { return m.contains("error") && m["id"].is_null(); });
}

Json Editor::initialize(const Json& options, const Json& capabilities) {
  const Json result = this->result(
      "initialize", {{"processId", nullptr}, {"capabilities", capabilities}, {"initializationOptions", options}});
  notify("initialized", Json::object());
  return result;
}

void Editor::open(const std::string& uri, const std::string& text, int version) {
  notify("textDocument/didOpen",
         {{"textDocument", {{"uri", uri}, {"languageId", "lag"}, {"version", version}, {"text", text}}}});
}

void Editor::change(const std::string& uri, int version, const Json& changes) {
  notify("textDocument/didChange",
         {{"textDocument", {{"uri", uri}, {"version", version}}}, {"contentChanges", changes}});
}

void Editor::close_input() {
  if (in_ >= 0) close(in_);
  in_ = -1;
}

void Editor::signal(int number) const { kill(process_, number); }

int Editor::wait() {
  int status = 0;
  waitpid(process_, &status, 0);
  process_ = 0;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

Json place(int line, int character) { return {{"line", line}, {"character", character}}; }

Json at(const std::string& uri, int line, int character) {
  return {{"textDocument", {{"uri", uri}}}, {"position", place(line, character)}};
}

Json about(const std::string& uri) { return {{"textDocument", {{"uri", uri}}}}; }

}  // namespace lsp_test

#include "server.hpp"

#include "access.hpp"
#include "folder.hpp"
#include "sessions.hpp"

#include <httplib.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <mutex>

namespace maupertuis::studio {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t most_threads = 300;  // a connection that is kept alive holds one
constexpr std::size_t largest_request = 8'000'000;

// What the browser itself is asked to enforce: no script but the page's own files, no request but to this server.
constexpr const char* policy =
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src "
    "'self'; font-src 'self'; worker-src 'self' blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

const char* type_of(const std::string& ending) {
  static const std::map<std::string, const char*> types = {{".html", "text/html; charset=utf-8"},
                                                           {".js", "text/javascript; charset=utf-8"},
                                                           {".css", "text/css; charset=utf-8"},
                                                           {".json", "application/json"},
                                                           {".svg", "image/svg+xml"},
                                                           {".png", "image/png"},
                                                           {".woff2", "font/woff2"},
                                                           {".wasm", "application/wasm"},
                                                           {".webmanifest", "application/manifest+json"},
                                                           {".txt", "text/plain; charset=utf-8"},
                                                           {".lag", "text/plain; charset=utf-8"}};
  const auto found = types.find(ending);
  return found == types.end() ? "application/octet-stream" : found->second;
}

void answer_json(httplib::Response& response, int status, const Json& json) {
  response.status = status;
  response.set_header("Cache-Control", "no-store");
  response.set_content(json.dump(-1, ' ', false, Json::error_handler_t::replace), "application/json");
}

Json trouble_json(const std::string& message, const std::string& reason, const std::string& help) {
  return {{"ok", false},
          {"kind", "request"},
          {"trouble", {{"code", ""}, {"message", message}, {"reason", reason}, {"help", help}}}};
}

void answer_trouble(httplib::Response& response, const FileTrouble& t) {
  answer_json(response, t.status, trouble_json(t.message, t.reason, t.help));
}

bool is_session(const std::string& id) {
  return !id.empty() && id.size() <= 40 && std::all_of(id.begin(), id.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
}

/// For the eyes of somebody who came by a wrong address. The sentences are our own.
std::string sentence_page(const std::string& message, const std::string& reason, const std::string& help) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width\"><title>Maupertuis studio</title><style>body{font:1.1rem/1.5 Georgia,serif;"
         "max-width:34rem;margin:15vh auto;padding:0 1rem;color:#1d1b18;background:#fffdf8}@media "
         "(prefers-color-scheme:dark){body{color:#e8e5de;background:#14161a}}</style></head><body><h1>" +
         message + "</h1><p>" + reason + "</p><p>" + help + "</p></body></html>\n";
}

std::string event(const char* kind, const std::string& json) {
  return std::string("event: ") + kind + "\ndata: " + json + "\n\n";
}

class Studio {
 public:
  Studio(const ServerOptions& options, int port, httplib::Server& server)
      : options_(options), access_(port), folder_(options.folder), sessions_(options.program, {}), server_(server) {
    guard();
    questions();
    files();
    pages();  // whatever else is asked for
  }
  const Access& access() const { return access_; }
  /// The threads of the server end when what they wait for has ended.
  void stop() {
    sessions_.end();
    const std::lock_guard lock(saving_);  // a file that is being written is written whole
    server_.stop();
  }

 private:
  /// Before anything else is looked at.
  void guard() {
    server_.set_default_headers({{"Content-Security-Policy", policy},
                                 {"Referrer-Policy", "no-referrer"},
                                 {"X-Content-Type-Options", "nosniff"},
                                 {"Cross-Origin-Opener-Policy", "same-origin"},
                                 {"Cross-Origin-Resource-Policy", "same-origin"},
                                 {"Cross-Origin-Embedder-Policy", "require-corp"}});
    server_.set_payload_max_length(largest_request);
    server_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      return refused(request, response) ? httplib::Server::HandlerResponse::Handled
                                        : httplib::Server::HandlerResponse::Unhandled;
    });
    server_.set_exception_handler([](const httplib::Request&, httplib::Response& response, std::exception_ptr) {
      answer_json(response, 500, trouble_json("The server came upon a mistake of its own.", "", "Please report it."));
    });
    server_.set_error_handler([](const httplib::Request&, httplib::Response& response) {
      if (response.body.empty())
        answer_json(
            response, response.status,
            trouble_json(response.status == 413 ? "The request is too long." : "There is nothing here.", "", ""));
    });
  }

  bool refused(const httplib::Request& request, httplib::Response& response) {
    const auto refuse = [&](const char* message, const char* reason, const char* help) {
      const bool read_by_person = request.get_header_value("Accept").find("text/html") != std::string::npos;
      if (read_by_person) {
        response.status = 403;
        response.set_content(sentence_page(message, reason, help), "text/html; charset=utf-8");
      } else {
        answer_json(response, 403, trouble_json(message, reason, help));
      }
      return true;
    };
    if (!access_.is_host(request.get_header_value("Host")))
      return refuse("This name is not that of the studio.", "It listens at 127.0.0.1 alone.",
                    "Take the address that `maup studio` printed.");
    const bool writes = request.method != "GET" && request.method != "HEAD";
    if (request.has_header("Origin") ? !access_.is_origin(request.get_header_value("Origin")) : writes)
      return refuse("Another page asked.", "The studio answers its own page alone.", "");
    if (request.path == "/" && request.has_param("token") && access_.redeem(request.get_param_value("token"))) {
      response.set_header("Set-Cookie", access_.cookie_header());
      response.set_redirect("/", 303);
      return true;
    }
    if (access_.knows(request.get_header_value("Cookie"))) {
      if (request.path != "/" || !request.has_param("token")) return false;
      response.set_redirect("/", 303);  // a token that was used before, in the browser that used it
      return true;
    }
    return refuse("This browser does not know the studio.",
                  "The address that `maup studio` prints is good once, in one browser.",
                  "End `maup studio` with Ctrl-C and start it again for a new address.");
  }

  void pages() {
    server_.Get(R"(/.*)", [this](const httplib::Request& request, httplib::Response& response) {
      std::error_code error;
      const fs::path root = fs::canonical(options_.page, error);
      const fs::path file =
          fs::weakly_canonical(root / fs::path(request.path == "/" ? "index.html" : request.path.substr(1)), error);
      const bool inside =
          !error && std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first == root.end();
      if (!inside || !fs::is_regular_file(file, error)) {
        response.status = 404;
        return;
      }
      std::ifstream stream(file, std::ios::binary);
      response.set_header("Cache-Control", "no-cache");
      response.set_content(std::string(std::istreambuf_iterator<char>(stream), {}), type_of(file.extension().string()));
    });
  }

  void questions() {
    server_.Post("/api/request", [this](const httplib::Request& request, httplib::Response& response) {
      const std::string id = request.get_param_value("session");
      if (!is_session(id))
        return answer_json(response, 400, trouble_json("The request names no session.", "", "Reload the page."));
      response.set_header("Cache-Control", "no-store");
      response.set_chunked_content_provider(
          "text/event-stream", [this, id, body = request.body](std::size_t, httplib::DataSink& sink) {
            const auto send = [&sink](const std::string& text) { sink.write(text.data(), text.size()); };
            const Told told{[&](const std::string& json) { send(event("message", json)); },
                            [&] { return sink.is_writable(); }};
            send(event("answer", sessions_.ask(id, body, told)));
            sink.done();
            return true;
          });
    });
    server_.Post("/api/cancel", [this](const httplib::Request& request, httplib::Response& response) {
      sessions_.cancel(request.get_param_value("session"));
      answer_json(response, 200, {{"ok", true}});
    });
  }

  void files() {
    server_.Get("/api/files", [this](const httplib::Request&, httplib::Response& response) {
      try {
        Json list = Json::array();
        for (const Folder::Entry& e : folder_.list()) list.push_back({{"path", e.path}, {"size", e.size}});
        answer_json(response, 200,
                    {{"ok", true},
                     {"folder", folder_.root().filename().string()},
                     {"files", std::move(list)},
                     {"open", options_.open}});
      } catch (const FileTrouble& t) {
        answer_trouble(response, t);
      }
    });
    server_.Get("/api/file", [this](const httplib::Request& request, httplib::Response& response) {
      try {
        const std::string path = request.get_param_value("path"), text = folder_.read(path);
        answer_json(response, 200, {{"ok", true}, {"path", path}, {"text", text}, {"etag", Folder::tag(text)}});
      } catch (const FileTrouble& t) {
        answer_trouble(response, t);
      }
    });
    server_.Put("/api/file",
                [this](const httplib::Request& request, httplib::Response& response) { save(request, response); });
  }

  void save(const httplib::Request& request, httplib::Response& response) {
    const std::string path = request.get_param_value("path");
    std::string expected = request.get_header_value("If-Match");
    expected.erase(std::remove(expected.begin(), expected.end(), '"'), expected.end());
    const std::lock_guard lock(saving_);  // between the look at a file and its new content
    try {
      folder_.write(path, request.body, expected);
      answer_json(response, 200, {{"ok", true}, {"etag", Folder::tag(request.body)}});
    } catch (const FileTrouble& t) {
      Json out = trouble_json(t.message, t.reason, t.help);
      if (t.status == 409) try {
          const std::string theirs = folder_.read(path);
          out["text"] = theirs, out["etag"] = Folder::tag(theirs);
        } catch (const FileTrouble&) {  // it is gone
          out["text"] = nullptr, out["etag"] = nullptr;
        }
      answer_json(response, t.status, out);
    }
  }

  const ServerOptions& options_;
  Access access_;
  Folder folder_;
  Sessions sessions_;
  httplib::Server& server_;
  std::mutex saving_;
};

}  // namespace

std::string serve(const ServerOptions& options,
                  const std::function<void(const std::string&, int, std::function<void()>)>& started) {
  httplib::Server server;
  server.new_task_queue = [] { return new httplib::ThreadPool(most_threads); };
  // Two servers at one port would take turns: the second is refused instead.
  socket_t listening = -1;
  server.set_socket_options([&listening](socket_t socket) {
    listening = socket;
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  int port = options.port;
  if (port == 0)
    port = server.bind_to_any_port("127.0.0.1");
  else if (!server.bind_to_port("127.0.0.1", port))
    return "Port " + std::to_string(port) + " is in use";
  if (port <= 0) return "No port could be opened";
  ::listen(listening, most_threads);  // the library lets no more than five connections wait
  Studio studio(options, port, server);
  started("http://127.0.0.1:" + std::to_string(port) + "/?token=" + studio.access().token(), port,
          [&studio] { studio.stop(); });
  server.listen_after_bind();
  return {};
}

}  // namespace maupertuis::studio

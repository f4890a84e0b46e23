#include "lsp/server.hpp"

#include <fmt/format.h>
#include <maupertuis/json_depth.hpp>

#include <csignal>
#include <thread>

namespace maupertuis::app::lsp {
namespace {

constexpr std::size_t most_texts = 200;

const Json& member(const Json& object, const char* key) {
  static const Json none;
  return object.is_object() && object.contains(key) ? object[key] : none;
}

std::string uri_of(const Json& params) {
  const Json& uri = member(member(params, "textDocument"), "uri");
  return uri.is_string() ? uri.get<std::string>() : std::string();
}

int version_of(const Json& params) {
  const Json& version = member(member(params, "textDocument"), "version");
  return version.is_number_integer() ? version.get<int>() : 0;
}

std::string key_of(const Json& id) { return id.dump(-1, ' ', true, Json::error_handler_t::replace); }

std::chrono::milliseconds milliseconds_of(const Json& value, std::chrono::milliseconds otherwise) {
  if (!value.is_number()) return otherwise;
  return std::chrono::milliseconds(static_cast<long>(std::min(std::max(value.get<double>(), 0.0), 3.6e6)));
}

using Answer = Json (*)(OpenText&, const Json&, const Client&);
struct Method {
  std::string_view name;
  Answer answer;
};
constexpr Method methods[] = {
    {"textDocument/hover", hover_json},
    {"textDocument/completion", completion_json},
    {"textDocument/signatureHelp", signature_json},
    {"textDocument/definition", definition_json},
    {"textDocument/references", references_json},
    {"textDocument/documentHighlight", highlights_json},
    {"textDocument/prepareRename", prepare_rename_json},
    {"textDocument/rename", rename_json},
    {"textDocument/documentSymbol", symbols_json},
    {"textDocument/formatting", formatting_json},
    {"textDocument/codeAction", code_actions_json},
    {"textDocument/semanticTokens/full", semantic_tokens_json},
    {"textDocument/foldingRange", folding_json},
};

/// Signals go to the thread that reads, and wake it.
class SignalsElsewhere {
 public:
  SignalsElsewhere() {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : {SIGINT, SIGTERM, SIGALRM, SIGVTALRM}) sigaddset(&set, signal);
    pthread_sigmask(SIG_BLOCK, &set, &before_);
  }
  ~SignalsElsewhere() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsElsewhere(const SignalsElsewhere&) = delete;
  SignalsElsewhere& operator=(const SignalsElsewhere&) = delete;

 private:
  sigset_t before_;
};

}  // namespace

Server::Server(int in, int out, const std::atomic<bool>& stop)
    : writer_(out), reader_(in, stop, writer_.failed()), signal_(stop) {}
Server::~Server() = default;

bool Server::run() {
  std::thread answering;
  {
    const SignalsElsewhere scope;
    answering = std::thread([this] { answer(); });
  }
  read();
  answering.join();
  return good_end_;
}

// ------------------------------------------------------------------------------------------------ the reading thread

void Server::read() {
  while (true) {
    Frame frame = reader_.next();
    if (frame.kind == Frame::Kind::End) {
      if (signal_) stop_ = true;
      return push({});
    }
    Event event;
    event.kind = Event::Kind::Malformed;
    event.text = std::move(frame.text);
    if (frame.kind == Frame::Kind::Message) {
      const bool deep = is_too_deep(event.text);
      event.message = deep ? Json() : Json::parse(event.text, nullptr, false);
      const bool json = !deep && !event.message.is_discarded();
      event.kind = json ? Event::Kind::Message : Event::Kind::Malformed;
      event.text = json ? std::string() : deep ? "a message nested too deeply" : "a message that is no JSON";
      if (!json) event.message = nullptr;
    }
    const bool last = member(event.message, "method") == "exit";
    note_cancellation(event.message);
    push(std::move(event));
    if (last) return;
  }
}

/// What the next messages make idle is ended before its turn comes.
void Server::note_cancellation(const Json& message) {
  const Json& method = member(message, "method");
  if (method == "textDocument/didChange" || method == "textDocument/didClose") {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!looking_.empty() && uri_of(member(message, "params")) == looking_) stop_ = true;
  }
  if (method != "$/cancelRequest") return;
  const Json& id = member(member(message, "params"), "id");
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::string key = key_of(id);
  if (cancelled_.size() < 10'000) cancelled_.insert(key);
  if (key == running_) stop_ = true;
}

void Server::push(Event event) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    events_.push_back(std::move(event));
  }
  arrived_.notify_all();
}

// ---------------------------------------------------------------------------------------------- the answering thread

void Server::answer() {
  while (!ended_ && !writer_.failed()) {
    std::optional<Event> event = next_event();
    if (event)
      handle(*event);
    else
      look_at_what_is_due();
  }
  background_.reset();
}

/// Nothing where a text is due to be looked at before anything arrives.
std::optional<Server::Event> Server::next_event() {
  std::unique_lock<std::mutex> lock(mutex_);
  std::optional<Clock::time_point> due;
  for (const auto* list : {&due_, &due_equations_})
    for (const auto& [uri, time] : *list)
      if (!due || time < *due) due = time;
  const auto ready = [this] { return !events_.empty(); };
  if (due)
    arrived_.wait_until(lock, *due, ready);
  else
    arrived_.wait(lock, ready);
  if (events_.empty()) return std::nullopt;
  Event event = std::move(events_.front());
  events_.pop_front();
  return event;
}

void Server::handle(Event& event) {
  switch (event.kind) {
    case Event::Kind::Message:
      return handle_message(event.message);
    case Event::Kind::Malformed:
      return refuse(nullptr, error::parse, "Not understood: " + event.text + ".");
    case Event::Kind::Findings:
      return take(event.findings);
    case Event::Kind::End:
      ended_ = true;
  }
}

void Server::handle_message(const Json& message) {
  const Json& id = member(message, "id");
  const Json& method = member(message, "method");
  const bool answered =
      message.is_object() && !method.is_string() && (message.contains("result") || message.contains("error"));
  if (answered) return;  // to a request of ours; there are none that need an answer
  const bool good_id = id.is_null() || id.is_string() || id.is_number_integer();
  if (!method.is_string() || !good_id)
    return refuse(good_id ? id : Json(), error::invalid_request,
                  "A message is an object with a method, and an id if it is a request.");
  const std::string name = method.get<std::string>();
  if (id.is_null()) return notification(name, member(message, "params"));
  request(id, name, member(message, "params"));
}

void Server::request(const Json& id, const std::string& method, const Json& params) {
  const std::string key = key_of(id);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    running_ = key;
    stop_ = signal_.load() || cancelled_.count(key) > 0;
  }
  if (stop_) {
    refuse(id, error::cancelled, "The request was cancelled.");
  } else {
    try {
      reply(id, result_of(method, params));
    } catch (const Refusal& refusal) {
      refuse(id, refusal.code, refusal.message);
    } catch (const Interrupted&) {
      refuse(id, error::cancelled, "The request was cancelled.");
    } catch (const std::exception& failure) {
      refuse(id, error::internal,
             fmt::format("internal error: {}. This is a defect of maup; please report it.", failure.what()));
    }
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  running_.clear();
  cancelled_.erase(key);
  stop_ = false;
}

Json Server::result_of(const std::string& method, const Json& params) {
  if (method == "initialize") return initialize(params);
  if (!initialized_) throw Refusal{error::not_initialized, "The first request is `initialize`."};
  if (shut_down_) throw Refusal{error::invalid_request, "After `shutdown` only `exit` is expected."};
  if (method == "shutdown") {
    shut_down_ = true;
    if (background_) background_->cancel({});
    return nullptr;
  }
  for (const Method& known : methods) {
    if (known.name != method) continue;
    OpenText* text = open_text(params);
    if (!text) throw Refusal{error::invalid_params, "This text is not open."};
    // No error in the protocol: editors that lay out what they save would not save it then.
    if (method == "textDocument/formatting")
      if (const std::string why = why_not_formatted(*text); !why.empty())
        tell("window/showMessage", {{"type", 2}, {"message", why}});
    return known.answer(*text, params, client_);
  }
  throw Refusal{error::unknown_method, fmt::format("There is no method `{}`.", method.substr(0, 100))};
}

Json Server::initialize(const Json& params) {
  if (initialized_) throw Refusal{error::invalid_request, "`initialize` came before."};
  initialized_ = true;
  client_ = client_of(params);
  const Json& options = member(params, "initializationOptions");
  patience_ = milliseconds_of(member(options, "patience"), patience_);
  later_patience_ = milliseconds_of(member(options, "derivationPatience"), later_patience_);
  budget_ = milliseconds_of(member(options, "derivationBudget"), budget_);
  derives_ = !(member(options, "derivation").is_boolean() && !member(options, "derivation").get<bool>());
  const SignalsElsewhere scope;
  background_ = std::make_unique<Background>(budget_, [this](Findings findings) {
    Event event;
    event.kind = Event::Kind::Findings;
    event.findings = std::move(findings);
    push(std::move(event));
  });
  return {{"capabilities", capabilities(client_)}, {"serverInfo", {{"name", "maup"}, {"version", MAUPERTUIS_VERSION}}}};
}

void Server::notification(const std::string& method, const Json& params) {
  if (method == "exit") {
    ended_ = true;
    good_end_ = shut_down_;
    return;
  }
  if (!initialized_ || shut_down_) return;
  if (method == "textDocument/didOpen") open(params);
  if (method == "textDocument/didChange") change(params);
  if (method == "textDocument/didClose") close(params);
  if (method == "textDocument/didSave") look_later(uri_of(params), std::chrono::milliseconds(0));
}

// ----------------------------------------------------------------------------------------------------------- the texts

OpenText* Server::open_text(const Json& params) {
  const auto found = texts_.find(uri_of(params));
  return found == texts_.end() ? nullptr : &found->second;
}

void Server::open(const Json& params) {
  const Json& text = member(member(params, "textDocument"), "text");
  const std::string uri = uri_of(params);
  if (!text.is_string() || uri.empty()) return;
  if (texts_.size() >= most_texts && !texts_.count(uri))
    return tell("window/showMessage", {{"type", 2}, {"message", "maup: more texts are open than it looks at (200)."}});
  background_->cancel(uri);
  texts_.erase(uri);
  texts_.emplace(uri, OpenText(uri, text.get<std::string>(), version_of(params), client_.encoding, &stop_));
  look_later(uri, std::chrono::milliseconds(0));
}

void Server::change(const Json& params) {
  OpenText* text = open_text(params);
  if (!text) return;
  background_->cancel(text->uri());
  if (!text->change(member(params, "contentChanges"), version_of(params)))
    tell("window/logMessage", {{"type", 1}, {"message", "textDocument/didChange without changes that can be read"}});
  look_later(text->uri(), patience_);
}

void Server::close(const Json& params) {
  const std::string uri = uri_of(params);
  if (!texts_.count(uri)) return;
  background_->cancel(uri);
  due_.erase(uri);
  due_equations_.erase(uri);
  texts_.erase(uri);
  tell("textDocument/publishDiagnostics", {{"uri", uri}, {"diagnostics", Json::array()}});
}

void Server::look_later(const std::string& uri, std::chrono::milliseconds after) {
  if (!texts_.count(uri)) return;
  due_equations_.erase(uri);
  due_[uri] = Clock::now() + after;
}

void Server::look_at_what_is_due() {
  const auto now = Clock::now();
  const auto take_due = [now](std::map<std::string, Clock::time_point>& list) {
    for (auto it = list.begin(); it != list.end(); ++it)
      if (it->second <= now) {
        std::string uri = it->first;
        list.erase(it);
        return uri;
      }
    return std::string();
  };
  if (const std::string uri = take_due(due_); !uri.empty()) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      looking_ = uri;
      stop_ = signal_.load();
    }
    try {
      look_at(texts_.at(uri));
    } catch (const Interrupted&) {  // by the change that arrives next: then it is looked at again
    } catch (const std::exception& failure) {
      tell("window/logMessage", {{"type", 1}, {"message", fmt::format("maup: internal error: {}", failure.what())}});
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    looking_.clear();
    stop_ = false;
    return;
  }
  const std::string uri = take_due(due_equations_);
  if (uri.empty()) return;
  const OpenText& text = texts_.at(uri);
  background_->begin({uri, text.text(), text.version()});
}

void Server::look_at(OpenText& text) {
  const Diagnostics found = text.diagnostics();
  publish(text, found);
  if (derives_ && !found.has_errors() && !text.too_large()) due_equations_[text.uri()] = Clock::now() + later_patience_;
}

void Server::publish(OpenText& text, const Diagnostics& diagnostics) {
  tell("textDocument/publishDiagnostics", {{"uri", text.uri()},
                                           {"version", text.version()},
                                           {"diagnostics", diagnostics_json(diagnostics, text, client_)}});
}

void Server::take(const Findings& findings) {
  const auto found = texts_.find(findings.uri);
  if (found == texts_.end() || found->second.version() != findings.version) return;
  if (findings.diagnostics)
    publish(found->second, *findings.diagnostics);
  else
    tell("window/logMessage",
         {{"type", 3},
          {"message",
           fmt::format("The equations of {} were not derived in {} s: mistakes that show in them alone are not "
                       "told. `maup check` takes its time.",
                       findings.uri, static_cast<double>(budget_.count()) / 1000)}});
}

// -------------------------------------------------------------------------------------------------------- what is sent

void Server::send(const Json& message) { writer_.write(message.dump(-1, ' ', false, Json::error_handler_t::replace)); }

void Server::reply(const Json& id, Json result) {
  send({{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(result)}});
}

void Server::refuse(const Json& id, int code, const std::string& message) {
  send({{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", message}}}});
}

void Server::tell(const char* method, Json params) {
  send({{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}});
}

}  // namespace maupertuis::app::lsp

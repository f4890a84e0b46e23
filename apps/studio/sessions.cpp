#include "sessions.hpp"

#include <maupertuis/json_depth.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>

namespace maupertuis::studio {
namespace {

using Json = nlohmann::json;

std::string trouble(const char* kind, const char* message, const char* reason, const char* help) {
  return Json{{"ok", false},
              {"kind", kind},
              {"trouble", {{"code", ""}, {"message", message}, {"reason", reason}, {"help", help}}}}
      .dump();
}

/// Whether a request opens a text. What is no request is refused by the worker.
bool is_open(const std::string& request) {
  if (is_too_deep(request)) return false;
  const Json parsed = Json::parse(request, nullptr, false);
  if (!parsed.is_object()) return false;
  const auto what = parsed.find("do");
  return what != parsed.end() && what->is_string() && *what == "open";
}

std::string explained(Child::Outcome::Kind kind) {
  switch (kind) {
    case Child::Outcome::Kind::TooLong:
      return trouble("budget", "The work did not come to an end and was stopped.",
                     "Every question has a time, so that the page stays alive.",
                     "Ask with more time, or for less; the text is untouched.");
    case Child::Outcome::Kind::NotStarted:
      return trouble("internal", "No process could be started for this tab.", "The machine has no room for another.",
                     "Close some tabs.");
    case Child::Outcome::Kind::Died:
      return trouble("internal", "The process that computed this ended.",
                     "It needed more memory than it may have, or came upon a mistake of the program.",
                     "The text is untouched; ask for less, or report this model.");
    case Child::Outcome::Kind::Answered:
      break;
  }
  return {};
}

}  // namespace

std::shared_ptr<Sessions::Session> Sessions::session(const std::string& id) {
  const std::lock_guard lock(guard_);
  auto& found = sessions_[id];
  if (!found) found = std::make_shared<Session>(std::make_unique<Child>(program_, limits_.memory));
  found->used = std::chrono::steady_clock::now();
  auto out = found;
  make_room();
  return out;
}

/// The tab that was used longest ago goes first. One that is being answered lives until it has been.
void Sessions::make_room() {
  while (sessions_.size() > limits_.most) {
    const auto oldest = std::min_element(sessions_.begin(), sessions_.end(),
                                         [](const auto& a, const auto& b) { return a.second->used < b.second->used; });
    sessions_.erase(oldest);
  }
}

std::string Sessions::ask(const std::string& id, const std::string& request, const Told& told) {
  const auto own = session(id);
  const unsigned cancels = own->cancels;
  const std::lock_guard turn(own->turn);
  const auto wanted = [&] { return !ended_ && own->cancels == cancels && told.wanted(); };
  if (!wanted()) return trouble("cancelled", "It was cancelled.", "", "");
  const bool opens = is_open(request);
  const std::chrono::duration<double> longest(limits_.longest);
  if (!own->child->alive() && !own->opened.empty() && !opens)
    own->child->ask(
        own->opened, longest, [](const std::string&) {}, wanted);
  const Child::Outcome outcome = own->child->ask(request, longest, told.message, wanted);
  if (outcome.kind != Child::Outcome::Kind::Answered) return explained(outcome.kind);
  if (opens && outcome.answer.rfind(R"({"ok":true)", 0) == 0) own->opened = request;
  return outcome.answer;
}

void Sessions::cancel(const std::string& id) {
  const std::lock_guard lock(guard_);
  const auto found = sessions_.find(id);
  if (found != sessions_.end()) ++found->second->cancels;
}

void Sessions::end() {
  const std::lock_guard lock(guard_);
  ended_ = true;
  for (auto& [id, session] : sessions_) session->child->kill_now();
  for (auto& [id, session] : sessions_) session->child->wait_gone();
}

}  // namespace maupertuis::studio

#include "studio/deadline.hpp"
#include "studio/requests.hpp"

#include <maupertuis/json_depth.hpp>
#include <maupertuis/studio.hpp>

#include <algorithm>
#include <chrono>
#include <map>
#include <string_view>

namespace maupertuis::studio {
namespace {

using Answering = Json (*)(Desk&, const Work&);
const std::map<std::string_view, Answering>& answering() {
  static const std::map<std::string_view, Answering> all = {
      {"hello", hello},
      {"open", open_text},
      {"fixes", fixes},
      {"hover", hover},
      {"complete", complete},
      {"signature", signature},
      {"definition", definition},
      {"references", references},
      {"rename", rename},
      {"format", format},
      {"explain", explain},
      {"equations", equations},
      {"phase_space", phase_space},
      {"conserved", conserved},
      {"expectations", expectations},
      {"claim", claim},
      {"run", run},
      {"modes", modes},
      {"section", section},
      {"paths", paths},
      {"pose", pose},
      {"export", export_file},
  };
  return all;
}

constexpr std::chrono::milliseconds between_progress(50);

/// Bytes that are no UTF-8 come back as the sign for such.
std::string written(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json told(const Trouble& trouble) {
  Json out = {
      {"ok", false},
      {"kind", trouble.kind},
      {"trouble",
       {{"code", trouble.code}, {"message", trouble.message}, {"reason", trouble.reason}, {"help", trouble.help}}}};
  if (!trouble.diagnostics.is_null()) out["diagnostics"] = trouble.diagnostics;
  return out;
}

Trouble unreadable(std::string why) { return {"request", std::move(why), "", "", "", nullptr}; }

}  // namespace

class Session::Implementation {
 public:
  explicit Implementation(const SessionLimits& limits) : limits_(limits), desk_(Interrupt(&stop_)) {}

  Json answer(std::string_view text, const Send& send, std::uint64_t since) {
    try {
      return in_its_time(read(text), send, since);
    } catch (const Trouble& trouble) {
      return told(trouble);
    }
  }
  void cancel() {
    ++cancels_;
    stop_ = true;
  }
  std::uint64_t cancels() const { return cancels_; }

 private:
  Json read(std::string_view text) const {
    if (text.size() > 3 * limits_.largest_text + 100'000)
      throw Trouble{
          "refused",
          "The text is too long.",
          "A model is a text that a person writes; this has " + std::to_string(text.size() / 1'000'000) + " megabytes.",
          "Is it the right file?",
          "",
          nullptr};
    if (is_too_deep(text)) throw unreadable("Its brackets stand in each other too deep.");
    Json request = Json::parse(text, nullptr, false);
    if (!request.is_object()) throw unreadable("The request is no JSON object.");
    if (text_of(request, "text").size() > limits_.largest_text)
      throw Trouble{"refused",
                    "The text is too long.",
                    "A model is a text that a person writes, of at most " +
                        std::to_string(limits_.largest_text / 1000) + " kB here.",
                    "Is it the right file?",
                    "",
                    nullptr};
    return request;
  }

  Json in_its_time(const Json& request, const Send& send, std::uint64_t since) {
    const std::string what = text_of(request, "do");
    const auto found = answering().find(what);
    if (found == answering().end()) throw unreadable("`" + what + "` is no request.");
    const double asked = number_of(request, "budget", limits_.budget);
    const double budget = std::clamp(asked, 0.05, limits_.longest_budget);
    // First lowered, then looked at: a cancel in between raises it again.
    stop_ = false;
    const auto cancelled = [this, since] {
      if (limits_.cancelled && limits_.cancelled() && cancels_ == since) ++cancels_;
      return cancels_ != since;
    };
    if (cancelled()) throw Trouble{"cancelled", "It was cancelled.", "", "", "", nullptr};
    const Deadline deadline(budget, stop_, cancelled);
    auto last = std::chrono::steady_clock::time_point{};
    const Work work{request, Interrupt(&stop_), [&](const Json& message) {
                      const auto now = std::chrono::steady_clock::now();
                      if (!send || (message.contains("progress") && now - last < between_progress)) return;
                      last = now;
                      send(written(message));
                    }};
    try {
      Json out = {{"ok", true}};
      out.update(found->second(desk_, work));
      desk_.forget_said();
      return out;
    } catch (const Interrupted&) {
      desk_.forget_studies();  // one that was interrupted may have said half of what it found
      if (cancelled()) throw Trouble{"cancelled", "It was cancelled.", "", "", "", nullptr};
      throw Trouble{"budget",
                    "It did not come within " + Json(budget).dump() + " s.",
                    "Every question has a time, so that the page stays alive.",
                    "Ask with more time, or for less.",
                    "",
                    nullptr};
    } catch (const Trouble&) {
      desk_.forget_said();
      throw;
    } catch (const std::bad_alloc&) {
      desk_.forget_studies();
      throw;
    } catch (const std::exception& e) {
      desk_.forget_studies();
      throw Trouble{"internal", std::string("Something that should hold did not: ") + e.what(),
                    "",         "Please report this model.",
                    "",         nullptr};
    }
  }

  SessionLimits limits_;
  StopFlag stop_ = false;
  std::atomic<std::uint64_t> cancels_ = 0;
  Desk desk_;
};

Session::Session(const SessionLimits& limits) : implementation_(std::make_unique<Implementation>(limits)) {}
Session::~Session() = default;

std::string Session::answer(std::string_view request, const Send& send, std::uint64_t since) {
  return written(implementation_->answer(request, send, since));
}

void Session::cancel() { implementation_->cancel(); }
std::uint64_t Session::cancels() const { return implementation_->cancels(); }

}  // namespace maupertuis::studio

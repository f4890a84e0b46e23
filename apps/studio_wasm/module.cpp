// The functions of maup.wasm: one session, that takes requests as texts (README.md).
#include <emscripten.h>

#include <maupertuis/studio.hpp>

#include <new>
#include <string>

namespace {

using maupertuis::studio::Session;
using maupertuis::studio::SessionLimits;

// What the script around the module has given it: where messages go, and whether the request is not wanted any more.
EM_JS(void, post_message, (const char* text), { Module["message"](UTF8ToString(text)); });
EM_JS(bool, is_cancelled, (), { return Module["cancelled"](); });

constexpr const char* no_memory =
    R"({"ok": false, "kind": "refused", "trouble": {"code": "", "message": "The memory is not enough.", "reason": )"
    R"("A page of a browser has at most 2 GB.", "help": "Ask for less: a shorter run, fewer parts of a field."}})";

struct Studio {
  explicit Studio(const SessionLimits& limits) : session(limits) {}
  Session session;
  std::string answer;
};

}  // namespace

extern "C" {

/// `watched`: `Module.cancelled` is there, and is asked while a request is answered.
EMSCRIPTEN_KEEPALIVE Studio* maup_create(bool watched) {
  SessionLimits limits;
  if (watched) limits.cancelled = is_cancelled;
  return new Studio(limits);
}

EMSCRIPTEN_KEEPALIVE void maup_destroy(Studio* studio) { delete studio; }

/// The answer stays until the next call. Messages go to `Module.message` meanwhile.
EMSCRIPTEN_KEEPALIVE const char* maup_answer(Studio* studio, const char* request) {
  try {
    studio->answer =
        studio->session.answer(request, [](std::string_view message) { post_message(std::string(message).c_str()); });
  } catch (const std::bad_alloc&) {
    return no_memory;
  }
  return studio->answer.c_str();
}

}  // extern "C"

#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

/// What stands behind the page of the studio, whatever carries its requests (docs/design/studio.md).
namespace maupertuis::studio {

struct SessionLimits {
  double budget = 20;                    // s that a request may take where it does not say
  double longest_budget = 600;           // s that it may ask for
  std::size_t largest_text = 1'000'000;  // bytes of a model
  /// In programs of one thread (WebAssembly), where nobody could call `cancel` while a request is answered: whether it
  /// is to be cancelled. Asked on the thread of `answer`, as often as a motion makes steps.
  std::function<bool()> cancelled{};
};

/// Receives what a request has to tell before its answer: one JSON object a call. Called on the thread of `answer`.
using Send = std::function<void(std::string_view message)>;

/// A model text that is open, and answers about it.
///
/// Requests and answers are JSON objects; docs/design/studio.md lists them. An answer depends on the request and the
/// text that was opened last, on nothing else: what was computed for an earlier one is kept only to be quick.
///
/// Threads: one at a time calls `answer`; `cancel` may be called from any.
class Session {
 public:
  explicit Session(const SessionLimits& limits = {});
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Carries out one request. Whatever it holds, the answer is an object with "ok"; nothing is thrown but
  /// std::bad_alloc. A request ends within a second of the end of its budget.
  std::string answer(std::string_view request, const Send& send = {}) { return answer(request, send, cancels()); }
  /// The same for a request that came while `cancels()` was `since`: a cancel from then on is heard, whether the
  /// request waited or was being answered.
  std::string answer(std::string_view request, const Send& send, std::uint64_t since);

  /// Ends the request that is being answered, and those that wait: their answers say "cancelled".
  void cancel();
  /// How often that was.
  std::uint64_t cancels() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace maupertuis::studio

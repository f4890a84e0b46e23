#pragma once
#include "studio/shapes.hpp"

#include <maupertuis/interrupt.hpp>
#include <maupertuis/language_services.hpp>
#include <maupertuis/study.hpp>

#include <list>
#include <memory>
#include <optional>
#include <set>
#include <string>

namespace maupertuis::studio {

/// A request on its way: what it asks, and the means to answer it.
struct Work {
  const Json& request;
  Interrupt interrupt;
  std::function<void(const Json&)> send;  // a message before the answer
};

/// A text of the request, or `otherwise`. Trouble where it is of another type.
std::string text_of(const Json& request, const char* key, const std::string& otherwise = {});
double number_of(const Json& request, const char* key, double otherwise);
bool is_true(const Json& request, const char* key);

/// The open text, and the studies of it for the values that were asked last.
class Desk {
 public:
  explicit Desk(const Interrupt& interrupt) : interrupt_(interrupt) {}

  /// Puts a text on the desk in the place of the one before.
  void open(std::string name, std::string text);

  // Trouble of kind request where no text is open.
  language::Document& document();
  const Units& units();
  const SourceText& source() { return document().source(); }

  /// The study with what the request says beside the text: set, start, run, mode, section.
  Study& study(const Json& request);
  /// The same, certified with its readable form; trouble of kind model where the text has mistakes.
  Study& certified(const Json& request);
  /// The same where nothing is shown but a motion or a pose: other values do not change the equations of a text, so
  /// that those of the same text and mode need to be certified once. Many of these come while a slider moves.
  Study& moved(const Json& request);
  /// A study that has collected messages beyond its equations says them once: the next request begins a new one.
  void forget_said();

  void forget_studies() { studies_.clear(); }

  /// Those of the study, and what a question of this request has found beside them.
  Json diagnostics(const Study& study, const Diagnostics& more = {});
  /// Throws the mistakes of both as trouble of kind model.
  [[noreturn]] void refuse(const Study& study, const Diagnostics& more = {});

 private:
  struct Kept {
    std::string key;
    std::unique_ptr<Study> study;
    std::size_t messages = 0;  // when its equations were certified
  };
  static constexpr std::size_t most_kept = 3;

  Interrupt interrupt_;
  std::optional<language::Document> document_;
  std::optional<Units> units_;
  std::list<Kept> studies_;                // used last first
  std::set<std::string> certified_modes_;  // of this text
};

}  // namespace maupertuis::studio

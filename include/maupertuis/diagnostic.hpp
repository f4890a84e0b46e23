#pragma once
#include <maupertuis/source.hpp>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace maupertuis {

enum class Severity { Note, Warning, Error };

/// One message to the user about one mistake: what is wrong, where, why in words of physics, and what helps.
struct Diagnostic {
  std::string code;  // stable: E0412 (error), W0203 (warning), N0101 (note)
  Severity severity = Severity::Error;
  std::optional<Span> span;  // none: the mistake is not at a place of a text
  std::string message;       // one line: what is wrong
  std::string reason;        // one sentence of physics or of the language: why
  std::string help;          // one sentence: what to write instead
};

/// Collects diagnostics in the order of discovery. Passes append and go on; nothing is thrown for a user's mistake.
class Diagnostics {
 public:
  Diagnostic& error(std::string code, std::optional<Span> span, std::string message, std::string reason = {},
                    std::string help = {});
  Diagnostic& warning(std::string code, std::optional<Span> span, std::string message, std::string reason = {},
                      std::string help = {});
  Diagnostic& note(std::string code, std::optional<Span> span, std::string message, std::string reason = {},
                   std::string help = {});
  void append(Diagnostic diagnostic);
  void append(const Diagnostics& others);

  bool has_errors() const;
  bool empty() const { return items_.empty(); }
  std::span<const Diagnostic> items() const { return items_; }
  /// Orders by place (the model first, then the texts beside it; those without a place last), stable.
  void sort_by_place();

 private:
  Diagnostic& add(Severity severity, std::string code, std::optional<Span> span, std::string message,
                  std::string reason, std::string help);
  std::vector<Diagnostic> items_;
};

/// What `maup explain CODE` says. Every stage publishes the entries of its own codes; a test compares them with
/// the codes that the sources use.
struct CodeEntry {
  std::string_view code;
  std::string_view title;        // half a line, e.g. "two sides of an equation differ in dimension"
  std::string_view explanation;  // a paragraph or two: the physics, and how to mend it
  std::string_view wrong;        // a smallest model text that gives it; may be empty
  std::string_view right;        // the same, mended; may be empty
};

struct RenderOptions {
  bool color = false;
  std::size_t limit = 50;  // further messages are counted, not shown
};

/// Elm's layout: a head line with the code, the source line with a caret under the exact span, the reason, the help.
/// Precondition: the places are in `texts`; a SourceText alone is one such.
std::string render(const Diagnostic& diagnostic, const SourceTexts& texts, const RenderOptions& options = {});
std::string render(const Diagnostics& diagnostics, const SourceTexts& texts, const RenderOptions& options = {});

/// The nearest of `candidates` to a misspelt `name` (Damerau-Levenshtein, at most a third of its length off);
/// empty if none is near.
std::string did_you_mean(std::string_view name, std::span<const std::string> candidates);

}  // namespace maupertuis

#include "syntax/lint_letters.hpp"

#include <maupertuis/look_alikes.hpp>

#include <fmt/format.h>

#include <map>

namespace maupertuis::syntax {
namespace {

class LetterLint {
 public:
  LetterLint(const SourceText& source, Diagnostics& diagnostics) : source_(source), diagnostics_(diagnostics) {}

  void look_at(const Name& name) {
    const auto [first, is_new] = seen_.emplace(latin_look(name.text), name);
    if (!is_new && first->second.text != name.text) return twins(first->second, name);
    const std::string foreign = foreign_letter(name.text);
    if (foreign.empty() || !is_new) return;
    diagnostics_.warning("W0107", name.span, fmt::format("`{}` mixes two alphabets: {}", name.text, foreign),
                         fmt::format("It looks like `{}`, and is another name.", latin_look(name.text)),
                         "Write it with Latin letters.");
  }

 private:
  void twins(const Name& first, const Name& name) {
    diagnostics_.warning(
        "W0106", name.span,
        fmt::format("`{}` looks like another name, that of line {}", name.text, source_.locate(first.span.begin).line),
        "Their letters are of different alphabets: nobody who reads the model can tell them apart.",
        "Rename one of them.");
  }

  const SourceText& source_;
  Diagnostics& diagnostics_;
  std::map<std::string, Name> seen_;  // by how it looks
};

}  // namespace

void lint_letters(const TokenList& list, const std::vector<StatementTokens>& statements, const SourceText& source,
                  Diagnostics& diagnostics) {
  LetterLint lint(source, diagnostics);
  for (const StatementTokens& statement : statements)
    for (const Name& name : Declarations::of(list, statement)) lint.look_at(name);
}

}  // namespace maupertuis::syntax

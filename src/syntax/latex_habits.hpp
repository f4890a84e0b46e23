#pragma once
#include "syntax/token.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace maupertuis::syntax {

/// A command of LaTeX in a model text, and what the language writes in its place.
struct LatexCommand {
  std::size_t length = 0;  // bytes, with what belongs to it: \dot{\theta}, \frac{a}{b}
  std::string help;        // one sentence
  struct Part {
    Token::Kind kind;
    std::string text;
  };
  std::vector<Part> tokens;  // what it stands for, so that the rest of the statement is looked at; none: not known
};

/// `text` begins with a backslash.
LatexCommand latex_command(std::string_view text);

}  // namespace maupertuis::syntax

#pragma once
#include <maupertuis/source.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace maupertuis::app {

/// A statement of the model language that options stand for: words of its own around what was typed. Errors in it are told at the option.
class OptionStatement {
 public:
  struct Piece {
    std::string option;         // "--until"
    std::uint32_t begin, end;   // of what was typed, in the statement
  };

  explicit OptionStatement(std::string_view words) : text_(words) {}
  OptionStatement& add(std::string_view words);
  /// What was typed, as one line: no line ends and no comment in it.
  OptionStatement& add_typed(std::string_view option, std::string_view typed);

  const std::string& text() const { return text_; }
  const std::vector<Piece>& pieces() const { return pieces_; }

 private:
  std::string text_;
  std::vector<Piece> pieces_;
};

/// What was typed as one statement: no line ends and no comment in it.
std::string as_one_line(std::string statement);

/// A place in what an option said.
struct OptionPlace {
  SourceText source;  // its name is that of the option
  Span span;
};

}  // namespace maupertuis::app

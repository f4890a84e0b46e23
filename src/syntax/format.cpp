#include "syntax/declarations.hpp"
#include "syntax/layout.hpp"
#include "syntax/lexer.hpp"
#include "syntax/unicode.hpp"
#include "syntax/words.hpp"

#include <maupertuis/require.hpp>
#include <maupertuis/syntax_tree.hpp>

#include <algorithm>

/// The formatter works on tokens: what the author broke into lines stays so, each line gets its canonical blanks and
/// spellings, and comments stay where they stand. The tree is unchanged by construction, since the tokens are.
namespace maupertuis::syntax {
namespace {

constexpr std::size_t kWidth = 100;
constexpr std::string_view kIndent = "    ";

struct Line {
  std::uint32_t place = 0;  // offset in the source, for the order of comments and lines
  std::string text;
  std::string comment;
  bool continues = false;  // belongs to the statement of the line before
};

// A comma or a sum is a good place to break, unless the next line would begin like a statement.
bool may_break_before(std::span<const Token> tokens, std::size_t i) {
  if (tokens[i].kind == Token::Kind::Name && is_statement_word(tokens[i].text)) return false;
  const bool binary = (tokens[i].is("+") || tokens[i].is("-")) && blank_before(tokens, i) && i + 1 < tokens.size() &&
                      blank_before(tokens, i + 1);
  return tokens[i - 1].is(",") || binary;
}

int depth_change(const Token& token) {
  if (token.is("(") || token.is("[")) return 1;
  return token.is(")") || token.is("]") ? -1 : 0;
}

// Where a line that is too long ends: at a good place that fits, in as few brackets as possible and then as late as
// possible, but not before half of the line; where none fits, at the first one.
std::size_t fitting_end(std::span<const Token> statement, std::size_t begin, std::size_t end) {
  std::size_t fitting = end, width = begin == 0 ? 0 : kIndent.size(), width_there = 0;
  int depth = 0, depth_there = 0;
  for (std::size_t i = begin; i < end; ++i) {
    if (i > begin && may_break_before(statement, i)) {
      if (width > kWidth && fitting != end) return fitting;
      if (fitting == end || depth <= depth_there || width_there < kWidth / 2) {
        fitting = i;
        width_there = width;
        depth_there = depth;
      }
    }
    depth += depth_change(statement[i]);
    width += (i > begin && blank_before(statement, i) ? 1 : 0) + length_in_characters(statement[i].text) +
             (statement[i].kind == Token::Kind::String ? 2 : 0);
  }
  return width > kWidth ? fitting : end;
}

void add_lines(std::span<const Token> statement, std::vector<Line>& lines) {
  for (std::size_t begin = 0; begin < statement.size();) {
    std::size_t end = begin + 1;
    while (end < statement.size() && !statement[end].line_start) ++end;
    end = fitting_end(statement, begin, end);
    const bool continues = begin > 0;
    std::string text = (continues ? std::string(kIndent) : std::string()) + lay_out(statement.first(end), begin);
    lines.push_back({statement[begin].span.begin, std::move(text), {}, continues});
    begin = end;
  }
}

class Layout {
 public:
  Layout(std::vector<Line> lines, const std::vector<Comment>& comments, std::string_view source)
      : lines_(std::move(lines)), source_(source) {
    attach(comments);
  }

  std::string run() {
    align_comments();
    std::string text;
    std::uint32_t last_place = 0;
    for (const Line& line : lines_) {
      if (!text.empty() && !line.continues && blank_line_between(last_place, line.place)) text += '\n';
      text += line.text;
      text += line.comment;
      text += '\n';
      last_place = line.place;
    }
    return text;
  }

 private:
  // A comment ends the line it stands on, or is a line of its own: indented inside a statement.
  void attach(const std::vector<Comment>& comments) {
    std::vector<Line> own;
    for (const Comment& comment : comments) {
      const auto after = std::upper_bound(lines_.begin(), lines_.end(), comment.span.begin,
                                          [](std::uint32_t place, const Line& line) { return place < line.place; });
      if (!stands_alone(comment.span.begin)) {
        (after - 1)->comment = comment.text;
        continue;
      }
      const bool inside = after != lines_.end() && after->continues;
      own.push_back({comment.span.begin, (inside ? std::string(kIndent) : std::string()) + comment.text, {}, inside});
    }
    std::vector<Line> all(lines_.size() + own.size());
    std::merge(lines_.begin(), lines_.end(), own.begin(), own.end(), all.begin(),
               [](const Line& a, const Line& b) { return a.place < b.place; });
    lines_ = std::move(all);
  }

  bool stands_alone(std::uint32_t place) const {
    std::size_t begin = place;
    while (begin > 0 && source_[begin - 1] != '\n') --begin;
    for (std::size_t i = begin; i < place;) {
      const CodePoint c = *decode(source_, i);
      if (!is_blank(c.value) && c.value != 0xFEFF) return false;
      i += c.length;
    }
    return true;
  }

  bool blank_line_between(std::uint32_t begin, std::uint32_t end) const {
    int breaks = 0;
    for (std::size_t i = end; i > begin; --i) {
      const char c = source_[i - 1];
      if (c == '\n')
        ++breaks;
      else if (c != ' ' && c != '\t' && c != '\r')
        break;
    }
    return breaks > 1;
  }

  // The comments of neighbouring lines stand below each other.
  void align_comments() {
    for (std::size_t i = 0; i < lines_.size();) {
      std::size_t end = i, widest = 0;
      for (; end < lines_.size() && !lines_[end].comment.empty(); ++end) {
        const bool apart =
            end > i && !lines_[end].continues && blank_line_between(lines_[end - 1].place, lines_[end].place);
        if (apart) break;
        widest = std::max(widest, length_in_characters(lines_[end].text));
      }
      for (std::size_t k = i; k < end; ++k) {
        lines_[k].comment.insert(0, widest - length_in_characters(lines_[k].text) + 2, ' ');
      }
      i = std::max(end, i + 1);
    }
  }

  std::vector<Line> lines_;
  std::string_view source_;
};

}  // namespace

std::string format(const SyntaxTree& tree, const SourceText& source) {
  Diagnostics diagnostics;
  const auto list = lex(source, diagnostics);
  MAUP_REQUIRE(list.has_value());
  std::vector<Line> lines;
  for (const StatementTokens& statement : split_statements(*list, source, diagnostics)) {
    const std::span<const Token> tokens(list->tokens);
    auto printed = with_primes(tokens.subspan(statement.begin, statement.end - statement.begin));
    for (Token& token : printed)
      token.field = token.kind == Token::Kind::Name && tree.declarations->kind(token.text) == Declarations::Kind::Field;
    add_lines(printed, lines);
  }
  MAUP_REQUIRE(!diagnostics.has_errors());
  return Layout(std::move(lines), tree.comments, source.text()).run();
}

}  // namespace maupertuis::syntax

#include "syntax/lexer.hpp"
#include "syntax/words.hpp"

#include <fmt/format.h>

/// Statements from lines: rule 10 of the language.
namespace maupertuis::syntax {
namespace {

class Splitter {
 public:
  Splitter(const TokenList& list, const SourceText& source, Diagnostics& diagnostics)
      : tokens_(list.tokens), source_(source), diagnostics_(diagnostics) {}

  std::vector<StatementTokens> run() {
    if (tokens_.empty()) return {};
    base_ = indent(tokens_.front());
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
      if (i == 0 || (tokens_[i].line_start && begins_statement(i))) begin_statement(i);
      track_brackets(i);
      if (tokens_[i].unreadable()) statements_.back().broken = true;
    }
    end_statement(tokens_.size());
    return std::move(statements_);
  }

 private:
  // The column of a token, tabs counting to multiples of 4.
  std::size_t indent(const Token& token) const {
    const std::string_view text = source_.text();
    std::size_t begin = token.span.begin;
    while (begin > 0 && text[begin - 1] != '\n') --begin;
    if (begin == 0 && text.substr(0, 3) == "\xEF\xBB\xBF") begin = 3;
    std::size_t column = 0;
    for (; begin < token.span.begin; ++begin) column = text[begin] == '\t' ? (column / 4 + 1) * 4 : column + 1;
    return column;
  }

  bool begins_statement(std::size_t i) {
    const bool indented = indent(tokens_[i]) > base_;
    const bool word = looks_like_statement(i);
    if (!open_.empty()) return word && !indented;
    if (indented && word) complain_about_indent(i);
    return !indented || word;
  }

  // A statement word at the start of a line. T, V, ... and `friction` of a contact also stand inside statements.
  bool looks_like_statement(std::size_t i) const {
    const Token& token = tokens_[i];
    if (token.kind != Token::Kind::Name || !is_statement_word(token.text)) return false;
    if (energy_of(token.text)) return i + 1 < tokens_.size() && (tokens_[i + 1].is("=") || tokens_[i + 1].is("+="));
    return !(token.is("friction") && tokens_[statements_.back().begin].is("contact"));
  }

  void complain_about_indent(std::size_t i) {
    const Span first = tokens_[statements_.back().begin].span;
    diagnostics_.error(
        "E0107", tokens_[i].span,
        fmt::format("this indented line begins with the statement word `{}`", tokens_[i].text),
        fmt::format("An indented line continues the statement of line {}.", source_.locate(first.begin).line),
        "Remove the indentation if it is a statement of its own.");
  }

  void track_brackets(std::size_t i) {
    const Token& token = tokens_[i];
    if (token.is("(") || token.is("[")) open_.push_back(i);
    if (!token.is(")") && !token.is("]")) return;
    const std::string_view wanted = token.is(")") ? "(" : "[";
    if (!open_.empty() && tokens_[open_.back()].is(wanted)) return open_.pop_back();
    if (statements_.back().broken) return;
    statements_.back().broken = true;
    diagnostics_.error("E0106", token.span, fmt::format("this `{}` closes no bracket", token.text),
                       open_.empty()
                           ? "No bracket is open here."
                           : fmt::format("The bracket that is open here is `{}`.", tokens_[open_.back()].text),
                       "Remove it, or write the opening bracket.");
  }

  void begin_statement(std::size_t i) {
    end_statement(i);
    statements_.push_back({i, i, false});
  }

  void end_statement(std::size_t i) {
    if (statements_.empty()) return;
    StatementTokens& statement = statements_.back();
    statement.end = i;
    if (!open_.empty() && !statement.broken) {
      statement.broken = true;
      diagnostics_.error("E0106", tokens_[open_.back()].span, "this bracket is never closed",
                         "Every bracket is closed before the next statement begins.",
                         fmt::format("Write the missing `{}`.", tokens_[open_.back()].is("(") ? ")" : "]"));
    }
    open_.clear();
  }

  const std::vector<Token>& tokens_;
  const SourceText& source_;
  Diagnostics& diagnostics_;
  std::vector<StatementTokens> statements_;
  std::vector<std::size_t> open_;  // token indices of the brackets that are open
  std::size_t base_ = 0;           // column of the first statement
};

}  // namespace

std::vector<StatementTokens> split_statements(const TokenList& list, const SourceText& source,
                                              Diagnostics& diagnostics) {
  return Splitter(list, source, diagnostics).run();
}

}  // namespace maupertuis::syntax

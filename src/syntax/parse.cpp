#include "syntax/declarations.hpp"
#include "syntax/lexer.hpp"
#include "syntax/lint_letters.hpp"
#include "syntax/statement_parser.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis::syntax {
namespace {

constexpr std::size_t kMostBrokenStatements = 1000;

void check_one_system(const SyntaxTree& tree, const SourceText& source, Diagnostics& diagnostics) {
  const Statement* first = nullptr;
  for (const Statement& statement : tree.statements) {
    if (!std::holds_alternative<SystemStatement>(statement.body)) continue;
    if (first) {
      diagnostics.error("E0124", statement.span, "a second system begins here",
                        fmt::format("The system of this file is named on line {}; one file holds one system.",
                                    source.locate(first->span.begin).line),
                        "Move it into a file of its own.");
      return;
    }
    first = &statement;
  }
}

}  // namespace

SyntaxTree parse(const SourceText& source, Diagnostics& diagnostics) {
  SyntaxTree tree;
  auto list = lex(source, diagnostics);
  if (!list) return tree;
  tree.comments = std::move(list->comments);
  const std::vector<StatementTokens> statements = split_statements(*list, source, diagnostics);
  if (statements.empty()) {
    diagnostics.error("E0109", std::nullopt, fmt::format("{} has no statement", source.name()),
                      "A model needs coordinates and energies.", "`maup new pendulum` writes a model to start from.");
    return tree;
  }
  tree.declarations = std::make_shared<const Declarations>(*list, statements);
  lint_letters(*list, statements, source, diagnostics);
  const ParseContext context{*list, source, *tree.declarations, diagnostics, nullptr, &tree.lost_names};
  std::size_t failures = 0;
  for (const StatementTokens& statement : statements) {
    try {
      if (statement.broken) throw Abandoned{};
      for (Statement& parsed : StatementParser(context, statement).run()) tree.statements.push_back(std::move(parsed));
    } catch (const Abandoned&) {
      for (Name& name : Declarations::lost_with(*list, statement)) tree.lost_names.push_back(std::move(name));
      if (++failures == kMostBrokenStatements) break;
    }
  }
  check_one_system(tree, source, diagnostics);
  return tree;
}

}  // namespace maupertuis::syntax

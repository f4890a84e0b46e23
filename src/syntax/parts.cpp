#include "syntax/lexer.hpp"
#include "syntax/statement_parser.hpp"

#include <fmt/format.h>

/// Parts of statements that stand in a text of their own beside a model.
namespace maupertuis::syntax {

template <class Part>
Part StatementParser::ended(Part part) {
  expect_end();
  flush_warnings();
  return part;
}

ExpressionPtr StatementParser::formula_alone() {
  next();
  return ended<ExpressionPtr>(formula());
}

ExpressionPtr StatementParser::quantity_alone() {
  next();
  return ended<ExpressionPtr>(quantity());
}

Equation StatementParser::equation_alone() {
  next();
  Equation equation;
  equation.left = formula();
  expect("=", "the left side of the equation");
  equation.right = quantity();
  return ended(std::move(equation));
}

// x = 4 t + 7, y = 3 t + 5
std::vector<Assignment> StatementParser::assignments_alone() {
  next();
  std::vector<Assignment> assignments;
  list([&] {
    Assignment one;
    one.variable = variable();
    expect("=", fmt::format("`{}`", text_of(*one.variable)));
    one.value = formula();
    assignments.push_back(std::move(one));
  });
  return ended(std::move(assignments));
}

ParamStatement StatementParser::parameters_alone() { return ended(std::get<ParamStatement>(param_statement())); }

StartStatement StatementParser::start_alone() { return ended(std::get<StartStatement>(start_statement())); }

// 10 s,   until P.y = 0,   until P.y = 0 within 60 s
RunStatement StatementParser::run_alone() {
  next();
  return ended(run_length());
}

SweepStatement StatementParser::sweep_alone() {
  next();
  return ended(sweep_values());
}

PathStatement StatementParser::path_alone() {
  next();
  return ended(path_ends());
}

namespace {

/// One statement, whatever its lines: a token that stands for its first words, and all that is written.
template <class Part>
std::optional<Part> parse_part(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics,
                               Part (StatementParser::*part)()) {
  if (!model.declarations) return std::nullopt;
  auto list = lex(text, diagnostics);
  if (!list) return std::nullopt;
  for (Token& token : list->tokens) token.line_start = false;
  Token opening;
  opening.kind = Token::Kind::Name;
  opening.span = {0, 0, text.id()};
  list->tokens.insert(list->tokens.begin(), opening);
  const std::vector<StatementTokens> statements = split_statements(*list, text, diagnostics);
  const ParseContext context{*list, text, *model.declarations, diagnostics};
  try {
    if (statements.front().broken) throw Abandoned{};
    return (StatementParser(context, statements.front()).*part)();
  } catch (const Abandoned&) {
    return std::nullopt;
  }
}

}  // namespace

using P = StatementParser;

ExpressionPtr parse_formula(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics) {
  return parse_part(text, model, diagnostics, &P::formula_alone).value_or(nullptr);
}

ExpressionPtr parse_quantity(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics) {
  return parse_part(text, model, diagnostics, &P::quantity_alone).value_or(nullptr);
}

std::optional<Equation> parse_equation(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics) {
  return parse_part(text, model, diagnostics, &P::equation_alone);
}

std::optional<std::vector<Assignment>> parse_assignments(const SourceText& text, const SyntaxTree& model,
                                                         Diagnostics& diagnostics) {
  return parse_part(text, model, diagnostics, &P::assignments_alone);
}

std::optional<ParamStatement> parse_parameters(const SourceText& text, const SyntaxTree& model,
                                               Diagnostics& diagnostics) {
  return parse_part(text, model, diagnostics, &P::parameters_alone);
}

std::optional<StartStatement> parse_start(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics) {
  return parse_part(text, model, diagnostics, &P::start_alone);
}

std::optional<RunStatement> parse_run(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics) {
  return parse_part(text, model, diagnostics, &P::run_alone);
}

std::optional<SweepStatement> parse_sweep(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics) {
  return parse_part(text, model, diagnostics, &P::sweep_alone);
}

std::optional<PathStatement> parse_path(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics) {
  return parse_part(text, model, diagnostics, &P::path_alone);
}

}  // namespace maupertuis::syntax

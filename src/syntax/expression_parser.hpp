#pragma once
#include <maupertuis/diagnostic.hpp>

#include "syntax/declarations.hpp"
#include "syntax/token.hpp"
#include "syntax/words.hpp"

#include <initializer_list>
#include <string>
#include <vector>

namespace maupertuis::syntax {

/// Thrown to leave a statement after its mistake was reported; never leaves `parse`.
struct Abandoned {};

/// What all statements of a text share while they are parsed.
struct ParseContext {
  const TokenList& list;
  const SourceText& source;
  const Declarations& declarations;
  Diagnostics& diagnostics;
  /// What was read as units, where someone wants to know.
  std::vector<UnitExpression>* units = nullptr;
  /// Names whose statements were lost to a mistake that is told, before the statement that is read.
  const std::vector<Name>* lost = nullptr;
};

/// Recursive descent over the tokens of one statement: the cursor, formulas, and quantities.
///
///     sum      = product { ("+" | "-") product }
///     product  = ["-"] power { ("*" | "/" | "·" | "×" | nothing) power }     left-associative, one precedence
///     power    = postfix [ "^" power ]
///     postfix  = primary { "'" | "." name }
class ExpressionParser {
 protected:
  using Node = std::shared_ptr<Expression>;  // mutable until the statement is complete

  ExpressionParser(const ParseContext& context, const StatementTokens& statement);

  // ------------------------------------------------------------------------------------------------ cursor
  const Token& peek(std::size_t ahead = 0) const;
  const Token& previous() const { return context_.list.tokens[index_ - 1]; }
  bool at_end() const { return index_ >= end_; }
  const Token& next();
  bool accept(std::string_view sign_or_word);
  const Token& expect(std::string_view sign_or_word, std::string_view after);
  void expect_end();
  /// E0105 where `9,81` stands at the cursor: a decimal comma.
  void refuse_decimal_comma();
  void refuse_time_of_derivative(const Expression& rate);
  bool opens_a_list() const;
  static std::string describe(const Token& token);
  static std::optional<Operator> product_operator(const Token& token);
  static bool is_constant(const Expression& e);
  [[noreturn]] void fail(std::string code, Span span, std::string message, std::string reason = {},
                         std::string help = {});
  [[noreturn]] void fail_expected(std::string_view what, std::string help = {});
  void warn(std::string code, Span span, std::string message, std::string reason, std::string help);
  void flush_warnings();

  // ------------------------------------------------------------------------------------------------- words
  /// A name that this statement declares; reserved words are refused.
  Name new_name(std::string_view what);
  /// A name that is used.
  Name used_name(std::string_view what, std::string help = {});

  // ---------------------------------------------------------------------------------------------- formulas
  Node formula() { return sum(); }
  Node condition();
  /// A formula in a place for vectors, points: one name or bracket (`spring A - B`).
  Node operand(std::string_view what);
  /// Name or Member with primes: the left side of `start`.
  Node variable();
  /// The rest of `reaction rod`, whose word has been read.
  Node bare_reaction(const Token& word);

  // -------------------------------------------------------------------------------------------- quantities
  /// A quantity place: `-10 deg`, `10 pi rad/s`, `(1, 2) m`, `(1 m, 2 m)`, or a formula.
  Node quantity();
  UnitExpression bracketed_unit();
  std::optional<UnitExpression> units();
  /// Tells who wants to know that this was read as a unit.
  void note(const UnitExpression& unit) const;

  /// What is written from the token `ahead` to the next comma outside brackets, or to the end of the statement.
  std::string item_text(std::size_t ahead = 0) const;
  std::string text_of(Span span) const { return std::string(context_.source.slice(span)); }
  std::string text_of(const Expression& expression) const { return text_of(expression.span); }

  const ParseContext& context_;
  std::size_t begin_, index_, end_;

 private:
  Node sum();
  Node signed_product();
  Node product();
  Node signed_power();
  Node power();
  Node exponent();
  Node postfix();
  Node primary();
  Node number();
  Node name();
  Node value_at_place(const Token& field);
  /// `of_quantities`: its components are quantity places.
  Node bracket(bool of_quantities = false);
  Node with_bracketed_unit(Node value);
  Node call(const Function& function);
  Node bare_argument(const Token& function, const Node& exponent);
  Node arguments_of(const Token& name, const Function& function);
  Node piecewise(const Token& name);
  Node disjunction();
  Node conjunction();
  Node comparison();
  std::string function_exponent(const Token& function, Node& exponent);

  void check_number(const Token& token);
  void check_application(const Token& name);
  [[noreturn]] void unknown_before_bracket(const Token& name);
  void refuse_brackets_of_function(const Token& name);
  std::string text_to_closing_bracket() const;
  bool is_momentum(std::string_view name) const;
  void lint_product(const Expression& left, Operator op, const Expression& right);
  void lint_power(const Expression& base, const Expression& exponent);
  bool is_meant_in_argument(const Expression& argument, const Expression& right) const;
  void lint_sum(const Expression& left, const Expression& right);

  Node quantity_or_null();
  std::size_t tokens_of_number(std::size_t ahead) const;
  Node constant();
  Node constant_power();
  [[noreturn]] void refuse_ambiguous_slash();
  bool ends_quantity(const Token& token) const;
  bool unit_factors(UnitExpression& unit, int sign);
  bool unit_factor(UnitExpression& unit, int sign);
  bool unit_exponent(UnitExpression::Factor& factor);

  Node make(Expression::Kind kind, Span span, std::initializer_list<Node> arguments = {});
  Node finish(Node node);
  Node binary(Operator op, Node left, Node right);
  Node negate(const Token& sign, Node operand);

  struct Nesting {
    explicit Nesting(ExpressionParser& parser);
    ~Nesting() { --parser.nesting_; }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;
    ExpressionParser& parser;
  };

  Token end_token_;
  std::vector<Diagnostic> warnings_;
  std::optional<Span> ambiguous_slash_;  // of the units read last: `J/kg K`
  int nesting_ = 0;
  bool in_condition_ = false;
};

}  // namespace maupertuis::syntax

#pragma once
#include <maupertuis/diagnostic.hpp>
#include <maupertuis/syntax_tree.hpp>

#include <string>

namespace maupertuis::syntax::test {

struct Parsed {
  SourceText source;
  Diagnostics diagnostics;
  SyntaxTree tree;

  explicit Parsed(std::string text) : source("test.lag", std::move(text)), tree(parse(source, diagnostics)) {}
  bool fine() const { return diagnostics.empty(); }
  /// All messages, for a test that fails.
  std::string messages() const { return render(diagnostics, source); }
  /// The codes in the order of the text: "E0105 W0101".
  std::string codes() {
    diagnostics.sort_by_place();
    std::string all;
    for (const Diagnostic& d : diagnostics.items()) all += (all.empty() ? "" : " ") + d.code;
    return all;
  }
  std::string at(std::size_t i) const {
    return diagnostics.items()[i].span ? std::string(source.slice(*diagnostics.items()[i].span)) : "";
  }
};

/// The expression of a single `let`.
inline ExpressionPtr tree_of(const std::string& text, const std::string& declarations = "") {
  Parsed parsed(declarations + "let result = " + text + "\n");
  if (parsed.tree.statements.empty()) return nullptr;
  return std::get<LetStatement>(parsed.tree.statements.back().body).items.at(0).value;
}

/// The structure of an expression with all brackets: (- (* m g) (cos θ)); the signs of products without a sign are _.
inline std::string shape(const Expression& e) {
  const std::string primes(static_cast<std::size_t>(e.primes), '\'');
  const auto all = [&](std::string head) {
    for (const ExpressionPtr& argument : e.arguments) head += " " + shape(*argument);
    return "(" + head + ")";
  };
  static const char* const operators[] = {"+",   "-", "*",  "_", "/",  "·",   "×", "^",
                                          "neg", "<", "<=", ">", ">=", "and", "or"};
  switch (e.kind) {
    case Expression::Kind::Number:
      return e.text;
    case Expression::Kind::Name:
      return e.text + primes;
    case Expression::Kind::Member:
      return shape(*e.arguments[0]) + "." + e.text + primes;
    case Expression::Kind::Vector:
      return all("vector");
    case Expression::Kind::TimeDerivative:
      return all("dt" + primes);
    case Expression::Kind::Piecewise:
    case Expression::Kind::Call:
      return all(e.text);
    case Expression::Kind::Binary:
    case Expression::Kind::Unary:
      return all(operators[static_cast<int>(e.op)]);
    case Expression::Kind::Quantity:
      break;
  }
  std::string units;
  for (const auto& factor : e.unit->factors) {
    units += " " + factor.word + ":" + std::to_string(factor.exponent_numerator);
    if (factor.exponent_denominator != 1) units += "/" + std::to_string(factor.exponent_denominator);
  }
  return "[" + shape(*e.arguments[0]) + units + "]";
}

/// The shape of a `let` formula, or the codes of what is wrong with it.
inline std::string shape_of(const std::string& text, const std::string& declarations = "") {
  Parsed parsed(declarations + "let result = " + text + "\n");
  if (!parsed.diagnostics.empty()) return parsed.codes();
  return shape(*std::get<LetStatement>(parsed.tree.statements.back().body).items.at(0).value);
}

/// The shape of a quantity place.
inline std::string quantity_of(const std::string& text, const std::string& declarations = "") {
  Parsed parsed(declarations + "param result = " + text + "\n");
  if (!parsed.diagnostics.empty()) return parsed.codes();
  return shape(*std::get<ParamStatement>(parsed.tree.statements.back().body).items.at(0).value);
}

inline std::string formatted(const std::string& text) {
  Parsed parsed(text);
  return parsed.diagnostics.has_errors() ? parsed.messages() : format(parsed.tree, parsed.source);
}

}  // namespace maupertuis::syntax::test

#include <maupertuis/verification.hpp>

#include <algorithm>

namespace maupertuis {

std::optional<Verification> verify_errors(const syntax::SyntaxTree& tree, const SourceText& source,
                                          const Diagnostics& found) {
  Verification verification;
  for (const syntax::Statement& statement : tree.statements) {
    const auto* expect = std::get_if<syntax::ExpectStatement>(&statement.body);
    const auto* error = expect ? std::get_if<syntax::expectation::Error>(&expect->kind) : nullptr;
    if (!error) continue;
    // `expect contradiction`: no motion obeys the Lagrangian.
    const std::string code = error->code.text == "contradiction" ? "E0623" : error->code.text;
    ExpectationResult result;
    result.line = source.locate(statement.span.begin).line;
    result.text = std::string(source.slice(statement.span));
    result.expected = code;
    result.passed =
        std::any_of(found.items().begin(), found.items().end(), [&](const Diagnostic& d) { return d.code == code; });
    for (const Diagnostic& d : found.items()) result.actual += (result.actual.empty() ? "" : ", ") + d.code;
    if (result.actual.empty()) result.actual = "no error";
    if (!result.passed) result.message = "The model does not give this error.";
    verification.results.push_back(std::move(result));
  }
  if (verification.results.empty()) return std::nullopt;
  return verification;
}

}  // namespace maupertuis

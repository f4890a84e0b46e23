// Texts as they are while one types: every service answers on every one of them, without a crash and within bounds.
#include "../under_sanitizers.hpp"
#include "support.hpp"

#include <doctest/doctest.h>

#include <random>

namespace {
using namespace language_test;

/// What every answer has to obey: places lie in the text, edits too.
void check_span(Span span, const std::string& text) {
  if (span.begin > span.end || span.end > text.size()) FAIL_CHECK("a span outside of the text");
}

/// The services that need no model.
void ask_fast(Document& asked, const std::string& text, std::uint32_t place) {
  std::uint32_t end = 0;
  for (const SemanticToken& token : semantic_tokens(asked)) {
    check_span(token.span, text);
    if (token.span.begin < end) FAIL_CHECK("tokens overlap");
    end = token.span.end;
  }
  for (const Symbol& symbol : symbols(asked)) check_span(symbol.span, text), check_span(symbol.name_span, text);
  for (const Span& span : folding(asked)) check_span(span, text);
  for (const TextEdit& edit : formatting(asked).edits) check_span(edit.span, text);
  signature(asked, place);
}

void ask_all(const std::string& text, std::uint32_t place) {
  Document asked = document(text);
  ask_fast(asked, text, place);
  if (const auto found = hover(asked, place)) check_span(found->span, text);
  check_span(complete(asked, place).replaced, text);
  if (const auto found = definition(asked, place)) check_span(*found, text);
  for (const Span& span : references(asked, place)) check_span(span, text);
  for (const Diagnostic& d : asked.diagnostics().items())
    if (d.span) check_span(*d.span, text);
}

}  // namespace

TEST_CASE("models of the gallery, typed character by character") {
  std::size_t models = 0;
  for (const auto& path : models_in("models")) {
    const std::string text = read_file(path);
    if (text.size() > 900) continue;
    CAPTURE(path.filename().string());
    ++models;
    for (std::uint32_t i = 0; i <= text.size(); i += under_sanitizers ? 4 : 1) {
      const std::string typed = text.substr(0, i);
      CAPTURE(i);
      Document asked = document(typed);
      ask_fast(asked, typed, i);
      if (i % 41 == 0) ask_all(typed, i);
    }
  }
  CHECK(models > 10);
}

TEST_CASE("models of the gallery without one of their lines, asked at random places") {
  std::mt19937 random(1744);
  for (const auto& path : models_in("models")) {
    const std::string text = read_file(path);
    if (text.size() > 900) continue;
    CAPTURE(path.filename().string());
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
      std::string left = text;
      left.erase(begin, end - begin);
      ask_all(left, static_cast<std::uint32_t>(random() % (left.size() + 1)));
      begin = end;
    }
  }
}

TEST_CASE("texts that are none") {
  for (const std::string& text : {std::string(), std::string("\xff\xfe"), std::string("\0\0", 2), std::string("θ"),
                                  std::string("'"), std::string("."), std::string("B."), std::string("param"),
                                  std::string("param\r\n"), std::string("((((((((("), std::string("system \""),
                                  std::string("\xEF\xBB\xBF"
                                              "coord"),
                                  std::string("coord θ̇̈ : \n\r\r"), std::string("√√√√x"), std::string(3000, '('),
                                  std::string("let a = ") + std::string(5000, 'a')})
    for (std::uint32_t i = 0; i <= text.size() + 1; i += 1 + static_cast<std::uint32_t>(text.size() / 50))
      ask_all(text, i);
}

TEST_CASE("renames and fixes of half a model") {
  const std::string text = pendulum;
  for (std::uint32_t i = 0; i < text.size(); i += 3) {
    const std::string typed = text.substr(0, i);
    Document asked = document(typed);
    for (const TextEdit& edit : rename(asked, i / 2, "other").edits) check_span(edit.span, typed);
    for (const Fix& fix : fixes(asked, asked.source().whole()))
      for (const TextEdit& edit : fix.edits) check_span(edit.span, typed);
  }
}

#include <maupertuis/language_services.hpp>
#include <maupertuis/language_words.hpp>
#include <maupertuis/units.hpp>

#include "language_services/roles.hpp"
#include "language_services/units_of_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

/// Declarations, references and renames.
namespace maupertuis::language {
namespace {

const Declared* declared_at(Document& document, std::uint32_t offset) {
  const Roles& roles = document.roles();
  const std::size_t token = roles.token_at(offset);
  if (token == nowhere) return nullptr;
  return roles.of(token) == WordRole::Unit ? name_read(document, token) : roles.declared(token);
}

/// The tokens that stand for it, its declaration among them.
std::vector<std::size_t> uses_of(const Declared& declared, Document& document) {
  const Roles& roles = document.roles();
  std::vector<std::size_t> uses;
  for (std::size_t i = 0; i < document.reading().tokens.size(); ++i) {
    const bool named = roles.declared(i) == &declared;
    const bool as_word = !named && roles.ambiguous(i) && document.reading().tokens[i].text == declared.name;
    if (named || (as_word && name_read(document, i) == &declared)) uses.push_back(i);
  }
  return uses;
}

/// The same kind of mistakes in the same number: what is left of diagnostics when places and names are taken away.
std::multiset<std::string> codes_of(const Diagnostics& diagnostics) {
  std::multiset<std::string> codes;
  for (const Diagnostic& d : diagnostics.items()) codes.insert(d.code);
  return codes;
}

bool is_used(Document& document, const std::string& name) {
  const auto& tokens = document.reading().tokens;
  return std::any_of(tokens.begin(), tokens.end(), [&](const syntax::TextToken& t) {
    return t.kind == syntax::TextToken::Kind::Name && t.text == name;
  });
}

/// The one name that a text is, in canonical spelling; empty where it is no name.
std::string name_in(std::string_view text) {
  const SourceText alone("", std::string(text));
  const syntax::TextReading reading = syntax::read_text(alone);
  const bool one = reading.tokens.size() == 1 && reading.comments.empty() &&
                   reading.tokens[0].kind == syntax::TextToken::Kind::Name && reading.tokens[0].span == alone.whole();
  return one ? reading.tokens[0].text : std::string();
}

/// Why this cannot be the new name of `old`; empty where nothing speaks against it.
std::string refusal_of(Document& document, const Declared& old, const std::string& name, std::string_view typed) {
  if (name.empty())
    return fmt::format("`{}` is no name: a name is a letter, followed by letters, digits and _.", typed);
  if (syntax::find_function(name)) return fmt::format("`{}` is a function of the language.", name);
  if (syntax::is_clause_word(name))
    return fmt::format("`{}` is a word of the language that separates the parts of a statement.", name);
  if (name == "pi" || name == "t" || name == "O") return fmt::format("`{}` has a meaning of its own.", name);
  const Declared* other = document.roles().find(name);
  if (other && other != &old)
    return fmt::format("`{}` is taken: a {} has this name on line {}.", name, word_of(other->kind),
                       document.source().locate(other->span.begin).line);
  return {};
}

/// The edit of one use; derivatives that were typed as dots over the letter stay as primes.
TextEdit edit_of(Document& document, std::size_t token, std::string_view name) {
  const auto& tokens = document.reading().tokens;
  std::string text =
      std::string(document.roles().before(token)) + std::string(name) + std::string(document.roles().after(token));
  for (std::size_t i = token + 1; i < tokens.size() && tokens[i].span == tokens[token].span; ++i)
    text += tokens[i].text;
  return {tokens[token].span, std::move(text)};
}

}  // namespace

std::optional<Span> definition(Document& document, std::uint32_t offset) {
  const Declared* declared = declared_at(document, offset);
  return declared ? std::optional(declared->span) : std::nullopt;
}

std::vector<Span> references(Document& document, std::uint32_t offset, bool with_declaration) {
  std::vector<Span> spans;
  const Declared* declared = declared_at(document, offset);
  if (!declared) return spans;
  for (const std::size_t token : uses_of(*declared, document))
    if (with_declaration || token != declared->token) spans.push_back(document.reading().tokens[token].span);
  return spans;
}

std::optional<Span> renamed_at(Document& document, std::uint32_t offset) {
  if (!declared_at(document, offset)) return std::nullopt;
  return document.reading().tokens[document.roles().token_at(offset)].span;
}

Rename rename(Document& document, std::uint32_t offset, std::string_view typed) {
  const Declared* old = declared_at(document, offset);
  if (!old) return {{}, "There is no name of this model here."};
  const std::string name = name_in(typed);
  std::string refusal = refusal_of(document, *old, name, typed);
  if (!refusal.empty()) return {{}, std::move(refusal)};
  if (name == old->name) return {};
  if (is_used(document, name)) return {{}, fmt::format("`{}` stands in the text already, with another meaning.", name)};
  const auto& tokens = document.reading().tokens;
  for (std::size_t i = 0; i < tokens.size() && !document.model(); ++i)
    if (document.roles().ambiguous(i) && tokens[i].text == old->name)
      return {{},
              fmt::format("On line {} `{}` may be the unit or the name: mend the mistakes of the text first.",
                          document.source().locate(tokens[i].span.begin).line, old->name)};
  Rename out;
  for (const std::size_t token : uses_of(*old, document)) out.edits.push_back(edit_of(document, token, name));
  Document renamed(SourceText(document.source().name(), edited(document.source().text(), out.edits)),
                   document.interrupt());
  if (codes_of(renamed.diagnostics()) != codes_of(document.diagnostics()))
    return {{}, fmt::format("With the name `{}` other lines would be read otherwise.", name)};
  return out;
}

std::string edited(std::string_view text, std::vector<TextEdit> edits) {
  std::sort(edits.begin(), edits.end(),
            [](const TextEdit& a, const TextEdit& b) { return a.span.begin < b.span.begin; });
  std::string out;
  std::size_t at = 0;
  for (const TextEdit& edit : edits) {
    const std::size_t begin = std::clamp<std::size_t>(edit.span.begin, at, text.size());
    out += text.substr(at, begin - at);
    out += edit.text;
    at = std::clamp<std::size_t>(edit.span.end, begin, text.size());
  }
  out += text.substr(at);
  return out;
}

}  // namespace maupertuis::language

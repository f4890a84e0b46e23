#include <maupertuis/language_services.hpp>
#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/units.hpp>

#include "language_services/names_text.hpp"
#include "language_services/roles.hpp"
#include "language_services/units_of_text.hpp"
#include "language_services/words_help.hpp"

#include <fmt/format.h>

namespace maupertuis::language {
namespace {

std::string code_block(const std::string& text) { return "```lag\n" + text + "\n```"; }

std::string with_paragraph(std::string text, const std::string& paragraph) {
  return paragraph.empty() ? text : std::move(text) + "\n\n" + paragraph;
}

std::string about_name(const Declared& declared, Document& document) {
  const std::uint32_t line = document.source().locate(declared.span.begin).line;
  std::string out = code_block(item_of(declared, document));
  const std::string facts = facts_of(declared, document);
  out = with_paragraph(std::move(out), fmt::format("{} `{}`{}", word_of(declared.kind), declared.name,
                                                   facts.empty() ? "" : ": " + facts));
  out = with_paragraph(std::move(out), comment_of(declared, document));
  return with_paragraph(std::move(out), fmt::format("Declared on line {}.", line));
}

std::string about_word(const WordHelp& word) {
  return with_paragraph(code_block(std::string(word.form)), std::string(word.help));
}

std::string about_function(const FunctionHelp& function) {
  return with_paragraph(code_block(fmt::format("{}({})", function.name, function.parameters)),
                        std::string(function.help));
}

/// rpm: angular velocity, 1 rpm = 0.10472 rad/s
std::string about_unit(const std::string& word) {
  const auto unit = find_unit(word);
  if (!unit) {
    const AmbiguousUnit* two = find_ambiguous_unit(word);
    return two ? fmt::format("`{}` is {}. Write {}.", word, two->meanings, two->instead) : std::string();
  }
  const std::string name = physical_name(unit->dimension);
  const std::string si = to_string(unit->dimension);
  return fmt::format("unit `{}`{}: 1 {} = {} {} in SI", word, name.empty() ? "" : " of " + name, word,
                     short_number(si_value(*unit)), si == "1" ? "" : si);
}

std::string about_predefined(const std::string& word) {
  if (word == "t") return "the time `t`";
  if (word == "pi") return "the number π = 3.14159…";
  return "the origin `O`";
}

std::string about_member(const std::string& member) {
  if (member == "ω") return "the angular velocity, on the axes of the body";
  if (member == "ω_world") return "the angular velocity, on the axes of the world";
  if (member.size() == 2 && member[0] == 'q') return fmt::format("component {} of the unit quaternion", member[1]);
  if (member == "x" || member == "y" || member == "z") return fmt::format("the component along {}", member);
  return {};
}

std::string about_token(std::size_t i, Document& document) {
  const syntax::TextReading& reading = document.reading();
  const Roles& roles = document.roles();
  const std::string& text = reading.tokens[i].text;
  const std::size_t first = reading.statements.empty() ? i : reading.statements[roles.statement_of(i)].begin;
  switch (roles.of(i)) {
    case WordRole::StatementWord:
      if (const WordHelp* word = find_statement_word(text)) return about_word(*word);
      return {};
    case WordRole::Word:
      if (const WordHelp* word = find_word_in(text, reading.tokens[first].text)) return about_word(*word);
      return {};
    case WordRole::Function:
      if (const FunctionHelp* function = find_function_help(text)) return about_function(*function);
      return {};
    case WordRole::Predefined:
      return about_predefined(text);
    case WordRole::Unit:
      if (const Declared* name = name_read(document, i)) return about_name(*name, document);
      return about_unit(text);
    case WordRole::Member:
      return about_member(text);
    case WordRole::Name:
    case WordRole::Declaration:
      return about_name(*roles.declared(i), document);
    case WordRole::Unknown:
    case WordRole::Other:
      return {};
  }
  return {};
}

/// What the codes of the messages at this place mean.
std::string about_mistakes(std::uint32_t offset, Document& document) {
  std::string out;
  for (const Diagnostic& d : document.diagnostics().items()) {
    if (!d.span || d.span->source != document.source().id() || offset < d.span->begin || offset > d.span->end) continue;
    const CodeEntry* entry = find_code(d.code);
    if (entry)
      out =
          with_paragraph(std::move(out), fmt::format("**{}** {}\n\n{}", entry->code, entry->title, entry->explanation));
  }
  return out;
}

}  // namespace

std::optional<Hover> hover(Document& document, std::uint32_t offset) {
  const std::size_t token = document.roles().token_at(offset);
  std::string text = token == nowhere ? std::string() : about_token(token, document);
  const std::string mistakes = about_mistakes(offset, document);
  if (!mistakes.empty()) text = text.empty() ? mistakes : text + "\n\n---\n\n" + mistakes;
  if (text.empty()) return std::nullopt;
  const Span span = token == nowhere ? Span{offset, offset, 0} : document.reading().tokens[token].span;
  return Hover{span, std::move(text)};
}

}  // namespace maupertuis::language

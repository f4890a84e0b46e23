#include "language_services/roles.hpp"

#include <maupertuis/language_words.hpp>
#include <maupertuis/units.hpp>

#include "language_services/words_help.hpp"

#include <algorithm>

namespace maupertuis::language {
namespace {

using syntax::TextToken;

NameKind kind_of_statement(std::string_view word) {
  constexpr struct {
    std::string_view word;
    NameKind kind;
  } kinds[] = {{"system", NameKind::System},
               {"coord", NameKind::Coordinate},
               {"let", NameKind::Definition},
               {"rates", NameKind::Rate},
               {"input", NameKind::Input},
               {"frame", NameKind::Frame},
               {"point", NameKind::Point},
               {"body", NameKind::Body},
               {"constraint", NameKind::Constraint},
               {"contact", NameKind::Contact},
               {"event", NameKind::Event},
               {"reaction", NameKind::Reaction},
               {"independent", NameKind::Independent},
               {"field", NameKind::Field}};
  for (const auto& entry : kinds)
    if (entry.word == word) return entry.kind;
  return NameKind::Parameter;
}

}  // namespace

std::string_view word_of(NameKind kind) {
  switch (kind) {
    case NameKind::System:
      return "system";
    case NameKind::Parameter:
      return "parameter";
    case NameKind::Coordinate:
      return "coordinate";
    case NameKind::Definition:
      return "definition";
    case NameKind::Rate:
      return "rate (quasi-velocity)";
    case NameKind::Input:
      return "input";
    case NameKind::Frame:
      return "frame";
    case NameKind::Point:
      return "point";
    case NameKind::Body:
      return "body";
    case NameKind::Constraint:
      return "constraint";
    case NameKind::Contact:
      return "contact";
    case NameKind::Event:
      return "event";
    case NameKind::Reaction:
      return "reaction";
    case NameKind::Field:
      return "field";
    case NameKind::Space:
      return "space variable";
    case NameKind::Independent:
      return "independent variable";
  }
  return "name";
}

Roles::Roles(const syntax::TextReading& reading) : reading_(reading), roles_(reading.tokens.size()) {
  for (std::size_t s = 0; s < reading.statements.size(); ++s) declare(s);
  for (std::size_t s = 0; s < reading.statements.size(); ++s)
    for (std::size_t i = reading.statements[s].begin; i < reading.statements[s].end; ++i) {
      roles_[i].statement = s;
      classify(i, reading.statements[s].begin);
    }
}

void Roles::declare(std::size_t statement) {
  const syntax::TextStatement& s = reading_.statements[statement];
  const std::string& word = reading_.tokens[s.begin].text;
  dimensionless_ = dimensionless_ || word == "dimensionless";
  bool in_variables = false;
  std::size_t i = s.begin;
  for (const syntax::Name& name : s.declares) {
    while (i < s.end && reading_.tokens[i].span.begin < name.span.begin) {
      const TextToken& token = reading_.tokens[i++];
      if (word == "field" && (token.is("(") || token.is(")"))) in_variables = token.is("(");
    }
    if (i == s.end) return;
    const NameKind kind = in_variables ? NameKind::Space : kind_of_statement(word);
    auto& table = kind == NameKind::Event ? events_ : by_name_;
    if (kind != NameKind::System && !table.emplace(name.text, names_.size()).second) continue;
    roles_[i].name = names_.size();
    roles_[i].role = WordRole::Declaration;
    names_.push_back({name.text, kind, name.span, i, statement});
  }
}

// The 2 of `2 m` and the m of `2 m s^-1`, in a statement that was not read to its end.
bool Roles::follows_quantity(std::size_t token, std::size_t first) const {
  for (std::size_t i = token; i > first;) {
    const TextToken& before = reading_.tokens[--i];
    if (before.kind == TextToken::Kind::Number)
      return i == first || !reading_.tokens[i - 1].is("^") || i < 3 || roles_[i - 2].role == WordRole::Unit;
    if (roles_[i].role == WordRole::Unit) return true;
    if (!before.is("/") && !before.is("*") && !before.is("·")) return false;
  }
  return false;
}

bool Roles::is_event(std::size_t token, std::size_t first) const {
  const bool test = reading_.tokens[first].is("expect") || reading_.tokens[first].is("claim");
  return test && token > first && reading_.tokens[token - 1].is("event");
}

std::size_t Roles::name_index(std::string_view name) const {
  const auto found = by_name_.find(std::string(name));
  return found == by_name_.end() ? nowhere : found->second;
}

const Declared* Roles::find(std::string_view name) const {
  const std::size_t index = name_index(name);
  return index == nowhere ? nullptr : &names_[index];
}

// p_θ of a coordinate, λ_rod of a constraint, u_x and u_t of a field.
bool Roles::is_made_from_name(std::size_t token) {
  const std::string& text = reading_.tokens[token].text;
  Entry& entry = roles_[token];
  const auto set = [&](std::size_t name, std::size_t before, std::size_t after) {
    entry.role = WordRole::Name;
    entry.name = name;
    entry.before = static_cast<std::uint16_t>(before);
    entry.after = static_cast<std::uint16_t>(after);
    return true;
  };
  for (const std::string_view prefix : {std::string_view("p_"), std::string_view("λ_")}) {
    if (text.compare(0, prefix.size(), prefix) != 0) continue;
    const std::size_t name = name_index(std::string_view(text).substr(prefix.size()));
    const NameKind wanted = prefix == "p_" ? NameKind::Coordinate : NameKind::Constraint;
    if (name != nowhere && names_[name].kind == wanted) return set(name, prefix.size(), 0);
  }
  const std::size_t underscore = text.find('_');
  if (underscore == std::string::npos || underscore == 0) return false;
  const std::size_t name = name_index(std::string_view(text).substr(0, underscore));
  return name != nowhere && names_[name].kind == NameKind::Field && set(name, 0, text.size() - underscore);
}

void Roles::classify(std::size_t i, std::size_t first) {
  const TextToken& token = reading_.tokens[i];
  Entry& entry = roles_[i];
  if (token.kind != TextToken::Kind::Name || entry.role == WordRole::Declaration) return;
  const std::string& statement = reading_.tokens[first].text;
  const std::size_t name = name_index(token.text);
  if (i == first && syntax::is_statement_word(token.text)) {
    entry.role = WordRole::StatementWord;
  } else if (i > first && reading_.tokens[i - 1].is(".")) {
    entry.role = WordRole::Member;
  } else if (is_event(i, first)) {
    const auto event = events_.find(token.text);
    entry.name = event != events_.end() ? event->second : name;
    entry.role = entry.name == nowhere ? WordRole::Unknown : WordRole::Name;
  } else if (token.unit && (name == nowhere || find_unit(token.text) || token.bracketed_unit)) {
    entry.role = WordRole::Unit;
    entry.ambiguous = name != nowhere && !token.bracketed_unit && !dimensionless_ && statement != "param";
    if (name != nowhere && dimensionless_ && !token.bracketed_unit) entry.role = WordRole::Name, entry.name = name;
  } else if (syntax::find_function(token.text)) {
    const WordHelp* word = find_word_in(token.text, statement);  // draw reaction rod; method … step
    entry.role = word && !(i + 1 < reading_.tokens.size() && reading_.tokens[i + 1].is("(")) ? WordRole::Word
                                                                                             : WordRole::Function;
  } else if (syntax::is_clause_word(token.text)) {
    entry.role = WordRole::Word;
  } else if (name != nowhere) {
    entry.role = WordRole::Name;
    entry.name = name;
  } else if (syntax::is_predefined(token.text)) {
    entry.role = WordRole::Predefined;
  } else if (find_word_in(token.text, statement)) {
    entry.role = WordRole::Word;
  } else if (!is_made_from_name(i)) {
    entry.role = follows_quantity(i, first) && find_unit(token.text) ? WordRole::Unit : WordRole::Unknown;
  }
}

const Declared* Roles::declared(std::size_t token) const {
  return roles_[token].name == nowhere ? nullptr : &names_[roles_[token].name];
}

std::string_view Roles::before(std::size_t token) const {
  return std::string_view(reading_.tokens[token].text).substr(0, roles_[token].before);
}

std::string_view Roles::after(std::size_t token) const {
  const std::string_view text = reading_.tokens[token].text;
  return text.substr(text.size() - roles_[token].after);
}

std::size_t Roles::token_at(std::uint32_t offset) const {
  const auto& tokens = reading_.tokens;
  const auto after = std::upper_bound(tokens.begin(), tokens.end(), offset,
                                      [](std::uint32_t place, const TextToken& t) { return place < t.span.begin; });
  std::size_t i = static_cast<std::size_t>(after - tokens.begin());
  if (i == 0) return nowhere;
  // Of tokens with one place, θ and ' of θ̇, the first.
  for (--i; i > 0 && tokens[i - 1].span.begin == tokens[i].span.begin;) --i;
  if (tokens[i].span.end > offset) {
    const bool better = tokens[i].span.begin == offset && tokens[i].kind != TextToken::Kind::Name && i > 0 &&
                        tokens[i - 1].span.end == offset && tokens[i - 1].kind == TextToken::Kind::Name;
    if (!better) return i;
    --i;
  }
  if (tokens[i].span.end < offset) return nowhere;
  for (; i > 0 && tokens[i - 1].span.begin == tokens[i].span.begin;) --i;
  return i;
}

}  // namespace maupertuis::language

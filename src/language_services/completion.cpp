#include <maupertuis/language_services.hpp>
#include <maupertuis/language_words.hpp>
#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/units.hpp>

#include "language_services/names_text.hpp"
#include "language_services/roles.hpp"
#include "language_services/words_help.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace maupertuis::language {
namespace {

using syntax::TextToken;

/// Where the cursor is: the statement, the tokens of it before the word that is being typed, and that word.
struct Place {
  std::size_t statement = nowhere;  // nowhere: a new statement begins here
  std::size_t before = nowhere;     // the last token before the word; nowhere: none in this statement
  Span word;                        // empty where no word is being typed
  bool in_text = false;             // in a comment or a text in quotes
  std::string statement_word;
};

bool is_word_byte(char c) {
  const auto b = static_cast<unsigned char>(c);
  return b >= 0x80 || (b >= '0' && b <= '9') || (b >= 'a' && b <= 'z') || (b >= 'A' && b <= 'Z') || b == '_';
}

bool only_blanks_before(std::string_view text, std::uint32_t offset) {
  while (offset > 0 && (text[offset - 1] == ' ' || text[offset - 1] == '\t')) --offset;
  return offset == 0 || text[offset - 1] == '\n' || text[offset - 1] == '\r';
}

bool is_indented(std::string_view text, std::uint32_t offset) {
  return offset > 0 && (text[offset - 1] == ' ' || text[offset - 1] == '\t');
}

/// The word that touches the offset, as the text has it: it may be no token yet.
Span word_around(std::string_view text, std::uint32_t offset) {
  std::uint32_t begin = offset, end = offset;
  while (begin > 0 && is_word_byte(text[begin - 1])) --begin;
  while (end < text.size() && is_word_byte(text[end])) ++end;
  const bool number = begin < end && text[begin] >= '0' && text[begin] <= '9';
  if (number) begin = offset;  // the 60 of 60deg is not replaced
  while (number && begin > 0 && is_word_byte(text[begin - 1]) && !(text[begin - 1] >= '0' && text[begin - 1] <= '9'))
    --begin;
  return {begin, end, 0};
}

Place place_of(Document& document, std::uint32_t offset) {
  const syntax::TextReading& reading = document.reading();
  const std::string_view text = document.source().text();
  Place place;
  place.word = word_around(text, offset);
  for (const syntax::Comment& comment : reading.comments)
    place.in_text = place.in_text || (comment.span.begin < offset && offset <= comment.span.end);
  if (only_blanks_before(text, place.word.begin) && !is_indented(text, place.word.begin)) return place;
  for (std::size_t s = 0; s < reading.statements.size(); ++s) {
    const syntax::TextStatement& statement = reading.statements[s];
    if (statement.begin == statement.end || reading.tokens[statement.begin].span.begin >= place.word.begin) break;
    place.statement = s;
  }
  if (place.statement == nowhere) return place;
  const syntax::TextStatement& statement = reading.statements[place.statement];
  place.statement_word = reading.tokens[statement.begin].text;
  for (std::size_t i = statement.begin; i < statement.end && reading.tokens[i].span.begin < place.word.begin; ++i) {
    place.before = i;
    const TextToken& token = reading.tokens[i];
    place.in_text = place.in_text || (token.kind == TextToken::Kind::String && offset < token.span.end);
  }
  return place;
}

class Collector {
 public:
  Collector(Document& document, Place place) : document_(document), place_(std::move(place)) {}

  Completions run(std::uint32_t offset) {
    out_.replaced = place_.word;
    if (place_.in_text || ends_without_word(offset)) return std::move(out_);
    if (place_.before == nowhere)
      add_statements();
    else
      add_within_statement();
    if (is_finished(offset)) out_.items.clear();
    return std::move(out_);
  }

 private:
  /// Behind a number, a derivative, a bracket or a text that is closed a blank comes before anything else.
  bool ends_without_word(std::uint32_t offset) const {
    const std::string_view text = document_.source().text();
    return place_.word.begin == place_.word.end && offset > 0 &&
           (is_word_byte(text[offset - 1]) ||
            std::string_view("')]\"").find(text[offset - 1]) != std::string_view::npos);
  }

  /// The word is one of those offered, in any spelling, and the cursor is at its end: it may be all that was meant, and
  /// whoever then types Enter wants a new line. What is longer is offered with its next letter.
  bool is_finished(std::uint32_t offset) const {
    if (place_.word.begin == place_.word.end || offset != place_.word.end) return false;
    const std::string_view word = document_.source().slice(place_.word);
    const std::size_t at = roles().token_at(offset);
    const std::string_view read =
        at != nowhere && token(at).span == place_.word ? std::string_view(token(at).text) : word;
    return std::any_of(out_.items.begin(), out_.items.end(),
                       [&](const Completion& c) { return c.label == word || c.label == read; });
  }

  void add_within_statement() {
    const TextToken& before = token(place_.before);
    if (before.is(".")) {
      add_members();
    } else if (inside_unit_bracket()) {
      add_units(0);
    } else if (before.is("euler")) {
      for (const char* axes : {"zxz", "zyx", "xyz", "zyz", "xyx", "xzx", "yxy", "yzy", "xzy", "yxz", "yzx", "zxy"})
        add(axes, CompletionKind::Word, "axes of the three rotations", "", 0);
    } else if (place_.statement_word == "coord" && before.is(":")) {
      add_words(0);  // its kind: no name stands there
    } else if (!declares_name_here()) {
      add_inside();
    }
  }

  const TextToken& token(std::size_t i) const { return document_.reading().tokens[i]; }
  const Roles& roles() const { return document_.roles(); }

  void add(std::string label, CompletionKind kind, std::string detail, std::string help, int rank) {
    if (!seen_.insert(label).second) return;
    Completion item;
    item.insert = label;
    item.label = std::move(label);
    item.kind = kind;
    item.detail = std::move(detail);
    item.help = std::move(help);
    item.rank = rank;
    out_.items.push_back(std::move(item));
  }

  void add_statements() {
    for (const SnippetHelp& snippet : snippet_table()) {
      Completion item;
      item.label = std::string(snippet.label);
      item.kind = CompletionKind::Snippet;
      item.detail = std::string(snippet.detail);
      item.insert = std::string(snippet.text);
      item.snippet = true;
      item.rank = 1;
      out_.items.push_back(std::move(item));
    }
    for (const WordHelp& word : word_table())
      if (word.statements.empty())
        add(std::string(word.word), CompletionKind::Statement, std::string(word.form), std::string(word.help), 0);
  }

  bool inside_unit_bracket() const {
    for (std::size_t i = place_.before + 1; i-- > document_.reading().statements[place_.statement].begin;) {
      if (token(i).is("]")) return false;
      if (token(i).is("[")) return true;
    }
    return false;
  }

  /// A new name is the author's to choose.
  bool declares_name_here() {
    static constexpr std::string_view lists[] = {"param", "let", "coord", "rates", "field"};
    static constexpr std::string_view single[] = {"system", "point", "body", "frame", "event", "input", "independent"};
    const std::string& word = place_.statement_word;
    const std::size_t first = document_.reading().statements[place_.statement].begin;
    const bool list = std::find(std::begin(lists), std::end(lists), word) != std::end(lists);
    const bool one = std::find(std::begin(single), std::end(single), word) != std::end(single);
    if (place_.before == first) return list || one;
    if (token(place_.before).is("name")) return word == "constraint" || word == "contact";
    return list && token(place_.before).is(",") && depth() == 0;
  }

  int depth() const {
    int depth = 0;
    for (std::size_t i = document_.reading().statements[place_.statement].begin; i <= place_.before; ++i)
      depth += token(i).is("(") || token(i).is("[") ? 1 : token(i).is(")") || token(i).is("]") ? -1 : 0;
    return depth;
  }

  /// An operand ends before the cursor: a word of the language or a unit may follow.
  bool after_operand() {
    const TextToken& before = token(place_.before);
    if (before.kind == TextToken::Kind::Number || before.kind == TextToken::Kind::String) return true;
    if (before.is(")") || before.is("]") || before.is("'")) return true;
    const WordRole role = roles().of(place_.before);
    return before.kind == TextToken::Kind::Name && role != WordRole::StatementWord && role != WordRole::Function &&
           role != WordRole::Word;
  }

  void add_inside() {
    const bool operand = after_operand();
    if (is_place_of_unit()) add_units(operand || within_unit() ? 0 : 40);
    add_words(operand ? 5 : 20);
    add_names(operand ? 20 : 5);
    add_functions(operand ? 30 : 10);
  }

  bool within_unit() const {
    return place_.before > 0 && (token(place_.before).is("/") || token(place_.before).is("*")) &&
           token(place_.before - 1).unit;
  }

  /// Whether the grammar takes a unit here: behind the number of a quantity, and not behind an exponent, in a formula
  /// or behind `rel`.
  bool is_place_of_unit() const {
    if (place_.before > 0 && token(place_.before - 1).is("rel")) return false;
    const std::string probe = edited(document_.source().text(), {{place_.word, "kg"}});
    const syntax::TextReading read = syntax::read_text(SourceText("", probe));
    return std::any_of(read.tokens.begin(), read.tokens.end(),
                       [&](const TextToken& t) { return t.unit && t.span.begin == place_.word.begin; });
  }

  /// What is measured by the number before the cursor, where the words before it say so: a time behind `run`, an angle
  /// behind `start θ =`.
  std::optional<Dimension> expected_dimension() const {
    const std::size_t first = document_.reading().statements[place_.statement].begin;
    std::size_t i = place_.before;
    if (token(i).kind != TextToken::Kind::Number || i == first) return std::nullopt;
    for (--i; i > first && (token(i).is("-") || token(i).is("+"));) --i;
    for (const std::string_view word : {std::string_view("run"), std::string_view("within"), std::string_view("at"),
                                        std::string_view("output"), std::string_view("every")})
      if (token(i).is(word)) return dimensions::time();
    if (place_.statement_word != "start" || !token(i).is("=")) return std::nullopt;
    std::int64_t derivatives = 0;
    for (--i; i > first && token(i).is("'"); --i) ++derivatives;
    const Declared* name = roles().declared(i);
    const auto quantity = name && name->kind == NameKind::Coordinate ? dimension_of_kind(*name) : std::nullopt;
    return quantity ? std::optional(*quantity / pow(dimensions::time(), derivatives)) : std::nullopt;
  }

  /// `length` of `coord x, y : length`.
  std::optional<Dimension> dimension_of_kind(const Declared& coordinate) const {
    for (std::size_t i = coordinate.token; i + 1 < document_.reading().statements[coordinate.statement].end; ++i) {
      if (!token(i).is(":")) continue;
      if (token(i + 1).is("angle")) return dimensions::angle();
      if (token(i + 1).is("length")) return dimensions::length();
      if (token(i + 1).is("charge")) return dimensions::charge();
      return std::nullopt;
    }
    return std::nullopt;
  }

  void add_words(int rank) {
    for (const WordHelp& word : word_table())
      if (stands_in(word, place_.statement_word))
        add(std::string(word.word), CompletionKind::Word, std::string(word.form), std::string(word.help), rank);
    // Words of formulas: conditions, and what stands in every statement that has a case.
    for (const std::string_view word : {std::string_view("else"), std::string_view("and"), std::string_view("or")})
      if (depth() > 0) add(std::string(word), CompletionKind::Word, "in a condition", "", rank + 20);
  }

  void add_names(int rank) {
    for (const Declared& name : roles().names()) {
      if (name.kind == NameKind::System) continue;
      const std::string facts = facts_of(name, document_);
      add(name.name, CompletionKind::Name, fmt::format("{}{}", word_of(name.kind), facts.empty() ? "" : ", " + facts),
          comment_of(name, document_), rank);
    }
    add("t", CompletionKind::Name, "the time", "", rank + 1);
    add("pi", CompletionKind::Name, "the number π", "", rank + 1);
    add("O", CompletionKind::Name, "the origin", "", rank + 1);
  }

  void add_functions(int rank) {
    for (const FunctionHelp& function : function_table())
      add(std::string(function.name), CompletionKind::Function,
          fmt::format("{}({})", function.name, function.parameters), std::string(function.help), rank);
  }

  void add_units(int rank) {
    if (roles().dimensionless()) return;
    const std::optional<Dimension> expected = expected_dimension();
    const auto add_unit = [&](const std::string& word, int more) {
      const auto unit = find_unit(word);
      if (!unit) return;
      const bool fits = !expected || unit->dimension == *expected;
      add(word, CompletionKind::Unit, "unit" + of_quantity(unit->dimension), "", rank + more + (fits ? 0 : 2));
    };
    if (expected) add(to_string(*expected), CompletionKind::Unit, "unit" + of_quantity(*expected), "", rank);
    for (const char* word :
         {"kg", "g", "m", "cm", "mm", "km", "s", "ms", "N", "kN", "J", "W", "rad", "deg", "Hz", "rpm"})
      add_unit(word, 0);
    for (const std::string& word : unit_words()) add_unit(word, 1);
    const std::string typed(document_.source().slice(place_.word));
    if (!typed.empty()) add_unit(typed, 1);
  }

  static std::string of_quantity(const Dimension& dimension) {
    const std::string name = physical_name(dimension);
    return name.empty() ? "" : " of " + name;
  }

  void add_members() {
    const std::size_t first = document_.reading().statements[place_.statement].begin;
    const Declared* base = place_.before > first ? roles().declared(place_.before - 1) : nullptr;
    const bool turns = !base || base->kind == NameKind::Body || base->kind == NameKind::Frame;
    const Model* model = document_.model();
    const int dimension = model ? model->system.space_dimension : 3;
    add("x", CompletionKind::Member, "component along x", "", 0);
    add("y", CompletionKind::Member, "component along y", "", 0);
    if (dimension > 2) add("z", CompletionKind::Member, "component along z", "", 0);
    if (!turns) return;
    add("ω", CompletionKind::Member, "angular velocity on body axes", "", 1);
    add("ω_world", CompletionKind::Member, "angular velocity on world axes", "", 1);
    if (dimension > 2)
      for (const char* q : {"qw", "qx", "qy", "qz"})
        add(q, CompletionKind::Member, "component of the unit quaternion", "Of a body with `rotation quaternion`.", 2);
  }

  Document& document_;
  Place place_;
  Completions out_;
  std::set<std::string> seen_;
};

}  // namespace

Completions complete(Document& document, std::uint32_t offset) {
  offset = std::min(offset, document.source().whole().end);
  return Collector(document, place_of(document, offset)).run(offset);
}

// The function whose bracket is open at the place, and how many commas stand in it.
std::optional<Signature> signature(Document& document, std::uint32_t offset) {
  const syntax::TextReading& reading = document.reading();
  const Roles& roles = document.roles();
  const auto after = std::lower_bound(reading.tokens.begin(), reading.tokens.end(), offset,
                                      [](const TextToken& t, std::uint32_t place) { return t.span.begin < place; });
  std::size_t commas = 0;
  int depth = 0;
  for (std::size_t i = static_cast<std::size_t>(after - reading.tokens.begin()); i-- > 0;) {
    const TextToken& token = reading.tokens[i];
    if (roles.of(i) == WordRole::StatementWord) return std::nullopt;
    if (token.is(")") || token.is("]")) ++depth;
    if (token.is(",") && depth == 0) ++commas;
    if (!token.is("(") && !token.is("[")) continue;
    if (--depth >= 0) continue;
    depth = 0;
    const FunctionHelp* function =
        i > 0 && roles.of(i - 1) == WordRole::Function ? find_function_help(reading.tokens[i - 1].text) : nullptr;
    if (function) {
      Signature out;
      out.label = fmt::format("{}({})", function->name, function->parameters);
      out.help = std::string(function->help);
      std::string_view rest = function->parameters;
      while (!rest.empty()) {
        const std::size_t comma = rest.find(", ");
        out.parameters.emplace_back(rest.substr(0, comma));
        rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 2);
      }
      out.active = std::min(commas, out.parameters.size() - 1);
      return out;
    }
    commas = 0;
  }
  return std::nullopt;
}

}  // namespace maupertuis::language

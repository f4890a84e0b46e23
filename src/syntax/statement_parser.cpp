#include "syntax/statement_parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

/// The table of statements, and those that declare: system, param, coord, let, input.
namespace maupertuis::syntax {

std::span<const StatementParser::Entry> StatementParser::table() {
  using P = StatementParser;
  static constexpr Entry entries[] = {
      {"system", &P::system_statement},
      {"source", &P::source_statement},
      {"note", &P::note_statement},
      {"dimensionless", &P::dimensionless_statement},
      {"param", &P::param_statement},
      {"coord", &P::coord_statement},
      {"let", &P::let_statement},
      {"input", &P::input_statement},
      {"frame", &P::frame_statement},
      {"point", &P::point_statement},
      {"body", &P::body_statement},
      {"gravity", &P::gravity_statement},
      {"spring", &P::spring_statement},
      {"damper", &P::damper_statement},
      {"torsion", &P::torsion_statement},
      {"force", &P::force_statement},
      {"torque", &P::torque_statement},
      {"reaction", &P::reaction_statement},
      {"start", &P::start_statement},
      {"run", &P::run_statement},
      {"output", &P::output_statement},
      {"draw", &P::draw_statement},
      {"expect", &P::expect_statement},
      {"method", &P::method_statement},
      {"precision", &P::precision_statement},
      {"claim", &P::claim_statement},
      {"constraint", &P::constraint_statement},
      {"gauge", &P::gauge_statement},
      {"contact", &P::contact_statement},
      {"friction", &P::friction_statement},
      {"event", &P::event_statement},
      {"impact", &P::impact_statement},
      {"sweep", &P::sweep_statement},
      {"independent", &P::independent_statement},
      {"path", &P::path_statement},
      {"rates", &P::rates_statement},
      {"field", &P::field_statement},
      {"density", &P::density_statement},
      {"boundary", &P::boundary_statement},
      {"T", &P::energy_statement},
      {"V", &P::energy_statement},
      {"U", &P::energy_statement},
      {"L", &P::energy_statement},
      {"D", &P::energy_statement},
      {"kinetic", &P::energy_statement},
      {"potential", &P::energy_statement},
      {"generalized_potential", &P::energy_statement},
      {"lagrangian", &P::energy_statement},
      {"dissipation", &P::energy_statement},
  };
  return entries;
}

std::vector<Statement> StatementParser::run() {
  const Token& word = peek();
  const auto entry = std::find_if(table().begin(), table().end(), [&](const Entry& e) {
    return word.kind == Token::Kind::Name && e.word == word.text;
  });
  if (entry == table().end()) unknown_statement();
  std::vector<Statement> statements;
  const std::size_t first = index_;
  StatementBody body = (this->*entry->handler)();
  statements.push_back(complete(std::move(body), first));
  if (word.is("system") && peek().is("source")) {
    const std::size_t second = index_;
    body = source_statement();
    statements.push_back(complete(std::move(body), second));
  }
  expect_end();
  flush_warnings();
  return statements;
}

Statement StatementParser::complete(StatementBody body, std::size_t first) const {
  return {std::move(body), cover(context_.list.tokens[first].span, previous().span)};
}

Span StatementParser::statement_span() const {
  return cover(context_.list.tokens[begin_].span, context_.list.tokens[std::max(index_, begin_ + 1) - 1].span);
}

namespace {

/// What other languages and books call a statement; empty for a word that is none of theirs.
std::string_view meant_by(std::string_view word) {
  static constexpr std::pair<std::string_view, std::string_view> meanings[] = {{"parameter", "param"},
                                                                               {"parameters", "param"},
                                                                               {"params", "param"},
                                                                               {"const", "param"},
                                                                               {"constant", "param"},
                                                                               {"constants", "param"},
                                                                               {"coordinate", "coord"},
                                                                               {"coordinates", "coord"},
                                                                               {"coords", "coord"},
                                                                               {"dof", "coord"},
                                                                               {"dofs", "coord"},
                                                                               {"variable", "coord"},
                                                                               {"variables", "coord"},
                                                                               {"particle", "point"},
                                                                               {"define", "let"},
                                                                               {"def", "let"},
                                                                               {"initial", "start"},
                                                                               {"init", "start"},
                                                                               {"ic", "start"},
                                                                               {"simulate", "run"},
                                                                               {"integrate", "run"},
                                                                               {"duration", "run"},
                                                                               {"constraints", "constraint"}};
  for (const auto& [theirs, ours] : meanings)
    if (word == theirs) return ours;
  return {};
}

}  // namespace

/// A line that is an equation, of motion or between coordinates, or gives a force; empty for others.
std::string StatementParser::help_for_equation() const {
  const auto& tokens = context_.list.tokens;
  std::size_t equals = index_;
  bool second_derivative = false;
  for (; equals < end_ && !tokens[equals].is("="); ++equals) {
    const bool twice = equals + 1 < end_ && tokens[equals].is("'") && tokens[equals + 1].is("'");
    second_derivative = second_derivative || twice;
  }
  if (equals == end_) return {};
  const std::string line = text_of(cover(tokens[index_].span, tokens[end_ - 1].span));
  if (second_derivative)
    return fmt::format("Equations of motion follow from the energies; to have one checked, write claim {}.", line);
  const std::string_view word = tokens[index_].text;
  if (equals > index_ + 3 && tokens[equals - 1].is(")") && tokens[equals - 2].text == "0" &&
      tokens[equals - 3].is("(") && equals + 1 < end_) {
    const std::string name = text_of(cover(tokens[index_].span, tokens[equals - 4].span));
    const std::string value = text_of(cover(tokens[equals + 1].span, tokens[end_ - 1].span));
    return fmt::format("A value at the start is written start {} = {}.", name, value);
  }
  if (equals > index_ + 1 && !tokens[index_ + 1].is("'"))
    return fmt::format(
        "A condition that the motion keeps is `constraint {}`; an equation of motion that is to be "
        "checked is a `claim`.",
        line);
  if (equals == index_ + 1 && (word[0] == 'F' || word[0] == 'Q'))
    return fmt::format(
        "A force along a coordinate q is written `force q = …`, on a point `force on P = (…)`; a "
        "definition `let {} = …`.",
        word);
  return {};
}

void StatementParser::unknown_statement() {
  const Token& word = peek();
  if (word.kind != Token::Kind::Name) {
    fail("E0110", word.span, fmt::format("a statement cannot begin with {}", describe(word)),
         "Every statement begins with its word.", "A continued line must be indented, or a bracket be open.");
  }
  std::size_t i = index_ + 1;
  while (i < end_ && context_.list.tokens[i].is("'")) ++i;
  const bool equation = i < end_ && (context_.list.tokens[i].is("=") || context_.list.tokens[i].is("+="));
  const std::vector<std::string> words = as_strings(statement_words());
  std::string lower(word.text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::string near = is_statement_word(lower) ? lower : std::string(meant_by(lower));
  if (near.empty()) near = did_you_mean(word.text, words);
  if (near.size() == 1 || (equation && !energy_of(near))) near.clear();
  std::string help;
  if (!near.empty()) {
    help = fmt::format("Did you mean `{}`?", near);
  } else if (std::string of_equation = help_for_equation(); !of_equation.empty()) {
    help = std::move(of_equation);
  } else if (equation) {
    help = fmt::format("A definition is `let {0} = …`, a parameter `param {0} = …`, an initial value `start {0} = …`.",
                       word.text);
  } else {
    help = "Statements begin with param, coord, let, point, T, V, force, start, run, …; a continued line is indented.";
  }
  fail("E0110", word.span, fmt::format("`{}` does not begin a statement", word.text), "", std::move(help));
}

// m = 1 kg g = 9.81 m/s^2: the name of the next item was read as a unit, or as a factor, of this one.
void StatementParser::refuse_missing_comma() {
  const Token& name = previous();
  if (!peek().is("=") || name.kind != Token::Kind::Name || index_ < begin_ + 3) return;
  const Token& before = context_.list.tokens[index_ - 2];
  const bool ends_value = before.kind == Token::Kind::Number || before.kind == Token::Kind::Name || before.is(")") ||
                          before.is("]") || before.is("'");
  if (!ends_value) return;
  fail("E0111", name.span, fmt::format("a comma is missing before `{}`", name.text),
       "The items of a list are separated by commas.", fmt::format("Write …, {} = ….", name.text));
}

// After a mistake in the item that begins at `first`: to the comma before the next `name =` or `name :`, outside
// brackets.
void StatementParser::skip_item(std::size_t first) {
  int depth = 0;
  for (std::size_t i = first; i < index_ && i < end_; ++i) {
    const Token& token = context_.list.tokens[i];
    depth += token.is("(") || token.is("[") ? 1 : token.is(")") || token.is("]") ? -1 : 0;
  }
  for (; !at_end(); next()) {
    if (peek().is("(") || peek().is("[")) ++depth;
    if (peek().is(")") || peek().is("]")) --depth;
    const bool item =
        peek(1).kind == Token::Kind::Name && (peek(2).is("=") || peek(2).is(":") || peek(2).is("'") || peek(2).is(","));
    if (depth == 0 && peek().is(",") && item) return;
  }
}

// A title in one word: "Foucault's pendulum" as foucaults_pendulum.
static std::string word_of(std::string_view title) {
  std::string out;
  for (const char c : title) {
    if (std::isalnum(static_cast<unsigned char>(c))) out += static_cast<char>(std::tolower(c));
    if (c == ' ' && !out.empty() && out.back() != '_') out += '_';
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  return out.empty() || std::isdigit(static_cast<unsigned char>(out.front())) ? "my_system" : out;
}

StatementBody StatementParser::system_statement() {
  next();
  SystemStatement system;
  if (peek().kind == Token::Kind::String)
    fail_expected("the name of the system",
                  fmt::format("Its name is one word and stands before the title: system {} \"{}\".",
                              word_of(peek().text), peek().text));
  system.name = new_name("the name of the system");
  if (peek().kind == Token::Kind::String) system.title = next().text;
  if (peek().kind == Token::Kind::Name && !peek().is("source"))
    fail("E0111", peek().span, fmt::format("the statement should end before {}", describe(peek())),
         "The name of a system is one word.",
         fmt::format("Write {0}_{1}, or give a title in quotes: system {0} \"{0} {1}\".", system.name.text,
                     peek().text));
  return system;
}

StatementBody StatementParser::source_statement() {
  next();
  if (peek().kind != Token::Kind::String) fail_expected("a citation in quotes after `source`");
  return SourceStatement{std::string(next().text)};
}

StatementBody StatementParser::note_statement() {
  next();
  if (peek().kind != Token::Kind::String) fail_expected("a sentence in quotes after `note`");
  return NoteStatement{std::string(next().text)};
}

StatementBody StatementParser::dimensionless_statement() {
  next();
  return DimensionlessStatement{};
}

StatementBody StatementParser::param_statement() {
  next();
  ParamStatement param;
  list([&] {
    ParamStatement::Item item;
    item.name = new_name("the name of a parameter");
    expect("=", "the name of a parameter");
    item.value = quantity();
    param.items.push_back(std::move(item));
  });
  return param;
}

StatementBody StatementParser::let_statement() {
  next();
  LetStatement let;
  list([&] {
    LetStatement::Item item;
    item.name = new_name("the name of a definition");
    expect("=", "the name of a definition");
    item.value = formula();
    let.items.push_back(std::move(item));
  });
  return let;
}

void StatementParser::coordinate_without_kind(const Name& name) {
  fail("E0129", name.span, fmt::format("the coordinate {} has no kind", name.text), "",
       fmt::format("Write {0} : angle, {0} : length, {0} : charge, {0} : number or {0} : [unit].", name.text));
}

// What people write in the place of the colon: a unit, (t), a value.
void StatementParser::coordinate_without_colon(const Name& name) {
  std::string help = fmt::format("Write for example {} : angle.", name.text);
  if (peek().is("(")) {
    help = fmt::format("Coordinates are functions of the time as they stand: write {0} : length, or {0} : angle.",
                       name.text);
  } else if (peek().is("=")) {
    help = fmt::format("Its value at the start is a statement of its own: write coord {0} : length, and start {0} {1}.",
                       name.text, item_text());
  } else if (peek().is("[")) {
    help = fmt::format("A unit follows a colon: write {} : {}.", name.text, item_text());
  }
  fail_expected("`:` and the kind of the coordinate", std::move(help));
}

static bool is_word_of_angles(std::string_view word) {
  constexpr std::string_view all[] = {"degrees", "degree", "deg", "radians", "radian", "rad"};
  return std::find(std::begin(all), std::end(all), word) != std::end(all);
}

// After the colon: angle, length, charge, number or a unit in brackets.
void StatementParser::kind_of(const Name& name, const char* what, Name& kind, std::optional<UnitExpression>& unit) {
  if (peek().is("[")) {
    unit = bracketed_unit();
    return;
  }
  const Token& word = peek();
  if (!word.is("angle") && !word.is("length") && !word.is("charge") && !word.is("number")) {
    const std::vector<std::string> kinds = {"angle", "length", "charge", "number"};
    const std::string near = word.kind == Token::Kind::Name ? did_you_mean(word.text, kinds) : "";
    fail("E0129", word.span,
         fmt::format("expected the kind of {} {}, found {}", *what == 'i' ? "an" : "a", what, describe(word)),
         fmt::format("{} {} is an angle, a length, a charge, a number, or has a unit in brackets.",
                     *what == 'i' ? "An" : "A", what),
         is_word_of_angles(word.text)
             ? fmt::format("Write {} : angle; angles are in rad, and 60 deg is a value of one.", name.text)
         : !near.empty() ? fmt::format("Did you mean `{}`?", near)
                         : fmt::format("Write for example {0} : length, or {0} : [m].", name.text));
  }
  kind = {std::string(next().text), word.span};
}

// coord x, y : length, θ : angle — names before a colon share its kind.
StatementBody StatementParser::coord_statement() {
  next();
  CoordStatement coord;
  std::size_t unnamed = 0;
  list([&] {
    CoordStatement::Item item;
    item.name = new_name("the name of a coordinate");
    coord.items.push_back(std::move(item));
    if (peek().is(",")) return;
    if (at_end()) coordinate_without_kind(coord.items.back().name);
    if (!peek().is(":")) coordinate_without_colon(coord.items.back().name);
    next();
    CoordStatement::Item& last = coord.items.back();
    kind_of(last.name, "coordinate", last.kind, last.unit);
    for (; unnamed + 1 < coord.items.size(); ++unnamed) {
      coord.items[unnamed].kind = coord.items.back().kind;
      coord.items[unnamed].unit = coord.items.back().unit;
    }
    unnamed = coord.items.size();
  });
  return coord;
}

StatementBody StatementParser::input_statement() {
  next();
  InputStatement input;
  input.name = new_name("the name of an input");
  if (accept("(")) {
    do input.variables.push_back(used_name("a space variable"));
    while (accept(","));
    expect(")", "the space variables");
  }
  if (accept(":")) {
    if (!peek().is("[")) fail_expected("a unit in square brackets", "Write for example input u : [N] = ….");
    input.unit = bracketed_unit();
  }
  if (!input.variables.empty() && at_end()) return input;
  expect("=", "the name of an input");
  input.value = quantity();
  return input;
}

StatementBody StatementParser::energy_statement() {
  if (peek().is("dissipation") && peek(1).is("density")) return density_statement();
  const Token& word = next();
  const auto which = *energy_of(word.text);
  if (is_short_energy(word.text) && context_.declarations.contains(word.text)) {
    fail("E0120", word.span, fmt::format("`{}` is a name of this model and cannot be given here", word.text),
         fmt::format("A declared {} means that name everywhere.", word.text),
         fmt::format("Write `{} = …`, or rename the declared {}.", long_energy_name(which), word.text));
  }
  EnergyStatement energy;
  energy.which = which;
  energy.name_span = word.span;
  if (accept("+=")) {
    energy.adds = true;
  } else {
    expect("=", fmt::format("`{}`", word.text));
  }
  energy.value = formula();
  return energy;
}

}  // namespace maupertuis::syntax

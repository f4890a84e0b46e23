#include "studio/requests.hpp"

#include <algorithm>

/// The language services: what an editor asks.
namespace maupertuis::studio {
namespace {

std::uint32_t place_of(Desk& desk, const Work& work, const char* key = "at") {
  const double at = number_of(work.request, key, 0);
  return desk.units().to_byte(at > 0 ? static_cast<std::uint32_t>(std::min(at, 4e9)) : 0);
}

const char* kind_of(language::TokenKind kind) {
  switch (kind) {
    case language::TokenKind::Keyword:
      return "keyword";
    case language::TokenKind::Function:
      return "function";
    case language::TokenKind::Parameter:
      return "parameter";
    case language::TokenKind::Coordinate:
      return "coordinate";
    case language::TokenKind::Definition:
      return "definition";
    case language::TokenKind::Place:
      return "place";
    case language::TokenKind::Member:
      return "member";
    case language::TokenKind::Unit:
      return "unit";
    case language::TokenKind::Number:
      return "number";
    case language::TokenKind::String:
      return "string";
    case language::TokenKind::Comment:
      return "comment";
    case language::TokenKind::Operator:
      return "operator";
    case language::TokenKind::Other:
      return "other";
  }
  return "other";
}

const char* kind_of(language::CompletionKind kind) {
  switch (kind) {
    case language::CompletionKind::Statement:
      return "statement";
    case language::CompletionKind::Word:
      return "word";
    case language::CompletionKind::Name:
      return "name";
    case language::CompletionKind::Function:
      return "function";
    case language::CompletionKind::Unit:
      return "unit";
    case language::CompletionKind::Member:
      return "member";
    case language::CompletionKind::Snippet:
      return "snippet";
  }
  return "word";
}

Json symbols_json(const std::vector<language::Symbol>& symbols, const Units& units) {
  Json list = Json::array();
  for (const language::Symbol& s : symbols)
    list.push_back({{"name", s.name},
                    {"detail", s.detail},
                    {"from", units.of_byte(s.span.begin)},
                    {"to", units.of_byte(s.span.end)},
                    {"children", symbols_json(s.children, units)}});
  return list;
}

Json span_answer(const std::optional<Span>& span, const Units& units) {
  return {{"from", span ? Json(units.of_byte(span->begin)) : Json()},
          {"to", span ? Json(units.of_byte(span->end)) : Json()}};
}

}  // namespace

Json open_text(Desk& desk, const Work& work) {
  desk.open(text_of(work.request, "name", "model.lag"), text_of(work.request, "text"));
  language::Document& document = desk.document();
  const Units& units = desk.units();
  const Diagnostics& found = document.diagnostics();
  Json tokens = Json::array(), folds = Json::array();
  for (const language::SemanticToken& token : language::semantic_tokens(document))
    tokens.push_back({units.of_byte(token.span.begin), units.of_byte(token.span.end), kind_of(token.kind)});
  for (const Span& span : language::folding(document)) folds.push_back(range_json(span, units));
  const Model* model = document.model();
  Json out = {{"diagnostics", diagnostics_json(found, {document.source()}, units)},
              {"tokens", std::move(tokens)},
              {"symbols", symbols_json(language::symbols(document), units)},
              {"folding", std::move(folds)},
              {"readable", model != nullptr}};
  out["fields"] = model && model->fields;
  out["modes"] = model && model->system.has_modes();
  out["runs"] = model && model->system.integral_constraints.empty();
  return out;
}

Json fixes(Desk& desk, const Work& work) {
  const Span span{place_of(desk, work, "from"), place_of(desk, work, "to")};
  Json list = Json::array();
  for (const language::Fix& fix : language::fixes(desk.document(), span))
    list.push_back({{"title", fix.title},
                    {"code", fix.code},
                    {"from", desk.units().of_byte(fix.span.begin)},
                    {"to", desk.units().of_byte(fix.span.end)},
                    {"edits", edits_json(fix.edits, desk.units())}});
  return {{"fixes", std::move(list)}};
}

Json hover(Desk& desk, const Work& work) {
  const auto found = language::hover(desk.document(), place_of(desk, work));
  Json out = span_answer(found ? std::optional(found->span) : std::nullopt, desk.units());
  out["markdown"] = found ? found->markdown : std::string();
  return out;
}

Json complete(Desk& desk, const Work& work) {
  const language::Completions found = language::complete(desk.document(), place_of(desk, work));
  Json items = Json::array();
  for (const language::Completion& c : found.items)
    items.push_back({{"label", c.label},
                     {"kind", kind_of(c.kind)},
                     {"detail", c.detail},
                     {"help", c.help},
                     {"insert", c.insert},
                     {"snippet", c.snippet},
                     {"rank", c.rank}});
  Json out = span_answer(found.replaced, desk.units());
  out["items"] = std::move(items);
  return out;
}

Json signature(Desk& desk, const Work& work) {
  const auto found = language::signature(desk.document(), place_of(desk, work));
  if (!found) return {{"label", ""}, {"parameters", Json::array()}, {"active", 0}, {"help", ""}};
  return {{"label", found->label}, {"parameters", found->parameters}, {"active", found->active}, {"help", found->help}};
}

Json definition(Desk& desk, const Work& work) {
  return span_answer(language::definition(desk.document(), place_of(desk, work)), desk.units());
}

Json references(Desk& desk, const Work& work) {
  Json places = Json::array();
  for (const Span& span : language::references(desk.document(), place_of(desk, work)))
    places.push_back(range_json(span, desk.units()));
  return {{"places", std::move(places)}};
}

Json rename(Desk& desk, const Work& work) {
  const std::uint32_t at = place_of(desk, work);
  const auto place = language::renamed_at(desk.document(), at);
  if (!place) return {{"edits", Json::array()}, {"refusal", "There is no name here that could be changed."}};
  const language::Rename found = language::rename(desk.document(), at, text_of(work.request, "name"));
  return {{"edits", edits_json(found.edits, desk.units())}, {"refusal", found.refusal}};
}

Json format(Desk& desk, const Work&) {
  const language::Formatting found = language::formatting(desk.document());
  return {{"edits", edits_json(found.edits, desk.units())}, {"refusal", found.mistake ? found.mistake->message : ""}};
}

Json explain(Desk&, const Work& work) {
  const std::string code = text_of(work.request, "code");
  const CodeEntry* entry = language::find_code(code);
  if (!entry) throw Trouble{"refused", "There is no code `" + code + "`.", "", "", "", nullptr};
  return {{"code", entry->code},
          {"title", entry->title},
          {"explanation", entry->explanation},
          {"wrong", entry->wrong},
          {"right", entry->right}};
}

Json hello(Desk&, const Work&) {
  Json words = Json::array();
  for (const language::WordHelp& word : language::words())
    words.push_back({{"word", word.word}, {"statements", word.statements}, {"form", word.form}, {"help", word.help}});
  return {{"version", MAUPERTUIS_VERSION}, {"words", std::move(words)}};
}

}  // namespace maupertuis::studio

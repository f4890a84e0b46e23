#include "lsp/answers.hpp"

#include <maupertuis/language_words.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis::app::lsp {
namespace {

using namespace language;

/// The value at the end of a path of keys; null where there is none.
const Json& at(const Json& json, std::initializer_list<const char*> path) {
  static const Json none;
  const Json* here = &json;
  for (const char* key : path) {
    if (!here->is_object() || !here->contains(key)) return none;
    here = &(*here)[key];
  }
  return *here;
}

bool is_true(const Json& json) { return json.is_boolean() && json.get<bool>(); }

Encoding encoding_of(const Json& offered) {
  if (offered.is_array())
    for (const Json& name : offered) {
      if (name == "utf-8") return Encoding::Utf8;
      if (name == "utf-16") return Encoding::Utf16;
      if (name == "utf-32") return Encoding::Utf32;
    }
  return Encoding::Utf16;
}

const char* name_of(Encoding encoding) {
  switch (encoding) {
    case Encoding::Utf8:
      return "utf-8";
    case Encoding::Utf16:
      return "utf-16";
    case Encoding::Utf32:
      return "utf-32";
  }
  return "utf-16";
}

// In the order of TokenKind. The names are those that themes of editors know.
constexpr const char* token_names[] = {"keyword", "function", "parameter", "variable", "macro",
                                       "class",   "property", "type",      "number",   "string",
                                       "comment", "operator", "variable"};

std::uint32_t place_of(OpenText& text, const Json& params) { return text.offset(at(params, {"position"})); }

Json edits_json(const std::vector<TextEdit>& edits, OpenText& text) {
  Json list = Json::array();
  for (const TextEdit& edit : edits) list.push_back({{"range", text.range(edit.span)}, {"newText", edit.text}});
  return list;
}

Json workspace_edit(const std::vector<TextEdit>& edits, OpenText& text, const Client& client) {
  const Json list = edits_json(edits, text);
  if (!client.versioned_edits) return {{"changes", {{text.uri(), list}}}};
  return {{"documentChanges",
           Json::array({{{"textDocument", {{"uri", text.uri()}, {"version", text.version()}}}, {"edits", list}}})}};
}

Json location(Span span, OpenText& text) { return {{"uri", text.uri()}, {"range", text.range(span)}}; }

int severity_of(Severity severity) {
  switch (severity) {
    case Severity::Error:
      return 1;
    case Severity::Warning:
      return 2;
    case Severity::Note:
      return 3;
  }
  return 3;
}

Json diagnostic_json(const Diagnostic& d, OpenText& text, const Client& client) {
  const bool placed = d.span && d.span->source == 0;
  std::string message = d.message;
  if (!d.reason.empty()) message += "\n" + d.reason;
  if (!d.help.empty()) message += "\n" + d.help;
  Json out = {{"range", text.range(placed ? *d.span : Span{})},
              {"severity", severity_of(d.severity)},
              {"code", d.code},
              {"source", "maup"},
              {"message", message}};
  if (!client.code_link.empty()) {
    std::string link = client.code_link;
    if (const auto place = link.find("{code}"); place != std::string::npos) link.replace(place, 6, d.code);
    out["codeDescription"] = {{"href", link}};
  }
  if (d.code == "W0416") out["tags"] = Json::array({1});  // a definition that is never used: shown faded
  return out;
}

}  // namespace

Client client_of(const Json& initialize) {
  Client client;
  client.encoding = encoding_of(at(initialize, {"capabilities", "general", "positionEncodings"}));
  client.snippets =
      is_true(at(initialize, {"capabilities", "textDocument", "completion", "completionItem", "snippetSupport"}));
  const Json& formats = at(initialize, {"capabilities", "textDocument", "hover", "contentFormat"});
  client.markdown = !formats.is_array() || std::find(formats.begin(), formats.end(), "markdown") != formats.end();
  client.versioned_edits = is_true(at(initialize, {"capabilities", "workspace", "workspaceEdit", "documentChanges"}));
  const Json& link = at(initialize, {"initializationOptions", "codeLink"});
  if (link.is_string()) client.code_link = link.get<std::string>();
  return client;
}

Json capabilities(const Client& client) {
  Json tokens = Json::array();
  for (const char* name : token_names) tokens.push_back(name);
  return {{"positionEncoding", name_of(client.encoding)},
          {"textDocumentSync", {{"openClose", true}, {"change", 2}, {"save", {{"includeText", false}}}}},
          {"hoverProvider", true},
          {"completionProvider", {{"triggerCharacters", {".", "[", " "}}}},
          {"signatureHelpProvider", {{"triggerCharacters", {"(", ","}}}},
          {"definitionProvider", true},
          {"referencesProvider", true},
          {"documentHighlightProvider", true},
          {"renameProvider", {{"prepareProvider", true}}},
          {"documentSymbolProvider", true},
          {"documentFormattingProvider", true},
          {"codeActionProvider", {{"codeActionKinds", {"quickfix"}}}},
          {"foldingRangeProvider", true},
          {"semanticTokensProvider",
           {{"legend", {{"tokenTypes", tokens}, {"tokenModifiers", {"declaration"}}}}, {"full", true}}}};
}

Json diagnostics_json(const Diagnostics& diagnostics, OpenText& text, const Client& client) {
  Json list = Json::array();
  for (const Diagnostic& d : diagnostics.items()) list.push_back(diagnostic_json(d, text, client));
  return list;
}

namespace {

/// The text of markdown for an editor that shows none: without fences and ticks.
std::string plain(const std::string& markdown) {
  std::string out;
  for (std::size_t i = 0; i < markdown.size(); ++i) {
    if (markdown.compare(i, 3, "```") == 0) {
      i = std::min(markdown.find('\n', i), markdown.size());
      continue;
    }
    if (markdown[i] != '`' && markdown.compare(i, 2, "**") != 0)
      out += markdown[i];
    else if (markdown[i] == '*')
      ++i;
  }
  return out;
}

}  // namespace

Json hover_json(OpenText& text, const Json& params, const Client& client) {
  const auto found = hover(text.document(), place_of(text, params));
  if (!found) return nullptr;
  return {{"contents",
           {{"kind", client.markdown ? "markdown" : "plaintext"},
            {"value", client.markdown ? found->markdown : plain(found->markdown)}}},
          {"range", text.range(found->span)}};
}

namespace {

int lsp_kind(CompletionKind kind) {
  switch (kind) {
    case CompletionKind::Statement:
    case CompletionKind::Word:
      return 14;  // keyword
    case CompletionKind::Name:
      return 6;  // variable
    case CompletionKind::Function:
      return 3;
    case CompletionKind::Unit:
      return 11;
    case CompletionKind::Member:
      return 5;  // field
    case CompletionKind::Snippet:
      return 15;
  }
  return 1;
}

}  // namespace

Json completion_json(OpenText& text, const Json& params, const Client& client) {
  const Completions found = complete(text.document(), place_of(text, params));
  const std::string typed = text.text().substr(found.replaced.begin, found.replaced.end - found.replaced.begin);
  const bool latin =
      std::all_of(typed.begin(), typed.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
  Json items = Json::array();
  for (const Completion& c : found.items) {
    if (c.snippet && !client.snippets) continue;
    Json item = {{"label", c.label},
                 {"kind", lsp_kind(c.kind)},
                 {"detail", c.detail},
                 {"sortText", fmt::format("{:02}{}", c.rank, c.label)},
                 {"textEdit", {{"range", text.range(found.replaced)}, {"newText", c.insert}}}};
    if (!c.help.empty()) item["documentation"] = c.help;
    if (c.snippet) item["insertTextFormat"] = 2;
    // On a keyboard without Greek letters `th` finds θ.
    if (const std::string spelled = syntax::spelled_out(c.label); latin && spelled != c.label)
      item["filterText"] = spelled;
    items.push_back(std::move(item));
  }
  return {{"isIncomplete", false}, {"items", std::move(items)}};
}

Json signature_json(OpenText& text, const Json& params, const Client&) {
  const auto found = signature(text.document(), place_of(text, params));
  if (!found) return nullptr;
  Json parameters = Json::array();
  for (const std::string& parameter : found->parameters) parameters.push_back({{"label", parameter}});
  return {{"signatures",
           Json::array({{{"label", found->label}, {"documentation", found->help}, {"parameters", parameters}}})},
          {"activeSignature", 0},
          {"activeParameter", found->active}};
}

Json definition_json(OpenText& text, const Json& params, const Client&) {
  const auto found = definition(text.document(), place_of(text, params));
  return found ? location(*found, text) : Json(nullptr);
}

Json references_json(OpenText& text, const Json& params, const Client&) {
  const Json& declaration = at(params, {"context", "includeDeclaration"});
  Json list = Json::array();
  for (const Span& span :
       references(text.document(), place_of(text, params), !declaration.is_boolean() || declaration.get<bool>()))
    list.push_back(location(span, text));
  return list;
}

Json highlights_json(OpenText& text, const Json& params, const Client&) {
  Json list = Json::array();
  for (const Span& span : references(text.document(), place_of(text, params)))
    list.push_back({{"range", text.range(span)}});
  return list;
}

Json prepare_rename_json(OpenText& text, const Json& params, const Client&) {
  const auto found = renamed_at(text.document(), place_of(text, params));
  return found ? text.range(*found) : Json(nullptr);
}

Json rename_json(OpenText& text, const Json& params, const Client& client) {
  const Json& name = at(params, {"newName"});
  if (!name.is_string()) throw Refusal{error::invalid_params, "`newName` is missing."};
  const Rename found = rename(text.document(), place_of(text, params), name.get<std::string>());
  if (!found.refusal.empty()) throw Refusal{error::failed, found.refusal};
  return workspace_edit(found.edits, text, client);
}

namespace {

int lsp_kind(SymbolKind kind) {
  switch (kind) {
    case SymbolKind::System:
      return 2;  // module
    case SymbolKind::Parameter:
      return 14;  // constant
    case SymbolKind::Coordinate:
      return 13;  // variable
    case SymbolKind::Definition:
      return 12;  // function
    case SymbolKind::Place:
      return 5;  // class
    case SymbolKind::Force:
      return 25;  // operator
    case SymbolKind::Event:
      return 24;
    case SymbolKind::Statement:
      return 7;  // property
  }
  return 7;
}

Json symbol_json(const Symbol& symbol, OpenText& text) {
  Json children = Json::array();
  for (const Symbol& child : symbol.children) children.push_back(symbol_json(child, text));
  return {{"name", symbol.name},
          {"detail", symbol.detail},
          {"kind", lsp_kind(symbol.kind)},
          {"range", text.range(symbol.span)},
          {"selectionRange", text.range(symbol.name_span)},
          {"children", std::move(children)}};
}

}  // namespace

Json symbols_json(OpenText& text, const Json&, const Client&) {
  Json list = Json::array();
  for (const Symbol& symbol : symbols(text.document())) list.push_back(symbol_json(symbol, text));
  return list;
}

Json formatting_json(OpenText& text, const Json&, const Client&) {
  return edits_json(formatting(text.document()).edits, text);
}

std::string why_not_formatted(OpenText& text) {
  const auto mistake = formatting(text.document()).mistake;
  if (!mistake) return "";
  const std::string place =
      mistake->span ? fmt::format("line {}: ", text.document().source().locate(mistake->span->begin).line) : "";
  return fmt::format("maup: a text with a mistake of grammar is not laid out. {}{} [{}] {}", place, mistake->message,
                     mistake->code, mistake->help);
}

Json code_actions_json(OpenText& text, const Json& params, const Client& client) {
  Json list = Json::array();
  const Json& only = at(params, {"context", "only"});
  const bool wanted = !only.is_array() || std::any_of(only.begin(), only.end(), [](const Json& kind) {
    return kind == "quickfix" || kind == "";
  });
  if (!wanted) return list;
  const Span place = text.span(at(params, {"range"}));
  const Diagnostics& known = text.document().diagnostics();
  for (const Fix& fix : fixes(text.document(), place)) {
    Json action = {{"title", fix.title}, {"kind", "quickfix"}, {"edit", workspace_edit(fix.edits, text, client)}};
    for (const Diagnostic& d : known.items())
      if (d.code == fix.code && d.span && *d.span == fix.span) {
        action["diagnostics"] = Json::array({diagnostic_json(d, text, client)});
        break;
      }
    list.push_back(std::move(action));
  }
  return list;
}

Json semantic_tokens_json(OpenText& text, const Json&, const Client&) {
  Json data = Json::array();
  Position last;
  for (const SemanticToken& token : semantic_tokens(text.document())) {
    const Range range = text.positions().of(token.span);
    if (range.start.line != range.end.line || range.end.character <= range.start.character) continue;
    const bool same_line = range.start.line == last.line;
    data.push_back(range.start.line - last.line);
    data.push_back(same_line ? range.start.character - last.character : range.start.character);
    data.push_back(range.end.character - range.start.character);
    data.push_back(static_cast<int>(token.kind));
    data.push_back(token.declaration ? 1 : 0);
    last = range.start;
  }
  return {{"data", std::move(data)}};
}

Json folding_json(OpenText& text, const Json&, const Client&) {
  Json list = Json::array();
  for (const Span& span : folding(text.document())) {
    const Range range = text.positions().of(span);
    Json fold = {{"startLine", range.start.line}, {"endLine", range.end.line}};
    if (text.text()[span.begin] == '#') fold["kind"] = "comment";
    list.push_back(std::move(fold));
  }
  return list;
}

}  // namespace maupertuis::app::lsp

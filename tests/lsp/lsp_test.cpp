// `maup lsp` from outside: a scripted editor, every request, hostile frames.
#include "editor.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <csignal>
#include <random>

using namespace lsp_test;

namespace {

const std::string uri = "file:///folder/pendulum.lag";
const std::string pendulum =
    "system pendulum \"Simple pendulum 🎡\"\n"
    "param m = 500 g, l = 1 m, g = 9.81 m/s^2   # 🎡 the bob's mass\n"
    "coord θ : angle\n"
    "point bob mass m at l (sin θ, -cos θ)\n"
    "gravity (0, -g)\n"
    "start θ = 60 deg\n"
    "run 10 s\n";

// With a wheel in front of the last name.
const std::string labelled =
    "param m = 1 kg\ncoord x : length\npoint P mass m at (x, 0)\npoint lengthy at (0, x)\ndraw label P \"🎡\", trail ";

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

bool quick_end(Editor& editor) {
  editor.result("shutdown", nullptr);
  editor.notify("exit", nullptr);
  return editor.wait() == 0;
}

/// The range as "line:character-line:character".
std::string text_of(const Json& range) {
  const auto one = [](const Json& p) {
    return std::to_string(p["line"].get<int>()) + ":" + std::to_string(p["character"].get<int>());
  };
  return one(range["start"]) + "-" + one(range["end"]);
}

}  // namespace

TEST_CASE("initialize, shutdown, exit") {
  Editor editor;
  CHECK(editor.error_code("textDocument/hover", at(uri, 0, 0)) == -32002);  // before initialize
  const Json result = editor.initialize();
  CHECK(result["serverInfo"]["name"] == "maup");
  CHECK(result["capabilities"]["positionEncoding"] == "utf-16");
  CHECK(result["capabilities"]["textDocumentSync"]["change"] == 2);
  CHECK(editor.error_code("initialize", Json::object()) == -32600);  // twice
  CHECK(editor.error_code("textDocument/unheardOf", Json::object()) == -32601);
  CHECK(editor.error_code("textDocument/hover", at("file:///not/open.lag", 0, 0)) == -32602);
  editor.notify("$/unheardOf", Json::object());
  CHECK(editor.answer(editor.ask("shutdown", nullptr))["result"].is_null());
  CHECK(editor.error_code("textDocument/hover", at(uri, 0, 0)) == -32600);  // after shutdown
  editor.notify("exit", nullptr);
  CHECK(editor.wait() == 0);
}

TEST_CASE("exit without shutdown, and a stream that ends, are told by exit code 1") {
  Editor left;
  left.initialize();
  left.notify("exit", nullptr);
  CHECK(left.wait() == 1);
  Editor closed;
  closed.initialize();
  closed.close_input();
  CHECK(closed.wait() == 1);
}

TEST_CASE("a signal ends it") {
  for (const int number : {SIGINT, SIGTERM}) {
    Editor editor;
    editor.initialize();
    editor.open(uri, pendulum);
    editor.diagnostics(uri, 1);
    editor.signal(number);
    CHECK(editor.wait() == 130);
  }
}

TEST_CASE("every request about a text") {
  Editor editor;
  editor.initialize(Json::object(),
                    {{"textDocument", {{"completion", {{"completionItem", {{"snippetSupport", true}}}}}}}});
  editor.open(uri, pendulum);
  CHECK(editor.diagnostics(uri, 1).empty());

  const Json hover = editor.result("textDocument/hover", at(uri, 3, 20));
  CHECK(has(hover["contents"]["value"], "param l = 1 m"));
  CHECK(has(hover["contents"]["value"], "🎡 the bob's mass"));
  CHECK(text_of(hover["range"]) == "3:20-3:21");
  CHECK(editor.result("textDocument/hover", at(uri, 1, 10)).is_null());

  const Json completion = editor.result("textDocument/completion", at(uri, 7, 0));
  const Json& items = completion["items"];
  const auto labelled = [](const Json& list, const std::string& label) {
    return std::find_if(list.begin(), list.end(), [&](const Json& i) { return i["label"] == label; });
  };
  REQUIRE(labelled(items, "start") != items.end());
  CHECK(has((*labelled(items, "pendulum model"))["textEdit"]["newText"], "${1:pendulum}"));
  const Json names = editor.result("textDocument/completion", at(uri, 3, 33))["items"];
  REQUIRE(labelled(names, "θ") != names.end());
  CHECK((*labelled(names, "θ"))["detail"] == "coordinate, angle (rad)");

  CHECK(text_of(editor.result("textDocument/definition", at(uri, 5, 6))["range"]) == "2:6-2:7");
  CHECK(editor.result("textDocument/definition", at(uri, 4, 0)).is_null());
  Json asked = at(uri, 2, 6);
  asked["context"] = {{"includeDeclaration", false}};
  const Json references = editor.result("textDocument/references", asked);
  REQUIRE(references.size() == 3);
  CHECK(text_of(references[0]["range"]) == "3:27-3:28");
  CHECK(editor.result("textDocument/documentHighlight", at(uri, 2, 6)).size() == 4);

  CHECK(text_of(editor.result("textDocument/prepareRename", at(uri, 2, 6))) == "2:6-2:7");
  CHECK(editor.result("textDocument/prepareRename", at(uri, 2, 0)).is_null());
  asked = at(uri, 2, 6);
  asked["newName"] = "φ";
  const Json edit = editor.result("textDocument/rename", asked)["changes"][uri];
  REQUIRE(edit.size() == 4);
  CHECK(edit[0]["newText"] == "φ");
  asked["newName"] = "mass";
  const Json refused = editor.answer(editor.ask("textDocument/rename", asked));
  CHECK(refused["error"]["code"] == -32803);
  CHECK(has(refused["error"]["message"], "`mass` is a word of the language"));

  const Json symbols = editor.result("textDocument/documentSymbol", about(uri));
  REQUIRE(symbols.size() == 7);
  CHECK(symbols[0]["name"] == "pendulum");
  CHECK(symbols[1]["children"].size() == 3);
  CHECK(editor.result("textDocument/formatting", about(uri)).size() == 1);  // the blanks before the comment
  // A text with a mistake of grammar is not laid out, and that is told, as `maup fmt` tells it.
  const std::string half = "file:///half.lag";
  editor.open(half, "coord θ :   angle\nT = (θ'^2\n");
  const int formatted = editor.ask("textDocument/formatting", about(half));
  const std::string told = editor.notification("window/showMessage")["message"];
  CHECK(has(told, "not laid out. line 2: "));
  CHECK(editor.answer(formatted)["result"] == Json::array());
  const Json tokens = editor.result("textDocument/semanticTokens/full", about(uri))["data"];
  CHECK(tokens.size() % 5 == 0);
  CHECK(std::vector<int>(tokens.begin(), tokens.begin() + 5) == std::vector<int>{0, 0, 6, 0, 0});
  CHECK(editor.result("textDocument/foldingRange", about(uri)).empty());
  Json in_function = at(uri, 3, 26);
  CHECK(editor.result("textDocument/signatureHelp", in_function).is_null());
  editor.change(uri, 2, Json::array({{{"text", "let a = atan2(1, "}}}));
  const Json signature = editor.result("textDocument/signatureHelp", at(uri, 0, 17));
  CHECK(signature["signatures"][0]["label"] == "atan2(y, x)");
  CHECK(signature["activeParameter"] == 1);
  CHECK(quick_end(editor));
}

TEST_CASE("mistakes are published with code, range and help, and mended by a code action") {
  Editor editor;
  editor.initialize({{"codeLink", "https://example.org/{code}.html"}});
  editor.open(uri, "# 🎡\nparam m = 1,5 kg /* 🎡 */\n", 4);
  CHECK(!editor.diagnostics(uri, 4).empty());
  editor.change(uri, 5, Json::array({{{"text", labelled + "lenght\n"}}}));
  const Json found = editor.diagnostics(uri, 5);
  REQUIRE(found.size() == 1);
  CHECK(found[0]["code"] == "E0201");
  CHECK(found[0]["severity"] == 1);
  CHECK(text_of(found[0]["range"]) == "4:25-4:31");  // the wheel counts two
  CHECK(found[0]["codeDescription"]["href"] == "https://example.org/E0201.html");
  CHECK(has(found[0]["message"], "Did you mean `lengthy`?"));
  Json asked = about(uri);
  asked["range"] = found[0]["range"];
  asked["context"] = {{"diagnostics", found}};
  const Json actions = editor.result("textDocument/codeAction", asked);
  REQUIRE(actions.size() == 1);
  CHECK(actions[0]["title"] == "Write lengthy");
  CHECK(actions[0]["edit"]["changes"][uri][0]["newText"] == "lengthy");
  asked["context"]["only"] = {"refactor"};
  CHECK(editor.result("textDocument/codeAction", asked).empty());
  CHECK(quick_end(editor));
}

TEST_CASE("the editor chooses how characters are counted") {
  for (const auto& [offered, column] : {std::pair{"utf-8", 4}, std::pair{"utf-16", 2}, std::pair{"utf-32", 1}}) {
    Editor editor;
    const Json result =
        editor.initialize(Json::object(), {{"general", {{"positionEncodings", {"utf-7", offered, "utf-16"}}}}});
    CHECK(result["capabilities"]["positionEncoding"] == offered);
    editor.open(uri, labelled + "lengthy\r\n");
    CHECK(text_of(editor.result("textDocument/definition", at(uri, 4, 23 + column))["range"]) == "3:6-3:13");
    CHECK(editor.result("textDocument/definition", at(uri, 4, 22 + column)).is_null());
    CHECK(quick_end(editor));
  }
}

TEST_CASE("mistakes that show in the equations alone are published behind the others") {
  Editor editor;
  editor.initialize({{"patience", 0}, {"derivationPatience", 0}});
  editor.open(uri,
              "param m = 1 kg, l = 1 m\ncoord x, y : length\npoint P mass m at (x, y)\nconstraint x^2 + y^2 = l^2\n"
              "constraint x^2 + y^2 = 4 l^2\nstart x = 1 m\nrun 1 s\n");
  CHECK(editor.diagnostics(uri, 1).empty());
  CHECK(!editor.diagnostics(uri, 1).empty());
  CHECK(quick_end(editor));
}

TEST_CASE("a derivation that takes too long is given up, and said") {
  std::string text = "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\n", last;
  for (int i = 1; i <= 200; ++i) {
    const std::string n = std::to_string(i);
    text += "coord a" + n + " : angle\npoint P" + n + " mass m at " + last + "l (sin a" + n + ", -cos a" + n + ")\n";
    last = "P" + n + " + ";
  }
  text += "gravity (0, -g)\nrun 1 s\n";
  Editor editor;
  editor.initialize({{"patience", 0}, {"derivationPatience", 0}, {"derivationBudget", 1}});
  editor.open(uri, text);
  CHECK(has(editor.notification("window/logMessage")["message"], "were not derived in 0.001 s"));
  CHECK(quick_end(editor));
}

TEST_CASE("changes of parts of a text leave what the editor shows") {
  // The same changes are made to a text here; the tokens of the two have to agree.
  Editor editor;
  editor.initialize({{"derivation", false}});
  std::mt19937 random(1744);
  std::u32string text = U"coord θ : angle\r\nparam 𝔪 = 1 kg # 🎡\nT = ½ 𝔪 θ̇²\n";
  const auto utf8 = [](const std::u32string& from) {
    std::string out;
    for (const char32_t c : from) {
      if (c < 0x80)
        out += static_cast<char>(c);
      else if (c < 0x800)
        out += {static_cast<char>(0xC0 | (c >> 6)), static_cast<char>(0x80 | (c & 63))};
      else if (c < 0x10000)
        out += {static_cast<char>(0xE0 | (c >> 12)), static_cast<char>(0x80 | ((c >> 6) & 63)),
                static_cast<char>(0x80 | (c & 63))};
      else
        out += {static_cast<char>(0xF0 | (c >> 18)), static_cast<char>(0x80 | ((c >> 12) & 63)),
                static_cast<char>(0x80 | ((c >> 6) & 63)), static_cast<char>(0x80 | (c & 63))};
    }
    return out;
  };
  const auto place_of = [&](std::size_t index) {  // lines end by \n or \r\n here
    int line = 0, character = 0;
    for (std::size_t i = 0; i < index; ++i) {
      character += text[i] >= 0x10000 ? 2 : 1;
      if (text[i] == U'\n') ++line, character = 0;
    }
    return place(line, character);
  };
  editor.open(uri, utf8(text), 0);
  const std::u32string pieces[] = {U"θ", U"𝔪", U"\n", U"kg ", U"", U"🎡", U"(", U" + x'", U"let a = "};
  for (int version = 1; version <= 300; ++version) {
    std::size_t a = random() % (text.size() + 1), b = std::min(a + random() % 4, text.size());
    const auto splits = [&](std::size_t i) {
      return i > 0 && i < text.size() && text[i - 1] == U'\r' && text[i] == U'\n';
    };
    if (splits(a)) --a;
    if (splits(b)) ++b;
    const std::u32string& piece = pieces[random() % std::size(pieces)];
    editor.change(uri, version,
                  Json::array({{{"range", {{"start", place_of(a)}, {"end", place_of(b)}}}, {"text", utf8(piece)}}}));
    text.replace(a, b - a, piece);
    if (version % 20 != 0) continue;
    const std::string other = "file:///other" + std::to_string(version) + ".lag";
    editor.open(other, utf8(text));
    CHECK(editor.result("textDocument/semanticTokens/full", about(uri)) ==
          editor.result("textDocument/semanticTokens/full", about(other)));
    editor.notify("textDocument/didClose", about(other));
  }
  CHECK(quick_end(editor));
}

TEST_CASE("a request that is cancelled before its turn is not carried out") {
  Editor editor;
  editor.initialize();
  editor.open(uri, pendulum);
  // One stream, so that the cancellation is read while the first requests are answered.
  std::string bytes;
  const auto frame = [&](const Json& message) {
    const std::string text = message.dump();
    bytes += "Content-Length: " + std::to_string(text.size()) + "\r\n\r\n" + text;
  };
  for (int id = 1000; id < 1200; ++id)
    frame({{"jsonrpc", "2.0"},
           {"id", id},
           {"method", "textDocument/codeAction"},
           {"params", {{"textDocument", {{"uri", uri}}}, {"range", {{"start", place(0, 0)}, {"end", place(9, 0)}}}}}});
  frame({{"jsonrpc", "2.0"}, {"method", "$/cancelRequest"}, {"params", {{"id", 1199}}}});
  editor.send_bytes(bytes);
  for (int id = 1000; id < 1199; ++id) CHECK(editor.answer(id).contains("result"));
  const Json last = editor.answer(1199);
  CHECK((last.contains("result") || last["error"]["code"] == -32800));
  editor.notify("$/cancelRequest", {{"id", 5000}});
  editor.send({{"jsonrpc", "2.0"}, {"id", 5000}, {"method", "textDocument/hover"}, {"params", at(uri, 3, 20)}});
  CHECK(editor.answer(5000)["error"]["code"] == -32800);
  CHECK(quick_end(editor));
}

TEST_CASE("frames that are none are answered and survived") {
  Editor editor;
  editor.initialize();
  editor.open(uri, pendulum);
  const auto complained = [&](const std::string& bytes, int code) {
    CAPTURE(bytes.substr(0, 60));
    editor.send_bytes(bytes);
    const Json complaint = editor.complaint();
    REQUIRE(complaint.is_object());
    CHECK(complaint["error"]["code"] == code);
    CHECK(text_of(editor.result("textDocument/definition", at(uri, 5, 6))["range"]) == "2:6-2:7");
  };
  complained("Content-Length: 2\r\n\r\n{]", -32700);
  complained("Content-Length: 0\r\n\r\n", -32700);
  complained("Content-Length: 2\r\n\r\n[]", -32600);
  complained("Content-Length: 4\r\n\r\nnull", -32600);
  complained("Content-Length: 13\r\n\r\n{\"method\": 3}", -32600);
  complained("Content-Length: 31\r\n\r\n{\"method\": \"a\", \"id\": {\"b\": 1}}", -32600);
  complained("Hello: 3\r\n\r\n", -32700);
  complained("Content-Length: -5\r\n\r\n", -32700);
  complained("Content-Length: 99999999999999999999x\r\n\r\n", -32700);
  complained(std::string(10'000, 'x'), -32700);
  const std::string deep = std::string(100'000, '[');
  complained("Content-Length: 100000\r\n\r\n" + deep, -32700);
  const std::string closed = deep + std::string(100'000, ']');  // JSON, and deeper than a stack
  const std::string nested = "{\"jsonrpc\":\"2.0\",\"method\":\"$/cancelRequest\",\"params\":{\"id\":" + closed + "}}";
  complained("Content-Length: " + std::to_string(nested.size()) + "\r\n\r\n" + nested, -32700);
  // Other headers, other cases of letters, and lines that end by \n alone are frames.
  const std::string text =
      R"({"jsonrpc":"2.0","id":"text id","method":"textDocument/foldingRange","params":)" + about(uri).dump() + "}";
  editor.send_bytes("content-type: x\r\nCONTENT-LENGTH:" + std::to_string(text.size()) + "\n\n" + text);
  CHECK(editor.result("textDocument/foldingRange", about(uri)).empty());
  CHECK(quick_end(editor));
}

TEST_CASE("parameters of the wrong kind are refused or passed over") {
  Editor editor;
  editor.initialize({{"patience", "soon"}, {"derivation", 3}, {"codeLink", Json::array()}});
  editor.open(uri, pendulum);
  for (const Json& params : {Json(), Json(3), Json("x"), Json::array(), Json::object(), Json{{"textDocument", 3}},
                             Json{{"textDocument", {{"uri", 7}}}}})
    for (const char* method : {"textDocument/hover", "textDocument/rename", "textDocument/codeAction"})
      CHECK(editor.error_code(method, params) == -32602);
  for (const Json& position : {Json(), Json(3), place(-1, -1), place(1'000'000, 5), place(3, 1'000'000),
                               Json{{"line", 1e300}, {"character", "x"}}}) {
    Json params = about(uri);
    params["position"] = position;
    params["range"] = {{"start", position}, {"end", place(0, 0)}};
    for (const char* method : {"hover", "completion", "definition", "references", "documentHighlight", "prepareRename",
                               "signatureHelp", "codeAction"})
      CHECK(editor.answer(editor.ask(std::string("textDocument/") + method, params)).contains("result"));
  }
  editor.change(uri, 2, Json(3));
  editor.change(uri, 3, Json::array({3}));
  editor.change(uri, 4, Json::array({{{"range", 3}, {"text", "coord x : length\n"}}}));
  editor.change(uri, 5,
                Json::array({{{"range", {{"start", place(9, 9)}, {"end", place(0, 0)}}}, {"text", "# \xff\n"}}}));
  editor.notify("textDocument/didOpen", {{"textDocument", {{"uri", uri}}}});
  editor.notify("textDocument/didClose", about("file:///other.lag"));
  CHECK(editor.answer(editor.ask("textDocument/documentSymbol", about(uri))).contains("result"));
  CHECK(quick_end(editor));
}

TEST_CASE("10 MB of text") {
  Editor editor;
  editor.initialize();
  std::string text;
  while (text.size() < 10'000'000) text += "param m" + std::to_string(text.size()) + " = 1 kg # 🎡\n";
  editor.open(uri, text);
  const Json found = editor.diagnostics(uri, 1);
  REQUIRE(found.size() == 1);
  CHECK(found[0]["code"] == "W0818");
  CHECK(editor.result("textDocument/documentSymbol", about(uri)).empty());
  editor.change(uri, 2,
                Json::array({{{"range", {{"start", place(2, 0)}, {"end", place(2'000'000, 0)}}}, {"text", ""}}}));
  const Json after = editor.diagnostics(uri, 2);
  CHECK(std::none_of(after.begin(), after.end(), [](const Json& d) { return d["code"] == "W0818"; }));
  CHECK(editor.result("textDocument/documentSymbol", about(uri)).size() == 2);
  // What stands in a message that is passed over is no message, even where it looks like one.
  std::string body = "Content-Length: 2\r\n\r\n[]";
  body.resize(100'000'000, ' ');
  editor.send_bytes("Content-Length: 100000000\r\n\r\n" + body);
  CHECK(has(editor.complaint()["error"]["message"], "more than 64 MiB"));
  CHECK(editor.result("textDocument/documentSymbol", about(uri)).size() == 2);
  CHECK(!editor.complained());
  CHECK(quick_end(editor));
}

TEST_CASE("many changes one after the other: the last version is the one that is published") {
  Editor editor;
  editor.initialize({{"patience", 1}, {"derivationPatience", 1}});
  editor.open(uri, "", 0);
  for (int version = 1; version <= static_cast<int>(pendulum.size()); ++version)
    if ((pendulum[static_cast<std::size_t>(version) - 1] & 0x80) == 0)
      editor.change(uri, version, Json::array({{{"text", pendulum.substr(0, static_cast<std::size_t>(version))}}}));
  CHECK(editor.diagnostics(uri, static_cast<int>(pendulum.size())).empty());
  CHECK(quick_end(editor));
}

TEST_CASE("a text that is closed has no mistakes left") {
  Editor editor;
  editor.initialize();
  editor.open(uri, "nonsense\n");
  CHECK(!editor.diagnostics(uri, 1).empty());
  editor.notify("textDocument/didSave", about(uri));
  CHECK(!editor.diagnostics(uri, 1).empty());
  editor.notify("textDocument/didClose", about(uri));
  const Json last = editor.notification("textDocument/publishDiagnostics");
  CHECK(last["uri"] == uri);
  CHECK(last["diagnostics"].empty());
  CHECK(quick_end(editor));
}

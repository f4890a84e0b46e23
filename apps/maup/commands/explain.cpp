#include "codes.hpp"
#include "command.hpp"
#include "json.hpp"

#include <fmt/format.h>

namespace maupertuis::app {
namespace {

Json entry_json(const CodeEntry& entry) {
  return {{"code", entry.code},
          {"title", entry.title},
          {"explanation", entry.explanation},
          {"wrong", entry.wrong},
          {"right", entry.right}};
}

std::string indented(std::string_view text) {
  std::string out = "    ";
  for (const char c : text) {
    out += c;
    if (c == '\n') out += "    ";
  }
  while (!out.empty() && (out.back() == ' ' || out.back() == '\n')) out.pop_back();
  return out + "\n";
}

ExitCode list_all(Console& console) {
  Json document = json_document("explain");
  document["codes"] = Json::array();
  for (const CodeEntry& entry : all_codes()) {
    if (console.json())
      document["codes"].push_back(entry_json(entry));
    else
      console.print(fmt::format("{}  {}\n", entry.code, entry.title));
  }
  if (console.json()) console.print_document(document);
  return ExitCode::Fine;
}

ExitCode explain(std::string code, Console& console) {
  if (code.empty()) return list_all(console);
  for (char& c : code) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  std::vector<std::string> known;
  for (const CodeEntry& entry : all_codes()) {
    known.emplace_back(entry.code);
    if (entry.code != code) continue;
    if (console.json()) {
      Json document = json_document("explain");
      document.update(entry_json(entry));
      console.print_document(document);
      return ExitCode::Fine;
    }
    console.print(fmt::format("{}: {}\n\n{}\n", entry.code, entry.title, entry.explanation));
    if (!entry.wrong.empty()) console.print(fmt::format("\nWrong:\n\n{}", indented(entry.wrong)));
    if (!entry.right.empty()) console.print(fmt::format("\nRight:\n\n{}", indented(entry.right)));
    return ExitCode::Fine;
  }
  const std::string near = did_you_mean(code, known);
  console.say(fmt::format("There is no message with the code {}.{} `maup explain` lists them all.\n", code,
                          near.empty() ? "" : fmt::format(" Did you mean {}?", near)));
  return ExitCode::Usage;
}

}  // namespace

void add_explain(CommandLine& line) {
  const auto code = std::make_shared<std::string>();
  Command& command = line.add("explain", "What a message means and how to mend it",
                              "  maup explain E0301\n"
                              "  maup explain                           # lists all codes\n"
                              "  maup explain W0401 --json\n",
                              [code](Console& console) { return explain(*code, console); });
  command.add_option("CODE", *code, "The code of a message, e.g. E0301; none: the list");
}

}  // namespace maupertuis::app

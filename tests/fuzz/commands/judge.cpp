#include "judge.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <regex>

namespace maupertuis::fuzz {
namespace {

bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

bool asks_for(const Input& input, const char* option) {
  return std::any_of(input.arguments.begin(), input.arguments.end(),
                     [&](const std::string& a) { return a.rfind(option, 0) == 0; });
}

/// The line that holds `part`, with its numbers made equal.
std::string line_with(const std::string& text, const char* part) {
  const auto at = text.find(part);
  const auto begin = text.rfind('\n', at) + 1, end = std::min(text.find('\n', at), text.size());
  return std::regex_replace(text.substr(begin, end - begin).substr(0, 160), std::regex("[0-9]+"), "0");
}

/// A word that stands alone, as printf writes what is no number.
std::string no_number(const std::string& text) {
  for (const char* word : {"nan", "inf", "NaN", "Infinity", "-nan", "-inf"}) {
    for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
      const auto end = at + std::char_traits<char>::length(word);
      const auto in_word = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || static_cast<unsigned char>(c) >= 0x80;
      };
      // "\\nand" in a document is the end of a line
      if ((at == 0 || (!in_word(text[at - 1]) && text[at - 1] != '\\')) && (end == text.size() || !in_word(text[end])))
        return line_with(text.substr(at > 60 ? at - 60 : 0), word);
    }
  }
  return {};
}

/// A page holds a program, whose words are not results; data are scripts with a type.
std::string without_scripts(std::string text) {
  for (auto begin = text.find("<script>"); begin != std::string::npos; begin = text.find("<script>", begin)) {
    const auto end = text.find("</script>", begin);
    text.erase(begin, end == std::string::npos ? end : end - begin);
  }
  return text;
}

/// A message quotes what was understood of an option; it is no result.
std::string without_messages(const std::string& text) {
  static const std::regex message("\"(message|reason|help)\": \"[^\n]*");
  return text.find("\"message\"") == std::string::npos ? text : std::regex_replace(text, message, "");
}

/// Somebody typed the word: then it may be quoted.
bool writes_no_number_itself(const Input& input) {
  const auto names_it = [](const std::string& text) {
    return has(text, "nan") || has(text, "inf") || has(text, "NaN") || has(text, "Inf");
  };
  return names_it(input.model) || std::any_of(input.arguments.begin(), input.arguments.end(), names_it);
}

std::string unknown_code(const std::string& text, const std::set<std::string>& catalogue) {
  static const std::regex code(R"((?:error|warning|note) ([EWN][0-9]{4})|"code": "([A-Z][0-9]+)\")");
  for (std::sregex_iterator it(text.begin(), text.end(), code), end; it != end; ++it) {
    const std::string found = (*it)[1].matched ? (*it)[1].str() : (*it)[2].str();
    if (!catalogue.count(found)) return found;
  }
  return {};
}

std::optional<std::string> of_numbers(const Input& input, const Outcome& outcome) {
  const bool is_text_alone =
      !input.arguments.empty() && input.arguments[0] == "explain";  // the catalogue writes about NaN
  if (is_text_alone || writes_no_number_itself(input)) return {};
  if (const std::string line = no_number(without_scripts(without_messages(outcome.out))); !line.empty())
    return "no number in the result: " + line;
  for (const auto& [name, text] : outcome.files) {
    const bool is_text = name.size() < 4 || name.compare(name.size() - 4, 4, ".npy") != 0;
    if (!is_text || name == "model.lag" || asks_for(input, "--errors"))
      continue;  // of an error inf is documented: no digit is certain
    if (const std::string line = no_number(without_scripts(text)); !line.empty())
      return "no number in a file " + name.substr(name.rfind('.') + 1) + ": " + line;
  }
  return {};
}

bool has_control_bytes(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' && c != '\r';
  });
}

}  // namespace

bool runs_motions(const Input& input) {
  static const std::set<std::string> motions{"simulate", "plot", "report", "test", "orbits", "compare", "animate"};
  if (input.arguments.empty()) return false;
  const std::string& command = input.arguments[0];
  return motions.count(command) || (command == "hamiltonian" && asks_for(input, "--integrate")) ||
         (command == "modes" && asks_for(input, "--"));
}

std::optional<std::string> failure(const Input& input, const Outcome& outcome, const std::set<int>& documented,
                                   const std::set<std::string>& catalogue) {
  const std::string command = input.arguments.empty() ? "" : input.arguments[0];
  const std::string all = outcome.err + "\n" + outcome.out;
  const bool asks_to_report = has(all, "please report") || has(all, "Please report");
  if (asks_to_report && command != "explain")
    return command + ": " + line_with(all, has(all, "please report") ? "please report" : "lease report");
  if (has(outcome.err, "internal precondition"))
    return command + ": " + line_with(outcome.err, "internal precondition");
  if (outcome.signal) return command + ": ended by signal " + std::to_string(outcome.signal);
  if (outcome.waiting) return command + ": waits, and computes nothing";
  if (outcome.too_long && !outcome.interruptible)
    return command + ": takes too long, and does not end when it is asked to";
  if (outcome.too_long && !runs_motions(input)) return command + ": takes too long";
  if (outcome.too_long) return {};
  if (!documented.count(outcome.code)) return command + ": undocumented exit code " + std::to_string(outcome.code);
  if (outcome.code != 0 && outcome.err.empty() && outcome.out.empty())
    return command + ": exit code " + std::to_string(outcome.code) + " without a word";
  if (const std::string code = unknown_code(all, catalogue); !code.empty())
    return command + ": a message's code that is not in the catalogue, " + code;
  if (const auto wrong = of_numbers(input, outcome)) return command + ": " + *wrong;
  const bool prints_document = asks_for(input, "--json") && !outcome.out.empty() && outcome.out[0] == '{';
  if (prints_document && outcome.code == 0 && !nlohmann::json::accept(outcome.out))
    return command + ": a JSON document that is none";
  if (has_control_bytes(outcome.out + outcome.err) && !asks_for(input, "--color"))
    return command + ": control bytes reach the terminal";
  return {};
}

}  // namespace maupertuis::fuzz

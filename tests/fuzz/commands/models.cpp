// Models: small ones that hold together, sentences of the grammar, worlds with odd statements, and stored models with
// changes.
#include "input.hpp"
#include "worlds.hpp"

#include <algorithm>
#include <cctype>
#include <regex>
#include <sstream>

namespace maupertuis::fuzz {
namespace {

using Lines = std::vector<std::string>;

Lines lines_of(const std::string& text) {
  Lines out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

std::string joined(const Lines& lines) {
  std::string out;
  for (const std::string& line : lines) out += line + "\n";
  return out;
}

/// Words, numbers, single signs; what is between them stays with the one before.
Lines tokens_of(const std::string& text) {
  const auto in_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || static_cast<unsigned char>(c) >= 0x80;
  };
  Lines out;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i + 1;
    if (in_word(text[i]))
      while (end < text.size() &&
             (in_word(text[end]) || (text[end] == '.' && std::isdigit(static_cast<unsigned char>(text[i])))))
        ++end;
    while (end < text.size() && text[end] == ' ') ++end;
    out.push_back(text.substr(i, end - i));
    i = end;
  }
  return out;
}

const Lines numbers{"0",      "1",   "-1",   "2",       "1e-9", "1e9",  "1e300",
                    "1e-300", "0.5", "1/3",  "3.14159", "100",  "1e16", "4503599627370497",
                    "0.1",    ".5",  "1e400"};

/// Runs of stored models last for hours of their own time; what is looked for is found in its first moments.
std::string with_short_runs(const std::string& text) {
  static const std::regex run("(^|\n)run +[0-9.eE+]+ *[a-z]*( *#[^\n]*)?(?=\n|$)");
  return std::regex_replace(text, run, "$1run 0.4 s");
}

}  // namespace

std::vector<std::string> names_in(const std::string& model) {
  static const std::regex declaration("^ *(?:param|coord|let|point|body|frame|input) +(.*)$");
  static const std::regex name("([A-Za-z\x80-\xff][A-Za-z0-9_\x80-\xff]*) *(?=[=:,]|mass|at|$)");
  std::vector<std::string> out;
  for (const std::string& line : lines_of(model)) {
    std::smatch match;
    if (out.size() > 24 || !std::regex_match(line, match, declaration)) continue;
    const std::string rest = match[1];
    for (std::sregex_iterator it(rest.begin(), rest.end(), name), end; it != end; ++it) out.push_back((*it)[1]);
  }
  return out;
}

std::string Generator::from_grammar(Random& random) const {
  const std::size_t count = 1 + random.below(3);
  std::vector<std::string> names{"x", "y", "z"};
  names.resize(count);
  std::string coordinates, kinetic, start;
  for (std::size_t i = 0; i < count; ++i) {
    coordinates += (i ? ", " : "") + names[i];
    kinetic += (i ? " + " : "") + std::string("1/2 m ") + names[i] + "'^2";
    start += (i ? ", " : "") + names[i] + " = 0." + std::to_string(1 + random.below(9));
  }
  names.insert(names.end(), {"m", "k"});
  const auto formula = [&] { return grammar_.sentence("formula", names, random); };
  Lines lines{"system drawn"};
  const bool dimensionless = !random.one_in(4);
  if (dimensionless) lines.push_back("dimensionless");
  lines.push_back(dimensionless ? "param m = 1, k = 2" : "param m = 1 kg, k = 2 N/m");
  lines.push_back("coord " + coordinates + (dimensionless ? " : number" : " : length"));
  const std::size_t way = random.below(4);
  if (way == 0)
    lines.push_back("L = " + formula());
  else
    lines.push_back("T = " + kinetic + (way == 1 ? " + " + formula() : "")),
        lines.push_back("V = " + (way == 2 ? "1/2 k x^2" : formula()));
  while (random.one_in(2)) lines.push_back(grammar_.sentence("statement", names, random));
  if (random.one_in(3)) lines.push_back("constraint " + formula() + " = " + formula());
  if (random.one_in(4)) lines.push_back("force on x = " + formula());
  if (random.one_in(3)) lines.push_back("expect " + grammar_.sentence("expectation", names, random));
  if (!random.one_in(6)) lines.push_back("start " + start + (random.one_in(2) ? ", x' = 1" : ""));
  lines.push_back(dimensionless ? "run 0.5" : "run 0.5 s");
  return joined(lines);
}

std::string Generator::changed(std::string text, Random& random) const {
  Lines lines = lines_of(text);
  for (std::size_t changes = random.below(4); changes-- && !lines.empty();) {
    const std::size_t at = random.below(lines.size());
    switch (random.below(9)) {
      case 0:
        lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 1:
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), lines[random.below(lines.size())]);
        break;
      case 2:
        std::swap(lines[at], lines[random.below(lines.size())]);
        break;
      case 3: {  // a line of another model
        const Lines others = lines_of(random.of(stored_));
        if (!others.empty()) lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), random.of(others));
        break;
      }
      case 4:
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at),
                     grammar_.sentence("statement", names_in(text), random));
        break;
      case 5: {  // bytes
        std::string& line = lines[at];
        if (!line.empty())
          line[random.below(line.size())] =
              static_cast<char>(random.one_in(4) ? random.below(256) : 32 + random.below(95));
        break;
      }
      default: {  // a word, a number or a sign of a line
        Lines tokens = tokens_of(lines[at]);
        if (tokens.empty()) break;
        std::string& token = tokens[random.below(tokens.size())];
        const bool number = std::isdigit(static_cast<unsigned char>(token[0]));
        if (number && !random.one_in(4))
          token = random.of(numbers) + " ";
        else if (random.one_in(3))
          token = random.of(words_) + " ";
        else if (const auto names = names_in(text); !names.empty() && random.one_in(2))
          token = random.of(names) + " ";
        else if (random.one_in(2))
          token.clear();
        else
          token = grammar_.sentence("formula", names_in(text), random) + " ";
        lines[at].clear();
        for (const std::string& part : tokens) lines[at] += part;
      }
    }
  }
  return joined(lines);
}

std::string Generator::model(Random& random) const {
  const std::size_t way = random.below(10);
  if (way == 0) return with_short_runs(grammar_.sentence("model", {"x", "y", "A", "m"}, random));
  if (way <= 3) return changed(from_grammar(random), random);
  if (way == 4) return model_of_a_world(random);
  return with_short_runs(changed(random.of(stored_), random));
}

}  // namespace maupertuis::fuzz

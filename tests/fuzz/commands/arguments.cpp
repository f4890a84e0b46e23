// Arguments: every command and option of the program's own table, with values that fit, that nearly fit, and that do
// not.
#include "input.hpp"

#include <stdexcept>
#include <utility>

namespace maupertuis::fuzz {
namespace {

using Words = std::vector<std::string>;

const Words times{"0.1s", "0.2 s", "300ms", "0.5", "0.01 min"},
    odd_times{"0", "-0.3s", "1e-300s", "3kg", "", "s", "0.1s,0.2s", "1e400s"};
const Words counts{"1", "2", "3", "4", "6", "12"},
    odd_counts{"0", "-1", "1e-8", "1e-3", "0.5", "20", "abc", "1e999", "", "99999999999999999999"};
const Words files{"out.csv", "out.npy", "out.json",  "out.svg",         "out.html", "out.lag", "out.png",
                  "out",     "",        "model.lag", "nowhere/out.csv", "-",        ".",       "/dev/full"};
const Words junk{"", "-", "--", "x", "=", "θ", "0", "'", "\"", "(", "x = ", "a\nb", "#", "é", "\xff", "{}", "%s"};

const std::string border = "----\n";

bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

}  // namespace

std::string Generator::value_for(const app::OptionRow& row, const std::vector<std::string>& names,
                                 Random& random) const {
  if (random.one_in(40)) return random.of(junk);
  const bool odd = random.one_in(5);
  if (!row.words.empty()) return random.one_in(12) ? random.of(words_) : random.of(row.words);
  const auto formula = [&] {
    return random.one_in(2) && !names.empty() ? random.of(names) : grammar_.sentence("formula", names, random);
  };
  const std::string name = names.empty() ? "x" : random.of(names);
  const std::string& value = row.value;
  if (value.rfind("FILE", 0) == 0) return random.of(files);
  if (has(value, "NAME=VALUE"))
    return name + (random.one_in(6) ? "'" : "") + "=" + grammar_.sentence("quantity", names, random);
  if (has(value, "POINT")) return random.one_in(3) ? random.of(odd ? odd_times : times) : name + "=" + formula();
  if (has(value, "TIME") || has(value, "PERIOD")) return random.of(odd ? odd_times : times);
  if (has(value, "NUMBER") || has(value, "INT") || has(value, "FLOAT") || value == "N")
    return random.of(odd ? odd_counts : counts);
  if (has(value, "EQUATION")) return formula() + " = " + formula() + (random.one_in(3) ? " rising" : "");
  if (has(value, "SWEEP")) return name + " = 0 .. 2 steps " + std::to_string(2 + random.below(6));
  if (has(value, "ENDS")) return "(" + random.of(counts) + ") at 0 to (" + random.of(counts) + ") at 1 s";
  if (has(value, "WEIGHTS")) return random.one_in(2) ? "1" : "1, 1, 0.1, 0";
  if (has(value, "NAME")) return name;
  if (random.one_in(3)) return name + " = " + formula();
  return formula();
}

std::vector<std::string> Generator::arguments(const std::string& model, Random& random) const {
  // Commands that look at a model and run nothing are the quickest, and most of the program stands behind them.
  static const Words quick{"check", "derive", "fmt", "check", "derive", "hamiltonian"};
  const app::CommandRow* command = &random.of(table_.commands);
  if (random.one_in(2)) {
    const std::string& name = random.of(quick);
    for (const app::CommandRow& row : table_.commands)
      if (row.name == name) command = &row;
  }
  if (random.one_in(200)) return {random.of(junk), random.of(words_)};
  const std::vector<std::string> names = names_in(model);
  Words out{command->name};
  const auto option = [&](const app::OptionRow& row) {
    const std::string& name = random.of(row.names);
    if (row.value.empty()) return out.push_back(name);
    const std::string value = value_for(row, names, random);
    if (random.one_in(4) && name.rfind("--", 0) == 0) return out.push_back(name + "=" + value);
    out.insert(out.end(), {name, value});
  };
  const std::size_t rarity = random.one_in(3) ? 8 : 40;  // of options
  bool has_length = false;
  const app::OptionRow* length = nullptr;
  for (const app::OptionRow& row : command->options) {
    if (row.positional) {
      const bool is_model = has(row.what, "odel");
      if (random.one_in(50)) continue;
      out.push_back(is_model ? random.one_in(3)    ? "-"
                               : random.one_in(40) ? "missing.lag"
                                                   : "model.lag"
                             : value_for(row, names, random));
    } else {
      const bool is_length = row.names.back() == "--duration";
      if (is_length) length = &row;
      if (row.names.back() == "--help" && !random.one_in(40)) continue;
      if (!random.one_in(rarity)) continue;
      option(row);
      has_length = has_length || is_length;
    }
  }
  // A studio that finds its page serves it until somebody ends it; hostile requests are sent by tests/studio.
  if (command->name == "studio") out.insert(out.end(), {"--page", "nowhere"});
  if (length && !has_length && !random.one_in(8)) out.insert(out.end(), {"--duration", "0.3s"});
  if (random.one_in(100)) out.push_back(random.of(junk));
  return out;
}

Input Generator::input(std::uint64_t number) const {
  Random random(seed_, number);
  Input out;
  out.model = model(random);
  out.arguments = arguments(out.model, random);
  return out;
}

std::string to_text(const Input& input) {
  std::string out;
  for (const std::string& argument : input.arguments) {
    for (const char c : argument)
      if (c == '\n')
        out += "\\n";
      else if (c == '\\')
        out += "\\\\";
      else
        out += c;
    out += '\n';
  }
  return out + border + input.model;
}

Input from_text(const std::string& text) {
  const auto at = text.rfind(border, 0) == 0 ? 0 : text.find(std::string("\n") + border) + 1;
  if (at == 0 && text.rfind(border, 0) != 0)
    throw std::runtime_error("no line of dashes between the arguments and the model");
  Input out;
  out.model = text.substr(at + border.size());
  std::string argument;
  for (std::size_t i = 0; i < at; ++i)
    if (text[i] == '\n')
      out.arguments.push_back(std::exchange(argument, {}));
    else if (text[i] == '\\' && i + 1 < at)
      argument += text[++i] == 'n' ? '\n' : text[i];
    else
      argument += text[i];
  return out;
}

}  // namespace maupertuis::fuzz

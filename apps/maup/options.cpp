#include "options.hpp"

#include <maupertuis/diagnostic.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>

namespace maupertuis::app {

Option* Option::type_name(const std::string& name) {
  own_->type_name(name);
  if (name.starts_with("FILE"))  // nothing would be written, and nothing said
    own_->check(
        CLI::Validator([](std::string& file) { return std::string(file.empty() ? "no file is named" : ""); }, ""));
  return this;
}
Option* Option::required() { return own_->required(), this; }
Option* Option::needs(const Option* other) { return own_->needs(other->own_), this; }
Option* Option::excludes(const Option* other) { return own_->excludes(other->own_), this; }
Option* Option::one_of(std::initializer_list<const char*> words) {
  return own_->check(CLI::IsMember(std::vector<std::string>(words.begin(), words.end()))), this;
}
Option* Option::between(int least, int most) { return own_->check(CLI::Range(least, most)), this; }
Option* Option::positive() {
  const auto problem = [](std::string& text) {
    double value = 0;
    return std::string(CLI::detail::lexical_cast(text, value) && value > 0 ? "" : text + " is no positive number");
  };
  return own_->check(CLI::Validator(problem, "POSITIVE")), this;
}
Option* Option::not_empty() {
  own_->check(
      CLI::Validator([](std::string& text) { return std::string(text.empty() ? "nothing is written" : ""); }, ""));
  return this;
}
Option* Option::delimiter(char separator) { return own_->delimiter(separator), this; }
Option* Option::allow_extra_args(bool allowed) { return own_->allow_extra_args(allowed), this; }
Option* Option::type_size(int arguments) { return own_->type_size(arguments), this; }
Option* Option::expected(int least, int most) { return own_->expected(least, most), this; }

template <class Value>
Option* Command::add_option(const std::string& names, Value& value, const std::string& what) {
  return kept(own_.add_option(names, value, what));
}
template Option* Command::add_option(const std::string&, std::string&, const std::string&);
template Option* Command::add_option(const std::string&, std::optional<std::string>&, const std::string&);
template Option* Command::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option* Command::add_option(const std::string&, int&, const std::string&);
template Option* Command::add_option(const std::string&, std::size_t&, const std::string&);
template Option* Command::add_option(const std::string&, double&, const std::string&);
template Option* Command::add_option(const std::string&, std::optional<int>&, const std::string&);
template Option* Command::add_option(const std::string&, std::optional<std::int64_t>&, const std::string&);
template Option* Command::add_option(const std::string&, std::optional<double>&, const std::string&);

Option* Command::add_option_function(const std::string& names, std::function<void(const Words&)> take,
                                     const std::string& what) {
  return kept(own_.add_option_function<Words>(names, std::move(take), what));
}
Option* Command::add_flag(const std::string& names, bool& value, const std::string& what) {
  return kept(own_.add_flag(names, value, what));
}
Option* Command::add_flag_callback(const std::string& names, std::function<void()> act, const std::string& what) {
  return kept(own_.add_flag_callback(names, std::move(act), what));
}
void Command::allow_extras() { own_.allow_extras(); }
void Command::group(const std::string& name) { own_.group(name); }

namespace {

/// --help of a command opens with its examples.
class HelpWithExamples : public CLI::Formatter {
 public:
  explicit HelpWithExamples(std::string examples) : examples_(std::move(examples)) { column_width(34); }
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    return "Examples:\n" + examples_ + "\n" + CLI::Formatter::make_help(app, std::move(name), mode);
  }

 private:
  std::string examples_;
};

/// "{auto,taylor,stiff}", which the parser says of a choice, behind the name of the value: METHOD:{auto,taylor,stiff}.
std::vector<std::string> words_of(const std::string& value) {
  const auto begin = value.find(":{"), end = value.rfind('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  return CLI::detail::split(value.substr(begin + 2, end - begin - 2), ',');
}

OptionRow row_of(const CLI::Option& option) {
  OptionRow row;
  row.positional = option.get_positional();
  if (row.positional) row.names = {option.get_name(true, false)};
  for (const std::string& name : option.get_snames()) row.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) row.names.push_back("--" + name);
  if (option.get_items_expected_max() > 0) {
    const std::string value = option.get_type_name();
    row.value = value.substr(0, value.find(':'));
    row.words = words_of(value);
    row.value_optional = option.get_items_expected_min() == 0 && !row.positional;
    row.many = option.get_items_expected_max() > 1;
  }
  row.what = option.get_description();
  row.required = option.get_required();
  return row;
}

std::vector<OptionRow> rows_of(const CLI::App& app) {
  std::vector<OptionRow> rows;
  for (const CLI::Option* option : app.get_options()) rows.push_back(row_of(*option));
  return rows;
}

}  // namespace

struct CommandParser::Implementation {
  CLI::App app;
  std::deque<Command> commands;
  std::map<std::string, std::string> examples;  // by command
};

CommandParser::CommandParser(const std::string& what, const std::string& version, const std::string& footer)
    : implementation_(new Implementation{CLI::App(what, "maup"), {}, {}}) {
  CLI::App& app = implementation_->app;
  app.require_subcommand(1);
  app.set_version_flag("--version", version);
  app.get_formatter()->column_width(16);
  app.footer(footer);
}

CommandParser::~CommandParser() = default;

Command& CommandParser::add(const std::string& name, const std::string& summary, const std::string& examples,
                            std::function<void()> chosen) {
  CLI::App& command = *implementation_->app.add_subcommand(name, summary);
  command.formatter(std::make_shared<HelpWithExamples>(examples));
  implementation_->examples[name] = examples;
  command.callback(std::move(chosen));
  return implementation_->commands.emplace_back(command);
}

OptionTable CommandParser::table() const {
  const CLI::App& app = implementation_->app;
  OptionTable table;
  table.program = app.get_name();
  table.summary = app.get_description();
  table.options = rows_of(app);
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    CommandRow row;
    row.name = command->get_name();
    row.summary = command->get_description();
    row.examples = implementation_->examples.at(row.name);
    row.later = command->get_group() != "Subcommands";
    row.options = rows_of(*command);
    table.commands.push_back(std::move(row));
  }
  return table;
}

/// What to say of a first word that is no command; empty where it is one, or an option.
std::string CommandParser::unknown_command(const std::string& word) const {
  std::vector<std::string> names;
  for (const CLI::App* command : implementation_->app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  if (word.empty() || word[0] == '-' || std::find(names.begin(), names.end(), word) != names.end()) return {};
  const std::string near = did_you_mean(word, names);
  const bool is_model = word.size() > 4 && word.substr(word.size() - 4) == ".lag";
  return fmt::format("`{}` is no command of maup.{}\nRun maup --help for the commands.\n", word,
                     is_model       ? fmt::format(" Write what to do with it: maup check {}", word)
                     : near.empty() ? ""
                                    : fmt::format(" Did you mean `{}`?", near));
}

CommandParser::Outcome CommandParser::parse(int argc, char** argv, std::ostream& out, std::ostream& err) {
  CLI::App& app = implementation_->app;
  if (const std::string unknown = argc > 1 ? unknown_command(argv[1]) : ""; !unknown.empty()) {
    err << unknown;
    return Outcome::Mistake;
  }
  try {
    app.parse(argc, argv);
    return Outcome::Command;
  } catch (const CLI::ParseError& error) {
    return app.exit(error, out, err) == 0 ? Outcome::Answered : Outcome::Mistake;
  }
}

}  // namespace maupertuis::app

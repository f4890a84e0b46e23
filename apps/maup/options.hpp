#pragma once
#include "option_table.hpp"

#include <deque>
#include <functional>
#include <initializer_list>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace maupertuis::app {

/// An option or flag of a command. What is asked of it is added one after the other:
/// command.add_option("--step", step, "…")->type_name("TIME")->needs(method).
class Option {
 public:
  explicit Option(CLI::Option* own) : own_(own) {}

  /// How --help calls its value.
  Option* type_name(const std::string& name);
  Option* required();
  Option* needs(const Option* other);
  Option* excludes(const Option* other);
  /// The value is one of these words; a whole number between two, both included; a positive number.
  Option* one_of(std::initializer_list<const char*> words);
  Option* between(int least, int most);
  Option* positive();
  /// An empty text is refused, instead of being taken for an option that is not given.
  Option* not_empty();
  /// One argument may hold several values, parted by `separator`.
  Option* delimiter(char separator);
  /// False: each value of a list wants the option written before it.
  Option* allow_extra_args(bool allowed);
  /// So many arguments after the option are one value.
  Option* type_size(int arguments);
  /// How many values are given, at least and at most.
  Option* expected(int least, int most);

 private:
  CLI::Option* own_;
};

/// A command and its options. Only options.cpp includes the parser behind it (CLI11): its headers take longer to
/// compile than a command does.
class Command {
 public:
  using Words = std::vector<std::string>;
  explicit Command(CLI::App& own) : own_(own) {}

  /// An option whose value goes to `value`, which lives as long as the command; std::optional stays empty without the
  /// option. `names` are as in "-o,--output"; a name without dashes is that of a positional argument. options.cpp lists
  /// the types.
  template <class Value>
  Option* add_option(const std::string& names, Value& value, const std::string& what);
  /// An option whose values are handed to `take`.
  Option* add_option_function(const std::string& names, std::function<void(const Words&)> take,
                              const std::string& what);
  Option* add_flag(const std::string& names, bool& value, const std::string& what);
  Option* add_flag_callback(const std::string& names, std::function<void()> act, const std::string& what);

  /// Arguments that belong to no option are passed over.
  void allow_extras();
  /// The heading above this command in the list of commands.
  void group(const std::string& name);

 private:
  Option* kept(CLI::Option* option) { return &options_.emplace_back(option); }

  CLI::App& own_;
  std::deque<Option> options_;
};

/// The commands of the program, and the reading of its arguments.
class CommandParser {
 public:
  /// What the arguments came to: a command that they name, --help or --version that were answered, a mistake that was
  /// told.
  enum class Outcome { Command, Answered, Mistake };

  /// `what` and `footer` stand above and below the list of commands, `version` is the answer to --version.
  CommandParser(const std::string& what, const std::string& version, const std::string& footer);
  ~CommandParser();

  /// `examples` open the command's --help; `chosen` is called by parse() when the arguments name the command.
  Command& add(const std::string& name, const std::string& summary, const std::string& examples,
               std::function<void()> chosen);
  /// What is answered goes to `out`, what is told of a mistake to `err`.
  Outcome parse(int argc, char** argv, std::ostream& out, std::ostream& err);
  /// What --help says, in parts; all but the version.
  OptionTable table() const;

 private:
  std::string unknown_command(const std::string& word) const;

  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace maupertuis::app

#pragma once
#include "option_table.hpp"

#include "grammar.hpp"

#include <string>
#include <vector>

namespace maupertuis::fuzz {

/// What the program is given: arguments without its own name, and the model, which is the file model.lag and standard
/// input alike.
struct Input {
  std::vector<std::string> arguments;
  std::string model;
};

/// As it is kept: an argument a line (\\n and \\\\ within it), a line of four dashes, the model.
std::string to_text(const Input& input);
Input from_text(const std::string& text);

/// Draws inputs: models from the grammar and from stored ones that are changed at random, arguments from the program's
/// own table of options.
class Generator {
 public:
  /// `stored`: texts of models. `table`: see CommandLine::table.
  Generator(Grammar grammar, std::vector<std::string> stored, app::OptionTable table, std::uint64_t seed)
      : grammar_(std::move(grammar)),
        stored_(std::move(stored)),
        table_(std::move(table)),
        seed_(seed),
        words_(grammar_.words().begin(), grammar_.words().end()) {}

  Input input(std::uint64_t number) const;

 private:
  std::string model(Random& random) const;
  std::string from_grammar(Random& random) const;
  std::string changed(std::string text, Random& random) const;
  std::vector<std::string> arguments(const std::string& model, Random& random) const;
  std::string value_for(const app::OptionRow& row, const std::vector<std::string>& names, Random& random) const;

  Grammar grammar_;
  std::vector<std::string> stored_;
  app::OptionTable table_;
  std::uint64_t seed_;
  std::vector<std::string> words_;
};

/// The names that a model declares, and the velocities of them.
std::vector<std::string> names_in(const std::string& model);

}  // namespace maupertuis::fuzz

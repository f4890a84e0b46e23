#pragma once
#include <string>
#include <vector>

namespace maupertuis::app {

/// What --help says of an option, in parts: completions and the manual page are written from it.
struct OptionRow {
  std::vector<std::string> names;  // "-o", "--output"; of a positional argument its one name, "MODEL"
  std::string value;               // how --help calls its value; empty: it takes none
  std::vector<std::string> words;  // the only values; empty: any
  std::string what;
  bool positional = false;
  bool required = false;
  bool many = false;  // it may stand several times
  bool value_optional = false;
};

struct CommandRow {
  std::string name, summary, examples;
  bool later = false;  // of a later version: it only says so
  std::vector<OptionRow> options;
};

/// The whole command line.
struct OptionTable {
  std::string program, summary, version;
  std::vector<OptionRow> options;  // of the program itself
  std::vector<CommandRow> commands;
};

}  // namespace maupertuis::app

#pragma once
#include <string>
#include <vector>

/// The code blocks of Markdown texts. What a block is, its first line says: ```console, ```lag, ```formula, …
namespace documents_test {

struct Block {
  std::string file;  // of the repository
  int line = 0;      // of its first line of text
  std::string kind;  // "console"; "lag"; "" where the document does not say
  std::string word;  // what follows the kind: "install" of "sh install"
  std::vector<std::string> text;

  std::string place() const { return file + ":" + std::to_string(line); }
  std::string joined() const;
};

/// The fenced blocks and those that are indented by four columns, which have no kind. Text behind an item of a list is
/// none.
std::vector<Block> blocks_of(const std::string& file, const std::string& markdown);

/// All documents that are read: README.md, ARCHITECTURE.md, CONTRIBUTING.md, CHANGELOG.md and the pages below docs.
std::vector<std::string> documents();

struct Command {
  std::string line;
  std::vector<std::string> shown;  // below it in the block
};
std::vector<Command> commands_of(const Block& block);

/// Whether the lines that are shown follow each other in what came. A line "…" stands for any number of lines, "…"
/// within a line for any text. Says in `missing` which line did not come.
bool shows(const std::vector<std::string>& shown, const std::string& came, std::string& missing);

}  // namespace documents_test

#include "blocks.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <sstream>

namespace documents_test {
namespace fs = std::filesystem;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string trimmed(std::string line) {
  while (!line.empty() && (line.back() == ' ' || line.back() == '\r')) line.pop_back();
  return line;
}

bool begins(const std::string& line, const char* with) { return line.rfind(with, 0) == 0; }

bool is_item(const std::string& line) {
  const std::size_t at = line.find_first_not_of(" 0123456789");
  return at != std::string::npos && at + 1 < line.size() && line[at + 1] == ' ' &&
         (line[at] == '-' || line[at] == '*' || (line[at] == '.' && at > 0));
}

/// 4.55(3): a number and by how much its last digit may be off. Last digits depend on the processor.
struct Measured {
  double value = 0, error = 0;
};

/// Takes the numbers with parentheses out of a line and leaves the places.
std::vector<Measured> taken_out(std::string& line) {
  static const std::regex number(R"((-?\d+(?:\.(\d+))?)\((\d+)\))");
  std::vector<Measured> found;
  for (std::sregex_iterator at(line.begin(), line.end(), number), end; at != end; ++at)
    found.push_back({std::stod((*at)[1]), std::stod((*at)[3]) * std::pow(10, -double((*at)[2].length()))});
  line = std::regex_replace(line, number, "()");
  return found;
}

bool same_numbers(std::string& shown, std::string& line) {
  const std::vector<Measured> a = taken_out(shown), b = taken_out(line);
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Measured& x, const Measured& y) {
    return std::abs(x.value - y.value) <= x.error + y.error && x.error <= 10 * y.error && y.error <= 10 * x.error;
  });
}

constexpr const char* any = "…";

/// A line with "…" in it: its parts come in this order, the first at the beginning and the last at the end.
bool fits(std::string shown, std::string line) {
  if (!same_numbers(shown, line)) return false;
  std::size_t at = 0, from = 0;
  for (;;) {
    const std::size_t next = shown.find(any, from);
    const std::string part = shown.substr(from, next == std::string::npos ? next : next - from);
    if (next == std::string::npos)
      return from == 0
                 ? line == part
                 : line.size() >= at + part.size() && line.compare(line.size() - part.size(), part.size(), part) == 0;
    const std::size_t found = line.find(part, at);
    if (found == std::string::npos || (from == 0 && found != 0)) return false;
    at = found + part.size();
    from = next + std::string(any).size();
  }
}

}  // namespace

std::string Block::joined() const {
  std::string all;
  for (const std::string& one : text) all += one + "\n";
  return all;
}

std::vector<Block> blocks_of(const std::string& file, const std::string& markdown) {
  std::vector<Block> blocks;
  bool fenced = false, indented = false, list = false;
  std::string before;
  int number = 0;
  for (const std::string& line : lines_of(markdown)) {
    ++number;
    if (begins(line, "```")) {
      fenced = !fenced;
      std::istringstream info(line.substr(3));
      Block block{file, number + 1, {}, {}, {}};
      info >> block.kind >> block.word;
      if (fenced) blocks.push_back(block);
    } else if (fenced) {
      blocks.back().text.push_back(line);
    } else if (begins(line, "    ") && (indented || (before.empty() && !list))) {
      if (!indented) blocks.push_back({file, number, {}, {}, {}});
      blocks.back().text.push_back(line.substr(4));
      indented = true;
      continue;
    }
    indented = false;
    if (!line.empty() && line[0] != ' ') list = is_item(line);
    before = line;
  }
  return blocks;
}

std::vector<std::string> documents() {
  std::vector<std::string> files{"README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"};
  const fs::path root(PROJECT_DIR);
  for (const auto& entry : fs::recursive_directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md") files.push_back(fs::relative(entry.path(), root).string());
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<Command> commands_of(const Block& block) {
  std::vector<Command> commands;
  for (const std::string& line : block.text) {
    if (begins(line, "$ "))
      commands.push_back({line.substr(2), {}});
    else if (!commands.empty())
      commands.back().shown.push_back(trimmed(line));
  }
  return commands;
}

bool shows(const std::vector<std::string>& shown, const std::string& came, std::string& missing) {
  const std::vector<std::string> lines = lines_of(came);
  std::size_t at = 0;
  bool skip = true;  // what comes before the first line that is shown, such as a warning
  for (const std::string& line : shown) {
    if (line.empty()) continue;
    if (line == any) {
      skip = true;
      continue;
    }
    const auto same = [&](const std::string& one) { return fits(line, trimmed(one)); };
    while (at < lines.size() && (skip ? !same(lines[at]) : lines[at].empty())) ++at;
    if (at == lines.size() || !same(lines[at])) {
      missing = line;
      return false;
    }
    ++at;
    skip = false;
  }
  return true;
}

}  // namespace documents_test

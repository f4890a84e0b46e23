#pragma once
#include "../program.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

/// The models of the gallery and of the literature, and what is done with all of them.
namespace print_test {

using namespace cli_test;

inline std::vector<std::string> models_in(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(PROJECT_DIR) + "/" + folder))
    if (entry.path().extension() == ".lag") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The model without what it expects of itself: these tests add their own.
inline std::string without_expectations(const std::string& model) {
  std::string out;
  bool left_out = false;
  for (const std::string& line : lines_of(model)) {
    const bool continued = !line.empty() && (line[0] == ' ' || line[0] == '\t');
    if (!continued) left_out = line.rfind("expect", 0) == 0 || line.rfind("claim", 0) == 0;
    if (!left_out) out += line + "\n";
  }
  return out;
}

inline std::string name_of(const std::string& path) { return std::filesystem::path(path).stem().string(); }

}  // namespace print_test

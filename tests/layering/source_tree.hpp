#pragma once
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace source_tree {

struct File {
  std::string path;  // relative to the project, with /
  std::vector<std::string> lines;
};

inline File read(const std::filesystem::path& path) {
  File file{std::filesystem::relative(path, PROJECT_DIR).generic_string(), {}};
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) file.lines.push_back(line);
  return file;
}

/// Every .hpp and .cpp below these folders of the project.
inline std::vector<File> sources(const std::vector<std::string>& folders) {
  std::vector<File> files;
  for (const std::string& folder : folders)
    for (const auto& entry : std::filesystem::recursive_directory_iterator(std::filesystem::path(PROJECT_DIR) / folder))
      if (entry.path().extension() == ".hpp" || entry.path().extension() == ".cpp") files.push_back(read(entry.path()));
  return files;
}

}  // namespace source_tree

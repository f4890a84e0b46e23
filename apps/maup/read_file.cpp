#include "read_file.hpp"

#include <fmt/format.h>

#include <maupertuis/look_alikes.hpp>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

namespace maupertuis::app {
namespace {

constexpr std::size_t size_limit = 64u << 20;

/// A name in messages stays on its line.
std::string on_one_line(std::string_view name) {
  std::string out;
  for (const char c : visible(name)) {
    if (c == '\n' || c == '\t')
      out += c == '\n' ? "\\n" : "\\t";
    else
      out += c;
  }
  return out;
}

/// The file of the same folder whose name is nearest to a misspelt path.
std::string nearest_file(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path wanted(path);
  const fs::path folder = wanted.has_parent_path() ? wanted.parent_path() : fs::path(".");
  std::vector<std::string> names;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->path().extension() == ".lag") names.push_back(it->path().filename().string());
  std::string near = did_you_mean(wanted.filename().string(), names);
  if (near.empty() && wanted.extension() != ".lag") near = did_you_mean(wanted.filename().string() + ".lag", names);
  return near.empty() ? near : (wanted.parent_path() / near).string();
}

void cannot_open(const std::string& path, int error, Diagnostics& diagnostics) {
  auto& diagnostic = diagnostics.error("E0801", {}, fmt::format("I cannot read {}.", display_name(path)),
                                       fmt::format("The system says: {}.", std::strerror(error)));
  if (error != ENOENT) return;
  if (const std::string near = nearest_file(path); !near.empty())
    diagnostic.help = fmt::format("Did you mean {}?", near);
  else
    diagnostic.help = "`maup new pendulum` writes a first model.";
}

/// A name that is not what it seems is told with every file that has one.
void warn_of_letters(const std::string& path, Diagnostics& diagnostics) {
  const std::string name = std::filesystem::path(path).filename().string(), foreign = foreign_letter(name);
  if (on_one_line(name) != name)
    diagnostics.warning("W0817", {}, fmt::format("the name of the file is shown as {}", on_one_line(name)),
                        "It holds characters that a terminal carries out instead of showing them.", "Rename it.");
  else if (!foreign.empty())
    diagnostics.warning("W0817", {}, fmt::format("the name of the file mixes two alphabets: {}", foreign),
                        fmt::format("It looks like {}, and is another name.", latin_look(name)), "Rename it.");
}

}  // namespace

std::string display_name(const std::string& path) { return path == "-" ? "standard input" : on_one_line(path); }

std::string read_file(const std::string& path, Diagnostics& diagnostics) {
  std::error_code error;
  warn_of_letters(path, diagnostics);
  if (path != "-" && std::filesystem::is_directory(path, error)) {
    diagnostics.error("E0802", {}, fmt::format("{} is a directory, not a model file.", path), {},
                      "Name one of the .lag files in it.");
    return {};
  }
  std::FILE* file = path == "-" ? stdin : std::fopen(path.c_str(), "rb");
  if (!file) {
    cannot_open(path, errno, diagnostics);
    return {};
  }
  std::string text;
  std::vector<char> buffer(1u << 16);
  while (text.size() <= size_limit) {
    const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file);
    text.append(buffer.data(), count);
    if (count < buffer.size()) break;
  }
  const int read_error = std::ferror(file) ? errno : 0;
  if (file != stdin) std::fclose(file);
  if (read_error) {
    cannot_open(path, read_error, diagnostics);
    return {};
  }
  if (text.size() > size_limit) {
    diagnostics.error("E0803", {}, fmt::format("{} is larger than 64 MiB.", display_name(path)),
                      "A model is a text that a person writes; this is something else.", "Is it the right file?");
    return {};
  }
  return text;
}

}  // namespace maupertuis::app

#include "output_files.hpp"

#include <maupertuis/picture.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace maupertuis::app {
namespace {

namespace fs = std::filesystem;

struct Kind {
  const char* name;
  std::vector<std::string_view> endings;
};

Kind kind_of(FileKind kind) {
  switch (kind) {
    case FileKind::Picture:
      return {"picture", {".svg", ".png", ".pdf"}};
    case FileKind::Table:
      return {"table", {".csv", ".npy", ".json"}};
    case FileKind::Csv:
      return {"text table", {".csv"}};
    case FileKind::Page:
      return {"page", {".html", ".htm"}};
    case FileKind::Model:
      return {"model", {".lag"}};
    case FileKind::Animation:
      return {"moving picture", {".mp4", ".gif", ".html", ".htm", ".svg"}};
  }
  return {};
}

bool is_special(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  return a == b || (fs::exists(a, error) && fs::exists(b, error) && fs::equivalent(a, b, error));
}

/// A redirected standard input has no name here; the file behind it is known by its device and number.
bool is_standard_input(const std::string& path) {
  struct stat own, input;
  return stat(path.c_str(), &own) == 0 && fstat(STDIN_FILENO, &input) == 0 && own.st_dev == input.st_dev &&
         own.st_ino == input.st_ino;
}

bool is_model(const std::string& path, const std::string& model) {
  return model == "-" ? is_standard_input(path) : is_same_file(path, model);
}

/// What a symbolic link leads to is written, whatever the link is called; empty where that is no model.
std::string model_behind(const std::string& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return {};
  const fs::path target = fs::weakly_canonical(path, error);
  return !error && target.extension() == ".lag" ? target.filename().string() : std::string();
}

/// E0804 before the run where the folder is missing; the rest is seen when the file is written.
void check_folder(const OutputFile& file, Diagnostics& diagnostics) {
  const fs::path folder = fs::path(file.path).parent_path();
  std::error_code error;
  if (!folder.empty() && !fs::is_directory(folder, error))
    diagnostics.error(
        "E0804", {},
        fmt::format("{} {} cannot be written: there is no folder {}.", file.option, file.path, folder.string()),
        "Nothing was computed.", fmt::format("Make it first: mkdir -p {}", folder.string()));
}

std::string help_for(const OutputFile& file, const Kind& kind) {
  const std::string extension = fs::path(file.path).extension().string();
  if (extension == ".h5") return "not supported yet: HDF5. Take .csv, .npy or .json.";
  if (file.kind == FileKind::Animation && (extension == ".png" || extension == ".pdf"))
    return "One moment is a picture: add --still 2s.";
  if (kind.endings.size() == 1) return fmt::format("Take {}.", kind.endings[0]);
  const std::span<const std::string_view> others(kind.endings.data(), kind.endings.size() - 1);
  return fmt::format("Take an ending {} or {}.", fmt::join(others, ", "), kind.endings.back());
}

}  // namespace

void check_output_files(std::initializer_list<OutputFile> files, const std::string& model, Diagnostics& diagnostics) {
  for (auto file = files.begin(); file != files.end(); ++file) {
    if (file->path.empty()) continue;
    const Kind kind = kind_of(file->kind);
    if (!is_special(file->path) && is_model(file->path, model)) {
      diagnostics.error("E0812", {}, fmt::format("{} {} is the model that is read.", file->option, file->path),
                        "Writing it would lose the model.", "Give another name.");
      continue;
    }
    if (const std::string other = model_behind(file->path); file->kind != FileKind::Model && !other.empty()) {
      diagnostics.error("E0812", {}, fmt::format("{} {} is a link to the model {}.", file->option, file->path, other),
                        "Writing it would lose that model.", "Give another name.");
      continue;
    }
    check_folder(*file, diagnostics);
    const bool known = std::any_of(kind.endings.begin(), kind.endings.end(),
                                   [&](std::string_view end) { return std::string_view(file->path).ends_with(end); });
    const bool takes_anything = is_special(file->path) && file->kind != FileKind::Table;  // of three formats of a table
    if (!known && !takes_anything)
      diagnostics.error("E0810", {}, fmt::format("{} names no format of a {}.", file->path, kind.name), {},
                        help_for(*file, kind));
    const std::string extension = fs::path(file->path).extension().string();
    if (extension == ".png" || extension == ".pdf")
      if (const std::string problem = known ? picture_problem() : std::string(); !problem.empty())
        diagnostics.error("E0840", {}, fmt::format("{} cannot be made: {}.", file->path, problem), {},
                          "Take .svg, which needs nothing else.");
    const auto twin = std::find_if(files.begin(), file, [&](const OutputFile& other) {
      return !other.path.empty() && is_same_file(other.path, file->path);
    });
    if (twin != file && !is_special(file->path))
      diagnostics.error("E0809", {}, fmt::format("{} and {} both ask for {}.", twin->option, file->option, file->path),
                        {}, "Give two files.");
  }
}

void check_is_new(const std::string& path, bool force, Diagnostics& diagnostics) {
  std::error_code error;
  if (force || diagnostics.has_errors() || path.empty() || is_special(path) || !fs::exists(path, error)) return;
  diagnostics.error("E0807", {}, fmt::format("{} exists already.", path), {},
                    "Choose another name with -o, or say --force to overwrite it.");
}

}  // namespace maupertuis::app

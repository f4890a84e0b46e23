#include "folder.hpp"

#include <maupertuis/trajectory.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <system_error>

namespace maupertuis::studio {
namespace {

namespace fs = std::filesystem;

bool is_hidden(const fs::path& path) { return path.filename().string().rfind('.', 0) == 0; }

/// What a path below the folder may be: a model, in no hidden folder.
bool is_model_path(const fs::path& path) {
  if (path.extension() != ".lag") return false;
  return std::none_of(path.begin(), path.end(), [](const fs::path& part) { return part == ".." || is_hidden(part); });
}

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

bool is_utf8(const std::string& text) {
  // A JSON text is UTF-8: the library that writes answers tells.
  try {
    nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

FileTrouble outside(const std::string& path) {
  return {403, "\"" + path + "\" is no model of the folder that was opened.",
          "The studio reads and writes .lag files below that folder alone.", "Start `maup studio` with its folder."};
}

}  // namespace

std::vector<Folder::Entry> Folder::list() const {
  std::vector<Entry> out;
  std::error_code error;
  if (!fs::is_directory(root_, error))
    throw FileTrouble{404, "The folder that was opened is no longer there.", root_.string() + " cannot be read.",
                      "What you have typed is kept in the page: export it, or bring the folder back."};
  auto it = fs::recursive_directory_iterator(root_, fs::directory_options::skip_permission_denied, error);
  for (; !error && it != fs::recursive_directory_iterator() && out.size() < most_entries; it.increment(error)) {
    if (is_hidden(it->path())) {
      it.disable_recursion_pending();
      continue;
    }
    std::error_code of_file;
    if (it.depth() > 12) it.disable_recursion_pending();
    const std::string path = it->path().lexically_relative(root_).generic_string();
    if (it->path().extension() == ".lag" && it->is_regular_file(of_file) && leads_inside(path))
      out.push_back({path, it->file_size(of_file)});
  }
  std::sort(out.begin(), out.end(), [](const Entry& a, const Entry& b) { return a.path < b.path; });
  return out;
}

/// Links are followed to where they lead: that has to be a model inside as well.
fs::path Folder::inside(const std::string& path) const {
  const fs::path asked(path);
  if (path.empty() || path.size() > 1000 || path.find('\0') != std::string::npos || asked.is_absolute() ||
      !is_model_path(asked))
    throw outside(path);
  std::error_code error;
  const fs::path root = fs::canonical(root_, error);
  if (error)
    throw FileTrouble{404, "The folder that was opened is no longer there.", root_.string() + " cannot be read.",
                      "What you have typed is kept in the page: export it, or bring the folder back."};
  const fs::path whole = fs::weakly_canonical(root / asked, error);
  const auto [end_of_root, below] = std::mismatch(root.begin(), root.end(), whole.begin(), whole.end());
  if (error || end_of_root != root.end()) throw outside(path);
  fs::path rest;
  for (auto part = below; part != whole.end(); ++part) rest /= *part;
  if (!is_model_path(rest)) throw outside(path);
  return whole;
}

bool Folder::leads_inside(const std::string& path) const {
  try {
    inside(path);
    return true;
  } catch (const FileTrouble&) {
    return false;
  }
}

std::string Folder::read(const std::string& path) const {
  const fs::path file = inside(path);
  std::error_code error;
  if (!fs::is_regular_file(file, error))
    throw FileTrouble{404, "There is no file " + path + ".", "It was moved or removed.", "Look at the list of files."};
  if (fs::file_size(file, error) > largest)
    throw FileTrouble{413, path + " is larger than a model can be here.",
                      "A model is a text that a person writes; this has more than a megabyte.",
                      "Is it the right file?"};
  std::string text = content_of(file);
  if (!is_utf8(text))
    throw FileTrouble{415, path + " is not written in UTF-8.",
                      "Some of its bytes stand for no letter; saved from here they would be lost.",
                      "Convert it, such as with `iconv -f latin1 -t utf-8`, and open it again."};
  return text;
}

void Folder::write(const std::string& path, const std::string& text, const std::string& expected) const {
  const fs::path file = inside(path);
  if (text.size() > largest)
    throw FileTrouble{413, "The text is too long to be saved here.", "A model has at most a megabyte.",
                      "Export it as a file."};
  std::error_code error;
  const bool there = fs::exists(file, error);
  if (there && !fs::is_regular_file(file, error)) throw outside(path);
  if (there && expected.empty())
    throw FileTrouble{409, path + " exists already.", "A new file does not take the place of another.",
                      "Choose another name, or open that file."};
  if (there && tag(content_of(file)) != expected)
    throw FileTrouble{409, path + " was changed by somebody else since it was read.",
                      "Another tab, an editor or a program has saved it.",
                      "Compare both, and choose which one to keep."};
  if (!there && !expected.empty())
    throw FileTrouble{409, path + " is no longer there.", "It was moved or removed since it was read.",
                      "Save it as a new file."};
  if (!fs::is_directory(file.parent_path(), error))
    throw FileTrouble{404, "There is no folder for " + path + ".", "It was moved or removed.",
                      "Save under another name."};
  if (const std::string failure = write_file(file.string(), text); !failure.empty())
    throw FileTrouble{500, failure + ".", "What was there before is untouched.", "Export the text as a file."};
}

std::string Folder::tag(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a: it tells versions apart, nothing more
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return std::to_string(text.size()) + "-" + std::to_string(hash);
}

}  // namespace maupertuis::studio

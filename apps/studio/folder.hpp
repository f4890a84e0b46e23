#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace maupertuis::studio {

/// Why a file was not read or written: an HTTP status, and what the page says.
struct FileTrouble {
  int status = 404;
  std::string message, reason, help;
};

/// The models below the folder that was opened. Nothing outside of it is read or written, whatever a path says.
class Folder {
 public:
  explicit Folder(std::filesystem::path root) : root_(std::move(root)) {}

  struct Entry {
    std::string path;  // below the folder, with /
    std::size_t size = 0;
  };
  static constexpr std::size_t most_entries = 2000;
  static constexpr std::size_t largest = 1'000'000;  // bytes of a model

  /// The .lag files, in the order of their names; without hidden folders and links to folders.
  std::vector<Entry> list() const;
  /// Throws FileTrouble.
  std::string read(const std::string& path) const;
  /// Saves a text whole, where the file still is what the page has read: `expected` is its tag, "" for a new file.
  /// Throws FileTrouble, with status 409 where somebody else has changed the file.
  void write(const std::string& path, const std::string& text, const std::string& expected) const;

  /// Of a content: the same for the same text.
  static std::string tag(const std::string& text);
  const std::filesystem::path& root() const { return root_; }

 private:
  std::filesystem::path inside(const std::string& path) const;
  bool leads_inside(const std::string& path) const;

  std::filesystem::path root_;
};

}  // namespace maupertuis::studio

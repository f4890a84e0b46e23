#pragma once
#include "machine_code/digest.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace maupertuis::machine_code {

/// Objects on disk, one file a key. A file carries its key, its length and a checksum: one that is damaged, cut off or
/// foreign is as good as absent and is written anew. Files appear whole, by renaming; so processes may read and write
/// at once. Code runs as the user: it is taken only from a folder and from files that the user owns and no one else can
/// write to, and never through a link.
class ObjectCache {
 public:
  static constexpr std::uintmax_t usual_limit = std::uintmax_t{256} << 20;

  explicit ObjectCache(std::filesystem::path folder, std::uintmax_t limit = usual_limit)
      : folder_(std::move(folder)), limit_(limit) {}

  /// $XDG_CACHE_HOME/maupertuis, else ~/.cache/maupertuis; empty where neither is set.
  static std::filesystem::path usual_folder();

  std::optional<std::vector<char>> read(const Digest& key) const;
  /// Then removes files that were not read for longest until the limit holds. Returns why it could not be written, or
  /// what stood in its place and is not run; empty: all is well.
  std::string write(const Digest& key, std::span<const char> object) const;

  struct Usage {
    std::size_t files = 0;
    std::uintmax_t bytes = 0;
  };
  Usage usage() const;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  static std::string name_of(const Digest& key) { return key.hex() + ".o"; }
  void trim() const;
  std::filesystem::path folder_;
  std::uintmax_t limit_;
};

}  // namespace maupertuis::machine_code

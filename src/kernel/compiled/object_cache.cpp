#include "kernel/compiled/object_cache.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include <unistd.h>

namespace maupertuis::compiled {
namespace {

namespace fs = std::filesystem;

struct Header {
  char magic[8];
  std::uint64_t key[2], length, checksum[2];
};
constexpr char magic[8] = {'m', 'a', 'u', 'p', 'o', 'b', 'j', '1'};

Header header_of(const Digest& key, std::span<const char> object) {
  const Digest sum = digest_of(object);
  Header header{{}, {key.high, key.low}, object.size(), {sum.high, sum.low}};
  std::memcpy(header.magic, magic, sizeof magic);
  return header;
}

/// Of this process and no other, whatever its threads do.
std::string temporary_ending() {
  static std::atomic<unsigned> count{0};
  return "." + std::to_string(getpid()) + "." + std::to_string(count++) + ".tmp";
}

struct File {
  fs::path path;
  fs::file_time_type time;
  std::uintmax_t size;
};

/// What cannot be read is skipped: another process may be at work here.
std::vector<File> files_of(const fs::path& folder, const char* extension) {
  std::vector<File> files;
  std::error_code ignored;
  for (auto entry = fs::directory_iterator(folder, ignored); entry != fs::directory_iterator(); entry.increment(ignored)) {
    if (ignored) break;
    if (entry->path().extension() != extension) continue;
    std::error_code gone;
    const File file{entry->path(), entry->last_write_time(gone), entry->file_size(gone)};
    if (!gone) files.push_back(file);
  }
  return files;
}

}  // namespace

fs::path ObjectCache::usual_folder() {
  if (const char* const xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg == '/') return fs::path(xdg) / "maupertuis";
  if (const char* const home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "maupertuis";
  return {};
}

std::optional<std::vector<char>> ObjectCache::read(const Digest& key) const {
  if (folder_.empty()) return {};
  std::ifstream in(path_of(key), std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::streamoff>(in.tellg());
  if (!in || size < static_cast<std::streamoff>(sizeof(Header))) return {};
  Header header;
  std::vector<char> object(static_cast<std::size_t>(size) - sizeof header);
  in.seekg(0);
  in.read(reinterpret_cast<char*>(&header), sizeof header);
  in.read(object.data(), static_cast<std::streamsize>(object.size()));
  const Header expected = header_of(key, object);
  if (!in || std::memcmp(&header, &expected, sizeof header) != 0) return {};
  std::error_code ignored;  // a cache that cannot be written still serves
  fs::last_write_time(path_of(key), fs::file_time_type::clock::now(), ignored);
  return object;
}

std::string ObjectCache::write(const Digest& key, std::span<const char> object) const {
  if (folder_.empty()) return "neither XDG_CACHE_HOME nor HOME is set";
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) return folder_.string() + " cannot be made: " + error.message();
  fs::path temporary = path_of(key);
  temporary += temporary_ending();
  const Header header = header_of(key, object);
  std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
  out.write(reinterpret_cast<const char*>(&header), sizeof header);
  out.write(object.data(), static_cast<std::streamsize>(object.size()));
  out.close();
  if (out) fs::rename(temporary, path_of(key), error);
  if (!out || error) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    return folder_.string() + " cannot be written";
  }
  trim();
  return {};
}

void ObjectCache::trim() const {
  std::error_code ignored;
  // What a process left that ended while writing.
  const auto old = fs::file_time_type::clock::now() - std::chrono::hours(1);
  for (const File& file : files_of(folder_, ".tmp"))
    if (file.time < old) fs::remove(file.path, ignored);
  std::vector<File> files = files_of(folder_, ".o");
  std::uintmax_t bytes = 0;
  for (const File& file : files) bytes += file.size;
  if (bytes <= limit_) return;
  std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.time < b.time; });
  for (const File& file : files) {
    if (bytes <= limit_) return;
    fs::remove(file.path, ignored);
    bytes -= file.size;
  }
}

ObjectCache::Usage ObjectCache::usage() const {
  Usage usage;
  for (const File& file : files_of(folder_, ".o")) ++usage.files, usage.bytes += file.size;
  return usage;
}

}  // namespace maupertuis::compiled

#include "machine_code/object_cache.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace maupertuis::machine_code {
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
  for (auto entry = fs::directory_iterator(folder, ignored); entry != fs::directory_iterator();
       entry.increment(ignored)) {
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

namespace {

/// A descriptor, closed at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  explicit operator bool() const { return number_ >= 0; }
  int number() const { return number_; }
  bool close() { return number_ < 0 || ::close(std::exchange(number_, -1)) == 0; }

 private:
  int number_;
};

/// What runs as the user must have been written by the user: anyone who can write here could have put in code of his
/// own.
std::string why_not_private(const struct stat& status, const std::string& name) {
  if (status.st_uid != geteuid()) return name + " belongs to another user";
  if ((status.st_mode & (S_IWGRP | S_IWOTH)) != 0) return name + " can be written by others (chmod go-w)";
  return {};
}

/// A folder that is no link and that the user alone writes to; else `trouble` says why it is not used.
Descriptor open_private(const fs::path& folder, std::string& trouble) {
  Descriptor out(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  struct stat status {};
  if (!out || fstat(out.number(), &status) != 0)
    trouble = folder.string() + " cannot be used: " + std::strerror(errno);
  else
    trouble = why_not_private(status, folder.string());
  return Descriptor(trouble.empty() ? dup(out.number()) : -1);
}

bool read_all(int file, char* to, std::size_t size) {
  while (size > 0) {
    const ssize_t count = ::read(file, to, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    to += count, size -= static_cast<std::size_t>(count);
  }
  return true;
}

bool write_all(int file, const char* from, std::size_t size) {
  while (size > 0) {
    const ssize_t count = ::write(file, from, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    from += count, size -= static_cast<std::size_t>(count);
  }
  return true;
}

/// Why what stands in an object's place is not run; empty where there is nothing, or the user's own file.
std::string why_refused(int folder, const std::string& name, const fs::path& path) {
  struct stat status {};
  if (fstatat(folder, name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0) return {};
  if (!S_ISREG(status.st_mode)) return path.string() + " is no plain file";
  return why_not_private(status, path.string());
}

}  // namespace

/// A pipe or a device in an object's place is passed over: opened without waiting, it is no file.
std::optional<std::vector<char>> ObjectCache::read(const Digest& key) const {
  if (folder_.empty()) return {};
  std::string trouble;
  const Descriptor folder = open_private(folder_, trouble);
  if (!folder) return {};
  const Descriptor file(openat(folder.number(), name_of(key).c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  struct stat status {};
  if (!file || fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode) || !why_not_private(status, {}).empty())
    return {};
  const auto size = static_cast<std::uintmax_t>(status.st_size);
  if (size < sizeof(Header) || size > limit_) return {};
  Header header;
  std::vector<char> object(size - sizeof header);
  if (!read_all(file.number(), reinterpret_cast<char*>(&header), sizeof header) ||
      !read_all(file.number(), object.data(), object.size()))
    return {};
  const Header expected = header_of(key, object);
  if (std::memcmp(&header, &expected, sizeof header) != 0) return {};
  const timespec now[2] = {{0, UTIME_OMIT}, {0, UTIME_NOW}};
  static_cast<void>(futimens(file.number(), now));  // a cache that cannot be written still serves
  return object;
}

std::string ObjectCache::write(const Digest& key, std::span<const char> object) const {
  if (folder_.empty()) return "neither XDG_CACHE_HOME nor HOME is set";
  std::error_code error;
  fs::create_directories(folder_.parent_path(), error);
  if (error || (mkdir(folder_.c_str(), S_IRWXU) != 0 && errno != EEXIST))
    return folder_.string() + " cannot be made: " + (error ? error.message() : std::strerror(errno));
  std::string trouble;
  const Descriptor folder = open_private(folder_, trouble);
  if (!folder) return trouble;
  const std::string temporary = name_of(key) + temporary_ending();
  const Header header = header_of(key, object);
  Descriptor file(openat(folder.number(), temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
                         S_IRUSR | S_IWUSR));
  const bool whole = file && write_all(file.number(), reinterpret_cast<const char*>(&header), sizeof header) &&
                     write_all(file.number(), object.data(), object.size());
  const std::string refused = why_refused(folder.number(), name_of(key), folder_ / name_of(key));
  if (!file.close() || !whole ||
      renameat(folder.number(), temporary.c_str(), folder.number(), name_of(key).c_str()) != 0) {
    static_cast<void>(unlinkat(folder.number(), temporary.c_str(), 0));
    return refused.empty() ? folder_.string() + " cannot be written" : refused + ", and cannot be replaced";
  }
  trim();
  return refused.empty() ? "" : refused + "; it was not run, and has been replaced";
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

}  // namespace maupertuis::machine_code

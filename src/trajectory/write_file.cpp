#include <maupertuis/trajectory.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

/// Whole or not at all: the content goes to a new name beside the target, to the disk, and takes the target's name in
/// one step. Until that step the old file stands untouched; after a failure the new name is removed.
namespace maupertuis {
namespace {

struct Target {
  std::string path;  // where the file is, links followed
  std::string folder;
  bool exists = false;
  struct stat status {};
};

Target resolve(const std::string& path) {
  Target target{path, ".", false, {}};
  if (char* real = realpath(path.c_str(), nullptr)) {
    target.path = real;
    std::free(real);
  }
  if (const auto slash = target.path.rfind('/'); slash != std::string::npos)
    target.folder = target.path.substr(0, slash == 0 ? 1 : slash);
  target.exists = ::stat(target.path.c_str(), &target.status) == 0;
  return target;
}

// The reason in words of someone who saves a file.
std::string reason_of(int error, const Target& target) {
  switch (error) {
    case ENOENT:
      return fmt::format("there is no folder {}", target.folder);
    case ENOTDIR:
      return fmt::format("{} is not a folder", target.folder);
    case EISDIR:
      return "it is a folder";
    case EACCES:
    case EPERM:
      return target.folder == "." ? "no permission to write in this folder"
                                  : fmt::format("no permission to write in the folder {}", target.folder);
    case EROFS:
      return "the disk is read-only";
    case ENOSPC:
    case EDQUOT:
      return "the disk is full";
    case EFBIG:
      return "the file would be larger than allowed";
    case ENAMETOOLONG:
      return "the name is too long";
    default:
      return std::strerror(error);
  }
}

// 0, or errno.
int write_all(int descriptor, const std::string& content) {
  std::size_t done = 0;
  while (done < content.size()) {
    const ssize_t count = ::write(descriptor, content.data() + done, content.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    done += static_cast<std::size_t>(count);
  }
  return 0;
}

// A device or a pipe has no content to lose and cannot be renamed to.
int write_in_place(const Target& target, const std::string& content) {
  const int descriptor = ::open(target.path.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) return errno;
  const int error = write_all(descriptor, content);
  return ::close(descriptor) != 0 && error == 0 ? errno : error;
}

// What a process left beside the target that ended while it wrote: the number of the process stands in the name.
void remove_left_over(const Target& target) {
  namespace fs = std::filesystem;
  const std::string begin = fs::path(target.path).filename().string() + ".partial-";
  std::error_code error;
  for (fs::directory_iterator it(target.folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.compare(0, begin.size(), begin) != 0) continue;
    const long process = std::strtol(name.c_str() + begin.size(), nullptr, 10);
    if (process > 0 && ::kill(static_cast<pid_t>(process), 0) != 0 && errno == ESRCH) ::unlink(it->path().c_str());
  }
}

// A name beside the target that nobody has yet. The descriptor, or -1 with errno set.
int open_beside(const Target& target, std::string& name) {
  for (int attempt = 0; attempt < 100; ++attempt) {
    name = fmt::format("{}.partial-{}-{}", target.path, ::getpid(), attempt);
    const int descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST) return descriptor;
  }
  return -1;
}

// The rename itself must reach the disk too; a file system that cannot do so is no failure.
void sync_folder(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  static_cast<void>(::fsync(descriptor));
  ::close(descriptor);
}

int replace(const Target& target, const std::string& content) {
  std::string name;
  remove_left_over(target);
  const int descriptor = open_beside(target, name);
  if (descriptor < 0) return errno;
  int error = write_all(descriptor, content);
  if (error == 0 && target.exists) static_cast<void>(::fchmod(descriptor, target.status.st_mode & 07777));
  if (error == 0 && ::fsync(descriptor) != 0 && errno != EINVAL) error = errno;
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error == 0 && ::rename(name.c_str(), target.path.c_str()) != 0) error = errno;
  if (error != 0)
    ::unlink(name.c_str());
  else
    sync_folder(target.folder);
  return error;
}

}  // namespace

std::string write_file(const std::string& path, const std::string& content) {
  const auto failed = [&](const std::string& reason) { return fmt::format("cannot write {}: {}", path, reason); };
  if (path.empty()) return "cannot write: the file name is empty";
  const Target target = resolve(path);
  if (target.exists && S_ISDIR(target.status.st_mode)) return failed("it is a folder");
  if (target.exists && ::access(target.path.c_str(), W_OK) != 0) return failed("the file is write-protected");
  const bool replaceable = !target.exists || S_ISREG(target.status.st_mode);
  const int error = replaceable ? replace(target, content) : write_in_place(target, content);
  return error == 0 ? std::string() : failed(reason_of(error, target));
}

}  // namespace maupertuis

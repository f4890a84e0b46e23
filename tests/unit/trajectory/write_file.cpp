// What is on the disk after a failure is what was there before.
#include <maupertuis/trajectory.hpp>

#include <doctest/doctest.h>

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace fs = std::filesystem;
using maupertuis::write_file;

namespace {

// A folder of its own for each test.
struct Folder {
  fs::path path;
  Folder() {
    std::string name = (fs::temp_directory_path() / "maup-write-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path = name;
  }
  ~Folder() { fs::remove_all(path); }
  std::string operator/(const std::string& name) const { return (path / name).string(); }
  std::size_t entries() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(path), {})); }
};

std::string content_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// Files of this process may not grow beyond `bytes` meanwhile: what a full disk does in the middle of a file.
class SizeLimit {
 public:
  explicit SizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  void (*handler_)(int);
  rlimit before_{};
};

}  // namespace

TEST_CASE("a new file appears whole, with nothing beside it") {
  const Folder folder;
  CHECK(write_file(folder / "a.csv", "t\r\n1\r\n") == "");
  CHECK(content_of(folder / "a.csv") == "t\r\n1\r\n");
  CHECK(folder.entries() == 1);
}

TEST_CASE("an existing file is replaced and keeps its permissions; a link is followed") {
  const Folder folder;
  std::ofstream(folder / "a.csv") << "old";
  fs::permissions(folder / "a.csv", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("a.csv", folder / "link.csv");
  CHECK(write_file(folder / "link.csv", "new") == "");
  CHECK(fs::is_symlink(folder / "link.csv"));
  CHECK(content_of(folder / "a.csv") == "new");
  CHECK(fs::status(folder / "a.csv").permissions() == (fs::perms::owner_read | fs::perms::owner_write));
  CHECK(folder.entries() == 2);
}

TEST_CASE("a new file has the permissions that the user's umask leaves") {
  const Folder folder;
  const mode_t before = ::umask(027);
  CHECK(write_file(folder / "a.csv", "x") == "");
  ::umask(before);
  CHECK((static_cast<unsigned>(fs::status(folder / "a.csv").permissions()) & 0777u) == 0640u);
}

TEST_CASE("a missing folder, a folder, a file for a folder: one sentence each") {
  const Folder folder;
  CHECK(write_file(folder / "none/a.csv", "x") ==
        "cannot write " + (folder / "none/a.csv") + ": there is no folder " + (folder / "none"));
  CHECK(write_file(folder.path.string(), "x") == "cannot write " + folder.path.string() + ": it is a folder");
  std::ofstream(folder / "file") << "old";
  CHECK(write_file(folder / "file/a.csv", "x") ==
        "cannot write " + (folder / "file/a.csv") + ": " + (folder / "file") + " is not a folder");
  CHECK(content_of(folder / "file") == "old");
  CHECK(write_file("", "x") == "cannot write: the file name is empty");
}

TEST_CASE("a full disk says so") {
  CHECK(write_file("/dev/full", "x") == "cannot write /dev/full: the disk is full");
  CHECK(write_file("/dev/null", "x") == "");
}

TEST_CASE("a write that ends half-way leaves the old file and nothing else") {
  const Folder folder;
  std::ofstream(folder / "a.csv") << "old";
  std::string sentence;
  {
    const SizeLimit limit(4096);
    sentence = write_file(folder / "a.csv", std::string(100'000, 'x'));
  }
  CHECK(sentence == "cannot write " + (folder / "a.csv") + ": the file would be larger than allowed");
  CHECK(content_of(folder / "a.csv") == "old");
  CHECK(folder.entries() == 1);
}

TEST_CASE("no permission: the folder or the file is protected") {
  const Folder folder;
  std::ofstream(folder / "a.csv") << "old";
  // The superuser is not stopped by permissions: a child without them tries instead.
  fs::permissions(folder / "a.csv",
                  fs::perms::all & ~fs::perms::owner_write & ~fs::perms::group_write & ~fs::perms::others_write);
  fs::permissions(folder.path, fs::perms::owner_read | fs::perms::owner_exec | fs::perms::group_read |
                                   fs::perms::group_exec | fs::perms::others_read | fs::perms::others_exec);
  int channel[2];
  REQUIRE(pipe(channel) == 0);
  if (fork() == 0) {
    if (geteuid() == 0 && setuid(65534) != 0) _exit(1);
    const std::string both = write_file(folder / "a.csv", "x") + "\n" + write_file(folder / "b.csv", "x");
    _exit(write(channel[1], both.data(), both.size()) == static_cast<ssize_t>(both.size()) ? 0 : 1);
  }
  close(channel[1]);
  std::string said(4096, '\0');
  said.resize(static_cast<std::size_t>(std::max<ssize_t>(0, read(channel[0], said.data(), said.size()))));
  close(channel[0]);
  CHECK(said == "cannot write " + (folder / "a.csv") + ": the file is write-protected\ncannot write " +
                    (folder / "b.csv") + ": no permission to write in the folder " + folder.path.string());
  fs::permissions(folder.path, fs::perms::owner_all);
  CHECK(content_of(folder / "a.csv") == "old");
  CHECK(folder.entries() == 1);
}

TEST_CASE("the ending names the format") {
  const Folder folder;
  maupertuis::Trajectory trajectory;
  trajectory.columns = {{"x", "m"}};
  trajectory.times = {0};
  trajectory.values = {1};
  for (const char* name : {"a.csv", "a.npy", "a.json"}) CHECK(write_trajectory(trajectory, folder / name) == "");
  CHECK(content_of(folder / "a.csv") == to_csv(trajectory));
  CHECK(content_of(folder / "a.npy") == to_npy(trajectory));
  CHECK(content_of(folder / "a.json") == to_json(trajectory));
  CHECK(write_trajectory(trajectory, folder / "a.txt") ==
        "cannot write " + (folder / "a.txt") + ": the format follows the ending, which is one of .csv, .npy, .json");
  CHECK(folder.entries() == 3);
}

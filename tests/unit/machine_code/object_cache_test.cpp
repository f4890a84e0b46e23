#include "machine_code/object_cache.hpp"

#include <doctest/doctest.h>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <fstream>
#include <thread>

using namespace maupertuis::machine_code;
namespace fs = std::filesystem;

namespace {

fs::path fresh_folder(const char* name) {
  const fs::path folder = fs::path(BUILD_DIR) / "tests" / name;
  fs::remove_all(folder);
  return folder;
}

std::vector<char> object_of(std::size_t size, char first) {
  std::vector<char> out(size);
  for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<char>(first + static_cast<char>(i % 101));
  return out;
}

fs::path file_of(const ObjectCache& cache, const Digest& key) { return cache.folder() / (key.hex() + ".o"); }

void overwrite(const fs::path& file, std::size_t at, char value) {
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(static_cast<std::streamoff>(at));
  stream.put(value);
}

}  // namespace

TEST_CASE("what is written is read, and nothing else") {
  const ObjectCache cache(fresh_folder("cache"));
  const Digest key{1, 2};
  CHECK(!cache.read(key));
  CHECK(cache.write(key, object_of(1000, 'a')) == "");
  CHECK(cache.read(key) == object_of(1000, 'a'));
  CHECK(!cache.read({2, 1}));
  CHECK(cache.write(key, object_of(10, 'b')) == "");
  CHECK(cache.read(key) == object_of(10, 'b'));
  CHECK(cache.usage().files == 1);
}

TEST_CASE("a changed byte anywhere, a missing end, an added end, a foreign name: as good as absent, and written anew") {
  const ObjectCache cache(fresh_folder("damaged-cache"));
  const Digest key{3, 4};
  const auto object = object_of(300, 'c');
  REQUIRE(cache.write(key, object) == "");
  const fs::path file = file_of(cache, key);
  const auto size = fs::file_size(file);
  for (std::size_t at = 0; at < size; at += 7) {
    overwrite(file, at, '~');  // stands nowhere in the header or the object
    CHECK(!cache.read(key));
    REQUIRE(cache.write(key, object) == "");
    CHECK(cache.read(key) == object);
  }
  for (const std::uintmax_t length : {size - 1, size / 2, std::uintmax_t{5}, std::uintmax_t{0}, size + 1}) {
    fs::resize_file(file, length);
    CHECK(!cache.read(key));
    REQUIRE(cache.write(key, object) == "");
  }
  fs::copy_file(file, file_of(cache, {3, 5}));
  CHECK(!cache.read({3, 5}));
}

TEST_CASE("the folder stays within its limit: what was not read for longest goes first") {
  const ObjectCache cache(fresh_folder("small-cache"), 3500);
  for (std::uint64_t i = 0; i < 3; ++i) {
    REQUIRE(cache.write({i, 0}, object_of(1000, 'd')) == "");
    fs::last_write_time(file_of(cache, {i, 0}), fs::file_time_type::clock::now() - std::chrono::minutes(10 - i));
  }
  CHECK(cache.usage().files == 3);
  CHECK(cache.read({0, 0}));  // so {1, 0} is the oldest
  REQUIRE(cache.write({7, 0}, object_of(1000, 'd')) == "");
  CHECK(cache.read({0, 0}));
  CHECK(!cache.read({1, 0}));
  CHECK(cache.read({2, 0}));
  CHECK(cache.read({7, 0}));
  CHECK(cache.usage().bytes <= 3500);
}

TEST_CASE("two processes of several threads write and read the same keys at once: never a wrong object") {
  const ObjectCache cache(fresh_folder("shared-cache"), 20000);
  const auto work = [&cache](unsigned seed) {
    bool good = true;
    for (unsigned i = 0; i < 300; ++i) {
      const Digest key{(i * 7 + seed) % 5, 9};
      const auto object = object_of(2000 + 500 * key.high, static_cast<char>('a' + key.high));
      if ((i + seed) % 3 != 0) {
        const auto found = cache.read(key);
        good = good && (!found || *found == object);
      } else {
        good = good && cache.write(key, object).empty();
      }
    }
    return good;
  };
  const pid_t child = fork();
  if (child == 0) _exit(work(1) ? 0 : 1);
  bool here[2] = {};
  std::thread other([&] { here[1] = work(3); });
  here[0] = work(2);
  other.join();
  int status = -1;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(here[0]);
  CHECK(here[1]);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  for (const auto& entry : fs::directory_iterator(cache.folder())) CHECK(entry.path().extension() == ".o");
}

TEST_CASE("a folder that cannot be made or written is told, and read as empty") {
  const fs::path file = fresh_folder("not-a-folder");
  fs::create_directories(file.parent_path());
  std::ofstream(file) << "x";
  const ObjectCache cache(file / "maupertuis");
  CHECK(!cache.read({1, 1}));
  CHECK(cache.write({1, 1}, object_of(10, 'e')).find("cannot be made") != std::string::npos);
  CHECK(cache.usage().files == 0);
  CHECK(ObjectCache({}).write({1, 1}, object_of(10, 'e')) == "neither XDG_CACHE_HOME nor HOME is set");
}

TEST_CASE("code that another could have written is not taken") {
  const ObjectCache cache(fresh_folder("private-cache"));
  const Digest key{5, 6};
  const auto object = object_of(100, 'g');
  REQUIRE(cache.write(key, object) == "");
  using fs::perms;
  CHECK((fs::status(cache.folder()).permissions() & perms::mask) == perms::owner_all);
  for (const perms other : {perms::group_write, perms::others_write}) {
    fs::permissions(file_of(cache, key), other, fs::perm_options::add);
    CHECK(!cache.read(key));
    const std::string told = cache.write(key, object);
    CHECK(told.find("can be written by others") != std::string::npos);
    CHECK(told.find("was not run, and has been replaced") != std::string::npos);
    CHECK(cache.read(key) == object);
    CHECK(cache.write(key, object) == "");
    fs::permissions(cache.folder(), other, fs::perm_options::add);
    CHECK(!cache.read(key));
    CHECK(cache.write(key, object).find("can be written by others") != std::string::npos);
    fs::permissions(cache.folder(), perms::owner_all, fs::perm_options::replace);
    CHECK(cache.read(key) == object);
  }
  if (geteuid() != 0) return;  // none but root gives files away
  REQUIRE(chown(file_of(cache, key).c_str(), 12345, 12345) == 0);
  CHECK(!cache.read(key));
  CHECK(cache.write(key, object).find("belongs to another user; it was not run") != std::string::npos);
  REQUIRE(chown(cache.folder().c_str(), 12345, 12345) == 0);
  CHECK(!cache.read(key));
  CHECK(cache.write(key, object).find("belongs to another user") != std::string::npos);
}

TEST_CASE("links, folders and pipes in an object's place are passed over, without waiting") {
  const fs::path folder = fresh_folder("odd-cache"), elsewhere = fresh_folder("odd-cache-elsewhere");
  const ObjectCache cache(folder), other(elsewhere);
  const Digest key{7, 8};
  const auto object = object_of(100, 'h');
  REQUIRE(cache.write({1, 1}, object) == "");
  REQUIRE(other.write(key, object) == "");
  fs::create_symlink(file_of(other, key), file_of(cache, key));
  CHECK(!cache.read(key));
  const std::string told = cache.write(key, object_of(100, 'i'));  // in place of the link, not through it
  CHECK(told.find("is no plain file; it was not run, and has been replaced") != std::string::npos);
  CHECK(other.read(key) == object);
  CHECK(cache.read(key) == object_of(100, 'i'));
  REQUIRE(mkfifo(file_of(cache, {7, 9}).c_str(), 0600) == 0);
  CHECK(!cache.read({7, 9}));
  CHECK(cache.write({7, 9}, object).find("is no plain file") != std::string::npos);
  fs::create_directory(file_of(cache, {7, 10}));
  CHECK(!cache.read({7, 10}));
  const fs::path link = fresh_folder("linked-cache");
  fs::create_directory_symlink(folder, link);
  CHECK(!ObjectCache(link).read(key));
  CHECK(ObjectCache(link).write(key, object).find("cannot be used") != std::string::npos);
}

TEST_CASE("a write that fails at its end, as on a full device, leaves nothing") {
  const fs::path folder = fresh_folder("full-cache");
  const ObjectCache cache(folder);
  fs::create_directories(folder);
  fs::create_directory(file_of(cache, {1, 1}));
  CHECK(cache.write({1, 1}, object_of(10, 'f')).find("is no plain file, and cannot be replaced") != std::string::npos);
  CHECK(std::distance(fs::directory_iterator(folder), fs::directory_iterator()) == 1);
}

#include "video.hpp"

#include "interrupt.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>

extern char** environ;

namespace maupertuis::app {
namespace {

constexpr int film_descriptor = 3;  // of ffmpeg: a file in memory

std::vector<std::string> arguments_of(const std::string& ffmpeg, const Video::Options& o) {
  std::vector<std::string> list{ffmpeg,
                                "-hide_banner",
                                "-loglevel",
                                "error",
                                "-f",
                                "rawvideo",
                                "-pix_fmt",
                                "bgr0",
                                "-s",
                                fmt::format("{}x{}", o.width, o.height),
                                "-r",
                                fmt::format("{:.6g}", o.fps),
                                "-i",
                                "pipe:0",
                                "-fflags",
                                "+bitexact",
                                "-flags:v",
                                "+bitexact",
                                "-map_metadata",
                                "-1"};
  const auto add = [&](std::initializer_list<const char*> more) { list.insert(list.end(), more.begin(), more.end()); };
  // A picture of few colours: each frame has the palette that it needs, so that none waits for the last.
  if (o.format == Video::Format::Gif)
    add({"-vf", "split[a][b];[a]palettegen=stats_mode=single:max_colors=96[p];[b][p]paletteuse=new=1:dither=none",
         "-loop", o.loop ? "0" : "-1", "-f", "gif"});
  else
    add({"-c:v", "libx264", "-preset", "medium", "-crf", "18", "-pix_fmt", "yuv420p", "-movflags", "+faststart",
         "-threads", "2", "-f", "mp4"});
  list.push_back("-y");
  list.push_back(fmt::format("/proc/self/fd/{}", film_descriptor));
  return list;
}

std::string content_of(int descriptor) {
  std::string out;
  char block[1 << 16];
  off_t at = 0;
  for (ssize_t count; (count = pread(descriptor, block, sizeof block, at)) > 0; at += count)
    out.append(block, static_cast<std::size_t>(count));
  return out;
}

}  // namespace

std::string find_ffmpeg() {
  const char* path = std::getenv("PATH");
  std::stringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (folder.empty() || folder[0] != '/') continue;  // not the folder where one happens to be
    const std::string file = folder + "/ffmpeg";
    struct stat status {};
    if (stat(file.c_str(), &status) == 0 && S_ISREG(status.st_mode) && access(file.c_str(), X_OK) == 0) return file;
  }
  return {};
}

struct Video::Process {
  pid_t id = -1;
  int input = -1, film = -1, words = -1;
  std::string problem;

  ~Process() {
    close_input();
    if (id > 0) {
      kill(id, SIGKILL);
      waitpid(id, nullptr, 0);
    }
    for (const int descriptor : {film, words})
      if (descriptor >= 0) close(descriptor);
  }
  void close_input() {
    if (input >= 0) close(input);
    input = -1;
  }
};

Video::Video(const std::string& ffmpeg, const Options& options) : process_(std::make_unique<Process>()) {
  Process& p = *process_;
  int ends[2];
  p.film = memfd_create("film", MFD_CLOEXEC);
  p.words = memfd_create("words", MFD_CLOEXEC);
  if (p.film < 0 || p.words < 0 || pipe2(ends, O_CLOEXEC) != 0) {
    p.problem = std::strerror(errno);
    return;
  }
  std::vector<std::string> words = arguments_of(ffmpeg, options);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, p.words, STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&files, p.film, film_descriptor);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t defaults;
  sigemptyset(&defaults);
  sigaddset(&defaults, SIGPIPE);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);  // Ctrl-C is for maup, which ends ffmpeg
  const int error = posix_spawn(&p.id, ffmpeg.c_str(), &files, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  close(ends[0]);
  p.input = ends[1];
  fcntl(p.input, F_SETFL, O_NONBLOCK);
  if (error == 0) return;
  p.id = -1;
  p.problem = std::strerror(error);
}

Video::~Video() = default;

bool Video::add(const std::vector<std::uint8_t>& pixels) {
  Process& p = *process_;
  for (std::size_t done = 0; p.id > 0 && done < pixels.size();) {
    if (interrupt_flag().load()) return false;  // ffmpeg may be slow to take what it is given
    pollfd ready{p.input, POLLOUT, 0};
    constexpr int milliseconds = 50;
    if (poll(&ready, 1, milliseconds) <= 0) continue;
    const ssize_t count = write(p.input, pixels.data() + done, pixels.size() - done);
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count <= 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return p.id > 0;
}

Video::Film Video::finish() {
  Process& p = *process_;
  p.close_input();
  int status = -1;
  while (p.id > 0 && waitpid(p.id, &status, 0) < 0 && errno == EINTR) {
  }
  const bool ran = p.id > 0;
  p.id = -1;
  if (!p.problem.empty()) return {{}, p.problem};
  if (ran && WIFEXITED(status) && WEXITSTATUS(status) == 0) return {content_of(p.film), {}};
  std::string words = content_of(p.words);
  while (!words.empty() && (words.back() == '\n' || words.back() == ' ')) words.pop_back();
  const std::size_t line = words.rfind('\n');
  return {{}, words.empty() ? "it ended without a word" : words.substr(line == std::string::npos ? 0 : line + 1)};
}

}  // namespace maupertuis::app

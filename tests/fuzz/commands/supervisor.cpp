#include "supervisor.hpp"

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>

namespace maupertuis::fuzz {
namespace fs = std::filesystem;

/// What the process that runs inputs leaves where this one can read it, also after its end.
struct Supervisor::Shared {
  std::atomic<std::uint64_t> at;        // the input that is running, or the next one
  std::atomic<double> processor_begin;  // when it began, in seconds of the process
  std::atomic<double> clock_begin;
  std::atomic<bool> failed;       // it was judged, and waits to be told
  std::atomic<bool> interrupted;  // it was asked to end, and has ended by itself
  std::atomic<std::uint64_t> codes[256];
  int code;
  char words[1024];
};

namespace {

constexpr double idle_part = 1e-3;  // of the clock: what uses less processor time waits for something else

double seconds_of(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string whole(int descriptor) {
  const auto size = lseek(descriptor, 0, SEEK_END);
  std::string text(static_cast<std::size_t>(std::max<off_t>(size, 0)), '\0');
  const auto got = pread(descriptor, text.data(), text.size(), 0);
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  return text;
}

void empty(int descriptor) {
  if (ftruncate(descriptor, 0) != 0) std::perror("ftruncate");
  lseek(descriptor, 0, SEEK_SET);
}

int memory_file(const char* name) {
  const int descriptor = memfd_create(name, 0);
  if (descriptor < 0) throw std::runtime_error("no file in memory");
  return descriptor;
}

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

Supervisor::Supervisor(Program program, Limits limits) : program_(std::move(program)), limits_(limits) {
  void* const memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no shared memory");
  shared_ = new (memory) Shared{};
  std::string pattern =
      (fs::exists("/dev/shm") ? "/dev/shm" : fs::temp_directory_path().string()) + "/maup_fuzz_XXXXXX";
  if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
  folder_ = pattern;
  in_ = memory_file("in"), out_ = memory_file("out"), err_ = memory_file("err");
}

Supervisor::~Supervisor() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
  munmap(shared_, sizeof(Shared));
  for (const int descriptor : {in_, out_, err_}) close(descriptor);
}

void Supervisor::prepare(const Input& input) {
  for (const auto& entry : fs::directory_iterator(folder_)) fs::remove_all(entry.path());
  std::ofstream(folder_ + "/model.lag", std::ios::binary) << input.model;
  for (const int descriptor : {in_, out_, err_}) empty(descriptor);
  if (pwrite(in_, input.model.data(), input.model.size(), 0) < 0) std::perror("pwrite");
  lseek(in_, 0, SEEK_SET);
  std::clearerr(stdin);
  std::fseek(stdin, 0, SEEK_SET);
}

Outcome Supervisor::carry_out(const Input& input) {
  prepare(input);
  std::vector<std::string> words{"maup"};
  words.insert(words.end(), input.arguments.begin(), input.arguments.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  Outcome outcome;
  outcome.code = program_(static_cast<int>(words.size()), arguments.data());
  std::cout.flush(), std::cerr.flush();
  std::fflush(nullptr);
  outcome.out = whole(out_), outcome.err = whole(err_);
  for (const auto& entry : fs::directory_iterator(folder_))
    if (entry.is_regular_file() && entry.file_size() < 20'000'000)
      outcome.files[entry.path().filename()] = content(entry.path());
  return outcome;
}

/// Never returns.
void Supervisor::child(std::uint64_t first, std::uint64_t last, const Draw& draw, const Judge& judge) {
  const rlimit memory{limits_.memory, limits_.memory}, no_core{0, 0};
  setrlimit(RLIMIT_AS, &memory);
  setrlimit(RLIMIT_CORE, &no_core);
  for (const auto& [from, to] : {std::pair(in_, 0), std::pair(out_, 1), std::pair(err_, 2)}) dup2(from, to);
  if (chdir(folder_.c_str()) != 0) _exit(1);
  for (std::uint64_t number = first; number < last; ++number) {
    const Input input = draw(number);
    shared_->processor_begin = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    shared_->clock_begin = seconds_of(CLOCK_MONOTONIC);
    shared_->at = number;
    const Outcome outcome = carry_out(input);
    shared_->code = outcome.code;
    ++shared_->codes[outcome.code & 255];
    if (outcome.code == 130) {  // nobody but the supervisor interrupts
      shared_->interrupted = true;
      _exit(0);
    }
    if (const auto wrong = judge(input, outcome)) {
      std::snprintf(shared_->words, sizeof shared_->words, "%s", wrong->c_str());
      shared_->failed = true;
      _exit(0);
    }
    shared_->at = number + 1;
  }
  _exit(0);
}

void Supervisor::run(std::uint64_t first, std::uint64_t count, const Draw& draw, const Judge& judge, const Tell& tell,
                     const std::function<bool()>& stop) {
  const std::uint64_t end = first + count;
  shared_->at = first;
  while (shared_->at < end && !stop()) {
    const std::uint64_t from = shared_->at;
    shared_->failed = shared_->interrupted = false;
    shared_->processor_begin = 0;
    shared_->clock_begin = seconds_of(CLOCK_MONOTONIC);
    std::fflush(nullptr);
    const pid_t pid = fork();
    const std::uint64_t last = std::min(end, from + limits_.inputs_of_process);
    if (pid == 0) child(from, last, draw, judge);
    if (pid < 0) throw std::runtime_error("no process");
    clockid_t clock{};
    clock_getcpuclockid(pid, &clock);
    Outcome outcome;
    int status = 0;
    double asked = 0;  // when it was told to end
    bool stopped = false, waiting = false;
    while (waitpid(pid, &status, WNOHANG) == 0) {
      usleep(2000);
      const double now = seconds_of(CLOCK_MONOTONIC);
      if (stop()) kill(pid, SIGKILL), stopped = true;
      const double used = seconds_of(clock) - shared_->processor_begin, passed = now - shared_->clock_begin;
      // A process of the lowest priority on a busy machine waits for the processor, but not for ever.
      const bool idle = passed > limits_.waiting && used < idle_part * passed;
      if ((idle || used > limits_.seconds) && asked == 0 && !shared_->failed)
        kill(pid, SIGTERM), asked = now, waiting = idle;
      if (asked != 0 && now - asked > 5) kill(pid, SIGKILL);
    }
    const std::uint64_t at = shared_->at;
    counts_.inputs += at - from;
    if (stopped) break;
    outcome.code = shared_->code;
    if (asked != 0 && at < last) {
      outcome.too_long = true;
      outcome.waiting = waiting;
      outcome.interruptible = shared_->interrupted;
    } else if (WIFSIGNALED(status)) {
      outcome.signal = WTERMSIG(status);
    } else if (!shared_->failed && at < last) {
      outcome.signal = SIGABRT;  // it ended the program without returning
    }
    if (shared_->failed || outcome.too_long || outcome.signal) {
      outcome.out = whole(out_), outcome.err = whole(err_);
      ++counts_.inputs;
      const auto wrong = shared_->failed ? std::optional<std::string>(shared_->words) : judge(draw(at), outcome);
      if (wrong)
        tell(at, *wrong, outcome);
      else
        ++counts_.long_runs;
      shared_->at = at + 1;
    }
  }
  for (int code = 0; code < 256; ++code)
    if (shared_->codes[code]) counts_.by_code[code] = shared_->codes[code];
}

}  // namespace maupertuis::fuzz

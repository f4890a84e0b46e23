// replay FILE|FOLDER...: feeds stored texts to the fuzz target, one after another, without libFuzzer: what the fuzzer
// once found stays found. A text that ends the program, or takes more than ten seconds of the processor, is named.
#include <sys/time.h>
#include <unistd.h>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;

constexpr time_t seconds_for_one = 10;  // of the processor: beside other tests, clocks on the wall run faster
char current[4096];                     // a handler of signals may read nothing that moves

void name_the_text(int signal) {
  const char* const words = signal == SIGPROF ? "\ntakes too long: " : "\nends the program: ";
  for (const char* const text : {words, static_cast<const char*>(current), "\n"})
    if (write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

std::vector<fs::path> texts(const fs::path& from) {
  if (!fs::is_directory(from)) return {from};
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(from))
    if (entry.is_regular_file()) out.push_back(entry.path());
  return out;
}

/// 0: no longer.
void end_after(time_t seconds) {
  const itimerval timer{{0, 0}, {seconds, 0}};
  setitimer(ITIMER_PROF, &timer, nullptr);
}

bool feed(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::fprintf(stderr, "cannot be read: %s\n", path.c_str()), false;
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::snprintf(current, sizeof current, "%s", path.c_str());
  end_after(seconds_for_one);
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  end_after(0);
  return true;
}

}  // namespace

int main(int count, char** arguments) {
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGILL, SIGPROF}) std::signal(signal, name_the_text);
  std::size_t fed = 0;
  for (int i = 1; i < count; ++i)
    for (const fs::path& path : texts(arguments[i])) {
      if (!feed(path)) return 1;
      ++fed;
    }
  std::printf("%zu texts\n", fed);
  return fed == 0;  // an empty corpus proves nothing
}

// Random models with walls, pulses, layers and switches: a run exits 0 only with the right motion. scripts/steep_models
// asks for more of them, and fresh ones.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include "referee.hpp"

using namespace steep;

namespace {

unsigned long long from_environment(const char* name, unsigned long long otherwise) {
  const char* const text = std::getenv(name);
  return text && *text ? std::strtoull(text, nullptr, 10) : otherwise;
}

/// Classes of which not one may be wrong. Of the others the table tells.
const std::set<std::string> hold = {"walls", "pulses", "layers", "switches", "mixed", "cores"};

struct Count {
  std::array<int, 5> of{};  // by verdict
  double largest = 0;
};

/// Keeps a model that went wrong, with the right values as its expectations.
void keep(unsigned long long number, const Description& d, const Judgement& j) {
  const std::filesystem::path folder = std::filesystem::path(BUILD_DIR) / "steep_models";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / fmt::format("{}_{}.lag", d.kind, number))
      << text_of(d, fmt::format("steep_{}", number)) << j.expectations
      << fmt::format("# error {:.2g}, stated {:.2g} {}\n", j.error, j.stated, j.reason);
}

class Session {
 public:
  void run(unsigned long long first, unsigned long long count, unsigned threads) {
    std::vector<std::thread> team;
    std::atomic<unsigned long long> next{0};
    for (unsigned i = 0; i < threads; ++i)
      team.emplace_back([&] {
        for (unsigned long long k = next++; k < count; k = next++) one(first + k);
      });
    for (std::thread& t : team) t.join();
  }

  std::string table() const {
    std::string out = fmt::format("{:<10} {:>7} {:>7} {:>7} {:>8} {:>9}  {}\n", "class", "right", "ended", "WRONG",
                                  "refused", "unjudged", "largest error of the right ones");
    for (const auto& [kind, c] : counts_)
      out += fmt::format("{:<10} {:>7} {:>7} {:>7} {:>8} {:>9}  {:.1e}\n", kind, c.of[0], c.of[1], c.of[2], c.of[3],
                         c.of[4], c.largest);
    return out + told_;
  }

  std::map<std::string, Count> counts_;

 private:
  void one(unsigned long long number) {
    const Description d = random_description(number);
    const char* const arguments = std::getenv("STEEP_ARGUMENTS");
    const Judgement j = judge(d, arguments ? arguments : "");
    const std::lock_guard lock(mutex_);
    Count& c = counts_[d.kind];
    ++c.of[static_cast<std::size_t>(j.verdict)];
    if (j.verdict == Verdict::Right) c.largest = std::max(c.largest, j.error);
    if (j.verdict == Verdict::Wrong || (j.verdict != Verdict::Right && std::getenv("STEEP_KEEP"))) keep(number, d, j);
    if (j.verdict == Verdict::Wrong)
      told_ +=
          fmt::format("WRONG {} {}: error {:.2g}, stated {:.2g} {}\n", d.kind, number, j.error, j.stated, j.reason);
    if (j.verdict == Verdict::Ended || j.verdict == Verdict::Refused)
      told_ +=
          fmt::format("{} {} {}: {}\n", j.verdict == Verdict::Ended ? "ended" : "refused", d.kind, number, j.reason);
  }

  std::mutex mutex_;
  std::string told_;
};

void check_models(unsigned long long first, unsigned long long count) {
  Session session;
  session.run(first, count, static_cast<unsigned>(from_environment("STEEP_THREADS", 2)));
  fmt::print("{}", session.table());
  int judged = 0;
  for (const auto& [kind, c] : session.counts_) {
    CAPTURE(kind);
    judged += c.of[0] + c.of[1] + c.of[2];
    CHECK(c.of[static_cast<std::size_t>(Verdict::Refused)] == 0);
    if (kind == "cores")
      CHECK(c.of[static_cast<std::size_t>(Verdict::Ended)] == 0);  // none of them meets a singularity
    if (hold.count(kind))
      CHECK(c.of[static_cast<std::size_t>(Verdict::Wrong)] == 0);
    else if (c.of[2] > 0)
      MESSAGE(fmt::format("{} to be mended: {} wrong", kind, c.of[2]));
  }
  // The reference judges nearly all: too sensitive ones are rare.
  CHECK(judged >= static_cast<int>(count) * 9 / 10);
}

}  // namespace

TEST_CASE("random steep models: no wrong number without a word") {
  const auto count = from_environment("STEEP_COUNT", 100), first = from_environment("STEEP_FIRST", 1);
  check_models(first, count);
}

TEST_CASE("random cores: no wrong number without a word") {
  check_models(first_core + from_environment("STEEP_FIRST", 1), from_environment("STEEP_COUNT", 60));
}
